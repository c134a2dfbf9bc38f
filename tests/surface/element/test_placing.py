"""Curved boundary elements: interpolation on them has to keep the order of straight ones.

For order p the error of interpolation is O(h^(p+1)) only where the blending's own derivatives are as small as the
boundary's curvature makes them (Lenoir, SIAM J. Numer. Anal. 23 (1986), 562-580, doi:10.1137/0723036); elements whose
boundary nodes alone are moved stop at lower orders.
"""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.element.connectivity import connect
from lamella.surface.element.lagrange import subdivision
from lamella.surface.element.placing import place_nodes, rim_parameters
from surface.form_finding.exact_patches import ArcLength, circle, disc

TAU = 2 * np.pi
ORDERS = [2, 3, 4]


def helix_loop(s):
    """Up one helix and down another, joined by straight ends: corners at 0, 0.4, 0.5, 0.9."""
    piece = np.select([s < 0.4, s < 0.5, s < 0.9], [0, 1, 2], 3)
    share = np.select(
        [piece == 0, piece == 1, piece == 2], [s / 0.4, (s - 0.4) / 0.1, (s - 0.5) / 0.4], (s - 0.9) / 0.1
    )
    angle = 2.0 * np.select([piece == 0, piece == 1, piece == 2], [share, 1, 1 - share], 0)
    radius = np.select([piece == 0, piece == 1, piece == 2], [2, 2 - share, 1], 1 + share)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0.5 * angle])


def order_of(errors) -> float:
    """Slope over refinements by two."""
    return float(-np.polyfit(np.arange(len(errors)), np.log2(errors), 1)[0])


def rms(values) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def cap(points):
    """A function over the disc: height of a sphere."""
    return np.sqrt(2 - points[..., 0] ** 2 - points[..., 1] ** 2)


@pytest.mark.parametrize("order", ORDERS)
class TestDisc:
    def placed(self, order: int, rings: int):
        points, faces, on_rim, parameter = disc(rings)
        mesh = connect(faces, len(points), order)
        rim = ArcLength(circle)
        return mesh, place_nodes(mesh, points, np.where(on_rim, 0, -1), parameter, [rim])

    def test_sphere_is_interpolated_to_full_order(self, order) -> None:
        local, _ = subdivision(6)
        errors, gradients = [], []
        for rings in (6, 12, 24):
            mesh, nodes = self.placed(order, rings)
            corners = nodes[mesh.elements]
            basis, x, y, *_ = mesh.basis.second_jet(local)
            at = np.matmul(basis, corners)
            errors.append(rms(np.matmul(basis, cap(corners)[..., None])[..., 0] - cap(at)))
            # the slope of the interpolant against the exact one
            slope = np.stack([np.matmul(f, cap(corners)[..., None])[..., 0] for f in (x, y)], -1)
            exact = -at[..., :2] / cap(at)[..., None]
            jacobian = np.stack([np.matmul(f, corners)[..., :2] for f in (x, y)], -2)
            gradients.append(rms(np.linalg.solve(jacobian, slope[..., None])[..., 0] - exact))
        assert order_of(errors) > order + 0.7, errors
        assert order_of(gradients) > order - 0.3, gradients

    def test_rim_lies_on_the_circle(self, order) -> None:
        t = np.linspace(0, 1, 9)
        errors = []
        for rings in (6, 12, 24):
            mesh, nodes = self.placed(order, rings)
            assert np.linalg.norm(nodes[mesh.rim_nodes], axis=2) == pytest.approx(1, abs=1e-12)
            powers = np.vander(t, order + 1) @ np.linalg.inv(np.vander(np.linspace(0, 1, order + 1), order + 1))
            along = np.einsum("tk,bkc->btc", powers, nodes[mesh.rim_nodes])
            errors.append(np.abs(np.linalg.norm(along, axis=2) - 1).max())
        assert order_of(errors) > order + 0.7

    def test_only_elements_on_the_rim_are_bent(self, order) -> None:
        mesh, nodes = self.placed(order, 4)
        points, faces, *_ = disc(4)
        barycentric = np.column_stack([1 - mesh.basis.nodes.sum(1), mesh.basis.nodes])
        bent = np.abs(nodes[mesh.elements] - barycentric @ points[faces]).max((1, 2)) > 1e-12
        assert bent.sum() == len(mesh.rim_elements)
        assert set(np.flatnonzero(bent)) == set(mesh.rim_elements)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_element_with_several_boundary_edges(order, edges) -> None:
    """One triangle shrinking on three circles of radius 1: interpolation inside keeps its order."""
    local, _ = subdivision(8)
    errors = []
    for h in (0.4, 0.2, 0.1):
        corners = h * np.column_stack([np.cos([0.2, 2.2, 4.4]), np.sin([0.2, 2.2, 4.4]), np.zeros(3)])

        def arcs(s, corners=corners):
            """From corner to corner along circles that bulge outwards, straight beyond the first `edges`."""
            side = np.minimum((3 * s).astype(int), 2)
            a, b = corners[side], corners[(side + 1) % 3]
            share = (3 * s - side)[:, None]
            half = np.linalg.norm(b - a, axis=1)[:, None] / 2
            opening = np.arcsin(half)
            along = np.sin((2 * share - 1) * opening)
            out = np.cos((2 * share - 1) * opening) - np.cos(opening)
            outward = np.cross(b - a, [0.0, 0.0, 1.0]) / (2 * half)
            bent = (a + b) / 2 + along * (b - a) / (2 * half) + out * outward
            return np.where((side < edges)[:, None], bent, a + share * (b - a))

        rim = ArcLength(arcs, (0.0, 1 / 3, 2 / 3))
        mesh = connect(np.array([[0, 1, 2]]), 3, order)
        nodes = place_nodes(mesh, corners, np.zeros(3, int), rim.corners, [rim])
        assert nodes[mesh.rim_nodes] == pytest.approx(
            rim.at(rim_parameters(mesh, rim.corners).ravel()).reshape(3, order + 1, 3), abs=1e-14
        )

        def f(x):
            return np.exp(x[..., 0]) * np.cos(2 * x[..., 1])

        basis = mesh.basis.basis(local)
        corner = nodes[mesh.elements[0]]
        errors.append(np.abs(basis @ f(corner) - f(basis @ corner)).max())
    assert order_of(errors) > order + 0.7, errors


