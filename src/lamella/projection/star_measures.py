"""How good a net is, measured on its vertices alone: spheres through stars, angles between polylines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.unknowns import dot


@dataclass(frozen=True)
class StarSpheres:
    """Best spheres or planes of stars.

    Attributes
    ----------
    deviation : (s,)
        Root mean square distance of a vertex and its neighbours from the best sphere, m.
    planarity : (s,)
        The same from the best plane, m.
    curvature : (s,)
        1 / r of the best sphere, 1/m, positive where its centre is on the side from which faces are
        counter-clockwise.
    """

    deviation: Floats
    planarity: Floats
    curvature: Floats


def star_spheres(mesh: QuadMesh, vertices: Integers) -> StarSpheres:
    """Best spheres of regular inner vertices with their four neighbours.

    A sphere is the zero set of f = a |x|^2 + b . x + c; with |b|^2 - 4 a c = 1 (Pratt 1987) f is the distance from it
    to first order, also where it is a plane (a = 0).
    """
    stars = mesh.stars(vertices)
    v = mesh.vertices[np.column_stack([vertices, stars])]
    size = np.linalg.norm(v[:, 1:] - v[:, :1], axis=2).mean(1)[:, None, None]
    d = (v - v.mean(1, keepdims=True)) / size
    rows = np.concatenate([(d * d).sum(2, keepdims=True), d, np.ones((*d.shape[:2], 1))], 2)
    a, b, c = _split(np.linalg.svd(rows)[2][:, -1])
    norm = np.sqrt(np.abs((b * b).sum(1) - 4 * a * c))
    value = np.einsum("spk,sk->sp", rows, np.column_stack([a, b, c])) / norm[:, None]
    flat = np.linalg.svd(d, compute_uv=False)[:, -1] / np.sqrt(d.shape[1])
    across = np.cross(d[:, 1] - d[:, 3], d[:, 2] - d[:, 4])
    # f grows away from the centre where a > 0
    inwards = -np.sign((b * across).sum(1))
    curvature = 2 * a / norm * np.where(inwards == 0, 1.0, inwards) / size[:, 0, 0]
    return StarSpheres(np.sqrt((value**2).mean(1)) * size[:, 0, 0], flat * size[:, 0, 0], curvature)


def _split(vectors: Floats) -> tuple[Floats, Floats, Floats]:
    return vectors[:, 0], vectors[:, 1:4], vectors[:, 4]


def circle_angles(mesh: QuadMesh, vertices: Integers) -> Floats:
    """Angles between the two polylines at regular inner vertices, degrees, (s,), 0 to 180.

    Measured between the tangents of the circles through the previous, the own and the next vertex: the angle at which
    the discrete osculating circles of paper section 2.1 cross.
    """
    v1, v2, v3, v4 = mesh.vertices[mesh.stars(vertices)].swapaxes(0, 1)
    own = mesh.vertices[vertices]
    first, second = _circle_tangent(v3, own, v1), _circle_tangent(v4, own, v2)
    return np.asarray(np.degrees(np.arctan2(np.linalg.norm(np.cross(first, second), axis=1), dot(first, second)[:, 0])))


def _circle_tangent(before: Floats, own: Floats, after: Floats) -> Floats:
    """Direction of the circle through three points at the middle one."""
    a, b = before - own, after - own
    return b * dot(a, a) - a * dot(b, b)


def chord_angles(mesh: QuadMesh, vertices: Integers) -> Floats:
    """Angles between the chords of opposite neighbours, degrees, (s,): the condition of `RightAngle`."""
    v1, v2, v3, v4 = mesh.vertices[mesh.stars(vertices)].swapaxes(0, 1)
    p, q = v1 - v3, v2 - v4
    return np.asarray(np.degrees(np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), dot(p, q)[:, 0])))


def face_angles(mesh: QuadMesh, faces: Integers) -> Floats:
    """Angles between the lines joining the middles of opposite sides, degrees, (f,): that of `EqualDiagonals`."""
    v1, v2, v3, v4 = mesh.vertices[mesh.faces[faces]].swapaxes(0, 1)
    p, q = v2 + v3 - v1 - v4, v3 + v4 - v1 - v2
    return np.asarray(np.degrees(np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), dot(p, q)[:, 0])))
