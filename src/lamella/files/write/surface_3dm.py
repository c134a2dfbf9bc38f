"""surface.3dm: a surface of curved elements as NURBS patches, with its boundary curves, for Rhino.

A polynomial of order p on a triangle, taken along a bilinear quadrilateral inside it, is a polynomial of degree p in
each of the quadrilateral's two parameters. Cut at its centroid and at the midpoints of its edges, a curved triangle is
therefore three Bezier patches of degree p x p: the same surface to rounding, without a degenerate corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import comb
from pathlib import Path

import numpy as np
import rhino3dm

from lamella.base.arrays import Floats, Integers
from lamella.base.vectors import diagonal
from lamella.files.whole import write_whole
from lamella.files.write.nurbs_objects import nurbs_surface
from lamella.files.write.rhino_file import IN_METRES, Frame, RhinoFile
from lamella.files.write.surface_patches import MESH_TOLERANCE, MOST_PATCHES, patch_count
from lamella.files.write.text import require_finite
from lamella.surface.element.lagrange import lagrange, subdivision
from lamella.surface.element.surface import EDGE_PARTS_DRAWN_MAX, ElementSurface

PATCH_TOLERANCE = 1e-12
"""Distance of the patches from the surface, over its diagonal or its largest coordinate: rounding."""

SAG_PLACES = 6
"""Parts of the sides of the small triangles between which a mesh's distance from the surface is taken."""

COLOURS = {"surface": (170, 190, 210), "boundary": (60, 60, 60)}


def write_surface_3dm(
    path: Path, surface: ElementSurface, frame: Frame = IN_METRES, *, name: str, version: str
) -> None:
    """Write `surface_3dm_bytes`; OSError if it cannot be written whole."""
    # rhino3dm's own Write says nothing of a full disk.
    write_whole(path, surface_3dm_bytes(surface, frame, name=name, version=version))


def surface_3dm_bytes(surface: ElementSurface, frame: Frame = IN_METRES, *, name: str, version: str) -> bytes:
    """Return the Rhino model of a surface.

    Layer "surface" holds three patches an element, in one group, or one mesh above `MOST_PATCHES`; layer "boundary"
    one closed curve a boundary loop. Document text ``lamella\\...`` says which, how far from the surface at most
    (``tolerance_m``), H, project and version.

    Parameters
    ----------
    surface : ElementSurface
    frame : Frame
        The file's unit, and where in the drawing the surface is measured from.
    name, version : str
        Of the project and of the program.

    Returns
    -------
    bytes
        The same for the same input: ids of layers and objects come from project name, layer and object name.
    """
    require_finite(surface.nodes)
    model = _Model(name, version, surface, frame)
    count = patch_count(surface)
    if count <= MOST_PATCHES:
        model.add_patches()
    else:
        model.add_mesh(count)
    model.add_boundary()
    return model.rhino.encoded()


# --------------------------------------------------------------------------------------------------- geometry


def patches(surface: ElementSurface) -> Floats:
    """Control points of three Bezier patches an element.

    Returns
    -------
    (3 m, p + 1, p + 1, 3)
        m. Patch 3 e + c has its first corner at corner c of element e and the one opposite at the centroid; the first
        parameter runs towards the next corner, the second towards the one before, so that patches are counter-clockwise
        about the surface's normal.
    """
    p = surface.connectivity.basis.order
    middle = _middle(surface.nodes)
    corners = (surface.nodes - middle)[surface.connectivity.elements]
    return np.asarray(np.matmul(_patch_matrix(p), corners).reshape(-1, p + 1, p + 1, 3) + middle)


@dataclass(frozen=True)
class BoundaryCurve:
    """A closed curve of Bezier pieces of degree p, one an element edge, each beginning where the one before ends.

    Attributes
    ----------
    loop : int
        Number of the loop, from 0.
    degree : int
    breaks : (n + 1,)
        Parameters at which pieces begin and end: lengths along the edges' nodes, m.
    controls : (n p + 1, 3)
        m; the last is the first. The surface lies to the left.
    """

    loop: int
    degree: int
    breaks: Floats
    controls: Floats


def boundary_curves(surface: ElementSurface) -> list[BoundaryCurve]:
    """The boundary loops, in the order of `ElementSurface.rim_loop`."""
    p = surface.connectivity.basis.order
    rim = surface.connectivity.rim_nodes
    middle = _middle(surface.nodes)
    curves = []
    for edges in _chains(rim[:, 0], rim[:, -1], surface.rim_loop):
        nodes = (surface.nodes - middle)[rim[edges]]
        steps = np.linalg.norm(np.diff(nodes, axis=1), axis=2).sum(1)
        pieces = np.matmul(_edge_matrix(p), nodes) + middle
        controls = np.concatenate([pieces[:, :-1].reshape(-1, 3), pieces[:1, 0]])
        curves.append(BoundaryCurve(int(surface.rim_loop[edges[0]]), p, np.r_[0.0, np.cumsum(steps)], controls))
    return curves


def _middle(nodes: Floats) -> Floats:
    # surfaces far from the origin lose no digits in the products
    return np.asarray((nodes.min(0) + nodes.max(0)) / 2)


def _chains(start: Integers, end: Integers, loop: Integers) -> list[list[int]]:
    """Edges from vertex `start` to vertex `end` as closed chains, those of the first loop first."""
    after = dict(zip(start.tolist(), range(len(start)), strict=True))
    following = [after[vertex] for vertex in end.tolist()]
    chains: list[list[int]] = []
    left = np.ones(len(start), bool)
    for first in np.argsort(loop, kind="stable").tolist():
        if not left[first]:
            continue
        chain, edge = [first], following[first]
        while edge != first:
            chain.append(edge)
            edge = following[edge]
        left[chain] = False
        chains.append(chain)
    return chains


