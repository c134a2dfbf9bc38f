"""Newton's method: quadratic at the end, few steps, the wanted volume, and the same film from both sides."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.family import member_of
from lamella.surface.form_finding.newton import Along, FixedH, NoFilmError, Volume, find_equilibrium
from surface.form_finding.exact_patches import CatenoidPatch, SphereCap, UnduloidPatch, catenoid_neck, ring
from surface.form_finding.films import disc_film, on_sizes, random_places, start, surface, tube


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("patch", [CatenoidPatch(), UnduloidPatch(), SphereCap(0.8)], ids=lambda p: type(p).__name__)
def test_moves_fall_quadratically_from_the_harmonic_start(patch, order) -> None:
    """Each step's largest shift is at most a constant times the square of the one before (Kantorovich)."""
    found = find_equilibrium(start([patch.rim()], order), patch.mean_curvature)
    assert found.steps <= 8
    assert found.negative == 0
    size = found.film.size
    moves = np.array(found.moves) / size
    falling = [(a, b) for a, b in pairwise(moves) if a < 0.05 and b > 1e-11]
    assert falling
    for before, after in falling:
        assert after < 30 * before**2, moves
    assert moves[-1] < 1e-7


def test_given_volume_is_enclosed_and_its_mean_curvature_found() -> None:
    """A cap of height h over the unit circle: V = pi h (3 + h^2) / 6, H = 2 h / (1 + h^2)."""
    h = 0.5
    volume = np.pi * h * (3 + h**2) / 6
    flat = disc_film(4, 5)
    # the normal points up: a bowl below has H > 0 and takes volume away from above
    found = find_equilibrium(flat, 0.0, Volume(-volume))
    assert found.mean_curvature == pytest.approx(2 * h / (1 + h**2), rel=1e-5)
    assert enclosed_volume(found.film) == pytest.approx(-volume, rel=1e-8)
    assert found.film.nodes[:, 2].min() == pytest.approx(-h, abs=1e-4)
    moves = np.array(found.moves)
    assert all(b < 30 * a**2 for a, b in pairwise(moves) if a < 0.05 and b > 1e-11)


def test_reversed_loop_reverses_the_sign_of_mean_curvature() -> None:
    """The normal follows the outer loop by the right-hand rule; H > 0 bends towards it: a bowl under an upward one."""
    patch = SphereCap(0.4)
    rim = patch.rim()

    class Backwards:
        name, length, corners, slides = "rim", rim.length, rim.corners, ()

        def at(self, t):
            return rim.at(1 - np.asarray(t))

    bowl = find_equilibrium(start([rim], 3), patch.mean_curvature)
    dome = find_equilibrium(start([Backwards()], 3), patch.mean_curvature)
    assert bowl.film.nodes[:, 2].min() == pytest.approx(-0.4, abs=5e-3)
    assert dome.film.nodes[:, 2].max() == pytest.approx(0.4, abs=5e-3)


@pytest.mark.parametrize("distance", [0.7, 1.1, 1.3])
def test_rings_from_the_harmonic_start(distance) -> None:
    """At most eight steps, also next to the limit; the neck is the thicker catenary's."""
    film = start([ring(1, distance), ring(1, 0)], 4)
    found = find_equilibrium(film)
    assert found.steps <= 8
    found = on_sizes(found.film, 0.2)
    at = surface(found.film).measured(random_places(found.film, 20_000)).position
    radius = np.hypot(at[:, 0], at[:, 1])
    neck = catenoid_neck(distance, thin=False)
    assert np.abs(radius - neck * np.cosh((at[:, 2] - distance / 2) / neck)).max() < 1e-5


@pytest.mark.parametrize("share", [0.9, 0.99, 0.999])
def test_steps_next_to_a_fold(share) -> None:
    """A cap with H R = 0.999, rings at 0.999 of the limit, and further away: eight steps from the harmonic start, where
    Newton's method alone halves the error ten times. Moves still fall quadratically at the end, with a constant that
    grows as the other film comes nearer, at a distance like sqrt(1 - share).
    """
    for loops, h in (([ring(1.0, 0.0)], share), ([ring(1, share * 1.3254868387), ring(1, 0)], 0.0)):
        found = find_equilibrium(start(loops, 4), h)
        assert found.steps <= 8
        before, last = np.array(found.moves[-2:]) / found.film.size
        assert last < 3 / np.sqrt(1 - share) * before**2


def test_unstable_film_is_kept_when_stability_is_not_asked_for() -> None:
    """From the exact thin-necked catenoid Newton's method stays there, with its one negative eigenvalue."""
    distance = 1.2
    neck = catenoid_neck(distance, thin=True)
    u = distance / 2 / neck
    kept = find_equilibrium(
        tube(lambda s: (neck * np.cosh(s), neck * s), np.linspace(-u, u, 13), 16, 4), condition=FixedH(stable=False)
    )
    assert kept.negative == 1
    assert kept.steps <= 3
    x = kept.film.nodes
    assert np.abs(np.hypot(x[:, 0], x[:, 1]) - neck * np.cosh(x[:, 2] / neck)).max() < 1e-4


def test_a_way_along_the_family_passes_the_fold() -> None:
    """Caps over the unit circle, H = 2 h / (1 + h^2): steps along the family go through h = 1, where H is largest."""
    here = find_equilibrium(disc_film(4, 5), 0.6)
    film, curvature, heights = here.film, here.mean_curvature, []
    for _ in range(6):
        member = member_of(film, curvature)
        ahead = member if member.growth < 0 else member.backwards()
        step = find_equilibrium(film, curvature, Along(ahead.weights, 0.25))
        moves = np.array(step.moves)
        assert all(b < 30 * a**2 for a, b in pairwise(moves) if a < 0.02 and b > 1e-9), moves
        assert ((step.film.nodes - film.nodes) * ahead.weights).sum() == pytest.approx(0.25, rel=1e-9)
        film, curvature = step.film, step.mean_curvature
        height = -film.nodes[:, 2].min()
        assert curvature == pytest.approx(2 * height / (1 + height**2), rel=5e-3)
        heights.append(height)
    assert heights[0] < 1 < heights[-1]
    assert np.all(np.diff(heights) > 0)


def test_direction_of_a_family_is_that_of_its_closed_form() -> None:
    """Caps of height h: dH/dh = 2 (1 - h^2) / (1 + h^2)^2 and dV/dh = pi (1 + h^2) / 2."""
    h = 0.6
    found = find_equilibrium(disc_film(4, 8), 2 * h / (1 + h**2))
    member = member_of(found.film, found.mean_curvature)
    # the volume is below 0 in a bowl
    wanted = -(2 * (1 - h**2) / (1 + h**2) ** 2) / (np.pi * (1 + h**2) / 2)
    assert member.rise / member.growth == pytest.approx(wanted, rel=1e-4)


def test_no_film_is_an_error_and_not_a_shape() -> None:
    """Rings beyond the limit, and a curvature no cap has."""
    with pytest.raises(NoFilmError):
        find_equilibrium(start([ring(1, 1.4), ring(1, 0)], 3))
    with pytest.raises(NoFilmError):
        find_equilibrium(disc_film(3, 4), 1.3)
