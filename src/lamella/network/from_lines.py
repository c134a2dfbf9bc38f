"""The network of given centre lines: of those of a file, say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import lengths
from lamella.network.network import Network
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.network.turning import derivative
from lamella.network.written_lines import written_darboux
from lamella.surface.darboux import Darboux


class CentreLine(NamedTuple):
    """A lamella by its points.

    `points`, `normals` (k, 3): samples, m, and the surface's unit normals there; `nodes`, `node_samples` (q,): its
    nodes and at which samples they are; `node_arclengths` (q,): from its start, m; `closed`: the first sample and node
    are repeated at the end.
    """

    id: str
    family: str
    closed: bool
    points: Floats
    normals: Floats
    nodes: Integers
    node_samples: Integers
    node_arclengths: Floats


def network_of_lines(
    lines: Sequence[CentreLine],
    *,
    node_points: Floats,
    node_normals: Floats,
    node_kinds: Integers,
    faces: Sequence[Sequence[int]],
    mean_curvature: float,
    pattern: Pattern = LAMELLAS,
) -> Network:
    """The network of centre lines, with the curvatures that their points and normals have.

    Parameters
    ----------
    lines : sequence of CentreLine
    node_points, node_normals : (n, 3)
        m, unit normals.
    node_kinds : (n,) int
    faces : sequence of lists of int
        Nodes, counter-clockwise about the normal.
    mean_curvature : float
        H of the surface, 1/m.
    pattern : Pattern

    Returns
    -------
    Network
        Tangents and Darboux curvatures by polynomials through neighbouring samples (`lamella.network.written_lines`);
        the places on the surface and the step of its lattice are not known: `sample_where` counts samples, `step` is
        NaN, `cells` the number of A lamellas.
    """
    counts = np.array([len(line.points) for line in lines])
    offsets = np.r_[0, np.cumsum(counts)]
    stop_offsets = np.r_[0, np.cumsum([len(line.nodes) for line in lines])]
    points = np.concatenate([line.points for line in lines])
    nothing = np.zeros(len(points))
    closed: Booleans = np.array([line.closed for line in lines], bool)
    arclengths = np.concatenate([_arclengths(line) for line in lines])
    families = np.array([line.family for line in lines])
    bare = Network(
        mean_curvature=mean_curvature,
        step=float("nan"),
        cells=int((families == "A").sum()),
        periods=(),
        left_out=0,
        node_points=node_points,
        node_normals=node_normals,
        node_kinds=node_kinds,
        ids=tuple(line.id for line in lines),
        families=families,
        closed=closed,
        sample_offsets=offsets,
        sample_points=points,
        sample_normals=np.concatenate([line.normals for line in lines]),
        sample_tangents=np.zeros_like(points),
        sample_darboux=Darboux(nothing, nothing, nothing),
        sample_mean_curvature=nothing + mean_curvature,
        sample_slopes=nothing,
        sample_where=np.arange(len(points)),
        sample_arclengths=arclengths,
        stop_offsets=stop_offsets,
        stop_nodes=np.concatenate([line.nodes for line in lines]),
        stop_samples=np.concatenate([line.node_samples for line in lines]),
        stop_arclengths=np.concatenate([line.node_arclengths for line in lines]),
        face_offsets=np.r_[0, np.cumsum([len(face) for face in faces], dtype=np.int64)],
        face_nodes=np.array([node for face in faces for node in face], np.int64),
        faces_left_out=np.zeros(0, np.int64),
        pattern=pattern,
    )
    tangents, there = written_darboux(bare)
    slopes = derivative(there.tg[:, None], arclengths, offsets, closed)[:, 0]
    return replace(
        bare,
        sample_tangents=tangents,
        sample_darboux=there,
        sample_slopes=slopes + 2 * there.kg * (there.kn - mean_curvature),
    )


def _arclengths(line: CentreLine) -> Floats:
    """Arc lengths of the samples, m: those of the nodes are given, between them chords share them out."""
    chords = np.r_[0.0, np.cumsum(lengths(np.diff(line.points, axis=0)))]
    return np.asarray(np.interp(chords, chords[line.node_samples], line.node_arclengths))
