"""The elements of a film do not hang on the last bits of its numbers, however symmetric its boundary is.

Between processors coordinates differ by a few units in the last place; here they are moved by some tens of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lamella.base.ties import nearest_whole, rounded, shortened
from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.pieces import lines
from lamella.surface.form_finding.find import find_film

# of the boundary's size
NOISE = 1e-14
Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Noisy:
    """A boundary loop whose points are off by rounding, by other amounts at every question."""

    loop: Loop
    rng: np.random.Generator

    def __getattr__(self, name: str) -> Any:
        return getattr(self.loop, name)

    def at(self, t: np.ndarray) -> np.ndarray:
        points = self.loop.at(t)
        return points + NOISE * self.loop.length * self.rng.uniform(-1, 1, points.shape)


def ring(radius: float, *center: float) -> Loop:
    return make_loop("ring", circle(np.array(center), radius, Z))


def regular(sides: int, radius: float, turn: float = 0.0, height: float = 0.0) -> Loop:
    """A regular polygon, its corners by turns up and down."""
    angle = 2 * np.pi * np.arange(sides) / sides + turn
    z = height * (-1.0) ** np.arange(sides)
    return make_loop("p", lines(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z]), closed=True))


CASES = {
    "rings one above the other": (lambda: (ring(2.0, 0, 0, 0), ring(2.0, 0, 0, 1.5)), 0.0),
    "octagon, corners of 135 degrees": (lambda: (regular(8, 4.0, height=0.2),), 0.0),
    "square, straight edges and corners of 90 degrees": (lambda: (regular(4, 5.0, np.pi / 4, 1.0),), 0.05),
    "square around a ring": (lambda: (regular(4, 6.0, np.pi / 4, 0.5), ring(1.5, 0, 0, 1.0)), 0.0),
    "rectangle as a strip": (
        lambda: (make_loop("p", lines(np.array([[0, 0, 0], [9.0, 0, 1], [9, 3, 0], [0, 3, 1]]), closed=True)),),
        0.0,
    ),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if "octagon" in name else []) for name in CASES]
)
def test_elements_do_not_hang_on_the_last_bits(name: str) -> None:
    """Loops that differ by rounding have the same triangles, with nodes as near as the loops."""
    build, curvature = CASES[name]
    loops = build()
    exact = find_film(loops, curvature, tolerance=3e-2).equilibrium.film
    noisy = tuple(Noisy(loop, np.random.default_rng(5)) for loop in loops)
    other = find_film(noisy, curvature, tolerance=3e-2).equilibrium.film  # type: ignore[arg-type]
    assert np.array_equal(exact.mesh.faces, other.mesh.faces)
    # a point in the middle between two of the grid may go either way; all others are as near as the loops
    off = np.linalg.norm(exact.nodes - other.nodes, axis=1) / exact.size
    assert np.median(off) < 1e-11
    assert off.max() < 1e-5


def test_halves_go_up_on_every_machine() -> None:
    values = np.array([0.5, 1.5, 2.5])
    assert nearest_whole(values).tolist() == nearest_whole(values - 1e-15).tolist() == [1, 2, 3]
    assert nearest_whole(np.array([0.49, 1.2])).tolist() == [0, 1]


def test_rounded_numbers_are_the_same_from_either_side() -> None:
    values = np.random.default_rng(0).normal(size=1000) * 3
    for change in (1 - 1e-15, 1 + 1e-15):
        assert np.array_equal(rounded(values * change, 2.0**-20), rounded(values, 2.0**-20))
        assert np.array_equal(shortened(values * change, 20), shortened(values, 20))
    assert np.abs(shortened(values, 20) / values - 1).max() <= 2.0**-20
