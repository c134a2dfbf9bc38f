"""Normal curvature beside a curve: kn + d (tg' + 2 kg (kn - H)) + O(d^2), and that slope along lamellas.

1. parallel curves at the geodesic distance d, shot from closed forms, against the formula, for lamellas, lines of
another normal curvature and principal lines; 2. the slope at the samples against the closed forms of tg along lamellas;
3. on elements, where it is differentiated, with its order; 4. next to singular nodes.
"""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import Catenoid, Enneper, Helicoid, Nodoid, Unduloid
from lamella.network.elements.element_network import element_network
from lamella.network.lattice.density import choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.network import SINGULAR, Network
from lamella.network.pattern import Pattern
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.darboux import sideways_slope
from network.elements.test_element_network import catenoid

FORMS = [
    Catenoid(1.3, (-1.0, 1.4)),
    Unduloid(0.6, 1.2, (-0.9, 1.3)),
    Nodoid(0.8, 2.0, (-0.3, 0.25)),
    Helicoid(5.0, 0.3, 2, 1),
]


def at_distance(
    surface: ClosedForm, zeta: np.ndarray, heading: np.ndarray, distance: float, steps: int = 40
) -> np.ndarray:
    """Places at a geodesic distance to the side of curves, where Q is constant: lambda = 1 / mu up to a factor.

    A curve of direction theta has kg = d theta / ds - u . grad ln lambda in the parameters, 0 on a geodesic.
    """

    def rate(zeta: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        way = np.exp(1j * theta)
        gradient = surface.at(zeta).log_mu_gradient
        return way / surface.metric(zeta), -(np.conj(gradient) * 1j * way).real

    theta, h = np.angle(1j * heading), distance / steps
    for _ in range(steps):
        k1, l1 = rate(zeta, theta)
        k2, l2 = rate(zeta + h / 2 * k1, theta + h / 2 * l1)
        k3, l3 = rate(zeta + h / 2 * k2, theta + h / 2 * l2)
        k4, l4 = rate(zeta + h * k3, theta + h * l3)
        zeta, theta = zeta + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), theta + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
    return zeta


@pytest.mark.parametrize("surface", FORMS, ids=lambda s: s.kind)
@pytest.mark.parametrize("angle", [np.pi / 4, -np.pi / 4, 0.3, 1.2, 0.0, np.pi / 2])
def test_parallel_curves(surface: ClosedForm, angle: float):
    """Lines at an angle to the principal directions: straight in the isothermic plane, so that tg' and kg are told."""
    rng = np.random.default_rng(5)
    zeta = surface.places(9, 9)[0]
    zeta = zeta[rng.integers(0, len(zeta), 12)] * 0.8 + 0.1 * zeta.mean()
    heading = np.full(len(zeta), np.exp(1j * (angle - np.angle(surface.hopf(zeta)[0]) / 2)))
    at = surface.at(zeta)
    slope = sideways_slope(at, heading)

    def kn(distance: float) -> np.ndarray:
        """Of the parallel curve, its direction by differences along the line."""
        step = 1e-4
        ends = [
            at_distance(surface, zeta + way * step * heading / surface.metric(zeta), heading, distance)
            for way in (-1, 1)
        ]
        along = ends[1] - ends[0]
        there = surface.at((ends[0] + ends[1]) / 2)
        return there.mean_curvature + (there.deviator * (along / np.abs(along)) ** 2).real

    scale = np.abs(at.deviator) + np.abs(at.mean_curvature)
    off = [np.abs(kn(d) - kn(0.0) - d * slope) / scale for d in (0.04, 0.02, 0.01)]
    if max(off[0]) < 1e-9:
        return
    orders = [np.log2(off[0].max() / off[1].max()), np.log2(off[1].max() / off[2].max())]
    assert min(orders) > 1.8
    assert off[2].max() < 2e-3


def test_slopes_of_lines_by_differences():
    """tg' + 2 kg (kn - H) from tg, kg and kn along traced lines, of another normal curvature too."""
    for surface, pattern in (
        (Catenoid(1.3, (-1.0, 1.4)), Pattern("lamellas", (1, 1), 0.1)),
        (Unduloid(0.6, 1.2, (-0.9, 1.3)), Pattern("lamellas", (1, 1), 0.4)),
        (Unduloid(0.6, 1.2, (-0.9, 1.3)), Pattern("principal", (1, 1), None)),
    ):
        density = choose_density(surface, cells=40, spacing=None, pattern=pattern)
        network = trace_closed_form(surface, density)
        k = network.sample_darboux
        for first, last in zip(network.sample_offsets[:-1], network.sample_offsets[1:], strict=True):
            one = slice(first, last)
            if last - first < 30:
                continue
            change = np.gradient(k.tg[one], network.sample_arclengths[one], edge_order=2)
            expected = change + 2 * k.kg[one] * (k.kn[one] - surface.mean_curvature)
            assert np.abs(network.sample_slopes[one] - expected).max() < 5e-3 * np.abs(network.sample_slopes).max()


