"""Lamellas as chains through small flat triangles: which crosses which, before anything is placed exactly.

Every element is cut into small triangles on which chi is taken as linear. A level line then enters and leaves each of
them once, and a whole number of chi inside lies on one line of either family: the net's combinatorics follow without
tolerances. Exact places come afterwards, from Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.isothermic.isothermic import sectors
from lamella.network.network import A, B
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.lagrange import local_faces

# small triangles reach over at most this many cells; parts of an element's edge at least and at most
SMALL_TRIANGLE_CELLS, EDGE_PARTS_MIN, EDGE_PARTS_MAX = 0.4, 3, 24
# cells; values as near as this to a whole number are moved off it
NUDGE = 1e-9
# lines of a family go on where the shift is as near as this to a whole number of cells
WHOLE = 1e-6


@dataclass(frozen=True)
class SmallTriangles:
    """Elements cut into small triangles.

    Attributes
    ----------
    element : (t,) int
    corners : (t, 3) int
        Grid points, the same across edges that are not cut.
    local : (f, 3, 2)
        Local coordinates of the corners, the same in every element: its f small triangles follow each other.
    chi : (g,) complex
        At the grid points.
    singular : (g, 2) bool
        Grid points that are umbilics with a whole real part, and imaginary part, of chi: lamellas of B, and of A, end
        there.
    """

    element: Integers
    corners: Integers
    local: Floats
    chi: Complexes
    singular: Booleans
    cut_left: Integers
    cut_right: Integers
    cut_piece: Integers


@dataclass(frozen=True)
class SmallGrid:
    """The small triangles of elements that are cut in one way, whatever chi is on them.

    Attributes
    ----------
    parts : int
        Of an element's edge.
    local : (g, 2)
        Local coordinates of an element's grid points.
    point : (m, g) int
        Number of each, the same across edges that are not cut.
    piece : (c,) int
        Piece of the cut that each edge on it is of.
    left, right : (c, parts + 1) int
        Grid points along it on both sides.
    """

    parts: int
    local: Floats
    point: Integers
    piece: Integers
    left: Integers
    right: Integers

    @classmethod
    def of(cls, connectivity: Connectivity, cut: Booleans, across: Integers, parts: int) -> SmallGrid:
        """Of a mesh with cut edges (m, 3) and the transitions through them (m, 3)."""
        grid = connect(connectivity.faces, int(connectivity.faces.max()) + 1, parts)
        point = sectors(grid, cut)
        element, edge = np.nonzero(across > 0)
        neighbour, other = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
        return cls(
            parts,
            grid.basis.nodes,
            point,
            across[element, edge] - 1,
            point[element[:, None], grid.basis.edge_nodes[edge]],
            point[neighbour[:, None], grid.basis.edge_nodes[other][:, ::-1]],
        )


def parts_of(cells: IntegerGridMap, reach: float = SMALL_TRIANGLE_CELLS) -> int:
    """Into how many parts the edges of elements are cut for small triangles that reach over so many cells at most."""
    corner = cells.value[:, :3]
    span = np.abs(corner - np.roll(corner, 1, 1)).max()
    return int(np.clip(np.ceil(span / reach), EDGE_PARTS_MIN, EDGE_PARTS_MAX))


def small_triangles(
    cells: IntegerGridMap, cut: Booleans, umbilics: Integers, grid: SmallGrid | None = None
) -> SmallTriangles:
    """Cut the elements of a cell map.

    Parameters
    ----------
    cells : IntegerGridMap
    cut : (m, 3) bool
        Edges that are cut.
    umbilics : (z,) int
        Vertices that may be singular nodes.
    grid : SmallGrid, optional
        Of these elements; as small as the net's combinatorics want it when not given.
    """
    connectivity = cells.mesh.connectivity
    if grid is None:
        grid = SmallGrid.of(connectivity, cut, cells.across, parts_of(cells))
    local, point, parts = grid.local, grid.point, grid.parts
    values = cells.value @ connectivity.basis.basis(local).T
    for vertex in umbilics.tolist():
        _straighten(values, cells, local, vertex)
    chi = np.zeros(int(point.max()) + 1, complex)
    chi[point] = values
    # umbilics on the lattice have whole values; no other grid point may
    singular = np.zeros((len(chi), 2), bool)
    pair = np.stack([chi.real, chi.imag], 1)
    for vertex in umbilics.tolist():
        element, which = np.nonzero(connectivity.faces == vertex)
        at = np.unique(point[element, which])
        settled = (np.abs(pair[at] - np.round(pair[at])) < WHOLE).all(0)
        singular[at] = settled
        pair[at] = np.where(settled, np.round(pair[at]), pair[at])
    near = (np.abs(pair - np.round(pair)) < NUDGE) & ~singular
    pair += np.where(near, 3 * NUDGE, 0)
    # both sides of a cut alike to the last digit, where the net goes on across it
    for family, whole in enumerate((integer_transitions(cells, A), integer_transitions(cells, B))):
        column = 1 - family
        for number in np.flatnonzero(~np.isnan(whole)):
            mine = grid.piece == number
            target = grid.right[mine].ravel()
            wanted = cells.signs[number] * pair[grid.left[mine].ravel(), column] + whole[number]
            free = ~singular[target].any(1)
            pair[target[free], column] = wanted[free]
    faces = local_faces(parts)
    left, right = grid.left, grid.right
    return SmallTriangles(
        np.repeat(np.arange(len(connectivity.elements)), len(faces)),
        point[:, faces].reshape(-1, 3),
        local[faces],
        pair[:, 0] + 1j * pair[:, 1],
        singular,
        np.stack([left[:, :-1].ravel(), left[:, 1:].ravel()], 1),
        np.stack([right[:, :-1].ravel(), right[:, 1:].ravel()], 1),
        np.repeat(grid.piece, parts),
    )


def _straighten(values: Complexes, cells: IntegerGridMap, local: Floats, vertex: int) -> None:
    """Make chi at local coordinates (k, 2) linear along each ray from an umbilic within the elements around it.

    It goes like a power of the distance there that polynomials only follow up to their order, to an error that near the
    umbilic is more than its value. Which lines pass through a homogeneous function's zero is decided at its rim.
    """
    basis = cells.mesh.connectivity.basis
    corners = CORNERS
    far = 1 - np.column_stack([1 - local.sum(1), local])
    for element, which in np.argwhere(cells.mesh.connectivity.faces == vertex).tolist():
        share = far[:, which]
        beyond = corners[which] + (local - corners[which]) / np.where(share > 0, share, 1)[:, None]
        zero = cells.value[element, which]
        rise = np.where(share > 0, cells.value[element] @ basis.basis(beyond).T - zero, 0)
        # other lines pass these elements where they reach over a cell: their places count
        if max(np.abs(rise.real).max(), np.abs(rise.imag).max()) < 1:
            values[element] = zero + share * rise


def integer_transitions(cells: IntegerGridMap, family: int) -> Floats:
    """By how many lines of a family the transitions shift them, nan where these do not go on, (t,)."""
    shifts = cells.shifts.imag if family == A else cells.shifts.real
    near = np.round(shifts)
    return np.where(np.abs(shifts - near) < WHOLE, near, np.nan)
