"""Room for end plates on an edge beam: which ends have one, which way it leads, how long its leg is.

Lamellas of either family that meet the rim nearly in one point are in each other's way there: they would run into each
other between the rim and the beam. The steeper one keeps its end plate; the other one ends at its last joint, which
holds it. An end plate leads along the beam the way in which its fold is flatter, with the leg that is asked for; where
a neighbour, its plate or a corner of the rim is in the way, it leads back, or its leg is shorter, down to half.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.hardware.axis_ends import ROOM, BeamAxis, BeamEnds, end_lengths, extent
from lamella.hardware.edge_rules import FOLD_BEND
from lamella.hardware.rules import MM, JointRules
from lamella.strip.lamellas import Lamellas
from lamella.strip.levels import level_heights

LEG_FLAT = 3.0
"""Thicknesses of an end plate that its leg on the beam has beyond the fold at least: what it is welded along."""

SHARPEST_FOLD = np.radians(135.0)
"""An end plate that leads back along the beam is folded by no more."""


@dataclass(frozen=True, eq=False)
class Plated:
    """Ends of one beam that have an end plate, (k,) each.

    Attributes
    ----------
    ends : int
        Which of the given ones.
    towards : float
        Whether the leg on the beam leads along the rim (1) or back (-1).
    legs : float
        Its length from the fold's corner, m.
    folds : float
        Of the plate, rad.
    """

    ends: Integers
    towards: Floats
    legs: Floats
    folds: Floats


def plated(
    lamellas: Lamellas,
    axes: Sequence[BeamAxis],
    axis: BeamAxis,
    ends: BeamEnds,
    folds: Floats,
    joints: JointRules,
    half_joint: float,
) -> Plated:
    """The ends that have a plate: clear of the next joint, of corners of the rim, of lamellas and plates beside them.

    Parameters
    ----------
    lamellas : Lamellas
    axes : sequence of BeamAxis
        All of them.
    axis : BeamAxis
        One of them.
    ends : BeamEnds
        All that meet this beam.
    folds : (e,)
        Angles between the lamellas and the beam, rad, at most a right one.
    joints : JointRules
    half_joint : float
        From a node to where its joint ends along its lamellas, m.

    Raises
    ------
    InputError
        No end has room.
    """
    room = _Room.of(lamellas, axis, ends, folds, joints, half_joint, extent(axis, axes, axis.face))
    # lamellas on two levels are clear of each other
    level = level_heights(lamellas.network, lamellas.section.level)[ends.lamellas]
    found: list[tuple[int, float, float, float]] = []
    for height in np.unique(level).tolist():
        mine = np.flatnonzero(level == height)
        found += room.legs(room.apart(mine[room.fits(folds)[mine] & room.on_side(mine)]))
    found.sort()
    if len(ends) and not found:
        raise _no_room(axis, ends, folds, lamellas, joints)
    columns = np.array(found, float).reshape(-1, 4).T
    return Plated(columns[0].astype(np.int64), columns[1], columns[2], columns[3])


@dataclass(frozen=True, eq=False)
class _Room:
    """What the ends at one beam take: half of what a lamella takes along it (e,), m, and how far it is free inwards."""

    axis: BeamAxis
    extent: tuple[float, float]
    ends: BeamEnds
    folds: Floats
    sides: Floats
    free: Floats
    towards: Floats
    half_layer: float
    first_and_rest: Callable[[Floats], tuple[Floats, float]]

    @classmethod
    def of(
        cls,
        lamellas: Lamellas,
        axis: BeamAxis,
        ends: BeamEnds,
        folds: Floats,
        joints: JointRules,
        half_joint: float,
        extent: tuple[float, float],
    ) -> _Room:
        network, section = lamellas.network, lamellas.section
        stops = network.stop_offsets
        node = network.stop_arclengths[np.where(ends.last, stops[ends.lamellas + 1] - 1, stops[ends.lamellas])]
        free = (ends.arclengths - node) * ends.senses + ends.inner - half_joint - ROOM / 2
        sides = _half_width(lamellas, joints) / np.sin(folds)
        towards = towards_of(axis, ends, lamellas)
        half_layer = (section.offset - section.thickness) / 2
        lengths = partial(end_lengths, rules=axis.rules, section=section, joints=joints)
        return cls(axis, extent, ends, folds, sides, free, towards, half_layer, lengths)

    def fits(self, folds: Floats) -> Booleans:
        """Where plates of some folds end before the next joint."""
        first, rest = self.first_and_rest(folds)
        return np.asarray(self.free >= first + rest)

    def on_side(self, some: Integers) -> Booleans:
        """Where lamellas lie within their side of the rim, at the beam's face."""
        if self.axis.piece.closed:
            return np.ones(len(some), bool)
        along, sides = self.ends.along[some], self.sides[some]
        low, high = self.extent
        return np.asarray((along - sides >= low) & (along + sides <= high))

    def apart(self, some: Integers) -> Integers:
        """Those that are in the way of none that is steeper, in their order along the rim.

        Two are in each other's way where they are too near at the beam, or have crossed on the way to it.
        """
        along = self.ends.along
        order = np.lexsort((np.round(along[some], 6), -np.round(self.folds[some], 6)))
        kept = np.zeros(0, np.int64)
        for k in some[order].tolist():
            gap = self._between(along[kept] - along[k])
            crossed = self._between(self.ends.at_rim[kept] - self.ends.at_rim[k]) * gap < 0
            if (np.abs(gap) >= self.sides[kept] + self.sides[k]).all() and not crossed.any():
                kept = np.append(kept, k)
        return kept[np.argsort(np.round(along[kept], 6), kind="stable")]

    def _between(self, gap: Floats) -> Floats:
        """Signed distances along the rim, m, the shorter way around; those that are rounding are 0."""
        turn = self.axis.piece.length
        shortest = np.mod(gap + turn / 2, turn) - turn / 2 if self.axis.piece.closed else gap
        return np.round(shortest, 6)

    def legs(self, some: Integers) -> list[tuple[int, float, float, float]]:
        """Of ends in their order: which, which way their legs lead, their lengths, the folds; where there is room."""
        along, count = self.ends.along[some], len(some)
        # what is taken before and after each end
        before, after = self.sides[some].copy(), self.sides[some].copy()
        turn = self.axis.piece.length
        closed = self.axis.piece.closed and count > 1
        found = []
        for k, end in enumerate(some.tolist()):
            right, left = np.inf, np.inf
            if closed or k + 1 < count:
                other = (k + 1) % count
                right = (along[other] - along[k]) % turn - before[other]
            if closed or k:
                left = (along[k] - along[k - 1]) % turn - after[k - 1]
            if not self.axis.piece.closed:
                right, left = min(right, self.extent[1] - along[k]), min(left, along[k] - self.extent[0])
            for towards, leg, fold in self._choices(end):
                if leg <= (right if towards > 0 else left):
                    found.append((end, towards, leg, fold))
                    taken = after if towards > 0 else before
                    taken[k] = max(taken[k], leg)
                    break
        return found

    def _choices(self, end: int) -> list[tuple[float, float, float]]:
        """Which way, leg and fold that a plate may have, the best first."""
        rules, fold, towards = self.axis.rules, float(self.folds[end]), float(self.towards[end])
        radius = (FOLD_BEND + 0.5) * rules.end_plate
        found = []
        for way, bend in ((towards, fold), (-towards, np.pi - fold)):
            back = way != towards
            tangent = radius * np.tan(bend / 2)
            # where the layer on its side ends the plate is still bent towards it
            bent = min(max(tangent - self.half_layer / np.sin(fold), 0.0), radius)
            near = radius - np.sqrt(radius**2 - bent**2) > rules.end_gap / 2
            if back and (near or bend > SHARPEST_FOLD + 1e-9 or not self.fits(np.full(len(self.ends), bend))[end]):
                continue
            least = np.ceil(MM * max(tangent + LEG_FLAT * rules.end_plate, rules.end_plate_leg / 2)) / MM
            found += [(way, leg, bend) for leg in (rules.end_plate_leg, least) if leg <= rules.end_plate_leg]
        # the leg that is asked for, either way, before a short one
        return sorted(found, key=lambda one: (one[1] < rules.end_plate_leg, one[0] != towards))