def test_closed_forms():
    """Catenoid: tg = 1 / (c cosh^2 u); Delaunay: -+T / r^2; du/ds = 1 / (sqrt2 lambda) along lamellas upwards."""
    c = 1.3
    network = lamella.net(Catenoid(c, (-1.0, 1.4)), cells=20)
    u = network.sample_points[:, 2] / c
    expected = np.sqrt(2) * np.tanh(u) / (c**2 * np.cosh(u) ** 3)
    up = np.sign(network.sample_tangents[:, 2])
    sense = np.sign(network.sample_darboux.tg)
    np.testing.assert_allclose(network.sample_slopes, -up * sense * expected, atol=1e-13)
    for surface in (Unduloid(0.6, 1.2, (-0.9, 1.3)), Nodoid(0.8, 2.0, (-0.3, 0.25))):
        network = lamella.net(surface, cells=20)
        r = np.hypot(*network.sample_points.T[:2])
        # dr/ds by the tangent
        outwards = (network.sample_points[:, :2] * network.sample_tangents[:, :2]).sum(1) / r
        expected = -2 * np.sign(network.sample_darboux.tg) * abs(surface.flux) / r**3 * outwards
        np.testing.assert_allclose(network.sample_slopes, expected, atol=1e-12)
    helicoid = lamella.net(Helicoid(5.0, 1.0, 4.0, 1.0), cells=10)
    helix = np.abs(helicoid.sample_darboux.kg) > 1e-9
    assert np.abs(helicoid.sample_slopes[helix]).max() < 1e-13


def ray_ends(network: Network) -> np.ndarray:
    """First samples of the rays that leave singular nodes."""
    at = network.sample_offsets[network.stop_owner] + network.stop_samples
    return at[network.node_kinds[network.stop_nodes] == SINGULAR]


@pytest.mark.parametrize("order", [2, 3, 4])
def test_enneper(order: int):
    """H^2 - K = (2 (n - 1) r^(n-2) / (1 + r^(2n-2))^2)^2: tg along a ray, straight in the parameters, has no kink."""
    surface = Enneper(order, 0.8, 2.0)
    network = lamella.net(surface, cells=16)
    r = np.abs(network.sample_where)
    at = surface.at(network.sample_where)
    expected = (
        2 * network.sample_darboux.tg * (np.conj(at.log_mu_gradient) * at.components(network.sample_tangents)).real
    )
    inside = r > 1e-9
    np.testing.assert_allclose(network.sample_slopes[inside], expected[inside], atol=1e-12)
    if order == 2:
        size = 1 + r**2
        np.testing.assert_allclose(np.abs(network.sample_darboux.tg), 2 / size**2 / 2.0, rtol=1e-10)
        return
    first = ray_ends(network)
    assert len(first) == 2 * order
    # tg = 2 (n - 1) r^(n-2) / scale there: at order 3 with the slope 2 (n - 1) / scale^2 out of the node, at order 4
    # none
    leaving = np.where(network.sample_arclengths[first] == 0, 1.0, -1.0)
    slope = leaving * network.sample_slopes[first] * np.sign(network.sample_darboux.tg[first + leaving.astype(int)])
    np.testing.assert_allclose(slope, 2 * 2 / surface.scale**2 if order == 3 else 0.0, rtol=1e-5, atol=1e-5)


def test_on_elements_with_its_order():
    """The catenoid's, from samples on elements: second order in their distance, at the ends too."""
    _, surface = catenoid(48, 26)
    errors = []
    for cells in (8, 16):
        network = element_network(surface, cells=cells).network
        x, y, _ = network.sample_points.T
        cosh = np.sqrt(x**2 + y**2)
        expected = np.sqrt(2) * np.sqrt(np.maximum(cosh**2 - 1, 0)) / cosh**4
        errors.append(np.abs(np.abs(network.sample_slopes) - expected).max())
    assert np.log2(errors[0] / errors[1]) > 1.7
    # of the largest slope, 0.54
    assert errors[1] < 0.03
