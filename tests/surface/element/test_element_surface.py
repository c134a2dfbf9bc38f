"""Elements with their nodes on closed forms: what they answer, and the order with which it gets better.

Closed forms: DESIGN section 9; elements of order p have curvatures of order p - 1.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lamella.surface.element.connectivity import connect
from lamella.surface.element.places import Places
from lamella.surface.element.placing import place_nodes
from lamella.surface.element.surface import ElementSurface
from surface.element.exact_elements import catenoid_patch, on_map, sphere_cap, whole_catenoid
from surface.form_finding.exact_patches import (
    ArcLength,
    CatenoidPatch,
    EnneperPatch,
    Exact,
    HelicoidPatch,
    UnduloidPatch,
    area_of,
    circle,
    disc,
)

PATCHES: dict[str, Exact] = {
    "catenoid": CatenoidPatch(),
    "unduloid": UnduloidPatch(),
    "helicoid": HelicoidPatch(),
    "Enneper": EnneperPatch(),
}
ORDERS = [2, 3, 4]


def irregular(patch: Exact, order: int, count: int) -> ElementSurface:
    """The rectangle of a patch in 2 count^2 shaken triangles."""
    rng = np.random.default_rng(7)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij"))
    place = np.column_stack([i, j]).astype(float)
    inside = (i > 0) & (i < count) & (j > 0) & (j < count)
    place[inside] += rng.uniform(-0.22, 0.22, (inside.sum(), 2))
    (u0, v0), (u1, v1) = patch.rectangle
    uv = np.array([u0, v0]) + place / count * [u1 - u0, v1 - v0]
    a = ((count + 1) * i + j)[(i < count) & (j < count)]
    b, c, d = a + count + 1, a + count + 2, a + 1
    flip = rng.random(len(a)) < 0.5
    faces = np.concatenate(
        [
            np.where(flip[:, None], np.column_stack([a, b, c]), np.column_stack([a, b, d])),
            np.where(flip[:, None], np.column_stack([a, c, d]), np.column_stack([b, c, d])),
        ]
    )

    def x(uv):
        return patch.x(uv[..., 0].ravel(), uv[..., 1].ravel()).reshape(*uv.shape[:-1], 3)

    return on_map(x, uv[faces], faces, order, patch.mean_curvature)


def rms(values) -> float:
    return float(np.sqrt(np.mean(np.abs(values) ** 2)))


def between(a, b):
    return np.arcsin(np.minimum(np.linalg.norm(np.cross(a, b), axis=1), 1))


def slope(errors) -> float:
    """Order over refinements by two."""
    return float(-np.polyfit(np.arange(len(errors)), np.log2(errors), 1)[0])


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("name", PATCHES)
def test_shape_operator_has_its_order(name: str, order: int) -> None:
    """H, K and principal directions of the elements and of the Gauss map, and grad ln mu, RMS over all elements."""
    patch = PATCHES[name]
    errors = []
    for count in (4, 8, 16):
        surface = irregular(patch, order, count)
        where = surface.check_places()
        at, measured = surface.at(where), surface.measured(where)
        u, v = patch.parameters(at.position)
        k1, d1, k2 = patch.curvatures(u, v)
        gauss, half = k1 * k2, (k1 - k2) / 2
        turn = np.exp(-0.5j * np.angle(measured.deviator))
        direction = turn.real[:, None] * measured.e_u + turn.imag[:, None] * measured.e_v
        # grad ln mu = grad ln(half) / 2 by differences of the closed form along the orthogonal parameter lines
        exact = np.zeros((len(u), 3))
        for tangent, du, dv in zip(patch.tangents(u, v), (1e-5, 0), (0, 1e-5), strict=True):
            (a, _, b), (c, _, d) = patch.curvatures(u + du, v + dv), patch.curvatures(u - du, v - dv)
            exact += (np.log((a - b) / (c - d)) / 4e-5 / (tangent**2).sum(1))[:, None] * tangent
        errors.append(
            [
                rms(np.linalg.norm(at.normal - patch.normal(u, v), axis=1)),
                rms(measured.mean_curvature - patch.mean_curvature),
                rms(measured.mean_curvature**2 - np.abs(measured.deviator) ** 2 - gauss),
                rms(between(direction, d1)),
                rms(at.mean_curvature**2 - np.abs(at.deviator) ** 2 - gauss),
                rms(np.abs(at.deviator) - half),
                rms(between(at.principal_directions[0], d1)),
                rms(np.linalg.norm(at.vector(at.log_mu_gradient) - exact, axis=1)),
            ]
        )
    columns = np.array(errors).T
    # Enneper's surface is cubic: elements of order 3 hold it exactly
    exact = name == "Enneper" and order > 2
    assert slope(columns[0]) > order - 0.2 or (exact and columns[0].max() < 1e-12), columns[0]
    for column in columns[1:4]:
        assert slope(column) > order - 1.3 or (exact and column.max() < 1e-10), column
    for column in columns[4:7]:
        assert slope(column) > order - 1.4, column
    # the continuous field is one of order p - 1: its slope has one less, 0 for elements of order 2
    if order > 2:
        assert slope(columns[7]) > order - 2.2, columns[7]


@pytest.mark.parametrize("name", PATCHES)
def test_smoothed_field_has_no_jumps(name: str) -> None:
    """The same from both sides of an edge's middle, but for the jump of the elements' normals."""
    surface = irregular(PATCHES[name], 3, 8)
    mesh = surface.connectivity
    middles = np.array([[0.5, 0], [0.5, 0.5], [0, 0.5]])
    element, edge = np.nonzero(mesh.neighbours >= 0)
    here = Places(element, middles[edge])
    there = Places(mesh.neighbours[element, edge], middles[mesh.neighbour_edges[element, edge]])
    one, other = surface.at(here), surface.at(there)
    assert one.position == pytest.approx(other.position, abs=1e-13)
    ridge = between(one.normal, other.normal).max()
    assert between(one.principal_directions[0], other.principal_directions[0]).max() < 3 * ridge + 1e-12
    assert np.abs(one.mean_curvature - other.mean_curvature).max() < 3 * ridge + 1e-12


def test_frames_are_right_handed_and_orthonormal() -> None:
    surface = irregular(PATCHES["helicoid"], 3, 4)
    at = surface.at(surface.check_places())
    assert np.cross(at.e_u, at.e_v) == pytest.approx(at.normal, abs=1e-13)
    assert (at.e_u * at.e_v).sum(1) == pytest.approx(np.zeros(len(at.e_u)), abs=1e-13)
    d1, d2 = at.principal_directions
    assert np.cross(d1, d2) == pytest.approx(at.normal, abs=1e-12)
    assert at.shape_operator @ at.normal[..., None] == pytest.approx(0, abs=1e-12)
    k1, _ = at.principal_curvatures
    assert (at.shape_operator @ d1[..., None])[..., 0] == pytest.approx(k1[:, None] * d1, abs=1e-12)


@pytest.mark.parametrize("order", ORDERS)
def test_area_of_patches(order) -> None:
    """Interpolation is off by O(h^(p+1)) in position; the area gains at least that order."""
    for name in ("catenoid", "helicoid"):
        exact = area_of(PATCHES[name])
        errors = [abs(irregular(PATCHES[name], order, count).area() - exact) for count in (4, 8, 16)]
        assert slope(errors) > order + 0.7, errors
    # 2 pi times the integral of cosh^2 from -0.8 to 1.1
    whole = np.pi * (1.9 + (np.sinh(2.2) + np.sinh(1.6)) / 2)
    assert whole_catenoid(4, 24, 10).area() == pytest.approx(whole, rel=1e-6)


def ball_cap(order: int, rings: int) -> ElementSurface:
    """The cap of the ball of radius 2 above 60 degrees of latitude, its rim on the exact circle."""
    points, faces, on_rim, parameter = disc(rings)
    mesh = connect(faces, len(points), order)
    flat = place_nodes(mesh, points, np.where(on_rim, 0, -1), parameter, [ArcLength(circle)])
    nodes = flat.copy()
    nodes[:, 2] = np.sqrt(4 - (flat[:, :2] ** 2).sum(1))
    return ElementSurface("cap", -0.5, mesh, nodes, np.zeros(len(mesh.rim_elements), np.int64))


@pytest.mark.parametrize("order", ORDERS)
def test_volume_and_area_of_a_ball_cap(order) -> None:
    """pi h^2 (3 R - h) / 3 and 2 pi R h, with a flat lid; the normal points out of the ball: positive."""
    h = 2 - np.sqrt(3)
    volume, area = np.pi * h**2 * (6 - h) / 3, 4 * np.pi * h
    caps = [ball_cap(order, rings) for rings in (4, 8, 16)]
    errors = [max(abs(cap.volume() - volume), abs(cap.area() - area)) for cap in caps]
    assert slope(errors) > order + 0.7, errors
    assert errors[-1] < 1e-5 * area


def test_volume_between_two_rings() -> None:
    """The catenoid's tube: pi times the integral of cosh^2; lids on both rings, the normal points outwards."""
    exact = np.pi / 2 * (1.9 + (np.sinh(2.2) + np.sinh(1.6)) / 2)
    assert whole_catenoid(4, 24, 10).volume() == pytest.approx(exact, rel=1e-6)


