"""From the triangles of a file to an oriented disc with holes, or a clear refusal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.base.message import Message
from lamella.base.vectors import diagonal
from lamella.base.wording import counted
from lamella.surface.from_mesh.cracks import NEAR_EDGE, close_t_junctions, near_border
from lamella.surface.from_mesh.edges import Edges, face_normals, find_edges
from lamella.surface.from_mesh.merge import drop_collapsed, drop_repeated, drop_unused, merge_vertices
from lamella.surface.from_mesh.orient import orient
from lamella.surface.from_mesh.raw_mesh import RawMesh, mesh_error, place
from lamella.surface.from_mesh.slivers import remove_slivers

FRAGMENT = 1e-3
"""Pieces below this part of the whole area are left over from modelling; they are dropped."""

NARROW_HOLE = 0.05
"""A hole narrower than this part of its own edges is a crack."""

MESH_ROUNDING = 1e-10
"""Of the mesh's size: vertices nearer to one another differ by rounding."""

SMALL_HOLE = 8
"""Holes with more vertices are judged by how near their sides come, for they need not be plane."""


@dataclass(frozen=True)
class CleanMesh:
    """A connected, oriented disc with holes.

    Attributes
    ----------
    points : (n, 3)
        m; every vertex is used.
    faces : (m, 3) int
        Triangles, counter-clockwise about the normal.
    borders : tuple of (k,) int
        Border loops as vertex indices, the longest (outer) one first, with the surface to the left.
    notes : tuple of Message
        What was mended, for the summary.
    """

    points: Floats
    faces: Integers
    borders: tuple[Integers, ...]
    notes: tuple[Message, ...]


def clean(raw: RawMesh) -> CleanMesh:
    """Mend what can be mended without guessing, refuse the rest.

    Mended, with a note: vertices at one place, seams and poles open by less than a tolerance (see `merge`), faces
    without area or given twice, slivers, T-junctions, fragments, faces turned against the others.

    Raises
    ------
    InputError
        Edges with three faces or more, several pieces, pieces that touch at a vertex, a surface with one side, without
        a border, with handles or with cracks; each with numbers and a place.
    """
    notes = list(raw.notes)
    merged = merge_vertices(raw.points, raw.faces)
    points, faces = merged.points, merged.faces
    # An .stl has no shared vertices: merging them there is reading, not mending.
    if merged.equal and len(raw.points) != 3 * len(raw.faces):
        notes.append(
            Message(
                "vertices_merged", f"{counted(merged.equal, 'vertex', 'vertices')} merged with others at the same place"
            )
        )
    if merged.welded:
        apart = merged.gap > MESH_ROUNDING * diagonal(points)
        notes.append(
            Message(
                "vertices_welded",
                f"{counted(merged.welded, 'border vertex', 'border vertices')} welded to others "
                + (f"up to {1000 * merged.gap:.2g} mm away" if apart else "a rounding away"),
            )
        )
    whole = drop_collapsed(faces)
    single = drop_repeated(whole)
    if len(whole) < len(faces):
        notes.append(Message("faces_collapsed", f"{counted(len(faces) - len(whole), 'face')} without area removed"))
    if len(single) < len(whole):
        notes.append(Message("faces_repeated", f"{counted(len(whole) - len(single), 'face')} given twice removed"))
    faces, removed, left = remove_slivers(points, single)
    if removed:
        notes.append(Message("slivers_removed", f"{counted(removed, 'sliver')} removed"))
    if left:
        notes.append(
            Message(
                "slivers_left", f"{counted(left, 'sliver')} left: without them the mesh would be connected differently"
            )
        )
    if not len(faces):
        raise mesh_error("the mesh has no faces with an area", "export it again")
    faces, closed = close_t_junctions(points, faces)
    if closed:
        notes.append(
            Message(
                "t_junctions_closed", f"{counted(closed, 'T-junction')} closed: faces split at vertices on their edges"
            )
        )
    edges = find_edges(faces)
    _require_two_faces_an_edge(points, edges)
    faces, dropped = _one_piece(points, faces, edges)
    if dropped:
        notes.append(dropped)
    points, faces = drop_unused(points, faces)
    edges = find_edges(faces)
    _require_one_fan_a_vertex(points, faces, edges)
    faces, note = orient(points, faces, edges)
    notes.append(note)
    edges = find_edges(faces)
    borders = _borders(points, faces, edges)
    _require_disc(points, faces, edges, len(borders))
    _require_no_crack(points, faces, edges, borders)
    return CleanMesh(points, faces, borders, tuple(notes))


