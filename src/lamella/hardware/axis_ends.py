"""Edge beams' axes, and the ends of lamellas that are joined to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.fabrication.trims import Trims
from lamella.hardware.edge_rules import END_EDGE, END_PITCH, FOLD_BEND, BeamSection, EdgeBeamRules
from lamella.hardware.rims import RimPiece
from lamella.hardware.rules import MM, JointRules
from lamella.strip.lamellas import Section

ROOM = 1e-3
"""m; between parts of a lamella's end and the joint next to it, and beyond computed edge distances."""


@dataclass(frozen=True, eq=False)
class BeamAxis:
    """The beam along one smooth piece of a rim.

    Attributes
    ----------
    piece : RimPiece
    rules : EdgeBeamRules
    beam : BeamSection
    distance : float
        From the rim to its axis, outwards, m.
    """

    piece: RimPiece
    rules: EdgeBeamRules
    beam: BeamSection
    distance: float

    @property
    def label(self) -> str:
        """Where it is, in words of the lists."""
        return f"side {self.piece.number + 1} of boundary {self.piece.loop + 1}"

    @property
    def face(self) -> float:
        """From the rim to where end plates touch the beam, m."""
        return self.distance - self.beam.reach

    @property
    def middle(self) -> float:
        """From the rim to the middle of the end plates' legs on the beam, m."""
        return self.face - self.rules.end_plate / 2

    @property
    def trim(self) -> float:
        """From the rim to the lamellas' ends, m."""
        return self.face - self.rules.end_plate - self.rules.end_gap


@dataclass(frozen=True, eq=False)
class BeamEnds:
    """Ends of lamellas at beams, (e,) each.

    Attributes
    ----------
    lamellas : int
    last : bool
        Whether it is the lamella's end, and not its start.
    axes : int
        Index of the beam's axis.
    at_rim : float
        Where on its piece of the rim the rim's node is, m.
    along : float
        Where beside its piece of the rim it meets the beam, m.
    arclengths : float
        Of the centre line where it meets the middle of an end plate's leg on the beam, m.
    folds : float
        Angle between the lamella's direction and the beam's, rad, at most a right one.
    inner : float
        Arc length from the rim's node back to the next joint, m; infinite if there is none.
    towards : float
        Whether the leg of its end plate on the beam leads along the rim (1) or back (-1); 0 without a plate.
    legs : float
        Length of that leg from the fold's corner, m; 0 without a plate.
    bends : float
        What the plate is folded by, rad; 0 without one.
    """

    lamellas: Integers
    last: Booleans
    axes: Integers
    at_rim: Floats
    along: Floats
    arclengths: Floats
    folds: Floats
    inner: Floats
    towards: Floats
    legs: Floats
    bends: Floats

    def __len__(self) -> int:
        return len(self.lamellas)

    @property
    def senses(self) -> Floats:
        """1 where arc length grows outwards, else -1."""
        return np.where(self.last, 1.0, -1.0)

    def chosen(self, some: Booleans | Integers) -> BeamEnds:
        """Those of some indices, or where a mask is true."""
        return BeamEnds(*(getattr(self, name)[some] for name in self.__dataclass_fields__))


@dataclass(frozen=True, eq=False)
class EdgeBeamAxes:
    """All axes, the lamellas' ends at them, and how the strips end there.

    Attributes
    ----------
    axes : tuple of BeamAxis
    ends : BeamEnds
        Those that have an end plate.
    left_out : BeamEnds
        Those that are in the way of a steeper one, or of a corner, and end at their last joint instead.
    loose : int
        The same of lamellas without a joint: they end before the beam, and nothing holds them.
    trims : Trims
    askew : int
        Ends on rims with beams that are left as they are, because they meet the rim at less than `LEAST_ANGLE`.
    """

    axes: tuple[BeamAxis, ...]
    ends: BeamEnds
    left_out: BeamEnds
    loose: int
    trims: Trims
    askew: int


def end_lengths(fold: Floats, rules: EdgeBeamRules, section: Section, joints: JointRules) -> tuple[Floats, float]:
    """From an end plate's corner to its first screw (of folds (q,), rad), and from there to its inner end, m.

    The layer that ends first, on the side where the beam leads inwards, has `END_EDGE` hole diameters beyond the screw.
    """
    hole = joints.block_size.hole
    outer = (section.layers - 1) / 2 * section.offset + section.thickness / 2
    before = (rules.end_plate / 2 + rules.end_gap + outer * np.abs(np.cos(fold))) / np.sin(fold)
    arc = (FOLD_BEND + 0.5) * rules.end_plate * np.tan(fold / 2)
    first = np.maximum(before, arc) + ROOM + END_EDGE * hole
    return np.ceil(first * MM * 2) / MM / 2, (END_PITCH + END_EDGE) * hole


def beside(axis: BeamAxis, axes: Sequence[BeamAxis], step: int) -> BeamAxis | None:
    """The beam along the piece of the rim before (-1) or after (1) this one."""
    mine = [one for one in axes if one.piece.loop == axis.piece.loop]
    index = next(k for k, one in enumerate(mine) if one is axis)
    return mine[(index + step) % len(mine)] if len(mine) > 1 else None


def extent(axis: BeamAxis, axes: Sequence[BeamAxis], distance: float) -> tuple[float, float]:
    """Parameters along a piece of a rim, m, between which a line beside it runs to those beside its neighbours.

    Parameters
    ----------
    axis : BeamAxis
    axes : sequence of BeamAxis
        All of them.
    distance : float
        From the rim, outwards, m.
    """
    piece = axis.piece
    if piece.closed:
        return 0.0, piece.length
    reach = []
    for other, at_end in ((beside(axis, axes, -1), False), (beside(axis, axes, 1), True)):
        mine = piece.frames(np.array([piece.length if at_end else 0.0]))
        if other is None:
            reach.append(0.0)
            continue
        there = other.piece.frames(np.array([0.0 if at_end else other.piece.length]))
        turn = np.arctan2(
            float(np.cross(mine.ahead, there.ahead)[0] @ mine.up[0]), float(mine.ahead[0] @ there.ahead[0])
        )
        # outwards of a corner that turns to the left the line goes on
        reach.append(distance * np.tan((turn if at_end else -turn) / 2))
    return -reach[0], piece.length + reach[1]
