"""Polylines of a quad mesh: straight on through its edges, and rings across its faces."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Integers
from lamella.base.errors import InputError
from lamella.projection.quad_mesh import QuadMesh


def polylines(mesh: QuadMesh) -> tuple[Integers, ...]:
    """Vertices of each polyline in order, (k,) each; a closed one ends where it begins.

    They go straight on at regular vertices (`QuadMesh.straight`) and end at singular ones and at the boundary. Each
    edge is in one of them. They are ordered by their first edge.
    """
    half = np.flatnonzero(mesh.straight >= 0)
    on = mesh.straight[half]
    # each edge with the edges that go on from it, at either end
    links: list[set[int]] = [set() for _ in range(len(mesh.edges))]
    for one, other in zip(mesh.edge_of[half].tolist(), mesh.edge_of[on].tolist(), strict=True):
        links[one].add(other)
        links[other].add(one)
    edges = mesh.edges.tolist()
    done = np.zeros(len(edges), bool)
    found = []
    ends = [e for e, linked in enumerate(links) if len(linked) < 2]
    for start in [*ends, *range(len(edges))]:
        if done[start]:
            continue
        chain, last = [start], -1
        done[start] = True
        while True:
            onwards = [e for e in links[chain[-1]] if e != last and not done[e]]
            if not onwards:
                break
            last = chain[-1]
            chain.append(onwards[0])
            done[chain[-1]] = True
        found.append((min(chain), np.array(_vertices([edges[e] for e in chain]), np.int64)))
    found.sort(key=lambda item: item[0])
    return tuple(vertices for _, vertices in found)


def _vertices(chain: list[list[int]]) -> list[int]:
    """Vertices along edges (a, b) that follow one another."""
    a, b = chain[0]
    if len(chain) > 1 and a in chain[1]:
        # two edges with both ends in common would be a polyline of two vertices: no mesh has that
        a, b = b, a
    along = [a, b]
    for one, other in chain[1:]:
        along.append(other if one == along[-1] else one)
    return along


def diagonal_ring(mesh: QuadMesh, vertex: int) -> Integers:
    """The closed ring through a vertex that runs from corner to opposite corner of faces, (k,).

    On a rotational net of lamellas these are the parallel circles.

    Raises
    ------
    InputError
        No such vertex, no ring through it that closes, or two.
    """
    count = len(mesh.vertices)
    if not 0 <= vertex < count:
        raise InputError(f"there is no vertex {vertex}", f"vertices are counted from 0 to {count - 1} as in the file")
    rings = []
    if vertex in mesh.inner:
        for half in mesh.spokes(np.array([vertex]))[0, :2].tolist():
            ring = _diagonal(mesh, half)
            if len(ring):
                rings.append(ring)
    if len(rings) != 1:
        ways = "no diagonal" if not rings else "both diagonals"
        raise InputError(
            f"{ways} of the faces through vertex {vertex} at {np.round(mesh.vertices[vertex], 4).tolist()} m "
            f"{'close' if rings else 'closes'} to a ring",
            "name a vertex inside on a ring, or all vertices of the ring in order, separated by commas",
        )
    return np.array(rings[0], np.int64)


def _diagonal(mesh: QuadMesh, half: int) -> list[int]:
    """Vertices from the tail of a half edge across its face and on; none if that does not close."""
    regular = set(mesh.inner.tolist())
    start = half
    ring: list[int] = []
    while len(ring) <= len(mesh.vertices):
        ring.append(int(mesh.tail[half]))
        half = int(mesh.next[mesh.next[half]])
        if int(mesh.tail[half]) not in regular:
            return []
        # two faces further round the corner reached
        for _ in range(2):
            half = int(mesh.twin[mesh.next[mesh.next[mesh.next[half]]]])
        if half == start:
            return ring
    return []