def test_volume_does_not_depend_on_the_origin() -> None:
    surface = sphere_cap(3)
    moved = ElementSurface(
        "x", -0.5, surface.connectivity, surface.nodes + np.array([100.0, -50.0, 30.0]), surface.rim_loop
    )
    assert moved.volume() == pytest.approx(surface.volume(), rel=1e-10)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 2e-4])
def test_mesh_keeps_its_sag(tolerance) -> None:
    """The middles of the edges of the sampled sphere and catenoid are no deeper below the surface than asked for."""
    for surface, depth in (
        (sphere_cap(4), lambda p: np.abs(2 - np.linalg.norm(p, axis=1))),
        (catenoid_patch(4), CatenoidPatch().distance),
    ):
        mesh = surface.mesh(tolerance)
        edges = np.unique(np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1), axis=0)
        sag = depth(mesh.points[edges].mean(1))
        size = np.linalg.norm(np.ptp(surface.nodes, axis=0))
        # the 99th part of the edges counts; curvature is taken in the middle of an element
        assert np.percentile(sag, 98) < tolerance * size
    counts = [len(sphere_cap(4).mesh(t).points) for t in (1e-2, 1e-3, 1e-4)]
    assert all(a < b for a, b in pairwise(counts))


@pytest.mark.parametrize("parts", [1, 2, 3, 5])
def test_subdivided_mesh_is_one_piece(parts) -> None:
    """Euler's number v - e + f is 1 of a disc and 0 of a tube, at any subdivision; no vertex is there twice."""
    for surface, euler in ((sphere_cap(3), 1), (catenoid_patch(3), 1), (whole_catenoid(3), 0)):
        mesh = surface.subdivided(parts)
        assert (mesh.faces[:, 2] == mesh.faces[:, 3]).all()
        edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
        unique, count = np.unique(edges, axis=0, return_counts=True)
        assert count.max() == 2
        assert len(mesh.points) - len(unique) + len(mesh.faces) == euler
        assert len(mesh.faces) == parts**2 * len(surface.connectivity.elements)
        assert (count == 1).sum() == parts * len(surface.connectivity.rim_elements)
        assert cKDTree(mesh.points).query(mesh.points, k=2)[0][:, 1].min() > 1e-4
        a, b, c = np.moveaxis(mesh.points[mesh.faces[:, :3]], 1, 0)
        assert (np.cross(b - a, c - a) * mesh.normals[mesh.faces[:, 0]]).sum(1).min() > 0
