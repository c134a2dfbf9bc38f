"""Nets bent without stretching (paper, Figure 8).

1. The unduloid's waist is narrowed by 10 % and 20 %: edges and stars are kept to 1e-8, the net stays rotational, the
angles change as told. 2. A net without symmetry cannot do that: the remainder is told by constraint. 3. Bad input.
"""

from functools import cache

import numpy as np
import pytest

from lamella import Unduloid
from lamella.projection.problems.deform import DeformedState, deform
from lamella.projection.problems.sphere_stars import sphere_stars
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.star_measures import circle_angles, star_spheres
from projection.nets import noisy, rotational_net
from refusals import refused

AROUND, ROWS = 20, 19
RING = AROUND * (ROWS // 2) + np.arange(AROUND)


@cache
def net() -> QuadMesh:
    """Lamellas around the waist of the unduloid with H = 1/2, as a net of spherical stars."""
    surface = Unduloid(0.6, 1.4, (-6.0, 6.0))
    return sphere_stars(rotational_net(surface, AROUND, ROWS, -(ROWS // 2) * np.pi / AROUND), radius=2.0).mesh


@cache
def narrowed() -> tuple[DeformedState, ...]:
    return deform(net(), RING, 0.8, radius=2.0)


def edge_lengths(mesh: QuadMesh) -> np.ndarray:
    return np.linalg.norm(mesh.vertices[mesh.edges[:, 1]] - mesh.vertices[mesh.edges[:, 0]], axis=1)


def waist(mesh: QuadMesh) -> float:
    return float(np.linalg.norm(mesh.vertices[RING, :2] - mesh.vertices[RING, :2].mean(0), axis=1).mean())


@pytest.mark.parametrize("share", [0.9, 0.8])
def test_narrower_waist(share: float) -> None:
    start = net()
    state = min(narrowed(), key=lambda s: abs(s.share - share))
    stars = star_spheres(state.mesh, start.inner)
    assert state.share == pytest.approx(share)
    assert state.solution.solved
    assert waist(state.mesh) == pytest.approx(share * waist(start), rel=1e-8)
    assert np.abs(edge_lengths(state.mesh) - edge_lengths(start)).max() <= 1e-8 * start.mean_edge
    assert stars.deviation.max() <= 1e-8 * start.mean_edge
    assert np.abs(stars.curvature) == pytest.approx(0.5, rel=1e-6)
    # still rotational, row by row
    around = np.linalg.norm(state.mesh.vertices[:, :2], axis=1).reshape(ROWS, AROUND)
    assert np.ptp(around, axis=1).max() < 1e-6
    # the rim goes on as the net does: its tips hang on two edges only
    bends = np.diff(around.mean(1), 3)
    assert np.abs(bends[[0, -1]]).max() < 0.05 * start.mean_edge
    # the scissors move: tens of degrees, in one sense for all
    change = circle_angles(state.mesh, start.inner) - circle_angles(start, start.inner)
    assert state.angle_change == pytest.approx(change)
    assert np.abs(change).max() > 100 * (1 - share)


def test_states_lead_from_the_start_to_the_end() -> None:
    shares = [state.share for state in narrowed()]
    assert shares[0] == 1
    assert shares[-1] == pytest.approx(0.8)
    assert np.diff(shares).min() > -0.0201
    first = narrowed()[0].mesh.vertices
    assert np.abs(first - net().vertices).max() < 1e-6


def test_radius_is_that_of_the_net() -> None:
    state = deform(net(), RING, 0.98)[-1]
    assert state.solution.solved
    assert state.mesh.vertices == pytest.approx(narrowed()[1].mesh.vertices, abs=1e-6)


def test_place_of_the_mesh_does_not_matter() -> None:
    away = np.array([5e5, 4.5e6, 300.0])
    state = deform(net().at(net().vertices + away), RING, 0.98, radius=2.0)[-1]
    assert state.solution.solved
    assert state.mesh.vertices - away == pytest.approx(narrowed()[1].mesh.vertices, abs=1e-7)


def test_net_without_symmetry_tells_the_remainder() -> None:
    """Four conditions on three unknowns a vertex (DESIGN section 5)."""
    states = deform(noisy(net(), 0.02, 0), RING, 0.96, radius=2.0)
    last = states[-1].solution
    assert len(states) == 3
    assert last.verdict in ("settled", "stagnated")
    assert {"edges", "stars"} <= set(last.unmet)
    assert 1e-4 < last.last.residual["stars"] < 0.02
    assert 1e-4 < last.last.residual["edges"] < 0.02


class TestRefused:
    def test_ring_along_a_polyline(self) -> None:
        with refused(numbers=net().edges[0]):
            deform(net(), np.array([net().edges[0, 0], net().edges[0, 1], 7]), 0.9)

    @pytest.mark.parametrize(
        ("ring", "numbers"), [([0, 1], [2]), ([0, 2, 0], []), ([0, 1, 10**6], [10**6, 379]), ([0.0, 1.0, 2.0], [3])]
    )
    def test_ring(self, ring: list[float], numbers: list[float]) -> None:
        with refused(numbers=numbers):
            deform(net(), ring, 0.9)

    @pytest.mark.parametrize("share", [0.0, -1.0, np.nan, 100.0])
    def test_share(self, share: float) -> None:
        with refused(names=("share",), numbers=(0.05, 5)):
            deform(net(), RING, share)
