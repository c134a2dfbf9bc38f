"""Films next to corners against a closed form: a minimal surface in two straight sides that meet at any angle b.

Weierstrass data f = w^(m - 1), f g = i c over the half disc |w| <= 1, Im w >= 0, with m = b / pi: both halves of the
real axis become straight sides, and the Gauss curvature is -(4 |g'| / (|f| (1 + |g|^2)^2))^2 (Dierkes, Hildebrandt and
Sauvigny, Minimal Surfaces (2010), section 3.3, doi:10.1007/978-3-642-11698-8). Its curvature goes like r^(pi / b - 2)
where b is below 180 degrees; for b above, g has a pole in the corner: the surface is turned over where g is above
1, and has the angle 360 degrees - b. The Gauss image covers less than half a sphere, so the surface is the stable one
(Barbosa and do Carmo, Amer. J. Math. 98 (1976), 515-528, doi:10.2307/2373899).
"""

from __future__ import annotations

import numpy as np
import pytest

from lamella.network.elements.element_network import element_network
from lamella.network.elements.rim_corners import RimCorners
from lamella.network.network import REGULAR
from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.pieces import lines, stack
from lamella.surface.boundary.splines import open_spline
from lamella.surface.element.rim import CORNER_CORE
from lamella.surface.form_finding.find import find_film

# units, m to the unit
UNIT = 5.0


def position(w: np.ndarray, m: float, c: float) -> np.ndarray:
    first, second = w**m / m, c**2 * w ** (2 - m) / (2 - m)
    x = np.stack([(first + second).real / 2, -(first - second).imag / 2, (1j * c * w).real], -1)
    return UNIT * x


def curvature(w: np.ndarray, m: float, c: float) -> np.ndarray:
    """Both principal curvatures, without sign, 1/m."""
    g, slope = c * np.abs(w) ** (1 - m), c * np.abs(1 - m) * np.abs(w) ** -m
    return 4 * slope / (np.abs(w) ** (m - 1) * (1 + g**2) ** 2) / UNIT


def boundary(m: float, c: float) -> Loop:
    arc = position(np.exp(1j * np.pi * np.linspace(0, 1, 121)), m, c)
    sides = [lines(np.array([arc[-1], np.zeros(3), arc[0]]), closed=False), open_spline(arc)]
    return make_loop("sector", stack(sides))


@pytest.mark.parametrize(("degrees", "c"), [(125.0, 0.6), (270.0, 0.7)], ids=["convex", "reflex"])
def test_films_and_nets_next_to_a_corner(degrees: float, c: float) -> None:
    m = degrees / 180
    found = find_film((boundary(m, c),), tolerance=5e-3)
    surface = found.surface("form-found")
    size = float(np.linalg.norm(np.ptp(surface.nodes, axis=0)))
    corners = RimCorners.of(surface)
    corner = int(np.linalg.norm(corners.points, axis=1).argmin())
    angle = np.degrees(corners.angles[corner])
    assert angle == pytest.approx(min(degrees, 360 - degrees), abs=1.5)

    # from the edge of the core to the far side, evenly in the logarithm
    radius = np.geomspace(1e-5, 0.9, 60)[:, None]
    w = (radius * np.exp(1j * np.pi * np.linspace(0.05, 0.95, 9))).ravel()
    exact = position(w, m, c)
    away = np.linalg.norm(exact, axis=1) / size
    places, near = surface.closest(exact)
    _, mean, deviator = surface.shape_at(places)
    off = np.abs(np.abs(deviator) / curvature(w, m, c) - 1)
    outside = away > CORNER_CORE
    assert np.count_nonzero(outside & (away < 10 * CORNER_CORE)) > 20
    assert np.linalg.norm(near - exact, axis=1)[outside].max() < 1e-5 * size
    # as good next to the corner as elsewhere
    assert off[outside].max() < 0.02
    assert off[outside & (away > 0.03)].max() < 0.01
    assert np.abs(mean)[outside].max() < 0.02 * curvature(w, m, c)[outside].max()
    if degrees < 180:
        close = outside & (away < 0.05)
        power = np.polyfit(np.log(away[close]), np.log(np.abs(deviator[close])), 1)[0]
        assert power == pytest.approx(180 / degrees - 2, abs=0.1)

    woven = element_network(surface, cells=14)
    net = woven.network
    resolved = corners.within(net.sample_points, corners.cores) < 0
    there = net.sample_darboux
    assert np.abs(there.kn[resolved]).max() < 5e-3 * np.abs(there.tg[resolved]).max()
    regular = net.node_points[net.node_kinds == REGULAR]
    off = np.abs(90 - net.node_angles)[corners.within(regular, corners.cores) < 0]
    assert off.max() < 0.2
    (row,) = [row for row in woven.describe()["corners"] if np.linalg.norm(row["point"]) < 1e-9]
    assert row["angle_deg"] == pytest.approx(angle)
    assert row["unresolved_radius"] < 0.0031 * size
