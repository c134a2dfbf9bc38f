"""Pixels of triangles: those whose middles lie inside, each once where triangles meet, and the nearest one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay

from lamella.view.render import raster
from lamella.view.render.raster import NO_TRIANGLE, rasterise

WIDTH, HEIGHT = 53, 37
DRAW = np.random.default_rng(11)


def inside(corners: np.ndarray, x: float, y: float) -> bool:
    """Whether a point lies in a triangle, by the signs of three areas."""
    turns = [
        (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    return min(turns) >= 0 or max(turns) <= 0


@pytest.mark.parametrize("batch", [1_000_000, 50])
def test_the_nearest_triangle_at_every_middle(batch: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against a loop over all triangles and pixels, with the depth from barycentric coordinates."""
    monkeypatch.setattr(raster, "BATCH_PIXELS", batch)
    corners = DRAW.uniform(-10, 60, (40, 3, 2))
    depth = DRAW.uniform(1, 2, (40, 3))
    seen = rasterise(corners, depth, WIDTH, HEIGHT)
    for row in range(0, HEIGHT, 3):
        for column in range(0, WIDTH, 3):
            x, y = column + 0.5, row + 0.5
            best, nearest = NO_TRIANGLE, np.inf
            for k in range(40):
                if inside(corners[k], x, y):
                    system = np.vstack([corners[k].T, np.ones(3)])
                    level = float(depth[k] @ np.linalg.solve(system, [x, y, 1.0]))
                    if level < nearest:
                        best, nearest = k, level
            assert seen.triangle[row, column] == best
            if best != NO_TRIANGLE:
                assert seen.depth[row, column] == pytest.approx(nearest, abs=1e-6)


def test_triangles_that_meet_leave_no_gap_and_no_pixel_twice() -> None:
    """Of a triangulated square, middles of pixels on the edges too: each pixel has one triangle."""
    points = np.vstack([DRAW.integers(0, 33, (60, 2)) + 0.5, [[0, 0], [33, 0], [0, 33], [33, 33]]])
    triangles = points[Delaunay(points).simplices]
    covered = np.zeros((33, 33), int)
    for triangle in triangles:
        covered += rasterise(triangle[None], np.ones((1, 3)), 33, 33).triangle != NO_TRIANGLE
    assert (covered == 1).all()


def test_nothing_of_nothing_and_of_triangles_without_area() -> None:
    assert (rasterise(np.zeros((0, 3, 2)), np.zeros((0, 3)), 4, 3).triangle == NO_TRIANGLE).all()
    flat = np.array([[[0.0, 0], [4, 4], [2, 2]], [[np.nan, 0], [4, 0], [0, 4]]])
    assert (rasterise(flat, np.ones((2, 3)), 4, 4).triangle == NO_TRIANGLE).all()
