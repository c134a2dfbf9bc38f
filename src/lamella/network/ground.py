"""What lines are traced on: a surface with flat charts, whether it is made of elements or known in closed form.

A place is an element with local coordinates (x, y). A chart goes on smoothly a little beyond its element, so that a
step may leave it and is handed on to the neighbour afterwards. A closed form is one element, its local coordinates
those of the parameter plane.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from lamella.surface.closed_form import ClosedForm
from lamella.surface.element.places import Places
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.rim import element_rims
from lamella.surface.element.surface import ElementSurface
from lamella.surface.outline import Disc, Rectangle
from lamella.surface.points import Complexes, Floats
from lamella.surface.scherk import Scherk, asymptotic_to_conformal

Integers = NDArray[np.int64]

# elements a step may pass, Newton's steps to a place seen from the next element, and what counts as outside of one
MOST_HOPS, NEWTON_STEPS, OUTSIDE = 8, 4, 1e-12
# of an element: a place farther outside, with no element beyond, was not settled
UNSETTLED = 1e-6
# parts of the longest way across a closed form's parameters in a step, and samples along either parameter
PARTS, SAMPLES = 60, 60
# difference of parameters along the rim, of the size
DELTA = 1e-6


class Look(NamedTuple):
    """What is seen at n places.

    Attributes
    ----------
    position, normal, e_u, e_v : (n, 3)
        m; orthonormal frame.
    mean : (n,)
        H, 1/m.
    deviator : (n,) complex
        See `lamella.surface.points.SurfacePoints`.
    to_local : (n, 2, 2)
        d(x, y) of components along e_u, e_v.
    """

    position: Floats
    normal: Floats
    e_u: Floats
    e_v: Floats
    mean: Floats
    deviator: Complexes
    to_local: Floats

    def take(self, some: NDArray[np.bool_]) -> Look:
        """Some of the places."""
        return Look(
            self.position[some],
            self.normal[some],
            self.e_u[some],
            self.e_v[some],
            self.mean[some],
            self.deviator[some],
            self.to_local[some],
        )


class RimPlaces(NamedTuple):
    """Where places on the rim are: the loop, a number that grows along it, the surface to its left, and its direction.

    Attributes
    ----------
    loop : (n,) int
    along : (n,)
    tangent : (n, 3)
    """

    loop: Integers
    along: Floats
    tangent: Floats


class Ground(Protocol):
    """A surface lines are traced on."""

    def look(self, where: Places) -> Look:
        """What is seen at n places; a little outside of their elements too."""

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        """H and deviator at n places from positions alone, 1/m, each (n,), in the frames of `look`."""

    def settle(self, where: Places) -> Places:
        """The same points of the surface, seen from the elements they are in."""

    def gap(self, where: Places) -> Floats:
        """Below 0 beyond the rim, above 0 inside, (n,)."""

    def reach(self, where: Places) -> Floats:
        """How far a step in local coordinates may go, (n,)."""

    def samples(self) -> tuple[Places, Floats]:
        """Places spread evenly, and the area each stands for, m^2."""

    def rim_places(self, where: Places) -> RimPlaces:
        """Places on the rim."""

    def rim_points(self, count: int) -> Places:
        """Places all around the loops of the rim, some `count` on each."""

    def hole(self, count: int) -> tuple[Places, float] | None:
        """Places at equal arcs around the first hole, and its length, m; None: there is no hole."""


class ElementGround:
    """A surface of elements.

    Parameters
    ----------
    surface : ElementSurface
    """

    # of an element
    _STEP = 0.35

    def __init__(self, surface: ElementSurface) -> None:
        self.surface = surface
        self._connectivity = surface.connectivity

    def look(self, where: Places) -> Look:
        there, mean, deviator = self.surface.shape_at(where)
        return Look(there.position, there.normal, there.e_u, there.e_v, mean, deviator, there.to_local)

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        there = self.surface.measured(where)
        return there.mean_curvature, there.deviator

    def reach(self, where: Places) -> Floats:
        return np.full(len(where), self._STEP)

    def settle(self, where: Places) -> Places:
        element, local = where.element.copy(), where.local.copy()
        neighbours, across = self._connectivity.neighbours, self._connectivity.neighbour_edges
        left = np.arange(len(where))
        for _ in range(MOST_HOPS):
            barycentric = _barycentric(local[left])
            # the edge opposite a corner begins at the next one
            beyond = neighbours[element[left][:, None], (np.arange(3) + 1) % 3]
            worst = np.where(beyond >= 0, barycentric, np.inf)
            corner = worst.argmin(1)
            rows = np.arange(len(left))
            out = worst[rows, corner] < -OUTSIDE
            left, corner, barycentric = left[out], corner[out], barycentric[out]
            if not len(left):
                break
            edge, rows = (corner + 1) % 3, np.arange(len(left))
            depth = barycentric[rows, corner]
            entered = np.zeros((len(left), 3))
            other = across[element[left], edge]
            # edges of two elements run in opposite directions
            entered[rows, other] = barycentric[rows, (edge + 1) % 3] + depth
            entered[rows, (other + 1) % 3] = barycentric[rows, edge] + depth
            entered[rows, (other + 2) % 3] = -depth
            goal = self.surface.frames(Places(element[left], local[left])).position
            element[left] = neighbours[element[left], edge]
            local[left] = self._nearest(goal, Places(element[left], entered[:, 1:]))
        return Places(element, local)

    def _nearest(self, goal: Floats, where: Places) -> Floats:
        """Local coordinates of the points of charts that are next to points (n, 3), from places nearby."""
        local = where.local
        for _ in range(NEWTON_STEPS):
            there = self.surface.frames(Places(where.element, local))
            off = goal - there.position
            across = np.stack([(off * there.e_u).sum(1), (off * there.e_v).sum(1)], 1)
            local = local + np.matmul(there.to_local, across[:, :, None])[:, :, 0]
        return local

    def gap(self, where: Places) -> Floats:
        barycentric = _barycentric(where.local)
        inner = self._connectivity.neighbours[where.element[:, None], (np.arange(3) + 1) % 3] >= 0
        settled = np.where(barycentric < -UNSETTLED, barycentric, 1.0)
        return np.asarray(np.where(inner, settled, barycentric).min(1))

    def samples(self) -> tuple[Places, Floats]:
        points, weights = triangle_rule(6)
        m = len(self._connectivity.faces)
        where = Places(np.repeat(np.arange(m), len(points)), np.tile(points, (m, 1)))
        determinant = np.linalg.det(self.surface.frames(where).to_local)
        return where, np.tile(weights, m) / determinant

    @cached_property
    def _rims(self) -> tuple[Integers, Floats, Floats, list[float]]:
        """Of every vertex its loop, its arc length along it and that of the edge from it, m; lengths of the loops."""
        count = int(self._connectivity.faces.max()) + 1
        loop, start, span = np.full(count, -1), np.zeros(count), np.zeros(count)
        lengths = []
        for number, rim in enumerate(element_rims(self._connectivity, self.surface.nodes, self.surface.rim_loop)):
            loop[rim.vertices] = number
            start[rim.vertices] = rim.starts * rim.length
            span[rim.vertices] = np.diff(np.append(rim.starts, 1.0)) * rim.length
            lengths.append(rim.length)
        return loop, start, span, lengths

    def rim_places(self, where: Places) -> RimPlaces:
        barycentric = _barycentric(where.local)
        beyond = self._connectivity.neighbours[where.element[:, None], (np.arange(3) + 1) % 3]
        edge = (np.where(beyond < 0, barycentric, np.inf).argmin(1) + 1) % 3
        along = _CORNERS[(edge + 1) % 3] - _CORNERS[edge]
        share = ((where.local - _CORNERS[edge]) * along).sum(1) / (along**2).sum(1)
        vertex = self._connectivity.faces[where.element, edge]
        loop, start, span, _ = self._rims
        basis = self._connectivity.basis
        _, first, second = basis.jet(self.surface.polynomials, where.element, where.local).transpose(0, 2, 1)
        tangent = along[:, :1] * first + along[:, 1:] * second
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        return RimPlaces(loop[vertex], start[vertex] + share * span[vertex], tangent)

    def _around(self, loop: int, count: int) -> Places:
        rim = element_rims(self._connectivity, self.surface.nodes, self.surface.rim_loop)[loop]
        return self.surface.closest(rim.at(np.arange(count) / count))[0]

    def rim_points(self, count: int) -> Places:
        loops = [self._around(loop, count) for loop in range(len(self._rims[3]))]
        return Places(np.concatenate([p.element for p in loops]), np.concatenate([p.local for p in loops]))

    def hole(self, count: int) -> tuple[Places, float] | None:
        lengths = self._rims[3]
        return (self._around(1, count), lengths[1]) if len(lengths) > 1 else None


_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def _barycentric(local: Floats) -> Floats:
    return np.column_stack([1 - local.sum(1), local])


class PlaneGround:
    """A closed form over a simply connected piece of its parameter plane.

    Parameters
    ----------
    surface : ClosedForm
        Helicoid, Enneper's or Scherk's surface.
    """

    def __init__(self, surface: ClosedForm) -> None:
        self.surface = surface
        places, _ = surface.places(SAMPLES, SAMPLES)
        self._middle = complex(places.real.min() + places.real.max(), places.imag.min() + places.imag.max()) / 2
        self._size = float(max(np.ptp(places.real), np.ptp(places.imag)))

    def look(self, where: Places) -> Look:
        zeta = _complex(where)
        at = self.surface.at(zeta)
        to_local = np.eye(2) / self.surface.metric(zeta)[:, None, None]
        return Look(at.position, at.normal, at.e_u, at.e_v, at.mean_curvature, at.deviator, to_local)

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        look = self.look(where)
        return look.mean, look.deviator

    def reach(self, where: Places) -> Floats:
        return np.full(len(where), self._size / PARTS)

    def settle(self, where: Places) -> Places:
        return where

    def gap(self, where: Places) -> Floats:
        return self._gap(_complex(where))

    def _gap(self, zeta: Complexes) -> Floats:
        outline = self.surface.outline
        if isinstance(outline, Rectangle):
            off = zeta - outline.corner
            return np.asarray(
                np.minimum.reduce([off.real, outline.width - off.real, off.imag, outline.height - off.imag])
            )
        if isinstance(outline, Disc):
            return np.asarray(outline.radius - np.abs(zeta))
        assert isinstance(self.surface, Scherk)
        limit = 2 * self.surface.outline.half_side
        most = float(asymptotic_to_conformal(np.array([limit]))[0])
        q, p = (np.arcsinh(self.surface.hyperbolic(np.clip(x, -most, most))[1]) for x in (zeta.real, zeta.imag))
        beyond = np.maximum(np.abs(zeta.real) - most, 0) + np.maximum(np.abs(zeta.imag) - most, 0)
        return np.asarray(limit - np.abs(p) - np.abs(q) - beyond)

    def samples(self) -> tuple[Places, Floats]:
        # cells of a grid over the parameters, by their middles
        side = self._size / (2 * SAMPLES)
        line = side * (np.arange(2 * SAMPLES) + 0.5 - SAMPLES)
        x, y = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
        zeta = self._middle + x + 1j * y
        zeta = zeta[self._gap(zeta) > 0]
        return _places(zeta), self.surface.metric(zeta) ** 2 * side**2

    def rim_places(self, where: Places) -> RimPlaces:
        # the outlines are convex about their middles, or as good as that (Scherk's)
        zeta = _complex(where)
        angle = np.angle(zeta - self._middle)
        ahead, behind = (self._on_rim(angle + sign * DELTA) for sign in (1, -1))
        tangent = self.surface.at(zeta).vector((ahead - behind) / np.abs(ahead - behind))
        return RimPlaces(np.zeros(len(zeta), np.int64), np.mod(angle + 1e-9, 2 * np.pi), tangent)

    def _on_rim(self, angle: Floats) -> Complexes:
        """Places of the rim at angles about the middle."""
        inside, outside = np.zeros(len(angle)), np.full(len(angle), self._size)
        for _ in range(60):
            middle = (inside + outside) / 2
            within = self._gap(self._middle + middle * np.exp(1j * angle)) > 0
            inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
        return np.asarray(self._middle + inside * np.exp(1j * angle))

    def rim_points(self, count: int) -> Places:
        return _places(self._on_rim(2 * np.pi * np.arange(count) / count))

    def hole(self, count: int) -> tuple[Places, float] | None:
        return None


def _complex(where: Places) -> Complexes:
    return np.asarray(where.local[:, 0] + 1j * where.local[:, 1])


def _places(zeta: Complexes) -> Places:
    return Places(np.zeros(len(zeta), np.int64), np.column_stack([zeta.real, zeta.imag]))
