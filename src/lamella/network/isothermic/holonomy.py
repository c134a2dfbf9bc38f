"""What isothermic coordinates do once around a hole, and around a vertex of the cut."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.isothermic import Isothermic, Transition
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.rim import element_rims


class Holonomy(NamedTuple):
    """w comes back as sign w + shift (sqrt(m)) from once around a boundary loop."""

    loop: int
    sign: int
    shift: complex


def holonomies(iso: Isothermic) -> tuple[Holonomy, ...]:
    """Of every hole of the surface, by the pieces of the cut that end on its rim."""
    shifts = np.array([piece.shift for piece in iso.transitions], complex)
    return tuple(
        Holonomy(hole, sign, complex(factors @ shifts)) for hole, (sign, factors) in enumerate(around_holes(iso), 1)
    )


def around_holes(iso: Isothermic) -> list[tuple[int, Integers]]:
    """Once around each hole w comes back as sign w + factors (t,) . shifts."""
    mesh = iso.mesh
    rims = element_rims(mesh.connectivity, mesh.nodes, mesh.loop[mesh.connectivity.rim_nodes[:, 0]])
    result = []
    for hole in range(1, len(rims)):
        place = {int(v): float(t) for v, t in zip(rims[hole].vertices, rims[hole].starts, strict=True)}
        passed = []
        for number, piece in enumerate(iso.transitions):
            tips = tip_vertices(mesh, piece)
            for side, end in enumerate(piece.ends):
                if end == -1 - hole:
                    passed.append((place[tips[side]], number, side == 0))
        sign, factors = 1, np.zeros(len(iso.transitions), np.int64)
        for _, number, inwards in sorted(passed):
            # from before the piece to behind it: left to right where it leads away from the rim
            s = iso.transitions[number].sign
            factors = s * factors
            factors[number] += 1 if inwards else -s
            sign *= s
        result.append((sign, factors))
    return result


def tip_vertices(mesh: IntegrationMesh, piece: Transition) -> tuple[int, int]:
    """First and last vertex of a piece of the cut."""
    faces = mesh.connectivity.faces
    first = faces[piece.left[0], piece.left_edge[0]]
    last = faces[piece.left[-1], (piece.left_edge[-1] + 1) % 3]
    return int(first), int(last)


def vertex_relations(
    mesh: IntegrationMesh, pieces: tuple[Transition, ...], across: Integers, odd: Integers
) -> dict[int, Integers]:
    """For each ordinary vertex where pieces meet: whole factors (t,) whose sum with the shifts is 0."""
    tips = [tip_vertices(mesh, piece) for piece in pieces]
    ends: dict[int, list[tuple[int, bool]]] = {}
    for number, (first, last) in enumerate(tips):
        ends.setdefault(first, []).append((number, True))
        ends.setdefault(last, []).append((number, False))
    umbilics = set(odd.tolist())
    result = {}
    for vertex, meeting in ends.items():
        if vertex in umbilics or mesh.loop[vertex] >= 0 or len(meeting) < 2:
            continue
        sign, factors = around_vertex(mesh, pieces, across, vertex)
        if sign != 1:
            raise InputError(
                f"the principal directions of the surface are not told well enough for a net: near "
                f"({coordinates(mesh.nodes[vertex])}) m they turn differently on both sides",
                "round the corners of its boundary (a spline or an arc), or write a smaller tolerance",
                "surface",
            )
        result[vertex] = factors
    return result


def around_vertex(
    mesh: IntegrationMesh, pieces: tuple[Transition, ...], across: Integers, vertex: int
) -> tuple[int, Integers]:
    """Once around a vertex, counter-clockwise, w comes back as sign w + factors (t,) . shifts."""
    sign, factors = 1, np.zeros(len(pieces), np.int64)
    for number, leaves in _around(mesh.connectivity, across, vertex):
        s = pieces[number].sign
        # a piece that leaves the vertex is crossed from its right side to its left
        factors = s * factors
        factors[number] += -s if leaves else 1
        sign *= s
    return sign, factors


def fixed_point_factors(iso: Isothermic) -> Floats:
    """Where a net's lattice hangs is these factors (t,) times the shifts, sqrt(m); all 0 where any place will do.

    It is where the first umbilic of odd order is. Without one, but with loops on which w comes back as -w + c, it is
    the fixed point of the first piece of the cut that does so: loops of that kind have to agree with each other alone.
    """
    factors = np.zeros(len(iso.transitions))
    turning = [number for number, piece in enumerate(iso.transitions) if piece.sign < 0 and not piece.stub]
    if len(iso.odd):
        _, twice = around_vertex(iso.mesh, iso.transitions, iso.across, int(iso.odd[0]))
        factors += twice / 2
    elif turning:
        factors[turning[0]] = 0.5
    return factors


def _around(connectivity: Connectivity, across: Integers, vertex: int) -> list[tuple[int, bool]]:
    """Pieces crossed once around a vertex counter-clockwise, each with whether it leaves the vertex."""
    element, corner = (int(part[0]) for part in np.nonzero(connectivity.faces == vertex))
    first = element
    passed = []
    while True:
        # out of the triangle over the edge that ends in the vertex: counter-clockwise around it
        edge = (corner + 2) % 3
        through = int(across[element, edge])
        if through:
            # over a transition from its left to its right: the piece leads to the vertex
            passed.append((abs(through) - 1, through < 0))
        element, other = (
            int(connectivity.neighbours[element, edge]),
            int(connectivity.neighbour_edges[element, edge]),
        )
        corner = other
        if element == first:
            return passed