def _require_two_faces_an_edge(points: Floats, edges: Edges) -> None:
    bad = np.flatnonzero(edges.count > 2)
    if len(bad):
        worst = bad[0]
        raise mesh_error(
            f"{counted(len(bad), 'edge')} with more than two faces; the first has {edges.count[worst]}, at "
            f"{place(points[edges.ends[worst]].mean(axis=0))} m",
            "remove the faces inside, or what touches the surface (in Rhino: ExtractNonManifoldMeshEdges)",
        )


def _one_piece(points: Floats, faces: Integers, edges: Edges) -> tuple[Integers, Message | None]:
    """Faces of the one large piece, and a note about fragments dropped."""
    one, two = (edges.inner_pairs // 3).T
    graph = coo_array((np.ones(len(one), dtype=np.int8), (one, two)), shape=(len(faces), len(faces)))
    count, label = connected_components(graph, directed=False)
    if count == 1:
        return faces, None
    areas = np.bincount(label, np.linalg.norm(face_normals(points, faces), axis=1) / 2, count)
    large = np.flatnonzero(areas >= FRAGMENT * areas.sum())
    if len(large) > 1:
        sizes = np.bincount(label, minlength=count)
        order = large[np.argsort(-areas[large], kind="stable")]
        listed = "; ".join(f"{areas[k]:.4g} m2 with {counted(int(sizes[k]), 'face')}" for k in order[:5])
        more = f"; and {len(large) - 5} more" if len(large) > 5 else ""
        raise mesh_error(
            f"the mesh has {len(large)} pieces that share no edge: {listed}{more}"
            + _gap(points, faces[label == order[0]], faces[label == order[1]]),
            "keep one of them; if they should be one surface, join them and weld their vertices",
        )
    share = 1 - float(areas[large[0]] / areas.sum())
    note = Message("fragments_dropped", f"{counted(count - 1, 'fragment')} dropped, together {share:.2g} of the area")
    return faces[label == large[0]], note


def _gap(points: Floats, one: Integers, other: Integers) -> str:
    """How near two pieces come to one another, and where."""
    here, there = np.unique(one), np.unique(other)
    distance, nearest = cKDTree(points[there]).query(points[here])
    k = int(np.argmin(distance))
    at = place((points[here[k]] + points[there[nearest[k]]]) / 2)
    return f". The two largest come within {1000 * distance[k]:.3g} mm of one another at {at} m"


def _require_one_fan_a_vertex(points: Floats, faces: Integers, edges: Edges) -> None:
    """Refuse vertices where two fans of faces touch (bow-ties)."""
    pairs = edges.inner_pairs
    start, end = pairs, pairs - pairs % 3 + (pairs + 1) % 3
    corners = faces.ravel()
    # Corners of neighbouring faces at the same vertex; start meets end when the two faces agree.
    agree = corners[start[:, 0]] != corners[start[:, 1]]
    other_start = np.where(agree, end[:, 1], start[:, 1])
    other_end = np.where(agree, start[:, 1], end[:, 1])
    rows, columns = np.concatenate((start[:, 0], end[:, 0])), np.concatenate((other_start, other_end))
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(len(corners), len(corners)))
    count, label = connected_components(graph, directed=False)
    vertex = np.empty(count, dtype=np.int64)
    vertex[label] = corners
    fans = np.bincount(vertex, minlength=len(points))
    bad = np.flatnonzero(fans > 1)
    if len(bad):
        raise mesh_error(
            f"at {counted(len(bad), 'vertex', 'vertices')} the mesh touches itself (faces meet at the vertex but not "
            f"at an edge); the first is at {place(points[bad[0]])} m",
            "fill the notch, weld the seam that is open beside it, or cut the parts apart there",
        )


