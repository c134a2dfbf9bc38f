"""The orders of all umbilics add up to what the boundary says (issue 4).

Q = D dz^2 has no zero on the boundary. Along all of it, with the surface on the left, Q(t, t) for the tangent t turns
W times; t itself turns chi times against a frame of the surface (Hopf), and D the sum of the orders m in it. So
W = sum m + 2 chi.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from conftest import run_of_example
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from network.elements.test_element_network import enneper

CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def boundary_turns(surface: ElementSurface) -> float:
    """Turns of Q(t, t) along the whole boundary."""
    connectivity = surface.connectivity
    share = (np.arange(16) + 0.5) / 16
    begin = CORNERS[connectivity.rim_edges]
    along = CORNERS[(connectivity.rim_edges + 1) % 3] - begin
    local = begin[:, None] + share[None, :, None] * along[:, None]
    where = Places(np.repeat(connectivity.rim_elements, len(share)), local.reshape(-1, 2))
    at = surface.at(where)
    basis = connectivity.basis
    corners = surface.nodes[connectivity.elements[where.element]]
    x, y = (np.einsum("nk,nkc->nc", basis.basis(where.local, *d), corners) for d in ((1, 0), (0, 1)))
    direction = np.repeat(along, len(share), axis=0)
    tangent = direction[:, :1] * x + direction[:, 1:] * y
    t = (tangent * at.e_u).sum(1) + 1j * (tangent * at.e_v).sum(1)
    value = (at.deviator * t**2).reshape(-1, len(share))
    after = {int(edge[0]): k for k, edge in enumerate(connectivity.rim_nodes)}
    total, left = 0.0, set(range(len(value)))
    while left:
        first = edge = min(left)
        ring = []
        while not ring or edge != first:
            ring.append(value[edge])
            left.discard(edge)
            edge = after[int(connectivity.rim_nodes[edge, -1])]
        phases = np.concatenate(ring)
        steps = np.angle(np.roll(phases, -1) / phases)
        assert np.abs(steps).max() < 1.5
        total += float(steps.sum()) / (2 * np.pi)
    return total


def of_example(name: str) -> Callable[[], ElementSurface]:
    def surface() -> ElementSurface:
        found = run_of_example(name, "surface").surface
        assert isinstance(found, ElementSurface)
        return found

    return surface


@pytest.mark.parametrize(
    ("surface", "chi", "rays"),
    [
        (lambda: enneper(3)[1], 1, [6]),
        (lambda: enneper(4)[1], 1, [8]),
        (of_example("13_oculus"), 0, [6, 6]),
        (of_example("14_three_columns"), -2, [6] * 6),
    ],
    ids=["hexagonal node", "eight rays", "oculus", "three holes"],
)
def test_orders_add_up_to_the_turning_of_the_boundary(
    surface: Callable[[], ElementSurface], chi: int, rays: list[int]
) -> None:
    """Orders of umbilics that are found add up to the turns of the boundary less twice its Euler number."""
    found = surface()
    turns = boundary_turns(found)
    assert turns == pytest.approx(round(turns), abs=1e-6)
    assert found.umbilics.orders.sum() == round(turns) - 2 * chi
    assert sorted(found.umbilics.rays.tolist()) == rays
