"""Why a net closes or not, as it is seen while a boundary moves: misses at their places, cells between umbilics."""

from __future__ import annotations

from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.elements.element_network import joint_name
from lamella.network.elements.followed_net import FollowedNet
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.rounding import largest_part
from lamella.network.isothermic.between_umbilics import between_umbilics
from lamella.network.isothermic.isothermic import Isothermic, Transition
from lamella.network.isothermic.lattice_origin import lattice_origin
from lamella.surface.element.umbilics import Umbilics

# umbilics whose distances are told: of more, every pair is too many to read
UMBILICS_MAX = 6


class NetMisses:
    """Tells them of nets one after the other; what nets of one reference share is kept."""

    def __init__(self) -> None:
        self._kept: object = None
        self._factors: Floats = np.zeros((0, 0))

    def of(self, net: FollowedNet, names: tuple[str, ...]) -> dict[str, Any]:
        """The umbilics, the cells between each two of odd order, and the misses of a net; `names` are its loops'.

        Returns
        -------
        dict
            "umbilics": point and rays of each. "apart": of each pair the points, and the whole or broken numbers of
            A and B lamellas between them. "misses": what a joint lies between, its place, and how many cells it is
            off whole ones.
        """
        iso = net.coordinates
        pattern = net.request.pattern
        cells = IntegerGridMap.of(iso, lattice_origin(iso, net.step, pattern), net.step, pattern)
        return {
            "umbilics": umbilic_rows(net.umbilics),
            "apart": self._apart(net, cells),
            "misses": _misses(iso, cells, names),
        }

    def _apart(self, net: FollowedNet, cells: IntegerGridMap) -> list[dict[str, Any]]:
        iso = net.coordinates
        if not 2 <= len(iso.odd) <= UMBILICS_MAX:
            return []
        kept = net.reference.kept
        if self._kept is not kept:
            self._kept, self._factors = kept, between_umbilics(kept.iso)
        pairs = [(p, q) for p in range(len(iso.odd)) for q in range(p)]
        places = iso.mesh.nodes[iso.odd]
        shifts = np.array([piece.shift for piece in iso.transitions], complex)
        distances = cells.pattern.cells(self._factors @ shifts, cells.step)
        return [
            {"from": places[p].tolist(), "to": places[q].tolist(), "a": float(abs(d.imag)), "b": float(abs(d.real))}
            for (p, q), d in zip(pairs, distances, strict=True)
        ]


def umbilic_rows(umbilics: Umbilics) -> list[dict[str, Any]]:
    """Point and rays of each."""
    return [
        {"point": point, "rays": 2 * (order + 2)}
        for point, order in zip(umbilics.position.tolist(), umbilics.orders.tolist(), strict=True)
    ]


def _misses(iso: Isothermic, cells: IntegerGridMap, names: tuple[str, ...]) -> list[dict[str, Any]]:
    off = largest_part(cells.shifts - np.round(cells.shifts))
    return [
        {"between": joint_name(piece, iso.mesh, names), "place": _middle(iso, piece), "off": float(miss)}
        for piece, miss in zip(iso.transitions, off, strict=True)
        if not piece.stub
    ]


def _middle(iso: Isothermic, piece: Transition) -> list[float]:
    """The middle one of the edges of a piece of the cut."""
    at = len(piece.left) // 2
    element, edge = piece.left[at], piece.left_edge[at]
    ends = iso.mesh.connectivity.faces[element, [edge, (edge + 1) % 3]]
    middle: list[float] = iso.mesh.nodes[ends].mean(0).tolist()
    return middle
