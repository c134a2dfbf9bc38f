"""Lamellas as lines of beam elements."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas, slotted
from lamella.strip.layers import running
from lamella.strip.stress import shortening
from lamella.structure.beam.poses import Poses
from lamella.structure.model.curve_samples import CurveSamples
from lamella.structure.model.divisions import Divisions
from lamella.structure.model.node_poses import joint_numbers
from lamella.structure.model.rim_beams import ON_NODE


@dataclass(frozen=True)
class Lines:
    """m elements of lamellas or of layers, before they are beams.

    Attributes
    ----------
    nodes : (m, 2) int
    lamella, layer : (m,) int
        The layer counted from the right one (0); -1: all of them.
    arclengths : (m, 2)
        Of the ends on the lamella's centre line, m.
    length : (m,)
        Natural length, m.
    turns, offsets : (m, 2, 3, 3), (m, 2, 3)
        Ends in the frames of their nodes, see `lamella.structure.beam.attachment.Attachment`.
    joints : (m, 2) int
        -1: none.
    crossed : (m, 2) bool
        Whether the end is at a node where another lamella is slotted in.
    points, frames : (i, 3), (i, 3, 3)
        Poses of inner nodes, which come after those that are there.
    """

    nodes: Integers
    lamella: Integers
    layer: Integers
    arclengths: Floats
    length: Floats
    turns: Floats
    offsets: Floats
    joints: Integers
    crossed: Booleans
    points: Floats
    frames: Floats

    @classmethod
    def along(
        cls, lamellas: Lamellas, curve: CurveSamples, divisions: Divisions, poses: Poses, shared: Integers, layer: int
    ) -> Lines:
        """Lines of beams along the lamellas or one layer of each.

        Parameters
        ----------
        lamellas : Lamellas
        curve : CurveSamples
            Where they run.
        divisions : Divisions
        poses : Poses
            Of the nodes that are there; the network's come first.
        shared : (e, elements + 1) int
            Node of each end that has one already; -1: the line gets a node of its own.
        layer : int
            -1: all layers.
        """
        network = lamellas.network
        lamella = np.broadcast_to(divisions.lamella[:, None], divisions.arclengths.shape)
        points, frames = curve.at(lamella, divisions.arclengths)
        own = shared < 0
        numbers = shared.copy()
        numbers[own] = len(poses.points) + np.arange(int(own.sum()))
        node_points, node_frames = (
            np.concatenate((there, new[own])) for there, new in ((poses.points, points), (poses.frames, frames))
        )
        back = np.swapaxes(node_frames[numbers], -1, -2)
        turns = back @ frames
        offsets = np.einsum("ejkl,ejl->ejk", back, points - node_points[numbers])
        # what is on its node up to rounding
        offsets[np.abs(offsets).max(-1) < ON_NODE] = 0.0
        turns[own], offsets[own] = np.eye(3), 0.0
        length = _natural_lengths(lamellas, curve, divisions, layer)
        crossed = _at_ends(divisions, joint_numbers(network)[network.stop_nodes[divisions.stops]])
        slots = slotted(network, lamellas.section)[network.stop_nodes[divisions.stops]]
        is_b = network.families[divisions.lamella] == "B"
        joints = np.where(is_b[:, None], crossed, -1) if len(poses.angles) else np.full_like(crossed, -1)
        count = divisions.elements
        ends = _pairs(numbers)
        return cls(
            ends,
            np.repeat(divisions.lamella, count),
            np.full(len(ends), layer),
            _pairs(divisions.arclengths),
            length.ravel(),
            _pairs(turns),
            _pairs(offsets),
            _pairs(joints),
            _pairs(_at_ends(divisions, slots) > 0),
            points[own],
            frames[own],
        )

    def joined(self, other: Lines) -> Lines:
        """Both, the other's after these."""
        names = self.__dataclass_fields__
        return replace(self, **{key: np.concatenate((getattr(self, key), getattr(other, key))) for key in names})


def _natural_lengths(lamellas: Lamellas, curve: CurveSamples, divisions: Divisions, layer: int) -> Floats:
    """Of the elements, m, (e, elements).

    The flat strip's length between its marks: the arc length of its own curve, and with relaxed marks what a twisted
    strip is longer by. Layers that are marked alike and not by their own curves slip in their slots; that is no strain.
    """
    network = lamellas.network
    ends = np.broadcast_to(divisions.lamella[:, None], divisions.arclengths.shape)
    whole = np.diff(divisions.arclengths, axis=1)
    if layer >= 0:
        whole = _arc_lengths(network, curve, divisions)
    if lamellas.section.marks == "arc-length":
        return np.asarray(whole)
    more = running(network, shortening(lamellas.section.height, network.sample_darboux.tg))
    return np.asarray(whole + np.diff(curve.integrated(ends, divisions.arclengths, more), axis=1))


def _arc_lengths(network: Network, curve: CurveSamples, divisions: Divisions) -> Floats:
    """Of a layer's own curve, by Gauss' rule on its speed, (e, elements)."""
    place, weight = np.polynomial.legendre.leggauss(4)
    start, step = divisions.arclengths[:, :-1], np.diff(divisions.arclengths, axis=1)
    lamella = np.broadcast_to(divisions.lamella[:, None], start.shape)
    total = np.zeros(start.shape)
    for s, w in zip((1 + place) / 2, weight / 2, strict=True):
        total += w * step * curve.speed(lamella, start + s * step)
    return total


def _at_ends(divisions: Divisions, values: Integers | Booleans) -> Integers:
    """Values (e, 2) at the ends of edges, -1 between them, (e, elements + 1)."""
    result = np.full(divisions.arclengths.shape, -1)
    result[:, [0, -1]] = values
    return result


def _pairs(values: NDArray[Any]) -> NDArray[Any]:
    """Values (e, elements + 1, ...) at the ends of elements, (e elements, 2, ...)."""
    both = np.stack((values[:, :-1], values[:, 1:]), 2)
    return both.reshape(-1, 2, *values.shape[2:])
