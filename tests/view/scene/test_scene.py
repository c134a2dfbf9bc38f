"""Scenes of what stages give: names are unique, motions are of layers that are there, curves are put together."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.view.scene.curves import Curves, Fact
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import PointsLayer, StripsLayer
from lamella.view.scene.scene import make_scene
from lamella.view.scene.thinning import rim_edges


def layer(name: str, **more: object) -> PointsLayer:
    return PointsLayer(name=name, label=name, positions=np.array([[0.0, 0, 0], [1, 2, 3]]), **more)  # type: ignore[arg-type]


def test_names_are_unique_also_those_of_frames() -> None:
    with pytest.raises(ValueError, match="'a'"):
        make_scene("x", [layer("a"), layer("a")])
    with pytest.raises(ValueError, match="'a'"):
        make_scene("x", [layer("a"), Frames("f", "F", np.zeros(1), layers=(layer("a"),))])


def test_motions_are_of_layers_that_are_there_and_of_all_frames() -> None:
    still = np.zeros((2, 2, 3))
    with pytest.raises(ValueError, match="'b'"):
        make_scene("x", [layer("a"), Frames("f", "F", np.zeros(2), motions=(Motion("b", still),))])
    with pytest.raises(ValueError, match="3 frames"):
        Frames("f", "F", np.zeros(3), motions=(Motion("a", still),))
    with pytest.raises(ValueError, match="captions"):
        Frames("f", "F", np.zeros(3), captions=("one",))
    with pytest.raises(ValueError, match="not both"):
        Motion("a", positions=still, displacements=still)


def test_curves_of_one_name_are_one() -> None:
    def curves(label: str) -> Curves:
        none = np.zeros(0, int)
        return Curves(
            "c",
            "Lamella",
            ("A1",),
            np.array([0, 1]),
            np.zeros(1),
            np.zeros(2, int),
            none,
            none,
            (Fact(label, "", ("1",)),),
        )

    (both,) = make_scene("x", [curves("first"), curves("second")]).curves
    assert [fact.label for fact in both.facts] == ["first", "second"]


def test_the_box_is_of_what_is_built() -> None:
    scene = make_scene("x", [layer("a"), layer("ground", material="ground")])
    assert [corner.tolist() for corner in scene.box] == [[0, 0, 0], [1, 2, 3]]


def test_the_rim_is_the_edges_of_one_triangle() -> None:
    """Of a square of two triangles: its four sides."""
    edges = rim_edges(np.array([[0, 1, 2], [0, 2, 3]]))
    assert edges.tolist() == [[0, 1], [1, 2], [2, 3], [3, 0]]


def test_the_box_reaches_to_the_edges_of_strips() -> None:
    """Of a strip 0.2 high that stands on a line and leans by 0.6 to the side."""
    up = np.tile([0.6, 0.0, 0.8], (2, 1))
    measures = {"height": 0.2, "thickness": 0.01, "level": 0.05}
    line = np.array([[0.0, 0, 0], [0, 3, 0]])
    strips = StripsLayer(
        name="s", label="S", positions=line, normals=up, offsets=np.array([0, 2]), sides=np.zeros(1), **measures
    )
    low, high = make_scene("x", [strips]).box
    assert low == pytest.approx([-0.03, 0, -0.04])
    assert high == pytest.approx([0.09, 3, 0.12])