def _borders(points: Floats, faces: Integers, edges: Edges) -> tuple[Integers, ...]:
    """Border loops with the surface to the left, the longest first."""
    halves = edges.halves[edges.first[edges.border]]
    start, end = faces[halves // 3, halves % 3], faces[halves // 3, (halves + 1) % 3]
    follower = dict(zip(start.tolist(), end.tolist(), strict=True))
    loops = []
    for first in np.sort(start).tolist():
        if first not in follower:
            continue
        loop = [first]
        while (after := follower.pop(loop[-1])) != first:
            loop.append(after)
        loops.append(np.array(loop, dtype=np.int64))
    lengths = [
        float(np.linalg.norm(np.diff(points[loop], axis=0, append=points[loop[:1]]), axis=1).sum()) for loop in loops
    ]
    return tuple(loops[k] for k in np.argsort(np.negative(lengths), kind="stable"))


def _require_disc(points: Floats, faces: Integers, edges: Edges, borders: int) -> None:
    euler = len(points) - len(edges.ends) + len(faces)
    handles = (2 - borders - euler) // 2
    figures = f"{len(points)} vertices - {len(edges.ends)} edges + {len(faces)} faces = {euler}"
    if not borders:
        shape = "like a sphere" if handles == 0 else f"with {handles} handle{'s' if handles > 1 else ''}"
        raise mesh_error(
            f"the mesh is closed ({shape}; {figures}): it has no border to hold the surface, and a sphere, the closed "
            "surface of constant mean curvature, has no net, for it curves alike in all directions",
            "cut the mesh open along the boundary of the structure",
        )
    if handles:
        raise mesh_error(
            f"the mesh has {handles} handle{'s' if handles > 1 else ''} ({figures}, with {borders} borders; a disc "
            f"with {borders - 1} holes has {2 - borders}): only discs with holes are covered",
            "cut the handles open, or remove what bridges the surface",
        )


def _require_no_crack(points: Floats, faces: Integers, edges: Edges, borders: tuple[Integers, ...]) -> None:
    """Refuse holes and notches so narrow that the mesh cannot mean them."""
    mend = "weld the two sides (in Rhino: Weld, MatchMeshEdge) or fill the hole"
    for loop in borders[1:]:
        at = points[loop]
        steps = np.linalg.norm(np.roll(at, -1, axis=0) - at, axis=1)
        centred = at - at.mean(axis=0)
        area = np.linalg.norm(np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)) / 2
        width = 2 * area / steps.sum()
        if len(loop) <= SMALL_HOLE and width < NARROW_HOLE * np.median(steps):
            raise mesh_error(
                f"the mesh has a crack of {steps.sum() / 2:.3g} m length and {1000 * width:.3g} mm mean width at "
                f"{place(at[0])} m",
                mend,
            )
        inner = np.isin(edges.ends, loop).any(axis=1) & ~edges.border
        around = float(np.median(edges.lengths(points)[inner])) if inner.any() else np.inf
        across = diagonal(at)
        if across < NEAR_EDGE * around:
            raise mesh_error(
                f"the mesh has a hole only {1000 * across:.3g} mm wide at {place(at[0])} m, between edges of "
                f"{1000 * around:.3g} mm",
                "fill the hole, or give it edges of its own size",
            )
    halves = edges.halves[edges.first[edges.border]]
    which, vertex, _, distance = near_border(points, faces, halves, NEAR_EDGE)
    start, end = faces[halves // 3, halves % 3], faces[halves // 3, (halves + 1) % 3]
    follower = np.zeros(len(points), dtype=np.int64)
    follower[start] = end
    # Next to its own corner the border may be as near as it likes: that is an angle, not a crack.
    apart = (follower[vertex] != start[which]) & (follower[end[which]] != vertex)
    # Where edges get short the border may come as near as these.
    steps = np.linalg.norm(points[end] - points[start], axis=1)
    local = np.full(len(points), np.inf)
    np.minimum.at(local, np.concatenate((start, end)), np.tile(steps, 2))
    apart &= distance < NEAR_EDGE * local[vertex]
    if apart.any():
        nearest = np.flatnonzero(apart)[np.argmin(distance[apart])]
        raise mesh_error(
            f"the border comes within {1000 * distance[nearest]:.3g} mm of itself at "
            f"{place(points[vertex[nearest]])} m, much less than its edges are long",
            mend,
        )
