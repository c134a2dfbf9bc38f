"""Films that follow their boundary: the same as found from nothing, whatever was in between; or made anew, and why."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from scipy.optimize import brentq

import lamella
from lamella.base.errors import InputError
from lamella.surface.form_finding.carried_rim import NotKeptError, carried_parameters
from lamella.surface.form_finding.followed_film import FollowedFilm
from lamella.surface.form_finding.kept_elements import Boundary

RING = lamella.circle((0, 0, 0), 3.0)
CORNERS = np.array([[-3.0, -2, 0], [3, -2, 0.8], [3, 2, 0], [-3, 2, 0.8]])


def ring(height: float, radius: float = 3.0) -> lamella.Loop:
    return lamella.circle((0, 0, height), radius)


def deviation_from_catenoid(points: np.ndarray, radius: float, height: float, *, unstable: bool = False) -> float:
    """Largest distance in r of points from the catenoid between rings of a radius at z = 0 and z = height, m.

    Its neck c solves radius = c cosh(height / 2 c); the smaller solution is the unstable one.
    """

    def off(c: float) -> float:
        return float(c * np.cosh(height / (2 * c)) - radius)

    # both solutions are on either side of the least radius, at height / 2 c = 1.19968
    middle = height / 2 / 1.19968
    neck = brentq(off, 0.05 * radius, middle) if unstable else brentq(off, middle, radius)
    wanted = neck * np.cosh((points[:, 2] - height / 2) / neck)
    return float(np.abs(np.hypot(points[:, 0], points[:, 1]) - wanted).max())


def saddle(angle: float, count: int = 12) -> lamella.Loop:
    """A wavy closed spline, its waves turned by an angle (radians)."""
    t = 2 * np.pi * np.arange(count) / count
    return lamella.spline(np.column_stack([4 * np.cos(t), 3 * np.sin(t), 0.7 * np.cos(2 * t + angle)]))


def nodes(film: FollowedFilm) -> np.ndarray:
    return film.equilibrium.film.nodes


def test_a_followed_film_is_the_one_of_its_boundary() -> None:
    """Catenoids, known in closed form: the followed one is as near as one found from nothing on as many elements."""
    for tolerance in (2e-2, 3e-3):
        first = lamella.follow([RING, ring(2.8)], tolerance=tolerance)
        assert first.at([RING, ring(2.81)]).factorisations == 1
        film = first.at([RING, ring(3.2)])
        assert film.made_anew == ""
        assert film.deviation.weighted <= 5 * tolerance
        found = lamella.film([RING, ring(3.2)], tolerance=tolerance)
        off, limit = (deviation_from_catenoid(points, 3.0, 3.2) for points in (nodes(film), found.nodes))
        assert off < 10 * limit
        assert off < 0.01 * tolerance * film.equilibrium.film.size


def test_no_change_moves_the_first_film() -> None:
    """Whatever is in between, a film on the first elements depends on its boundary alone, to the last bit."""
    first = lamella.follow([saddle(0.0), ring(0.2, 0.7)], tolerance=3e-2)
    draws = np.random.default_rng(3)
    film, other = first, first.at([saddle(0.05), ring(0.25, 0.7)])
    for _ in range(12):
        angle, height, radius = draws.normal(size=3) * [0.1, 0.1, 0.03]
        film = film.at([saddle(angle), ring(0.2 + height, 0.7 + radius)], draws.normal() * 0.01)
    there = film.at([saddle(0.05), ring(0.25, 0.7)], 0.0)
    assert np.array_equal(nodes(there), nodes(other))
    back = there.at([saddle(0.0), ring(0.2, 0.7)])
    assert np.array_equal(nodes(back), nodes(first))


def test_elements_that_do_not_hold_are_made_anew_and_the_first_ones_come_back() -> None:
    """A bump in the rim wants smaller elements."""
    bump = np.array([0.0, 0.3, 0.6])

    def bumped(share: float) -> lamella.Loop:
        t = 2 * np.pi * np.arange(12) / 12
        points = np.column_stack([4 * np.cos(t), 3 * np.sin(t), 0.7 * np.cos(2 * t)])
        points[3] += share * bump
        return lamella.spline(points)

    first = lamella.follow(bumped(0.0), tolerance=2e-2, leeway=2.0)
    sharp = first.at(bumped(1.0))
    assert sharp.made_anew.startswith("H is off")
    assert sharp.deviation.largest <= 2e-2
    assert sharp.factorisations == 0
    near = sharp.at(bumped(1.02))
    assert near.made_anew == ""
    assert near.elements is sharp.elements
    back = near.at(bumped(0.0))
    assert back.made_anew == ""
    assert np.array_equal(nodes(back), nodes(first))


def test_mean_curvature_and_volume_are_followed() -> None:
    """Spherical caps: H = 2 h / (h^2 + R^2), volume pi h (3 R^2 + h^2) / 6."""
    film = lamella.follow(lamella.circle((0, 0, 0), 1.0), tolerance=1e-2)
    for height in (0.1, 0.2, 0.35):
        wanted = 2 * height / (height**2 + 1)
        there = film.at(mean_curvature=-wanted)
        assert there.made_anew == ""
        radius = np.linalg.norm(nodes(there) - [0, 0, height - 1 / wanted], axis=1)
        assert np.abs(radius * wanted - 1).max() < 1e-4
        volume = np.pi * height * (3 + height**2) / 6
        by_volume = film.at(volume=volume)
        assert by_volume.surface.volume() == pytest.approx(volume, abs=1e-10)
        assert -by_volume.equilibrium.mean_curvature == pytest.approx(wanted, abs=1e-3)
        # as it was asked for last
        moved = by_volume.at(lamella.circle((0, 0, 0), 1.02))
        assert moved.surface.volume() == pytest.approx(volume, abs=1e-10)


def test_the_unstable_film_is_followed() -> None:
    """The other catenoid, with its thin neck: radius c where 3 = c cosh(h / 2 c)."""
    film = lamella.follow([RING, ring(3.2)], tolerance=6e-2, branch="unstable").at([RING, ring(3.25)])
    assert film.equilibrium.negative == 1
    assert film.made_anew == ""
    assert deviation_from_catenoid(nodes(film), 3.0, 3.25, unstable=True) < 1e-2


def test_what_has_no_film_is_refused_and_the_film_before_stays() -> None:
    film = lamella.follow([RING, ring(3.6)], tolerance=6e-2)
    before = nodes(film).copy()
    with pytest.raises(InputError) as refused:
        film.at([RING, ring(4.3)])
    assert "3.97" in str(refused.value)
    with pytest.raises(InputError) as crossing:
        film.at([RING, lamella.spline([[3, 0, 3], [-3, 0, 3.2], [0, 3, 3], [0, -3, 3.2]])])
    assert crossing.value.where == "loops[1]"
    with pytest.raises(InputError) as both:
        film.at(mean_curvature=0.1, volume=3.0)
    assert both.value.where == "volume"
    assert np.array_equal(nodes(film), before)
    assert film.at([RING, ring(3.65)]).made_anew == ""


def test_elements_may_be_asked_for_alone() -> None:
    film = lamella.follow([RING, ring(2.0)], tolerance=3e-2)
    with pytest.raises(NotKeptError, match="1 loops, not 2"):
        film.moved(Boundary((RING,), 0.0, None), anew=False)
    assert film.at([RING]).made_anew == "the boundary has 1 loops, not 2"


def test_a_loop_leaves_its_plane() -> None:
    """A flat disc whose rim is bent to a saddle, of which a spline with no corner is left."""
    flat = lamella.spline([[4 * np.cos(t), 3 * np.sin(t), 0] for t in 2 * np.pi * np.arange(12) / 12])
    film = lamella.follow(flat, tolerance=2e-2).at(saddle(0.3))
    found = lamella.film(saddle(0.3), tolerance=2e-3)
    _, nearest = found.closest(nodes(film))
    assert np.abs(nearest - nodes(film)).max() < 1e-3 * film.equilibrium.film.size


def test_corners_stay_at_their_vertices() -> None:
    """The fraction of a loop at which a corner is changes with the corners; the vertex there goes with it."""
    square = lamella.polyline(CORNERS)
    film = lamella.follow(square, tolerance=5e-2)
    moved = CORNERS + np.array([[0, 0, 0], [0.4, 0, 0.1], [0, 0, 0], [0, 0.2, 0]])
    there = film.at(lamella.polyline(moved))
    assert there.made_anew == ""
    distance = np.linalg.norm(nodes(there)[:, None] - moved, axis=2).min(0)
    assert distance.max() < 1e-9


def test_corners_that_come_or_slide_are_no_corners_of_the_elements() -> None:
    square = lamella.polyline(CORNERS)
    film = lamella.follow(square, tolerance=5e-2)
    mesh = film.equilibrium.film.mesh
    five = lamella.polyline(np.insert(CORNERS, 1, [0, -2.4, 0.4], 0))
    with pytest.raises(NotKeptError, match="5 corners, not 4"):
        carried_parameters(mesh, [square], [five])
    straight = lamella.polyline(np.insert(CORNERS, 1, CORNERS[:2].mean(0), 0))
    with pytest.raises(NotKeptError, match="a corner where it had none"):
        carried_parameters(mesh, [straight], [five])
    with pytest.raises(NotKeptError, match="slides"):
        carried_parameters(mesh, [square], [square.sliding(normal=(0, 0, 1))])


def test_films_whose_boundary_slides_are_made_anew() -> None:
    def standing(radius: float) -> list[lamella.Loop]:
        return [ring(0.0, radius).sliding(normal=(0, 0, 1)), ring(1.0, 2.0)]

    film = lamella.follow(standing(2.2), tolerance=5e-2).at(standing(2.25))
    assert "slides" in film.made_anew


def test_far_from_the_origin() -> None:
    """Survey coordinates: a film is measured from a point beside the first loop, and stays so."""
    far = np.array([5.1e6, 4.2e5, 120.0])
    base, up = lamella.circle(far, 3.0), np.array([0, 0, 1.0])
    film = lamella.follow([base, lamella.circle(far + 2.8 * up, 3.0)], tolerance=3e-2)
    film = film.at([base, lamella.circle(far + 3.2 * up, 3.0)])
    assert film.made_anew == ""
    height = nodes(film) - (far - film.origin)
    assert deviation_from_catenoid(height, 3.0, 3.2) < 1e-3
    assert film.surface.origin == film.origin


def test_pickles_and_prints() -> None:
    film = lamella.follow([RING, ring(2.8)], tolerance=3e-2)
    copy = pickle.loads(pickle.dumps(film))
    assert copy.allclose(film)
    assert np.array_equal(nodes(copy.at([RING, ring(2.9)])), nodes(film.at([RING, ring(2.9)])))
    assert "elements kept" in repr(film.at([RING, ring(2.9)]))
    with pytest.raises(InputError) as refused:
        lamella.follow([RING, ring(2.8)], leeway=0.5)
    assert refused.value.where == "leeway"
