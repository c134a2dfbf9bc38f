"""Pictures of surfaces without strips: true to place, colour and what hides what."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import lamella
from lamella.base.errors import InputError
from lamella.surface.element.surface import ElementSurface
from stages.other_surface import on_surface
from surface.element.exact_elements import catenoid_patch, sphere_cap, whole_catenoid

pytest.importorskip("matplotlib")
from matplotlib.colors import to_rgb
from PIL import Image

from lamella.view import surface_picture
from lamella.view.picture import Camera
from lamella.view.scene.surface_quantities import DIVERGING, surface_quantities
from lamella.view.surface_picture import draw_surface


@pytest.fixture(scope="module")
def closed_form() -> lamella.Results:
    surface = {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.8, 1.1]}
    return lamella.compute(lamella.parse_project({"name": "p", "surface": surface}), until="surface")


def of(surface: ElementSurface, results: lamella.Results) -> lamella.Results:
    return on_surface(results, surface)


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def near(image: np.ndarray, colour: tuple[float, ...], within: int = 40) -> int:
    return int((np.abs(image - 255 * np.array(colour)).max(axis=2) < within).sum())


def test_three_panels_show_the_same_shape(closed_form: lamella.Results, tmp_path: Path) -> None:
    draw_surface(of(whole_catenoid(3), closed_form), tmp_path / "p.png")
    image = pixels(tmp_path / "p.png")
    assert image.shape[1] == 3 * 520
    drawn = image[: -surface_picture.PICTURE_FOOT].min(axis=2) < 250
    panels = np.split(drawn, 3, axis=1)
    assert 0.2 < panels[0].mean() < 0.9
    for panel in panels[1:]:
        assert (panel != panels[0]).mean() < 0.01
    # a margin all around, so that nothing is cut off
    assert not drawn[0].any()
    assert not drawn[:, 0].any()
    assert not drawn[:, -1].any()


def test_equal_axes(closed_form: lamella.Results, tmp_path: Path) -> None:
    flat = sphere_cap(2)
    for size in ((500, 500), (900, 400)):
        draw_surface(of(flat, closed_form), tmp_path / "p.png", view=(-90.0, 90.0), panels=["shade"], size=size)
        image = pixels(tmp_path / "p.png")
        assert image.shape == (size[1], size[0], 3)
        drawn = image[: -surface_picture.PICTURE_FOOT].min(axis=2) < 250
        rows, columns = (np.flatnonzero(drawn.any(axis=axis)) for axis in (1, 0))
        # from above, a cap is round
        assert np.ptp(rows) == pytest.approx(np.ptp(columns), abs=3)


def test_the_two_sides_have_two_tones(closed_form: lamella.Results, tmp_path: Path) -> None:
    cap = of(sphere_cap(2), closed_form)
    for elevation, warm in ((60.0, False), (-60.0, True)):
        draw_surface(cap, tmp_path / "p.png", view=(-60.0, elevation), panels=["shade"], size=(300, 300))
        image = pixels(tmp_path / "p.png")[:200]
        coloured = image[np.ptp(image, axis=2) > 12]
        assert (np.median(coloured[:, 0] - coloured[:, 2]) > 0) == warm


def test_what_lies_behind_is_hidden() -> None:
    surface = whole_catenoid(3)
    mesh, rim, edges = surface.subdivided(4), np.empty((0, 2, 3)), np.empty((0, 2, 3))
    camera = Camera.around(mesh.points, 0.0, 0.0)
    scene = surface_picture._Scene.seen(mesh, rim, edges, camera)
    # from the side of x, drawn later is nearer: larger x
    middles = mesh.points[scene.triangles].mean(1)
    front, back = middles[:, 0] > 0.3, middles[:, 0] < -0.3
    assert scene.depth[front].max() < scene.depth[back].min()
    np.testing.assert_allclose((scene.to_eye**2).sum(1), 1)
    assert (scene.to_eye[:, 0] > 0.8).all()


def test_colours_are_those_of_the_values() -> None:
    surface = catenoid_patch(4)
    mesh = surface.mesh()
    quantities = surface_quantities(mesh, 0.0)
    painted = surface_picture._coloured(quantities["ratio"])
    assert np.abs(painted - to_rgb(DIVERGING[0])).max() < 0.02
    curved = surface_picture._coloured(quantities["K"])
    # the waist is curved most: darkest
    waist, end = np.abs(mesh.points[:, 2]) < 0.1, np.abs(mesh.points[:, 2]) > 0.95
    assert curved[waist].sum(1).max() < curved[end].sum(1).min()


def test_edges_of_the_curved_triangles_are_drawn_once_and_lie_on_them() -> None:
    surface = whole_catenoid(3)
    results = type("Run", (), {"surface": surface})
    _, rim, edges = surface_picture._sampled(results)  # type: ignore[arg-type]
    connectivity = surface.connectivity
    shared = (3 * len(connectivity.elements) - len(connectivity.rim_elements)) // 2
    parts = len(rim) // len(connectivity.rim_elements)
    assert len(edges) == parts * shared
    assert len({tuple(middle) for middle in edges.mean(1).round(9).tolist()}) == len(edges)
    for lines in (rim, edges):
        radius = np.hypot(lines[..., 0], lines[..., 1])
        assert np.abs(radius - np.cosh(lines[..., 2])).max() < 2e-3
    rings = 2 * np.pi * (np.cosh(0.8) + np.cosh(1.1))
    assert np.linalg.norm(rim[:, 1] - rim[:, 0], axis=1).sum() == pytest.approx(rings, rel=1e-3)


def test_boundary_of_a_closed_form() -> None:
    mesh = lamella.Catenoid(1.0, (-0.8, 1.1)).mesh(1e-4)
    rim = surface_picture._open_edges(mesh)
    rings = 2 * np.pi * (np.cosh(0.8) + np.cosh(1.1))
    assert np.linalg.norm(rim[:, 1] - rim[:, 0], axis=1).sum() == pytest.approx(rings, rel=1e-3)


def test_closed_form_says_that_it_has_no_deviation(closed_form: lamella.Results, tmp_path: Path) -> None:
    draw_surface(closed_form, tmp_path / "p.png", panels=("deviation", "ratio"), size=(700, 400))
    image = pixels(tmp_path / "p.png")
    # no scale below the first panel, one below the second
    first, second = np.split(image[-surface_picture.PICTURE_FOOT :], 2, axis=1)
    assert near(first, to_rgb(DIVERGING[-1]), 12) == 0
    assert near(second, to_rgb(DIVERGING[-1]), 12) > 20


def test_scales_are_written_in_short_numbers() -> None:
    assert [surface_picture._power(size) for size in (3.2e-5, 0.02, 1.0, 999.0, 2e6)] == [-5, 0, 0, 0, 6]
    assert surface_picture._superscript(-12) == "⁻¹²"


def test_same_run_same_bytes(closed_form: lamella.Results, tmp_path: Path) -> None:
    import matplotlib

    results = of(catenoid_patch(2), closed_form)
    for path in ("a", "b"):
        with matplotlib.rc_context({"lines.linewidth": 1.0 if path == "a" else 9.0, "font.size": 30}):
            draw_surface(results, tmp_path / f"{path}.png", panels=("shade", "deviation"), size=(500, 300))
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.parametrize(
    ("panels", "message"), [(["red"], "unknown panel 'red'"), ([], "0 panels"), (["K"] * 4, "4 panels")]
)
def test_wrong_panels(closed_form: lamella.Results, tmp_path: Path, panels: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        draw_surface(closed_form, tmp_path / "p.png", panels=panels)  # type: ignore[arg-type]
    assert not (tmp_path / "p.png").exists()
