"""`lamella.film`: the surface of the same project, from arrays too, far from the origin too."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import InputError

TURNS = 2 * np.pi * np.arange(8) / 8
RIM = np.stack([3 * np.cos(TURNS), 2.5 * np.sin(TURNS), 0.5 * np.cos(2 * TURNS)], 1)


def test_it_is_the_surface_of_a_project() -> None:
    table = {"kind": "form-found", "tolerance": 0.05, "boundary": [{"points": RIM.tolist(), "name": "outer"}]}
    other = lamella.make_surface(lamella.parse_project({"surface": table}))
    for given in ([lamella.spline(RIM)], [RIM], lamella.spline(RIM)):
        film = lamella.film(given, tolerance=0.05)
        assert film.allclose(other, 0.0)
    assert film.describe()["stability"] == "stable"


def test_a_volume_and_its_sphere() -> None:
    """The cap of height h over a circle of radius r has the volume pi h (3 r^2 + h^2) / 6 and H = 2 h / (r^2 + h^2)."""
    r, h = 2.0, 0.8
    cap = lamella.film([lamella.circle((0, 0, 0), r)], volume=np.pi * h * (3 * r**2 + h**2) / 6, tolerance=0.01)
    assert cap.mean_curvature == pytest.approx(-2 * h / (r**2 + h**2), rel=1e-3)
    _, top = cap.closest([[0.0, 0.0, 1.0]])
    assert top[0, 2] == pytest.approx(h, rel=1e-4)


def test_far_from_the_origin_it_is_measured_from_a_point_beside_it() -> None:
    far = RIM + np.array([500_000.0, 6_000_000.0, 100.0])
    film, near = lamella.film([far], tolerance=0.05), lamella.film([RIM], tolerance=0.05)
    assert film.origin == (500_000.0, 6_000_000.0, 100.0)
    assert film.area() == pytest.approx(near.area(), rel=1e-6)


def test_refused() -> None:
    ring = lamella.circle((0, 0, 0), 2.0)
    with pytest.raises(InputError) as caught:
        lamella.film([ring], 0.1, volume=2.0)
    assert caught.value.where == "volume"
    with pytest.raises(InputError) as caught:
        lamella.film([])
    assert caught.value.where == "loops"
    with pytest.raises(InputError):
        lamella.film([ring, lamella.circle((1.5, 0, 0), 1.0)], tolerance=0.02)
    # a circle of radius 2 carries |H| up to 1/2
    with pytest.raises(InputError) as caught:
        lamella.film([ring], 0.6, tolerance=0.02)
    assert caught.value.where == "mean_curvature"
