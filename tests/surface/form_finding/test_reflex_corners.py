"""Films in straight beams with reflex corners.

At a corner of the inner angle b > 180 degrees a film's normal turns like r^(2 pi / b - 1) with the distance r (Dierkes,
Hildebrandt and Tromba, Regularity of Minimal Surfaces (2010), chapter 3, doi:10.1007/978-3-642-11700-8): by much within
the last elements, however small they are.
"""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.pieces import lines
from lamella.surface.form_finding.find import find_film

# plans in units, heights in units, m to the unit
SHAPES = {
    "T": (
        [(0, 0), (3, 0), (3, 1), (2, 1), (2, 2.5), (1, 2.5), (1, 1), (0, 1)],
        [0, 0.7, 0.2, 0, 0.8, 0.5, 0.1, 0.6],
        3.0,
    ),
    "L": ([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2.2), (0, 2.2)], [0, 0.8, 0.1, -0.2, 0.9, 0.3], 3.0),
}


def beams(shape: str, sign: float = 1.0) -> Loop:
    plan, heights, unit = SHAPES[shape]
    points = unit * np.column_stack([plan, heights]) * [sign, 1, 1]
    return make_loop("beams", lines(points, closed=True))


@pytest.mark.parametrize(("shape", "finer"), [("L", 0.02), pytest.param("T", 0.02, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_beams_with_reflex_corners_have_one_film(shape, finer) -> None:
    """The film of least area, whatever its elements: those of its mirror image are others, so are finer ones."""
    areas = []
    for sign, tolerance in ((1.0, 0.1), (-1.0, 0.1), (1.0, finer)):
        found = find_film((beams(shape, sign),), tolerance=tolerance)
        assert found.deviation <= tolerance
        assert found.stability.verdict == "stable"
        areas.append(found.surface("form-found").area())
    # the area is off by the square of what the film is off
    assert np.ptp(areas) < 1e-5 * areas[0]


def test_new_elements_at_reflex_corners_do_not_fold() -> None:
    """New nodes along the normals of worn elements crowd at the corners of a T: laid anew there is its film."""
    assert find_film((beams("T"),), tolerance=0.3).deviation <= 0.3
