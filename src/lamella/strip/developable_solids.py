"""Developable strips as they stand: closed solids of all layers, between the rulings of their samples.

The strip's own normal is u all along a ruling, so that a layer at the distance d has the same rulings, moved by d u: it
is the parallel surface of a developable one, and developable too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.strip.developable_strips import DevelopableStrips, rulings
from lamella.strip.lamellas import Lamellas


@dataclass(frozen=True, eq=False)
class DevelopableSolid:
    """A piece of a layer along which the strip exists.

    Attributes
    ----------
    lamella, layer, piece : int
        The layer counted from the right one, the piece along the lamella, from 0 on.
    samples : (n,) int
        Of the network.
    vertices : (4 n, 3)
        Of each sample: lower and upper edge of the right face, then of the left one, m.
    triangles : (f, 3) int
        Counter-clockwise seen from outside.
    """

    lamella: int
    layer: int
    piece: int
    samples: Integers
    vertices: Floats
    triangles: Integers


def developable_solids(lamellas: Lamellas, strips: DevelopableStrips) -> Iterator[DevelopableSolid]:
    """The solids of all layers, where developable strips exist.

    Parameters
    ----------
    lamellas : Lamellas
    strips : DevelopableStrips
        Of their net.
    """
    network, section = lamellas.network, lamellas.section
    ruling = section.height / 2 * rulings(network, strips.slopes)
    aside = np.cross(network.sample_normals, network.sample_tangents)
    for lamella, (begin, end) in enumerate(zip(network.sample_offsets[:-1], network.sample_offsets[1:], strict=True)):
        runs = _runs(strips.exists[begin:end])
        for piece, (first, last) in enumerate(runs):
            some = np.arange(begin + first, begin + last)
            for layer, distance in enumerate(section.layer_offsets.tolist()):
                faces = [distance + side * section.thickness / 2 for side in (-1, 1)]
                corners = [
                    network.sample_points[some] + face * aside[some] + way * ruling[some]
                    for face in faces
                    for way in (-1, 1)
                ]
                vertices = np.stack(corners, axis=1).reshape(-1, 3)
                yield DevelopableSolid(lamella, layer, piece, some, vertices, _triangles(len(some)))


def _runs(there: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """First and one after the last of all runs of two samples or more."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], there.astype(np.int64), [0]])))
    return [(a, b) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]


def _triangles(samples: int) -> Integers:
    """Of a prism through samples of four corners: right lower 0, right upper 1, left lower 2, left upper 3."""
    around = ((0, 1), (1, 3), (3, 2), (2, 0))
    at = 4 * np.arange(samples - 1)
    sides = [
        np.stack([np.stack([at + a, at + 4 + a, at + 4 + b], 1), np.stack([at + a, at + 4 + b, at + b], 1)], 1)
        for a, b in around
    ]
    last = 4 * (samples - 1)
    ends = np.array([(0, 1, 3), (0, 3, 2), (last, last + 3, last + 1), (last, last + 2, last + 3)])
    return np.concatenate([np.concatenate(sides).reshape(-1, 3), ends])
