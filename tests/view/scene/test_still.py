"""A scene in one frame: layers moved, hidden and coloured as the slider says."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.view.render.soup import shown_layers
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import MeshLayer, PointsLayer
from lamella.view.scene.quantity import magnitude
from lamella.view.scene.scene import Scene, make_scene
from lamella.view.scene.still import at_frame
from lamella.view.surroundings import standing, surroundings

PLACES = np.array([[0.0, 0, 0], [1, 2, 3]])


def layer(name: str, group: str) -> PointsLayer:
    use = magnitude("use", "Use", "", np.zeros(2), 1.0)
    return PointsLayer(name=name, label=name, positions=PLACES, groups=(group,), quantities=(use,))


@pytest.fixture
def scene() -> Scene:
    steps = np.arange(3.0)[:, None, None] * np.ones((3, 2, 3))
    values = np.arange(6.0).reshape(3, 2)
    motions = (Motion("a", displacements=steps, values={"use": values}), Motion("own", positions=PLACES + steps))
    own = (layer("own", "x"),)
    frames = Frames("f", "F", np.arange(3.0), motions=motions, layers=own, hides=("b", "group:h"), exaggeration=4)
    return make_scene("x", [layer("a", "g"), layer("b", "g"), layer("c", "h"), layer("d", "g"), frames])


def test_layers_are_where_the_frame_has_them(scene: Scene) -> None:
    still = at_frame(scene, "f", 2)
    assert [one.name for one in still.layers] == ["a", "d", "own"]
    np.testing.assert_array_equal(still.layer("a").points, PLACES + 8)
    np.testing.assert_array_equal(still.layer("own").points, PLACES + 2)
    np.testing.assert_array_equal(still.layer("d").points, PLACES)
    assert still.layer("a").quantities[0].values.tolist() == [4, 5]
    np.testing.assert_array_equal(at_frame(scene, "f", -3).layer("a").points, PLACES)


@pytest.mark.parametrize(("name", "frame"), [("g", 0), ("f", 3), ("f", -4)])
def test_frames_that_are_not_there_are_refused(scene: Scene, name: str, frame: int) -> None:
    with pytest.raises(InputError) as error:
        at_frame(scene, name, frame)
    assert error.value.where == "--frames"


def test_the_ground_is_below_what_a_frame_shows() -> None:
    """A roof from 0 to 3 m that lies at 1 m before it is raised, with a hidden layer farther down."""
    roof = MeshLayer(name="roof", label="roof", positions=np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 3]]), faces=FACE)
    deep = MeshLayer(name="deep", label="deep", positions=roof.positions - 9, faces=FACE, groups=("g",), visible=False)
    flat = np.array([[[0.0, 0, 1], [5, 0, 1], [0, 5, 1]]])
    frames = Frames("f", "F", np.zeros(1), motions=(Motion("roof", positions=flat),))
    scene = make_scene("x", [roof, deep, frames, *surroundings(*np.array([[0.0, 0, 0], [4, 4, 3]]))])
    moved = at_frame(scene, "f", 0)
    still = standing(moved, shown_layers(moved, surface=True))
    assert still.layer("ground").points[0].tolist() == [2.5, 2.5, 1.0]
    assert still.layer("person").points[:, 2].min() == 1.0
    assert still.layer("person").points[:, 0].min() > 5.0


FACE = np.array([[0, 1, 2]])