@pytest.mark.parametrize("order", ORDERS)
def test_strip_between_two_helices(order) -> None:
    """Edges between the exact boundary nodes stay at O(h^(p+1)) of the helix x = r (cos a, sin a), z = a / 2."""
    rim = ArcLength(helix_loop, (0.0, 0.4, 0.5, 0.9))
    t = np.linspace(0, 1, 11)
    powers = np.vander(t, order + 1) @ np.linalg.inv(np.vander(np.linspace(0, 1, order + 1), order + 1))
    c = rim.corners
    errors = []
    for count in (3, 6, 12):
        parameter = np.concatenate(
            [np.linspace(c[0], c[1], count + 1), np.linspace(c[2], c[3], count + 1)[::-1]]
        )  # outer helix, and the inner one in the same order
        outer, inner = np.arange(count + 1), count + 1 + np.arange(count + 1)
        faces = np.concatenate(
            [
                np.column_stack([outer[:-1], outer[1:], inner[:-1]]),
                np.column_stack([inner[:-1], outer[1:], inner[1:]]),
            ]
        )
        mesh = connect(faces, len(parameter), order)
        nodes = place_nodes(mesh, rim.at(parameter), np.zeros(len(parameter), int), parameter, [rim])
        along = np.einsum("tk,bkc->btc", powers, nodes[mesh.rim_nodes]).reshape(-1, 3)
        r, a = np.hypot(along[:, 0], along[:, 1]), 2 * along[:, 2]
        expected = np.column_stack([r * np.cos(a), r * np.sin(a)])
        off = np.linalg.norm(along[:, :2] - expected, axis=1) + np.minimum(abs(r - 1), abs(r - 2))
        # the two straight ends are exact
        ends = (np.abs(a) < 1e-9) | (np.abs(a - 2) < 1e-9)
        assert np.linalg.norm(along[:, :2] - expected, axis=1)[ends].max() < 1e-12
        errors.append(off[~ends].max())
    assert order_of(errors) > order + 0.7, errors


def test_parameters_take_the_short_way_through_nought() -> None:
    mesh = connect(np.array([[0, 1, 2]]), 3, 4)
    t = rim_parameters(mesh, np.array([0.9, 0.1, 0.5]))
    across = t[(mesh.rim_nodes[:, 0] == 0)][0]
    assert across == pytest.approx([0.9, 0.95, 0.0, 0.05, 0.1])
