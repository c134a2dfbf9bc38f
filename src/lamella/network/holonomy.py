"""What isothermic coordinates do once around a hole."""

from __future__ import annotations

from typing import NamedTuple

from lamella.network.isothermic import Isothermic, Transition
from lamella.network.net_mesh import NetMesh
from lamella.surface.element.rim import element_rims


class Holonomy(NamedTuple):
    """w comes back as sign w + shift (sqrt(m)) from once around a boundary loop."""

    loop: int
    sign: int
    shift: complex


def holonomies(iso: Isothermic) -> tuple[Holonomy, ...]:
    """Of every hole of the surface, by the pieces of the cut that end on its rim."""
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
        sign, shift = 1, 0j
        for _, number, inwards in sorted(passed):
            s, c = iso.transitions[number].sign, iso.transitions[number].shift
            # from before the piece to behind it: left to right where it leads away from the rim
            sign, shift = (s * sign, s * shift + c) if inwards else (s * sign, s * (shift - c))
        result.append(Holonomy(hole, sign, shift))
    return tuple(result)


def tip_vertices(mesh: NetMesh, piece: Transition) -> tuple[int, int]:
    """First and last vertex of a piece of the cut."""
    faces = mesh.connectivity.faces
    first = faces[piece.left[0], piece.left_edge[0]]
    last = faces[piece.left[-1], (piece.left_edge[-1] + 1) % 3]
    return int(first), int(last)


def crossed(shift: complex) -> tuple[float, float]:
    """|u + v| and |u - v| of a period: over l0 the A and the B lamellas that are crossed."""
    return abs(shift.real + shift.imag), abs(shift.real - shift.imag)