def _half_width(lamellas: Lamellas, joints: JointRules) -> float:
    """From a lamella's centre line to the end of the screws through it, m."""
    section, size = lamellas.section, joints.block_size
    return (section.layers - 1) / 2 * section.offset + section.thickness / 2 + size.nut + 2 * size.pitch


def _no_room(axis: BeamAxis, ends: BeamEnds, folds: Floats, lamellas: Lamellas, joints: JointRules) -> InputError:
    """What is said where none of a beam's end plates has room."""
    along = np.sort(ends.along)
    apart = float(np.median(np.diff(along))) if len(along) > 1 else axis.piece.length
    most = apart - float((_half_width(lamellas, joints) / np.sin(folds)).max())
    first, rest = end_lengths(folds, axis.rules, lamellas.section, joints)
    return InputError(
        f"no end plate has room on the edge beam along {axis.label}: legs of {MM * axis.rules.end_plate_leg:g} mm on "
        f"it and {MM * float((first + rest).max()):.4g} mm between the layers, lamellas {MM * apart:.4g} mm apart",
        f"write end_plate_leg = {rounded(most, up=False):g} or less, or fewer cells"
        if most > 0
        else f"choose fewer cells: their ends have to be {MM * (apart - most):.4g} mm apart or more",
        "end_plate_leg",
    )


def _outwards(lamellas: Lamellas, ends: BeamEnds) -> tuple[Floats, Floats]:
    """Unit tangents out of the lamellas' ends, and normals there, (e, 3) each."""
    network = lamellas.network
    offsets = network.sample_offsets
    at = np.where(ends.last, offsets[ends.lamellas + 1] - 1, offsets[ends.lamellas])
    return ends.senses[:, None] * network.sample_tangents[at], network.sample_normals[at]


def towards_of(axis: BeamAxis, ends: BeamEnds, lamellas: Lamellas) -> Floats:
    """Whether the leg on the beam leads along the rim (1) or back (-1): the way the fold is flatter."""
    along = np.einsum("ij,ij->i", _outwards(lamellas, ends)[0], axis.piece.frames(ends.along).ahead)
    return np.where(np.round(along, 6) < 0, -1.0, 1.0)
