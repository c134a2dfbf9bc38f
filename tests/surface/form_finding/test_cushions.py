"""Cushions of given volume between two coplanar rings, against the ordinary differential equation of their meridian.

With psi the angle of the meridian over the plane, s its arc length: r' = cos psi, z' = sin psi,
psi' = 2 H - sin(psi) / r (Kenmotsu, Tohoku Math. J. 32 (1980), 147-153, doi:10.2748/tmj/1178229688). The family is
followed in psi at the inner ring: the volume has a largest value where the meridian leaves far beyond the vertical.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve

from lamella.base.errors import InputError
from lamella.surface.form_finding.find import find_film, notes_on
from surface.form_finding.exact_patches import ring

# deg
STEP = 5.0


def end_of_meridian(inner: float, mean_curvature: float, psi: float, length: float) -> np.ndarray:
    """r, z, psi, volume under it and area, at its end."""

    def slopes(_, y):
        r, z, angle = y[:3]
        return [
            np.cos(angle),
            np.sin(angle),
            2 * mean_curvature - np.sin(angle) / r,
            2 * np.pi * r * z * np.cos(angle),
            2 * np.pi * r,
        ]

    return solve_ivp(slopes, (0, length), [inner, 0, psi, 0, 0], "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]


@lru_cache
def family(inner: float) -> tuple[tuple[float, float, float], ...]:
    """psi (deg), H and length of cushions out to the ring of radius 1."""
    unknowns, result = np.array([-0.01, 1 - inner]), []
    for psi in np.arange(STEP, 176, STEP):
        unknowns = meridian(inner, float(psi), unknowns)
        result.append((float(psi), *map(float, unknowns)))
    return tuple(result)


def meridian(inner: float, psi: float, near: np.ndarray) -> np.ndarray:
    """H and length of the meridian that leaves at psi (deg)."""

    def missed(x):
        end = end_of_meridian(inner, x[0], np.radians(psi), x[1])
        return [end[0] - 1, end[1]]

    solution, _, ok, message = fsolve(missed, near, xtol=1e-12, full_output=True)
    assert ok == 1, message
    return solution


def cushion(inner: float, volume: float) -> tuple[float, float, float]:
    """psi (deg), H and area of the first cushion of a volume."""

    def at(psi: float, near: np.ndarray) -> np.ndarray:
        h, length = meridian(inner, psi, near)
        return np.array([h, length, *end_of_meridian(inner, h, np.radians(psi), length)[3:]])

    before, low = np.array([-0.01, 1 - inner]), 0.5
    for psi, *near in family(inner):
        near = np.array(near)
        if at(psi, near)[2] >= volume:
            angle = brentq(lambda x, near=near: at(x, near)[2] - volume, low, psi, xtol=1e-11)
            found = at(angle, near)
            return angle, found[0], found[3]
        before, low = near, psi
    raise AssertionError(f"no cushion of {volume}, up to {before}")


@pytest.mark.parametrize(
    ("inner", "volume", "beyond_vertical"),
    [(0.36, 0.36, False), (0.36, 0.72, True), pytest.param(0.2, 0.55, True, marks=pytest.mark.slow)],
)
@pytest.mark.few(1)
def test_cushion_of_given_volume(inner, volume, beyond_vertical) -> None:
    """H and area of a film of given volume, to 1e-6, are those of its meridian's differential equation."""
    psi, mean_curvature, area = cushion(inner, volume)
    assert (psi > 90) == beyond_vertical
    found = find_film((ring(1.0, 0.0), ring(inner, 0.0)), volume=volume, tolerance=0.01)
    assert found.equilibrium.mean_curvature == pytest.approx(mean_curvature, rel=1e-6)
    assert found.surface("cushion").area() == pytest.approx(area, rel=1e-6)


@pytest.mark.slow
def test_largest_volume_is_reported() -> None:
    """Beyond the volume at which the family turns back there is no such cushion."""
    inner = 0.36
    volumes = [end_of_meridian(inner, h, np.radians(psi), length)[3] for psi, h, length in family(inner)]
    with pytest.raises(InputError, match=r"turns back at about 0\.74") as error:
        find_film((ring(1.0, 0.0), ring(inner, 0.0)), volume=1.08 * max(volumes))
    assert error.value.where == "volume"
    offered = float(error.value.remedy.split(" m3")[0].split()[-1])
    assert 0.95 * max(volumes) < offered < max(volumes)


@pytest.mark.parametrize(("mean_curvature", "hangs"), [(0.5, True), (-0.5, False)])
def test_dome_of_the_wrong_sign(mean_curvature, hangs) -> None:
    """A cap of curvature H over a ring of radius R is 1/H - sqrt(1/H^2 - R^2) high: below it where H > 0."""
    notes = notes_on(find_film((ring(1.0, 0.0),), mean_curvature, tolerance=0.02))
    assert len(notes) == hangs
    if hangs:
        depth = float(notes[0].split("hangs up to ")[1].split()[0])
        # at the film's nodes, the lowest of which is within a tenth of the cap's radius from its pole
        assert depth == pytest.approx(2 - np.sqrt(3), rel=0.02)
        assert "mean_curvature = -0.5" in notes[0]
