"""Every example runs and has the one physical number its surface is known for."""

from pathlib import Path

import numpy as np
import pytest

from lamella import compute, read_project

EXAMPLES = Path(__file__).parents[1] / "examples"


def _delaunay(results):
    """Lamellas of an unduloid are arcs of radius r_M + r_m (Delaunay 1841)."""
    radii = {1 / abs(part.curvature) for part in results.parts.parts}
    assert len(radii) == 1
    return radii.pop(), 1.6 + 2.8


def _nodoid(results):
    """Largest twist at the neck: tg = |T| / r_m^2 = H r_M / r_m."""
    return results.summary["lamellas"]["geodesic_torsion_max"], (1 / (9 - 4)) * 9 / 4


def _catenoid(results):
    """Area pi c^2 (u + sinh u cosh u) on either side of the neck."""
    half = [np.pi * 2.5**2 * (u + np.sinh(u) * np.cosh(u)) for u in (2.0 / 2.5, 3.0 / 2.5)]
    return results.summary["surface"]["area"], sum(half)


def _helicoid(results):
    """The longest lamella is the outermost helix, sqrt((2 pi R)^2 + pitch^2) a turn."""
    return results.network.lengths.max(), 1.25 * np.hypot(2 * np.pi * 4.5, 6.0)


def _enneper(results):
    """Area pi (R^2 + R^4 + R^6 / 3) times the scale squared."""
    r = 1.1
    return results.summary["surface"]["area"], 25 * np.pi * (r**2 + r**4 + r**6 / 3)


def _scherk(results):
    """At the saddle the principal curvatures are +-1 over the scale, and so is the twist, the largest there is."""
    return results.summary["lamellas"]["geodesic_torsion_max"], 1 / 4.0


def _hexagonal(results):
    """A zero of order 1 of the Hopf differential has 2 (1 + 2) lamella rays."""
    (node,) = results.summary["network"]["singular_nodes"]
    return node["rays"], 6


NUMBERS = {
    "01_unduloid": (_delaunay, 1e-12),
    "02_nodoid": (_nodoid, 1e-9),
    "03_catenoid": (_catenoid, 1e-12),
    "04_helicoid": (_helicoid, 1e-12),
    "05_enneper": (_enneper, 1e-12),
    # the saddle itself is a corner of no cell where the number of cells is odd
    "06_scherk": (_scherk, 2e-3),
    "07_hexagonal_node": (_hexagonal, 0),
}


def test_every_example_has_its_number():
    assert {path.stem for path in EXAMPLES.glob("*.toml")} == set(NUMBERS)


@pytest.mark.parametrize("name", NUMBERS)
def test_example(name):
    number, tolerance = NUMBERS[name]
    results = compute(read_project(EXAMPLES / f"{name}.toml"))
    found, known = number(results)
    assert found == pytest.approx(known, rel=tolerance)
    assert results.summary["lamellas"]["utilisation_max"] < 1
    assert results.summary["network"]["closed"]
