"""The network of sampled curves: nodes, numbers and faces are found here, whichever algorithm traced the curves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.faces import Faces, trace_faces
from lamella.network.network import FAMILIES, Network, Period
from lamella.network.pattern import Pattern
from lamella.network.sampling import Division
from lamella.surface.darboux import Darboux


@dataclass(frozen=True)
class Curves:
    """Curves of a net with their stops, one curve after the other; between two stops of a curve lies one piece of it.

    Attributes
    ----------
    families : (m,) int
        `lamella.network.network.A` or `B` of each curve.
    closed : (m,) bool
    owner : (q,) int
        Curve of each stop.
    nodes : (q,) int
        Node of each stop.
    kinds : (n,) int
        Kind of each node, see `lamella.network.network.NODE_KINDS`.
    """

    families: Integers
    closed: Booleans
    owner: Integers
    nodes: Integers
    kinds: Integers

    @cached_property
    def first_stops(self) -> Integers:
        """The stop each piece begins with, (s,); it ends with the next one."""
        return np.flatnonzero(self.owner[1:] == self.owner[:-1])

    @cached_property
    def stop_offsets(self) -> Integers:
        """Where each curve's stops begin, (m + 1,)."""
        return np.asarray(np.r_[0, np.cumsum(np.bincount(self.owner, minlength=len(self.families)))], np.int64)

    @property
    def ids(self) -> tuple[str, ...]:
        """A1, A2, ... and B1, B2, ... in order."""
        is_a = self.families == 0
        rank = np.where(is_a, np.cumsum(is_a), np.cumsum(~is_a))
        return tuple(f"{FAMILIES[f]}{r}" for f, r in zip(self.families.tolist(), rank.tolist(), strict=True))


@dataclass(frozen=True)
class SampledCurves:
    """Where the stops and nodes of curves lie among the samples."""

    curves: Curves
    division: Division

    @cached_property
    def offsets(self) -> Integers:
        """Where each curve's samples begin, (m + 1,)."""
        curves = self.curves
        owner = curves.owner[curves.first_stops]
        counts = np.bincount(owner, self.division.given, minlength=len(curves.families)).astype(np.int64)
        return np.asarray(np.r_[0, np.cumsum(counts)], np.int64)

    @cached_property
    def stop_samples(self) -> Integers:
        """Sample of each stop, (q,)."""
        first, division = self.curves.first_stops, self.division
        sample = np.empty(len(self.curves.nodes), np.int64)
        sample[first] = division.starts
        sample[first[division.last] + 1] = (division.starts + division.counts)[division.last]
        return sample

    @cached_property
    def node_samples(self) -> Integers:
        """A sample at each node, (n,): the first one of those that stop there."""
        sample = np.empty(len(self.curves.kinds), np.int64)
        sample[self.curves.nodes[::-1]] = self.stop_samples[::-1]
        return sample

    def faces(self, normals: Floats, tangents: Floats, rim: RimNodes) -> Faces:
        """Faces of the net, from normals and tangents (k, 3) at the samples."""
        first = self.curves.first_stops
        starts, ends = self.stop_samples[first], self.stop_samples[first + 1]
        tails, heads = self.curves.nodes[first], self.curves.nodes[first + 1]
        return trace_faces(
            normals[self.node_samples],
            np.r_[tails, heads],
            np.r_[heads, tails],
            # forward from the start, backward from the end
            np.vstack([tangents[starts], -tangents[ends]]),
            rim.loops,
            rim.directions,
            seam=rim.seam,
        )


@dataclass(frozen=True)
class CurveSamples:
    """What is known at the samples, see `Network` for units and signs.

    Attributes
    ----------
    points, normals, tangents : (k, 3)
    darboux : Darboux
    mean_curvature, slopes, arclengths : (k,)
    where : (k,) or (k, d)
    """

    points: Floats
    normals: Floats
    tangents: Floats
    darboux: Darboux
    mean_curvature: Floats
    slopes: Floats
    where: NDArray[np.generic]
    arclengths: Floats


@dataclass(frozen=True)
class RimNodes:
    """How the boundary runs through the nodes of a net.

    Attributes
    ----------
    loops : list of (k,) int
        Boundary nodes of each loop in order, the surface to the left.
    directions : (n, 3)
        Unit direction of the rim at its nodes, forward along the loop (unused elsewhere).
    seam : (n,) bool, optional
        Nodes at which curves end inside the surface: no face across.
    """

    loops: list[Integers]
    directions: Floats
    seam: Booleans | None = None


def assemble(
    sampled: SampledCurves,
    samples: CurveSamples,
    rim: RimNodes,
    *,
    pattern: Pattern,
    mean_curvature: float,
    step: float,
    cells: int,
    periods: tuple[Period, ...],
    left_out: int,
) -> Network:
    """The network of sampled curves.

    Parameters
    ----------
    sampled : SampledCurves
    samples : CurveSamples
    rim : RimNodes
    pattern, mean_curvature, step, cells, periods, left_out
        See `Network`.

    Raises
    ------
    InputError
        The net is too coarse: a face has too many corners.
    """
    curves, nodes = sampled.curves, sampled.node_samples
    faces = sampled.faces(samples.normals, samples.tangents, rim)
    return Network(
        mean_curvature=mean_curvature,
        step=step,
        cells=cells,
        periods=periods,
        left_out=left_out,
        node_points=samples.points[nodes],
        node_normals=samples.normals[nodes],
        node_kinds=curves.kinds,
        ids=curves.ids,
        families=np.array(FAMILIES)[curves.families],
        closed=curves.closed,
        sample_offsets=sampled.offsets,
        sample_points=samples.points,
        sample_normals=samples.normals,
        sample_tangents=samples.tangents,
        sample_darboux=samples.darboux,
        sample_mean_curvature=samples.mean_curvature,
        sample_slopes=samples.slopes,
        sample_where=samples.where,
        sample_arclengths=samples.arclengths,
        stop_offsets=curves.stop_offsets,
        stop_nodes=curves.nodes,
        stop_samples=sampled.stop_samples - sampled.offsets[curves.owner],
        stop_arclengths=samples.arclengths[sampled.stop_samples],
        face_offsets=faces.offsets,
        face_nodes=faces.nodes,
        faces_left_out=faces.large,
        pattern=pattern,
    )
