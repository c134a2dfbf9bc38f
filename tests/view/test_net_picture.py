"""Nets in colour: the scale is the paper's, and what is drawn is there."""

from pathlib import Path

import numpy as np
import pytest

from lamella import InputError, QuadMesh, Unduloid, quad_mesh
from lamella.projection.mesh_figures import MeshFigures, mesh_figures
from lamella.view.net_colours import net_colours

pytest.importorskip("matplotlib")

from PIL import Image

from lamella.view.net_picture import NetPanel, draw_nets

RED = (0xD6, 0, 0)


def patch(bend: float) -> QuadMesh:
    """4 x 4 quads of side 1 of z = bend x y: each of them is off a plane by the same score."""
    i, j = (x.ravel().astype(float) for x in np.meshgrid(np.arange(5), np.arange(5), indexing="ij"))
    k = (5 * np.arange(4)[:, None] + np.arange(4)).ravel()
    return quad_mesh(
        np.column_stack([i - 2, j - 2, bend * (i - 2) * (j - 2)]), np.column_stack([k, k + 5, k + 6, k + 1])
    )


def test_planarity_is_red_at_5_thousandths_as_in_the_paper() -> None:
    scores = np.array([0.0, 0.0024, 0.00499, 0.005, 0.3])
    figures = MeshFigures({}, {"planarity": scores})
    rgb = net_colours(patch(0.0), figures, "planarity").rgb
    assert [tuple(row) == RED for row in rgb.tolist()] == [False, False, False, True, True]
    assert rgb[0, 2] > rgb[0, 0]


def test_colours_of_stars() -> None:
    at = Unduloid(0.6, 1.4, (-3.0, 3.0)).at
    i, j = (x.ravel() for x in np.meshgrid(np.arange(7), np.arange(7), indexing="ij"))
    k = (7 * np.arange(6)[:, None] + np.arange(6)).ravel()
    faces = np.column_stack([k, k + 7, k + 8, k + 1])
    mesh = quad_mesh(at(0.05 * (i + j) + 0.05j * (i - j)).position, faces)
    figures = mesh_figures(mesh)
    radius = net_colours(mesh, figures, "radius")
    assert radius.low < 2.0 < radius.high
    angle = net_colours(mesh, figures, "angle")
    assert angle.low + angle.high == pytest.approx(180)
    assert angle.high - 90 == pytest.approx(0.1)
    # boundary vertices have no star: grey
    for colours in (radius, angle, net_colours(mesh, figures, "sphericity")):
        assert colours.on == "vertices"
        assert np.ptp(colours.rgb[mesh.on_boundary].astype(int), axis=1).max() < 12
    with pytest.raises(InputError, match="unknown colour"):
        net_colours(mesh, figures, "taste")  # type: ignore[arg-type]


def test_picture(tmp_path: Path) -> None:
    flat, bent = NetPanel("flat", patch(0.0), "planarity"), NetPanel("bent", patch(0.1), "planarity", edges="none")
    draw_nets([flat, bent], tmp_path / "a.png", width=200, view=(-60, 50))
    image = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).astype(int)
    assert image.shape[1] == 400
    middle = image.shape[0] // 2
    left, right = image[middle - 30 : middle + 10, 60:140], image[middle - 30 : middle + 10, 260:340]
    assert (left[..., 2] > left[..., 0]).mean() > 0.9
    assert ((right[..., 0] > 100) & (right[..., 2] < 60)).mean() > 0.9
    with pytest.raises(InputError, match="0 panels"):
        draw_nets([], tmp_path / "b.png")
