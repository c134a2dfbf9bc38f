"""Surfaces of constant node angle between rings, against those of revolution, and where there are none.

With the outward normal a surface of revolution has k_par = -n_r / r around its axis, n_r being the normal's radial
part, and A k_mer + B k_par = c is a linear equation of first order for r k_par by r (Delaunay's, for A = B):

    (n_r + c r) r^(B / A) = const.

The meridian itself is found to 1e-11 by collocation of its differential equation.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from lamella import InputError
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.curve import make_loop
from lamella.surface.constant_angle import rounds
from lamella.surface.constant_angle.find_angle import FoundAngle, find_angle
from lamella.surface.constant_angle.relation import Relation
from lamella.surface.constant_angle.rounds import settled_rounds
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.meshing import straightened, with_sizes

LOW, HIGH, APART = 2.1, 1.8, 1.3


def rings(apart: float = APART, by: float = 1.0):
    z = np.array([0.0, 0.0, 1.0])
    return (
        make_loop("low", circle(np.zeros(3), by * LOW, z)),
        make_loop("high", circle(by * apart * z, by * HIGH, z)),
    )


def off_meridian(nodes: np.ndarray, angle: float, c: float, apart: float) -> float:
    """Largest distance of nodes from the surface of revolution near them, m."""
    a = np.cos(np.radians(angle / 2)) ** 2
    r, z = np.hypot(nodes[:, 0], nodes[:, 1]), nodes[:, 2]
    order = np.argsort(np.round(z, 9), kind="stable")
    height = np.linspace(0, apart, 201)
    start = np.interp(height, z[order], r[order])

    def bend(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        root = np.sqrt(1 + y[1] ** 2)
        return np.array([y[1], root**3 * (c + (1 - a) / (y[0] * root)) / a])

    def ends(low: np.ndarray, high: np.ndarray) -> np.ndarray:
        return np.array([low[0] - LOW, high[0] - HIGH])

    found = solve_bvp(bend, ends, height, np.array([start, np.gradient(start, height)]), tol=1e-11, max_nodes=20_000)
    assert found.status == 0
    radius, slope = found.sol(np.clip(z, 0, apart))
    return float((np.abs(r - radius) / np.sqrt(1 + slope**2)).max())


def is_one(found: FoundAngle, angle: float, c: float, apart: float = APART) -> None:
    """Positions, the first integral, A k1 + B k2 from continuous normals, and few rounds."""
    film, cosine = found.refined.film, np.cos(np.radians(angle))
    assert off_meridian(film.nodes, angle, c, apart) < 1e-6 * film.size
    surface = found.surface("found")
    there = surface.check_points()
    scale = found.refined.deviation.scale
    off = np.abs(there.mean_curvature + cosine * np.abs(there.deviator) - c) / scale
    assert np.percentile(off, 95) < 1e-3
    assert found.refined.deviation.largest <= 2e-3
    out = there.position[:, :2] / np.linalg.norm(there.position[:, :2], axis=1)[:, None]
    radius = np.linalg.norm(there.position[:, :2], axis=1)
    power = np.tan(np.radians(angle / 2)) ** 2
    integral = ((there.normal[:, :2] * out).sum(1) + c * radius) * radius**power
    assert np.ptp(integral) < 1e-4 * np.abs(integral).mean()


@pytest.fixture(scope="module")
def film() -> Film:
    """The film that ways start from."""
    return find_film(rings(), 0.0, tolerance=2e-2).equilibrium.film


@pytest.mark.parametrize(
    ("angle", "c"),
    [(50.0, 0.0), (60.0, -0.25)]
    + [
        pytest.param(angle, c, marks=pytest.mark.slow)
        for angle, c in ((70.0, 0.0), (110.0, 0.0), (60.0, 0.25), (100.0, -0.25))
    ],
)
def test_rings_span_a_surface_of_revolution(angle: float, c: float) -> None:
    found = find_angle(rings(), angle, c)
    is_one(found, angle, c)
    assert found.refined.rounds <= 15
    surface = found.surface("found")
    assert surface.describe()["node_angle"] == angle
    assert surface.describe()["mean_curvature_range"][0] < surface.mean_curvature


def test_a_larger_boundary_has_the_same_surface() -> None:
    nodes = find_angle(rings(by=1000.0), 70.0, 1e-4).refined.film.nodes / 1000
    assert off_meridian(nodes, 70.0, 0.1, APART) < 5e-6


def test_ninety_degrees_are_the_film(film: Film) -> None:
    made = settled_rounds(film, Relation(90.0, 0.0))
    assert np.abs(made.film.nodes - film.nodes).max() < 1e-8 * film.size


@pytest.mark.parametrize("angle", [50.0, 75.0, 110.0])
def test_rounds_contract_by_the_cosine(angle: float, film: Film, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without acceleration, and factored anew: H follows cos(2 phi) times what D was off, whatever the elements."""
    monkeypatch.setattr(rounds, "ANDERSON_DEPTH", 0)
    search = rounds._Search(film, Relation(angle, 0.0))
    moves = []
    for _ in range(14):
        search.factor = None
        moves.append(search.round())
    assert (moves[13] / moves[9]) ** (1 / 4) == pytest.approx(abs(np.cos(np.radians(angle))), rel=0.1)


def test_acceleration_takes_fewer_rounds(film: Film, monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(settled_rounds(film, Relation(50.0, 0.0)).moves) <= 15
    monkeypatch.setattr(rounds, "ANDERSON_DEPTH", 0)
    with pytest.raises(NoFilmError):
        settled_rounds(film, Relation(50.0, 0.0), most=30)


def test_positions_converge(film: Film) -> None:
    """Elements of half the size: positions of order 4 elements are off by a sixteenth or less."""
    relation, off = Relation(70.0, 0.0), []
    for size in (0.8, 0.4):
        finer = straightened(with_sizes(film, lambda points, size=size: np.full(len(points), size)))
        off.append(off_meridian(settled_rounds(finer, relation).film.nodes, 70.0, 0.0, APART))
    assert np.log2(off[0] / off[1]) > 4


@pytest.mark.slow
def test_near_the_last_surface() -> None:
    """There is one up to 117.998 degrees: r = w (1 + p^2)^(B / 2 A), p = dr / dz, w the waist."""
    is_one(find_angle(rings(), 117.8), 117.8, 0.0)


@pytest.mark.slow
def test_beyond_the_last_surface() -> None:
    with pytest.raises(InputError) as refused:
        find_angle(rings(), 118.1)
    assert refused.value.where == "angle"
    reached = float(refused.value.message.split("ends at ")[1].split()[0])
    assert 117.7 < reached <= 117.998


@pytest.mark.slow
def test_rings_nearer_to_each_other_reach_farther() -> None:
    """130 degrees: rings up to 0.888 apart."""
    is_one(find_angle(rings(0.85), 130.0, tolerance=4e-3), 130.0, 0.0, 0.85)
    with pytest.raises(InputError) as refused:
        find_angle(rings(0.92), 130.0)
    assert refused.value.where == "angle"


@pytest.mark.parametrize("angle", [29.0, 151.0, float("nan")])
def test_angles_that_are_not_offered(angle: float) -> None:
    with pytest.raises(InputError) as refused:
        find_angle(rings(), angle)
    assert refused.value.where == "angle"
    assert refused.value.remedy
