"""Kerf, lead-ins and tabs: moved outlines against distances measured on them, closed forms, and what is refused."""

from __future__ import annotations

import ezdxf
import numpy as np
import pytest
from ezdxf.path import make_path
from scipy.spatial import cKDTree

import lamella
from fabrication.test_strips import sampled
from lamella import InputError
from lamella.fabrication.contours import LEAD, CutOptions, check_contours, open_pieces
from lamella.fabrication.cut_length import outline_length
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.flat import circle, outline_area
from lamella.fabrication.offset import offset_outline

KERF = 0.0003


def strip_outlines() -> list[np.ndarray]:
    """Of straight, round and bowed strips, with sharp and rounded slots."""
    found = []
    for surface, curves in (
        (lamella.Catenoid(1.0, (-0.6, 0.8)), "cut"),
        (lamella.Unduloid(1.0, 1.6, (-0.8, 0.8)), "offset"),
    ):
        section = lamella.Section(height=0.06, layers=2, layer_curves=curves)
        strips = lamella.net(surface, cells=8).strips(section)
        for foot in (0.0, 0.0006):
            parts = strips.parts(foot_radius=foot).parts
            found += [parts[0].outline, parts[-1].outline]
    return found


@pytest.mark.parametrize("distance", [KERF / 2, -KERF / 2])
def test_every_point_lies_half_a_kerf_beside_the_outline(distance: float) -> None:
    for outline in strip_outlines():
        moved = offset_outline(outline, distance)
        # distances of sampled points; on corners the moved outline is farther off, by their sharpness
        step = 2e-5
        tree = cKDTree(sampled(outline, step))
        away = tree.query(sampled(moved, 5e-3))[0]
        assert away.min() > abs(distance) - 1e-9
        assert np.median(away) == pytest.approx(abs(distance), rel=0.01)
        assert away.max() < abs(distance) * 1.6
        # area = area + d length + d^2 (sum of tan of half the turns)
        change = outline_area(moved) - outline_area(outline)
        assert change == pytest.approx(distance * outline_length(outline), rel=0.02)
        # and back again, where no corner's arc was lost
        if len(moved) == len(outline):
            again = offset_outline(moved, -distance)
            assert np.abs(again - outline)[:, :2].max() < 1e-9


def test_circles_and_squares_in_closed_form() -> None:
    hole = circle(0.008, (0.1, 0.2))
    moved = offset_outline(hole, -KERF / 2)
    assert outline_area(moved) == pytest.approx(np.pi / 4 * (0.008 - KERF) ** 2, rel=1e-12)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0]], float)
    assert outline_area(offset_outline(square, 0.01)) == pytest.approx(1.02 * 2.02)
    with pytest.raises(ValueError, match="kerf"):
        offset_outline(square, -0.6)


def test_tabs_are_gaps_of_their_width() -> None:
    for outline in strip_outlines()[:3]:
        pieces = open_pieces(outline, 5, 0.0008)
        assert len(pieces) == 5
        whole = 0.0
        for one, other in zip(pieces, [*pieces[1:], pieces[0]], strict=True):
            assert np.linalg.norm(other[0, :2] - one[-1, :2]) == pytest.approx(0.0008, rel=1e-3)
            assert one[-1, 2] == 0.0
            # closing the piece adds its chord
            closing = float(np.linalg.norm(one[-1, :2] - one[0, :2]))
            whole += outline_length(one) - closing
        assert whole == pytest.approx(outline_length(outline) - 5 * 0.0008, rel=1e-9)


def test_the_drawing_has_moved_contours_and_lead_ins_in_waste(tmp_path) -> None:
    strips = lamella.net(lamella.Catenoid(1.0, (-0.6, 0.8)), cells=6).strips()
    parts = strips.parts()
    nesting = parts.nest()
    options = CutOptions(kerf=KERF, lead_in=0.003, tabs=3)
    write_drawings(tmp_path, parts, nesting, options, name="x", version="0")
    document = ezdxf.readfile(tmp_path / "sheets.dxf")
    assert not document.audit().errors
    space = document.modelspace()
    leads = space.query(f'LINE[layer=="{LEAD}"]')
    # one to the beginning of each piece of a contour
    assert len(leads) == 3 * parts.pieces
    cuts = space.query('LWPOLYLINE[layer=="CUT"]')
    assert len(cuts) == 3 * parts.pieces
    points = np.concatenate([[(p.x, p.y) for p in make_path(cut).flattening(0.01, segments=64)] for cut in cuts])
    for lead in leads:
        assert lead.dxf.start.distance(lead.dxf.end) == pytest.approx(3.0)
        near = np.linalg.norm(points - (lead.dxf.start.x, lead.dxf.start.y), axis=1).min()
        assert near > 2.0
    # drawings without options have no such layer
    write_drawings(tmp_path, parts, nesting, name="x", version="0")
    assert LEAD not in ezdxf.readfile(tmp_path / "sheets.dxf").layers


@pytest.mark.parametrize(
    ("options", "where"),
    [(CutOptions(kerf=0.004), "kerf"), (CutOptions(tabs=100, tab_width=0.1), "tabs")],
)
def test_a_kerf_that_closes_slots_is_refused(options: CutOptions, where: str) -> None:
    part = lamella.net(lamella.Catenoid(1.0, (-0.6, 0.8)), cells=6).strips().parts().parts[0]
    with pytest.raises(InputError) as refused:
        check_contours(part.outline, part.hole_outlines(), options, tag=part.id)
    assert refused.value.where == where
