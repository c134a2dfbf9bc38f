"""Large motions: published and closed-form solutions with the order in which errors fall."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import CrossSection
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.loads import make_loads
from lamella.structure.static import equilibrium
from lamella.structure.structure import make_structure
from structure.strips import orders, rod, strip


def bathe_bolourchi(elements: int, load: float) -> np.ndarray:
    """Tip of the 45-degree bend: radius 100, section 1 x 1, E = 1e7, nu = 0, and J = 1/6 (not 0.1406, the square's)."""
    young = 1e7
    section = CrossSection(young, young / 2, young / 2, young / 2 / 6, young / 12, young / 12)
    angle = np.linspace(0, np.pi / 4, elements + 1)
    points = 100 * np.stack((np.sin(angle), 1 - np.cos(angle), 0 * angle), 1)
    frames = exponential(np.stack((0 * angle, 0 * angle, angle), 1))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes, 25 * np.pi / elements, section, natural=(0, 0, 0.01))
    structure = make_structure(Poses(points, frames, np.zeros(0)), beams, {0: "all"})
    loads = make_loads(structure, forces={elements: (0, 0, load, 0, 0, 0)})
    return equilibrium(structure, loads, steps=3).poses.points[-1]


@pytest.mark.parametrize(
    ("load", "tip"),
    [(300, (58.779, 22.245, 40.192)), (450, (52.239, 18.508, 48.503)), (600, (47.150, 15.685, 53.475))],
)
def test_bathe_bolourchi(load, tip):
    """K.-J. Bathe, S. Bolourchi, International Journal for Numerical Methods in Engineering 14 (1979) 961; the figures
    are those of geometrically exact elements with J = 1/6."""
    assert np.abs(bathe_bolourchi(64, load) - tip).max() < 0.01


def test_bathe_bolourchi_converges_with_the_second_order():
    """A bend in space: between elements the curvature changes, in each it is constant but for the S-bend."""
    tips = np.array([bathe_bolourchi(n, 600) for n in (8, 16, 32, 64)])
    assert np.allclose(orders(np.linalg.norm(np.diff(tips, axis=0), axis=1)), 2.0, atol=0.1)


def elastica(load: float) -> np.ndarray:
    """Tip of a cantilever of unit length and bending stiffness under a dead transverse tip load (K. E. Bisshopp,
    D. C. Drucker, Quarterly of Applied Mathematics 3 (1945) 272)."""

    def residual(k):
        return ellipk(k * k) - ellipkinc(np.arcsin(1 / (k * np.sqrt(2))), k * k) - np.sqrt(load)

    k = brentq(residual, np.sqrt(0.5) + 1e-14, 1 - 1e-14, xtol=1e-15)
    amplitude = np.arcsin(1 / (k * np.sqrt(2)))
    across = 1 - 2 / np.sqrt(load) * (ellipe(k * k) - ellipeinc(amplitude, k * k))
    return np.array([np.sqrt(2 * (2 * k * k - 1) / load), across])


@pytest.mark.parametrize("load", [1.0, 10.0])
def test_elastica(load):
    """In a plane the errors fall with the fourth order: at 10 E I / L^2 the tip has turned by 82 degrees."""
    section = rod(axial=1e12, torsion=1.0, about_u=1.0, about_n=1.0)
    errors = []
    for elements in (4, 8, 16, 32):
        structure = strip(elements, 1.0, section, {0: "all"})
        found = equilibrium(structure, make_loads(structure, forces={elements: (0, load, 0, 0, 0, 0)}), steps=4)
        errors.append(np.abs(found.poses.points[-1, :2] - elastica(load)).max())
    assert np.allclose(orders(errors), 4.0, atol=0.3)
    assert errors[-1] < 1e-7


def test_own_weight_converges_with_the_fourth_order():
    """A cantilever that hangs down steeply under a dead load along it."""
    tips = []
    for elements in (4, 8, 16, 32):
        structure = strip(elements, 2.0, rod(), {0: "all"})
        found = equilibrium(structure, make_loads(structure, lines=(0, -20.0, 0)), steps=4)
        assert found.reactions.sum(0)[:3] == pytest.approx([0, 40, 0], abs=4e-8)
        tips.append(found.poses.points[-1, :2])
    falling = orders(np.linalg.norm(np.diff(tips, axis=0), axis=1))
    assert falling[-1] == pytest.approx(4.0, abs=0.4)
