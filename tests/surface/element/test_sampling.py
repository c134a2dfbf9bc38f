"""Meshes of curved elements: rims within their tolerance whatever the surface, and no T-junctions."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.base.arrays import Floats
from lamella.surface.element.surface import RIM_SHARE, ElementSurface
from lamella.surface.mesh import SurfaceMesh
from surface.element.exact_elements import catenoid_patch, on_map, sphere_cap, whole_catenoid


def flat_map(uv: Floats) -> Floats:
    """The unit disc in a tilted plane, from parameters of a hexagon: its straight edges become arcs."""
    radius = np.linalg.norm(uv, axis=-1, keepdims=True)
    turn = np.arctan2(uv[..., 1:], uv[..., :1])
    # distance to the hexagon's edge in this direction
    edge = np.cos(np.pi / 6) / np.cos((turn % (np.pi / 3)) - np.pi / 6)
    scaled = np.concatenate([np.cos(turn), np.sin(turn)], -1) * (radius / edge)
    return np.concatenate([4 * scaled, scaled[..., :1] * 2], -1)


def flat_disc(order: int = 4) -> ElementSurface:
    """Six triangles about the middle: as coarse as a flat surface may be."""
    turn = np.arange(6) * np.pi / 3
    hexagon = np.column_stack([np.cos(turn), np.sin(turn)])
    corners = np.stack([np.zeros((6, 2)), hexagon, np.roll(hexagon, -1, 0)], 1)
    faces = np.column_stack([np.full(6, 0), np.arange(6) + 1, (np.arange(6) + 1) % 6 + 1])
    return on_map(flat_map, corners, faces, order, 0.0)


def one_triangle(order: int = 4) -> ElementSurface:
    """A single element whose three edges all are rim."""
    corners = np.array([[[1.0, 0], [-0.5, 0.75**0.5], [-0.5, -(0.75**0.5)]]])

    def bulged(uv: Floats) -> Floats:
        factor = 1 + 0.3 * (1 - (uv**2).sum(-1, keepdims=True))
        return np.concatenate([uv * factor, 0 * uv[..., :1]], -1)

    return on_map(bulged, corners, np.array([[0, 1, 2]]), order, 0.0)


SURFACES = {"disc": flat_disc, "triangle": one_triangle, "cap": sphere_cap, "patch": catenoid_patch,
            "rings": whole_catenoid}  # fmt: skip


def edges_of(mesh: SurfaceMesh) -> set[tuple[int, int]]:
    triangles = mesh.faces[:, :3]
    half = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).tolist()
    edges = {(a, b) for a, b in half}
    assert len(edges) == len(half), "an edge is used twice in one direction"
    return edges


@pytest.mark.parametrize("kind", SURFACES)
@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_rims_keep_their_tolerance_and_meshes_have_no_t_junctions(kind: str, order: int, tolerance: float) -> None:
    """Meshes of curved elements: closed rims within the tolerance, each inner edge in two triangles."""
    surface = SURFACES[kind](order)
    mesh = surface.mesh(tolerance)
    edges = edges_of(mesh)
    rim = [(a, b) for a, b in edges if (b, a) not in edges]
    # one closed loop for each of the surface's, through vertices on the rim alone
    after = dict(rim)
    assert len(after) == len(rim)
    loops = 0
    while after:
        loops += 1
        here = next(iter(after))
        while here in after:
            here = after.pop(here)
    assert loops == len(np.unique(surface.rim_loop))
    # the rim itself, finely, against the chords
    t = np.linspace(0, 1, 200)
    corners = np.array([[0.0, 0], [1, 0], [0, 1]])
    connectivity = surface.connectivity
    begin, end = (corners[(connectivity.rim_edges + k) % 3] for k in (0, 1))
    local = begin[:, None] + t[:, None] * (end - begin)[:, None]
    basis = connectivity.basis.basis(local.reshape(-1, 2)).reshape(*local.shape[:2], -1)
    curve = np.matmul(basis, surface.nodes[connectivity.elements[connectivity.rim_elements]]).reshape(-1, 3)
    a, b = mesh.points[np.array(rim)].transpose(1, 0, 2)
    size = float(np.linalg.norm(np.ptp(surface.nodes, axis=0)))
    off = np.full(len(curve), np.inf)
    for p, q in zip(a, b, strict=True):
        share = np.clip((curve - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
        off = np.minimum(off, np.linalg.norm(curve - p - share[:, None] * (q - p), axis=1))
    assert off.max() <= 1.02 * RIM_SHARE * tolerance * size
    # faces look the way the surface does
    x, y, z = (mesh.points[mesh.faces[:, k]] for k in range(3))
    normals = np.cross(y - x, z - x)
    assert ((normals * mesh.normals[mesh.faces[:, 0]]).sum(1) > 0).all()


def test_the_area_of_a_flat_disc_of_six_elements() -> None:
    surface = flat_disc()
    areas = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        mesh = surface.mesh(tolerance)
        x, y, z = (mesh.points[mesh.faces[:, k]] for k in range(3))
        areas.append(np.linalg.norm(np.cross(y - x, z - x), axis=1).sum() / 2)
        # few vertices inside, where nothing bends
        assert len(mesh.points) < 20 + 4 / np.sqrt(tolerance)
    missing = 1 - np.array(areas) / surface.area()
    # sag t over the radius r leaves out 4 t / (3 r) of a disc's area
    np.testing.assert_array_less(missing, 2 * RIM_SHARE * np.array([1e-2, 1e-3, 1e-4]) * 4)
    assert missing[2] < missing[1] / 5 < missing[0] / 25


def test_without_a_wish_for_the_rim_nothing_is_split() -> None:
    surface = sphere_cap(3)
    mesh = surface.subdivided(3)
    assert len(mesh.faces) == 9 * len(surface.connectivity.elements)
