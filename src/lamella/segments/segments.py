"""Segments of a structure as records."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.message import Message
from lamella.base.result import Result
from lamella.base.wording import counted


@dataclass(frozen=True, eq=False)
class Segment:
    """What is assembled, carried and lifted in one.

    Attributes
    ----------
    id : str
        "S1", "S2", ... in the order of their first nodes.
    nodes : (n,) int
        Of the network, ascending.
    lamellas : (l,) int
        Of which it has pieces, ascending.
    parts : (p,) int
        Indices of its strips among all parts; of each its whole quantity.
    mass : float
        Of strips and hardware, kg.
    centre : (3,)
        Of gravity, m.
    size : float
        Greatest distance of two of its nodes and cut ends, m.
    lifting : (k,) int
        Nodes it is lifted at.
    shares : (k,)
        Of its weight that each of these carries.
    """

    id: str
    nodes: Integers
    lamellas: Integers
    parts: Integers
    mass: float
    centre: Floats
    size: float
    lifting: Integers
    shares: Floats


@dataclass(frozen=True, eq=False)
class SegmentJoint:
    """Where a strip goes over from one segment into another; it is spliced there.

    Attributes
    ----------
    segments : (int, int)
        Indices of the one behind and the one ahead, along the lamella.
    parts : (int, int)
        Indices of the parts.
    lamella : int
    point : (3,)
        On the lamella's centre line, m.
    """

    segments: tuple[int, int]
    parts: tuple[int, int]
    lamella: int
    point: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Segments(Result):
    """All segments of a structure.

    Attributes
    ----------
    segments : tuple of Segment
    joints : tuple of SegmentJoint
    of_node : (n,) int
        Index of each node's segment.
    of_part : (p,) int
        Of each part's.
    of_place : tuple of (q,) int
        Of each piece's, for every item of the hardware.
    borders : tuple of (b,) int
        Of each lamella: cells in whose middle it is cut, by the number of the node before.
    """

    segments: tuple[Segment, ...] = ()
    joints: tuple[SegmentJoint, ...] = ()
    of_node: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    of_part: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    of_place: tuple[Integers, ...] = ()
    borders: tuple[Integers, ...] = ()

    def _line(self) -> str:
        heaviest = max((one.mass for one in self.segments), default=0.0)
        joints = counted(len(self.joints), "joint")
        return f"{counted(len(self.segments), 'segment')}, up to {heaviest:.4g} kg, {joints}"

    @property
    def warnings(self) -> tuple[Message, ...]:
        """What the user should know about them."""
        without = [one.id for one in self.segments if not len(one.lifting)]
        if not without:
            return ()
        few = ", ".join(without[:5]) + (", ..." if len(without) > 5 else "")
        text = (
            f"{len(without)} of {counted(len(self.segments), 'segment')} ({few}) have no three nodes around their "
            "centre of gravity to be lifted at: choose larger segments"
        )
        return (Message("segments_lifting", text),)

    @property
    def mass(self) -> float:
        """Of all segments, kg."""
        return sum(one.mass for one in self.segments)
