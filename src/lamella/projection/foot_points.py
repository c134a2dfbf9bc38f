"""Foot points on surfaces, in bulk: closed forms, surfaces of curved elements, triangle meshes."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.errors import InputError
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.connectivity import connect
from lamella.surface.element.surface import ElementSurface
from lamella.surface.points import SurfacePoints

# places along each parameter among which the search on a closed form starts; Newton's steps
GRID_SAMPLES, FOOT_STEPS_MAX, FOOT_TOLERANCE = 120, 30, 1e-14


class Foot(NamedTuple):
    """Foot points and the unit normals there, (n, 3) each."""

    position: Floats
    normal: Floats


class FootSurface(Protocol):
    """A surface that finds the foot points of points nearby."""

    def foot(self, points: Floats) -> Foot:
        """Foot points of (n, 3)."""


class DirectedSurface(FootSurface, Protocol):
    """One that knows its principal directions too."""

    def principal_directions(self, points: Floats) -> tuple[Floats, Floats]:
        """Unit d1 and d2 at the foot points of (n, 3)."""


def foot_surface(surface: ClosedForm | ElementSurface) -> DirectedSurface:
    """Foot points on a surface of ours.

    Examples
    --------
    >>> import lamella
    >>> foot = lamella.foot_surface(lamella.Cylinder(2.0, (0.0, 3.0))).foot([[4.0, 0.0, 1.0]])
    >>> foot.position.round(6) + 0.0
    array([[2., 0., 1.]])
    """
    return ElementFeet(surface) if isinstance(surface, ElementSurface) else ClosedFormFeet(surface)


class ElementFeet:
    """Foot points on a surface of curved elements, with its own search."""

    def __init__(self, surface: ElementSurface) -> None:
        self._surface = surface

    def foot(self, points: Floats) -> Foot:
        at = self._surface.at(self._surface.closest(points)[0])
        return Foot(at.position, at.normal)

    def principal_directions(self, points: Floats) -> tuple[Floats, Floats]:
        return self._surface.at(self._surface.closest(points)[0]).principal_directions


class ClosedFormFeet:
    """Foot points on a closed form, by Newton's method in its parameters from the nearest of a grid of samples.

    The form goes on beyond its outline, so vertices at the rim have foot points too.
    """

    def __init__(self, surface: ClosedForm) -> None:
        self._surface = surface

    @cached_property
    def _samples(self) -> tuple[Complexes, cKDTree]:
        where = self._surface.places(GRID_SAMPLES, GRID_SAMPLES)[0]
        return where, cKDTree(self._surface.at(where).position)

    def _at_feet(self, points: Floats) -> SurfacePoints:
        samples, tree = self._samples
        where = samples[tree.query(points)[1]]
        for _ in range(FOOT_STEPS_MAX):
            at = self._surface.at(where)
            off = points - at.position
            # (I - s S) dt is the change of the tangential miss, s the signed distance and S the shape operator
            residual, s = at.components(off), (off * at.normal).sum(1)
            a, b = 1 - s * at.mean_curvature, s * at.deviator
            determinant = a**2 - np.abs(b) ** 2
            sound = determinant > 0.04
            step = np.where(sound, (a * residual + np.conj(b * residual)) / np.where(sound, determinant, 1), residual)
            change = step / self._surface.metric(where)
            where = where + change / np.maximum(1, np.abs(change) / 0.3)
            if np.abs(change).max(initial=0) < FOOT_TOLERANCE:
                break
        return self._surface.at(where)

    def foot(self, points: Floats) -> Foot:
        at = self._at_feet(points)
        return Foot(at.position, at.normal)

    def principal_directions(self, points: Floats) -> tuple[Floats, Floats]:
        return self._at_feet(points).principal_directions


class MeshFeet:
    """Foot points on a triangle mesh, normals interpolated between its vertices.

    Parameters
    ----------
    vertices : (n, 3)
        m.
    triangles : (t, 3) int
        Consistently oriented.
    """

    def __init__(self, vertices: Floats, triangles: Integers) -> None:
        points, faces = np.asarray(vertices, np.float64), np.asarray(triangles, np.int64)
        if faces.ndim != 2 or faces.shape[1] != 3 or not len(faces):
            raise InputError(f"triangles have shape {faces.shape}", "at least one triangle is expected, (t, 3)")
        corners = points[faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat = np.flatnonzero(~(np.linalg.norm(across, axis=1) > 0))
        if len(flat):
            raise InputError(f"triangle {flat[0]} has no area", "remove flattened triangles")
        normals = np.stack([np.bincount(faces.ravel(), np.repeat(c, 3), len(points)) for c in across.T], 1)
        self._faces, self._normals = faces, normals
        self._search = ClosestPoint(connect(faces, len(points), 1), points)

    def foot(self, points: Floats) -> Foot:
        places, position = self._search(points)
        a, b = places.local.T
        normal = np.einsum("nk,nkc->nc", np.stack([1 - a - b, a, b], 1), self._normals[self._faces[places.element]])
        return Foot(position, normal / np.linalg.norm(normal, axis=1, keepdims=True))
