"""Pictures: what is where it has to be, shadows fall away from the sun, the same bytes whatever the scale."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.view.render.light import sun_of
from lamella.view.render.png import png_bytes
from lamella.view.render.render import render
from lamella.view.render.soup import linear
from lamella.view.render.standpoint import VIEWS, direction_of, standpoint
from lamella.view.scene.layer import LinesLayer, MeshLayer, StripsLayer
from lamella.view.scene.quantity import magnitude
from lamella.view.scene.scene import Scene
from lamella.view.surroundings import surroundings

SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]])


def plate(at: Any = (0.0, 0.0, 0.0), size: float = 1.0, **more: Any) -> MeshLayer:
    return MeshLayer(name=f"plate {at}", label="P", positions=size * SQUARE + at, faces=FACES, **more)


def strips(scale: float = 1.0, away: Any = (0.0, 0.0, 0.0)) -> Scene:
    x = np.linspace(-1, 1, 40)
    points = np.stack([x, 0.3 * x, 0.5 * x**2], 1)
    layer = StripsLayer(
        name="s",
        label="S",
        material="steel",
        palette="Lamellas",
        quantities=(magnitude("use", "Use", "", x + 1),),
        positions=scale * points + away,
        normals=np.tile([0.0, 0, 1], (40, 1)),
        offsets=np.array([0, 40]),
        sides=scale * np.array([-0.05, 0.05]),
        height=scale * 0.2,
        thickness=scale * 0.01,
    )
    return Scene("x", (layer,))


def test_the_same_pixels_in_every_run_at_any_scale_and_in_survey_coordinates() -> None:
    first = render(strips(), size=(160, 100))
    assert (first == render(strips(), size=(160, 100))).all()
    for scale, away in ((1000.0, (0, 0, 0)), (1.0, (4.5e6, 5.3e6, 500.0))):
        other = render(strips(scale, away), size=(160, 100))
        off = np.abs(other.astype(int) - first)
        assert (off.max(2) > 8).mean() < 0.01


@pytest.mark.parametrize("view", [*VIEWS, "30,-20"])
def test_everything_is_in_the_picture_and_fills_it(view: str) -> None:
    points = np.random.default_rng(5).uniform(-1, 3, (60, 3)) * [2, 1, 0.7]
    camera = standpoint(view, points, float(points[:, 2].min()), 300, 200)
    flat, ahead = camera.pixels(points, 300, 200)
    assert (ahead > 0).all()
    assert flat.min() >= 0
    assert (flat <= [300, 200]).all()
    # up to the margin, on the side that is tighter, and as much on either side
    low, high = flat.min(0), [300, 200] - flat.max(0)
    assert low == pytest.approx(high, abs=2)
    assert min(low / [300, 200]) < 0.05


def test_points_are_where_geometry_has_them() -> None:
    """A camera twice as far away as a plate of side 2 is wide sees it under the angle atan(1/d)."""
    picture = render(Scene("x", (plate(),)), view="top", size=(200, 200))
    plain = picture.astype(int)
    is_plate = np.abs(plain - plain[1, 1]).sum(2) > 60
    rows, columns = np.flatnonzero(is_plate.any(1)), np.flatnonzero(is_plate.any(0))
    assert np.ptp(columns) + 1 == pytest.approx(200 / 1.06, abs=2)
    assert np.ptp(rows) + 1 == pytest.approx(200 / 1.06, abs=2)
    assert columns.mean() == pytest.approx(99.5, abs=1)


def test_a_shadow_falls_away_from_the_sun() -> None:
    high, ends = plate((0.0, 0.0, 1.5), 0.5), [plate((x, y, 0.0), 0.01) for x in (-3, 3) for y in (-3, 3)]
    built = Scene("x", (high, *ends))
    scene = Scene("x", (*built.layers, *(one for one in surroundings(*built.box) if one.name == "ground")))
    size = (320, 240)
    points = np.concatenate([one.positions for one in (high, *ends)])
    camera = standpoint("iso", points, 0.0, *size)
    sun = sun_of(camera)
    on_ground = np.array([0.0, 0.0, 1.5]) - 1.5 / sun[2] * sun
    lit = np.array([0.0, 0.0, 1.5]) + 1.5 / sun[2] * (sun * [1, 1, -1])
    picture = linear(render(scene, size=size) / 255)
    levels = []
    for point in (on_ground, lit):
        (x, y), _ = camera.pixels(point, *size)
        levels.append(picture[int(y), int(x)].mean())
    assert levels[0] < 0.6 * levels[1]


def test_quantities_families_and_lines_have_their_colours() -> None:
    scene = strips()
    material, use = (render(scene, size=(160, 100), colour=key).astype(int) for key in ("", "use"))
    spread = [np.ptp(one, axis=2).max() for one in (material, use)]
    # steel is grey, the scale is not
    assert spread[0] < 60 < spread[1]
    line = LinesLayer(
        name="l", label="L", positions=np.array([[-1.0, 0, 0], [1, 0, 1]]), offsets=np.array([0, 2]), colour="#ff0000"
    )
    drawn = render(Scene("x", (line,)), size=(160, 100)).astype(int)
    assert (drawn[..., 0] - drawn[..., 1]).max() > 60


def test_what_is_replaced_is_not_drawn() -> None:
    red = plate((0.0, 0.0, 0.2), colour="#ff0000")
    hidden = Scene("x", (red, plate(colour="#808080", replaces=(red.name,))))
    assert np.ptp(render(hidden, view="top", size=(64, 64)).astype(int), axis=2).max() < 40


@pytest.mark.parametrize("size", [(15, 100), (100, 8193)])
def test_pictures_have_limits(size: tuple[int, int]) -> None:
    with pytest.raises(InputError, match=f"{size[0]} x {size[1]}"):
        render(strips(), size=size)


@pytest.mark.parametrize("view", ["upper", "1,2,3", "nan,0", "0,91", ""])
def test_views_that_are_none_are_refused(view: str) -> None:
    with pytest.raises(InputError) as error:
        direction_of(view)
    assert error.value.where == "--view"


def test_unknown_quantities_and_empty_scenes_are_refused() -> None:
    with pytest.raises(InputError) as error:
        render(strips(), size=(64, 64), colour="beauty")
    assert error.value.where == "--colour"
    with pytest.raises(InputError):
        render(Scene("x"), size=(64, 64))


def test_a_png_is_read_back_by_another_program() -> None:
    from PIL import Image

    pixels = np.random.default_rng(2).integers(0, 256, (31, 17, 3)).astype(np.uint8)
    assert (np.asarray(Image.open(io.BytesIO(png_bytes(pixels)))) == pixels).all()
