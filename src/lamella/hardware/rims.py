"""Boundary loops of a surface as smooth pieces between corners: what edge beams follow.

Along a loop the surface lies to the left of the direction T, seen with the normal n up; m = T x n points outwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from lamella.base.arrays import Complexes, Floats
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Disc, Rectangle, Ring, Square
from lamella.surface.closed_forms.scherk import asymptotic_to_conformal
from lamella.surface.element.edge_basis import edge_values
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface

CORNER = 0.02
"""rad; a turn of a loop above this is a corner."""

EDGE_PARTS = 4
"""Samples an edge of an element."""

RING_SAMPLES = 256
"""Samples once around, or along a side, of a closed form."""


@dataclass(frozen=True, eq=False)
class RimPiece:
    """A smooth piece of a boundary loop, or a whole loop without corners.

    Attributes
    ----------
    loop : int
        Which loop it belongs to: 0 is the outer one, or the first.
    number : int
        Which piece of the loop, from 0 on.
    points, normals : (k, 3)
        Samples (m) and unit normals of the surface; where it is closed the first is repeated at the end.
    closed : bool
    """

    loop: int
    number: int
    points: Floats
    normals: Floats
    closed: bool

    @cached_property
    def _curves(self) -> tuple[CubicSpline, CubicSpline]:
        along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(self.points, axis=0), axis=1)))
        kind = "periodic" if self.closed else "not-a-knot"
        points, normals = self.points, self.normals
        if self.closed:
            points = np.concatenate([points[:-1], points[:1]])
            normals = np.concatenate([normals[:-1], normals[:1]])
        return CubicSpline(along, points, bc_type=kind), CubicSpline(along, normals, bc_type=kind)

    @property
    def length(self) -> float:
        """Of its chords, which it is parametrised by, m."""
        return float(self._curves[0].x[-1])

    def wrapped(self, along: Floats) -> Floats:
        """Parameters within the piece: modulo its length where it is closed."""
        return np.asarray(np.mod(along, self.length) if self.closed else np.clip(along, 0.0, self.length))

    def frames(self, along: Floats) -> RimFrames:
        """Frames at parameters (q,), m; beyond the ends of an open piece it goes on straight."""
        at = self.wrapped(along)
        curve, normal = self._curves
        point, ahead, up = curve(at), curve(at, 1), normal(at)
        ahead /= np.linalg.norm(ahead, axis=-1)[..., None]
        up -= np.einsum("...i,...i->...", up, ahead)[..., None] * ahead
        up /= np.linalg.norm(up, axis=-1)[..., None]
        if not self.closed:
            point = point + (along - at)[..., None] * ahead
        bend = curve(at, 2)
        bend -= np.einsum("...i,...i->...", bend, ahead)[..., None] * ahead
        return RimFrames(point, ahead, up, np.cross(ahead, up), bend)


@dataclass(frozen=True, eq=False)
class RimFrames:
    """Points (q, 3), m, unit vectors (q, 3) of a rim: forward, normal of the surface, outwards; its curvature, 1/m."""

    points: Floats
    ahead: Floats
    up: Floats
    out: Floats
    bend: Floats

    def beside(self, distance: float) -> Floats:
        """Points at a distance outwards, m, (q, 3)."""
        return np.asarray(self.points + distance * self.out)


def rim_pieces(surface: Surface[Any]) -> tuple[RimPiece, ...]:
    """The smooth pieces of all boundary loops, in order."""
    if isinstance(surface, ElementSurface):
        loops = _element_loops(surface)
    elif isinstance(surface, ClosedForm):
        loops = _closed_form_loops(surface)
    else:
        loops = []
    return tuple(piece for number, (points, normals) in enumerate(loops) for piece in _pieces(number, points, normals))


def _element_loops(surface: ElementSurface) -> list[tuple[Floats, Floats]]:
    """Samples of every loop, the first not repeated."""
    connectivity = surface.connectivity
    rim = connectivity.rim_nodes
    share = np.arange(EDGE_PARTS) / EDGE_PARTS
    values = edge_values(connectivity.basis.order, share)
    found = []
    for loop in range(int(surface.rim_loop.max(initial=-1)) + 1):
        edges = rim[surface.rim_loop == loop]
        after = {int(edge[0]): k for k, edge in enumerate(edges)}
        order = [0]
        while len(order) < len(edges):
            order.append(after[int(edges[order[-1], -1])])
        nodes = edges[order]
        points, normals = (
            np.matmul(values, field[nodes]).reshape(-1, 3) for field in (surface.nodes, surface.gauss_map)
        )
        found.append((points, normals / np.linalg.norm(normals, axis=1)[:, None]))
    return found


def _closed_form_loops(surface: ClosedForm) -> list[tuple[Floats, Floats]]:
    found = []
    for where in _outline_loops(surface):
        there = surface.at(where)
        found.append((there.position, there.normal))
    return found


def _outline_loops(surface: ClosedForm) -> list[Complexes]:
    """Parameters along the loops, the surface to their left, the first not repeated."""
    outline, share = surface.outline, np.arange(RING_SAMPLES) / RING_SAMPLES
    turn = 2 * np.pi * share
    if isinstance(outline, Ring):
        return [_complex(outline.end, turn), _complex(outline.start, -turn)]
    if isinstance(outline, Disc):
        return [outline.radius * np.exp(1j * turn)]
    if isinstance(outline, Rectangle):
        corner, width, height = outline.corner, outline.width, 1j * outline.height
        corners = [corner, corner + width, corner + width + height, corner + height]
    else:
        half = outline.half_side
        corners = [half * turned for turned in (-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j)]
    sides = [a + (b - a) * share for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    around = np.concatenate(sides)
    if isinstance(outline, Square):
        # X + i Y, see `lamella.surface.closed_forms.scherk`
        x, y = around.real, around.imag
        around = asymptotic_to_conformal(x - y) + 1j * asymptotic_to_conformal(x + y)
    return [around]


def _complex(u: float, v: Floats) -> Complexes:
    return np.asarray(u + 1j * v, np.complex128)


def _pieces(loop: int, points: Floats, normals: Floats) -> list[RimPiece]:
    """A loop cut at its corners."""
    ahead = np.roll(points, -1, axis=0) - points
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    cosine = np.clip(np.einsum("ij,ij->i", ahead, np.roll(ahead, 1, axis=0)), -1, 1)
    # a smooth curve turns as much at the samples beside this one
    turn = np.arccos(cosine)
    beside = np.maximum(np.roll(turn, 1), np.roll(turn, -1))
    corners = np.flatnonzero((turn > CORNER) & (turn > 3 * beside))
    if not len(corners):
        return [RimPiece(loop, 0, _closed(points), _closed(normals), True)]
    found = []
    for number, (begin, end) in enumerate(zip(corners, np.roll(corners, -1), strict=True)):
        index = np.arange(begin, end + 1 if end > begin else end + len(points) + 1) % len(points)
        found.append(RimPiece(loop, number, points[index], normals[index], False))
    return found


def _closed(values: Floats) -> Floats:
    return np.concatenate([values, values[:1]])