@lru_cache
def _edge_matrix(order: int) -> Floats:
    """Bezier control points (p + 1) of a curve by its values at equidistant parameters (p + 1)."""
    t = np.arange(order + 1) / order
    bernstein = np.stack([comb(order, k) * t**k * (1 - t) ** (order - k) for k in range(order + 1)], 1)
    return _clean(np.asarray(np.linalg.inv(bernstein)))


@lru_cache
def _patch_matrix(order: int) -> Floats:
    """Bezier control points (3 (p + 1)^2) of the three patches of an element by its nodes (k)."""
    corners = np.array([[0.0, 0], [1, 0], [0, 1]])
    s, t = np.meshgrid(*[np.arange(order + 1) / order] * 2, indexing="ij")
    bilinear = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], -1).reshape(-1, 4)
    to_controls = np.kron(_edge_matrix(order), _edge_matrix(order))
    matrices = []
    for c in range(3):
        here, onward, back = corners[c], corners[(c + 1) % 3], corners[(c + 2) % 3]
        quad = np.stack([here, (here + onward) / 2, corners.mean(0), (here + back) / 2])
        matrices.append(to_controls @ lagrange(order).basis(bilinear @ quad))
    return _clean(np.concatenate(matrices))


def _clean(matrix: Floats) -> Floats:
    """Zeros exactly zero, so that control points of a shared edge depend on that edge's nodes alone."""
    return np.where(np.abs(matrix) < 1e-13, 0.0, matrix)


def sag(surface: ElementSurface, parts: int) -> float:
    """Largest distance of the elements, each edge cut into `parts`, from the flat triangles, m.

    Taken at 28 places of every small triangle, between points of equal parameters.
    """
    basis = surface.connectivity.basis
    local, faces = subdivision(parts)
    x, y = lagrange(SAG_PLACES).nodes.T
    weights = np.stack([1 - x - y, x, y], 1)
    corners = (surface.nodes - _middle(surface.nodes))[surface.connectivity.elements]
    largest = 0.0
    for triangle in faces:
        off = basis.basis(weights @ local[triangle]) - weights @ basis.basis(local[triangle])
        largest = max(largest, float(np.linalg.norm(np.matmul(off, corners), axis=2).max()))
    return largest


# --------------------------------------------------------------------------------------------------- the file


class _Model:
    """A .3dm file being filled."""

    def __init__(self, name: str, version: str, surface: ElementSurface, frame: Frame) -> None:
        self.version, self.surface = version, surface
        self.diagonal = diagonal(surface.nodes)
        self.rhino = RhinoFile("surface.3dm", name, version, frame)
        self.file, self.origin = self.rhino.file, np.array(frame.origin)
        self.rhino.say(mean_curvature=repr(float(surface.mean_curvature)))
        self.rhino.add_layers(COLOURS)

    def add_patches(self) -> None:
        controls = patches(self.surface)
        p = controls.shape[1] - 1
        tolerance = PATCH_TOLERANCE * max(self.diagonal, float(np.abs(self.surface.nodes + self.origin).max()))
        self.rhino.say(
            tolerance_m=f"{tolerance:.1e}",
            surface=f"{len(controls)} Bezier patches of degree {p} x {p}, three to a curved triangle of the program: "
            "the program's surface itself, to rounding. They share their edges; _Join makes them one polysurface.",
        )
        group = rhino3dm.Group()
        group.Name = "surface"
        group.Id = self.rhino.identity("surface", "group")
        self.file.Groups.Add(group)
        # openNURBS leaves out the first and the last knot, which no basis function needs
        knots = np.repeat([0.0, 1.0], p)
        for k, net in enumerate(self.rhino.placed(controls)):
            attributes = self._attributes("surface", f"{k // 3}.{k % 3}")
            attributes.AddToGroup(0)
            self.file.Objects.AddSurface(nurbs_surface((p, p), (knots, knots), net), attributes)

    def add_mesh(self, count: int) -> None:
        parts, reached = 0, np.inf
        while reached > MESH_TOLERANCE * self.diagonal and parts < EDGE_PARTS_DRAWN_MAX:
            parts += 1
            reached = sag(self.surface, parts)
        # two digits, and the places between those looked at, rounded up
        tolerance = f"{1.07 * reached:.1e}"
        self.rhino.say(
            tolerance_m=tolerance,
            surface=f"one mesh, within {tolerance} m of the program's surface: as NURBS it would be {count} patches, "
            f"more than {MOST_PATCHES}. The boundary curves are exact.",
        )
        attributes = self._attributes("surface", "surface", tolerance_m=tolerance)
        self.rhino.add_mesh(self.surface.subdivided(parts), attributes)

    def add_boundary(self) -> None:
        for number, curve in enumerate(boundary_curves(self.surface), 1):
            attributes = self._attributes("boundary", f"boundary {number}", loop=str(curve.loop + 1))
            knots = np.repeat(curve.breaks, curve.degree)
            self.rhino.add_curve(curve.degree, knots, curve.controls, attributes)

    def _attributes(self, layer: str, name: str, **text: str) -> rhino3dm.ObjectAttributes:
        shared = {"mean_curvature": repr(float(self.surface.mean_curvature)), "version": self.version} if text else {}
        return self.rhino.attributes(layer, name, **(text | shared))
