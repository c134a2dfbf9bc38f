"""Films that pass through themselves."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.form_finding.find import find_film, notes_on
from lamella.surface.form_finding.found_film import Found
from lamella.surface.form_finding.newton import Equilibrium
from lamella.surface.form_finding.self_crossing import self_crossing
from lamella.surface.form_finding.stability import Stability
from surface.form_finding.exact_patches import ring
from surface.form_finding.films import disc_film, tube


def enneper(u, v):
    return np.column_stack([u - u**3 / 3 + u * v**2, -v + v**3 / 3 - v * u**2, u**2 - v**2])


@pytest.mark.parametrize(("radius", "crosses"), [(1.0, False), (1.65, False), (1.85, True), (2.5, True)])
def test_enneper(radius, crosses) -> None:
    """Enneper's surface over a disc of the parameters crosses itself from the radius sqrt(3) on, where x or y is 0."""
    flat = disc_film(4, 8)
    u, v = radius * flat.nodes[:, 0], radius * flat.nodes[:, 1]
    places = self_crossing(flat.at(enneper(u, v)))
    assert (places is not None) == crosses
    if places is not None:
        assert np.abs(places[:, :2]).min(1).max() < 0.1 * radius


def test_place_of_a_crossing() -> None:
    """Two strips of a tube that is pressed through itself: its profile crosses at a known radius and height."""

    def profile(s):
        # a loop in the meridian: (r, z) = (2 + t^3 - t, t^2), which crosses itself at t = -1, 1
        return 2 + s**3 - s, s**2

    places = self_crossing(tube(profile, np.linspace(-1.4, 1.4, 25), 40, 4))
    assert places is not None
    assert np.hypot(places[:, 0], places[:, 1]) == pytest.approx(2, abs=0.05)
    assert places[:, 2] == pytest.approx(1, abs=0.05)
    assert self_crossing(tube(profile, np.linspace(-0.9, 0.9, 25), 40, 4)) is None


def test_sound_films_do_not_cross() -> None:
    for bend in (0.0, 0.5, 0.98):
        assert self_crossing(disc_film(4, 6, lambda r2, bend=bend: -np.sqrt(1.02 - bend * r2))) is None
    assert self_crossing(tube(lambda s: (1 + 0 * s, s), np.linspace(0, 3, 9), 16, 3)) is None


def test_a_film_that_crosses_itself_is_told_with_its_place() -> None:
    flat = disc_film(4, 8)
    film = flat.at(enneper(2 * flat.nodes[:, 0], 2 * flat.nodes[:, 1]))
    found = Found(Equilibrium(film, 0.0, 0, 0, ()), Stability("stable", 1.0, 0, np.zeros(1)), 0.0, 1.0, 0, False)
    (note,) = notes_on(found)
    place = np.array([float(x) for x in note.split("(")[1].split(")")[0].split(",")])
    assert np.linalg.norm(self_crossing(film) - place, axis=1).min() < 1e-3
    assert not notes_on(find_film((ring(1.0, 0.0),), -0.5))
