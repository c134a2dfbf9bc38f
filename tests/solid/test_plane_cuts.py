"""Solids cut by planes: areas and volumes in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.hardware.shape import Prism, circle, rectangle
from lamella.solid.extrusion import prism_solid
from lamella.solid.plane_cuts import cross_section, part_behind
from lamella.solid.solid import Solid

BOX = prism_solid(Prism(rectangle(0.2, 0.1), 0.0, 0.06, (rectangle(0.04, 0.02, (0.05, 0.0)),)))


def area(loops: list[np.ndarray], normal: np.ndarray) -> float:
    return sum(float(np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0) @ normal) / 2 for loop in loops)


def unit(*vector: float) -> np.ndarray:
    return np.array(vector) / np.linalg.norm(vector)


@pytest.mark.parametrize(
    ("normal", "expected", "loops"),
    [
        (unit(0, 0, 1), 0.2 * 0.1 - 0.04 * 0.02, 2),
        (unit(0, 1, 0), 0.2 * 0.06 - 0.04 * 0.06, 2),
        (unit(1, 0, 0), 0.1 * 0.06, 1),
        # oblique: the plan's area over the cosine
        (unit(0.1, 0.05, 1), (0.2 * 0.1 - 0.04 * 0.02) / unit(0.1, 0.05, 1)[2], 2),
    ],
)
def test_area_of_a_cross_section(normal: np.ndarray, expected: float, loops: int) -> None:
    found = cross_section(BOX, np.array([0.0, 0.0, 0.03]), normal)
    assert len(found) == loops
    assert area(found, normal) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("normal", [unit(0, 0, 1), unit(1, 0, 0), unit(1, 2, 3), unit(-3, 1, 0.2)])
def test_both_parts_and_the_cross_section_close(normal: np.ndarray) -> None:
    point = np.array([0.013, 0.007, 0.031])
    volumes = []
    for way in (normal, -normal):
        part = part_behind(BOX, point, way)
        assert np.all((part.vertices[part.triangles].reshape(-1, 3) - point) @ way < 1e-8)
        # the divergence theorem from a point of the plane: the missing face adds nothing
        volumes.append(Solid(np.concatenate([point[None], part.vertices]), part.triangles + 1).volume)
    assert sum(volumes) == pytest.approx(BOX.volume, rel=1e-9)


def test_cut_edges_are_shared_by_their_triangles() -> None:
    cylinder = prism_solid(Prism(circle(0.02), 0.0, 0.05))
    part = part_behind(cylinder, np.array([0.0, 0.0, 0.02]), unit(0.2, 0, 1))
    edges = np.sort(np.concatenate([part.triangles[:, k] for k in ([0, 1], [1, 2], [2, 0])]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert set(count.tolist()) == {1, 2}
    # open edges are those of the cut alone, one for each side of the polygon
    assert int(np.sum(count == 1)) == len(cross_section(cylinder, np.array([0.0, 0.0, 0.02]), unit(0.2, 0, 1))[0])


def test_a_plane_through_corners_or_beside() -> None:
    assert cross_section(BOX, np.array([0.0, 0.0, 0.07]), unit(0, 0, 1)) == []
    assert part_behind(BOX, np.array([0.0, 0.0, 0.07]), unit(0, 0, 1)) is BOX
    assert len(part_behind(BOX, np.array([0.0, 0.0, -0.01]), unit(0, 0, 1)).triangles) == 0
    (loop,) = cross_section(BOX, np.array([-0.1, -0.05, 0.0]), unit(1, 0, 0)) or [np.empty((0, 3))]
    assert abs(area([loop], unit(1, 0, 0)) if len(loop) else 0.0) < 0.1 * 0.06 + 1e-12
