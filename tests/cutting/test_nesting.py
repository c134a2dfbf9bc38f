"""Shapes on sheets by their outlines: clear of each other by the gap, as dense as known lattices, never worse."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import CrossSection, JoinType, OpType

from lamella.base.arrays import Floats
from lamella.cutting.lattice import densest_lattice
from lamella.cutting.nesting import nested
from lamella.fabrication.flat import outline_points
from lamella.hardware.shape import circle, crossed, hexagon

CROSS = outline_points(crossed(0.03, 0.006, np.pi / 2))[:-1]
ELL = np.array([(0, 0), (0.08, 0), (0.08, 0.02), (0.02, 0.02), (0.02, 0.06), (0, 0.06)], float)
BAR = np.array([(0, 0), (0.2, 0), (0.2, 0.03), (0, 0.03)], float)
SHEET, GAP = (1.0, 0.5), 0.004


def area(points: Floats) -> float:
    x, y = points.T
    return abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2


def test_lattices_of_known_density() -> None:
    """Circles pi / sqrt(12), hexagons 1, a cross of half arms a, b: (2 a b - b^2) 4 / ((a + b)^2 + 4 b^2)."""
    a, b = 0.03, 0.006
    known = {
        "circle": (outline_points(circle(0.05), 64)[:-1], np.pi / np.sqrt(12)),
        "hexagon": (outline_points(hexagon(0.04))[:-1], 1.0),
        "cross": (CROSS, 4 * (2 * a * b - b**2) / ((a + b) ** 2 + 4 * b**2)),
    }
    for points, density in known.values():
        found = area(points) / densest_lattice(points, 0.0).area
        # cells of the grid, about 1 % of the shape, are left on all sides
        assert 0.9 * density < found < density


def shapes_on_sheets(outlines: list[Floats], kinds: Floats, spread: object) -> dict[int, list[Floats]]:
    placed: dict[int, list[Floats]] = {}
    for k, sheet, corner, turned in zip(kinds, spread.sheets, spread.corners, spread.turned, strict=True):
        points = outlines[k] @ np.array([[0, 1], [-1, 0]]) if turned else outlines[k]
        placed.setdefault(int(sheet), []).append(points - points.min(axis=0) + corner)
    return placed


@pytest.mark.parametrize("seed", range(4))
def test_no_two_shapes_are_nearer_than_the_gap(seed: int) -> None:
    """Random shapes in random numbers: grown by half the gap they do not overlap, and stay on their sheet."""
    rng = np.random.default_rng(seed)
    outlines = [CROSS, ELL, BAR]
    for _ in range(2):
        # a star-shaped polygon
        angle = np.sort(rng.uniform(0, 2 * np.pi, 9))
        outlines.append((rng.uniform(0.01, 0.05, 9) * [np.cos(angle), np.sin(angle)]).T)
    quantities = rng.integers(1, 120, len(outlines))
    kinds = np.repeat(np.arange(len(outlines)), quantities)
    for spread in nested(outlines, quantities, SHEET, GAP):
        assert len(spread.sheets) == quantities.sum()
        for shapes in shapes_on_sheets(outlines, kinds, spread).values():
            low, high = (
                np.min([one.min(axis=0) for one in shapes], axis=0),
                np.max([one.max(axis=0) for one in shapes], axis=0),
            )
            assert (low > GAP - 1e-6).all()
            assert (high < np.array(SHEET) - GAP + 1e-6).all()
            grown = [CrossSection([one]) for one in shapes]
            grown = [
                one if one.area() > 0 else CrossSection([points[::-1]])
                for one, points in zip(grown, shapes, strict=True)
            ]
            together = CrossSection.batch_boolean(
                [one.offset(GAP / 2 - 1e-6, join_type=JoinType.Round) for one in grown], OpType.Add
            )
            separate = sum(one.offset(GAP / 2 - 1e-6, join_type=JoinType.Round).area() for one in grown)
            assert together.area() == pytest.approx(separate, rel=1e-6)


def test_crosses_take_half_of_what_their_rectangles_take() -> None:
    plain, by_outline = nested([CROSS], np.array([2000]), SHEET, GAP)
    assert len(by_outline.ends) < 0.6 * len(plain.ends)


def test_rectangles_are_laid_as_rectangles() -> None:
    assert len(nested([BAR], np.array([100]), SHEET, GAP)) == 1
    assert nested([BAR], np.array([1]), (0.1, 0.1), GAP) == []
    few = nested([CROSS], np.array([2]), SHEET, GAP)
    assert len(few) == 1
