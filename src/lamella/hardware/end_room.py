"""Room for end plates on an edge beam: clear of the next joint, of corners of the rim and of neighbours."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.hardware.beam_axes import ROOM, BeamAxis, BeamEnds, end_lengths
from lamella.hardware.rules import MM, JointRules
from lamella.strip.lamellas import Lamellas
from lamella.strip.levels import level_heights


def with_room(
    lamellas: Lamellas, axis: BeamAxis, ends: BeamEnds, folds: Floats, joints: JointRules, half_joint: float
) -> Integers:
    """Ends whose plates are clear of the next joint and of the plates beside them."""
    first, rest = end_lengths(folds, axis.rules, lamellas.section, joints)
    network = lamellas.network
    stops = network.stop_offsets
    node = network.stop_arclengths[np.where(ends.last, stops[ends.lamellas + 1] - 1, stops[ends.lamellas])]
    beyond = (ends.arclengths - node) * ends.senses
    some = np.flatnonzero(beyond + ends.inner >= first + rest + half_joint + ROOM / 2)
    leg = axis.rules.end_plate_leg
    if not axis.piece.closed:
        # what is left of the rim's piece beside it
        length = axis.piece.length
        some = some[(ends.along[some] >= leg) & (ends.along[some] <= length - leg)]
    sides = _half_width(lamellas, joints) / np.sin(folds)
    towards = towards_of(axis, ends, lamellas)
    low = ends.along - np.maximum(sides, np.where(towards < 0, leg, 0.0))
    high = ends.along + np.maximum(sides, np.where(towards > 0, leg, 0.0))
    # lamellas on two levels are clear of each other
    level = level_heights(network, lamellas.section.level)[ends.lamellas]
    found = []
    for height in np.unique(level).tolist():
        mine = np.flatnonzero(level == height)
        clear = mine[~_in_the_way(axis, ends.along[mine], sides[mine], low[mine], high[mine])]
        found += _apart(axis, np.intersect1d(some, clear), ends.along, low, high)
    return np.array(sorted(found), np.int64)


def _apart(axis: BeamAxis, some: Integers, along: Floats, low: Floats, high: Floats) -> list[int]:
    """Those of some plates from `low` to `high` (e,) on the rim that do not meet one that was kept before them."""
    kept: list[int] = []
    for k in some[np.argsort(np.round(along[some], 6), kind="stable")].tolist():
        if not kept or low[k] >= high[kept[-1]]:
            kept.append(k)
    if axis.piece.closed and len(kept) > 1 and low[kept[0]] + axis.piece.length < high[kept[-1]]:
        kept.pop()
    return kept


def _half_width(lamellas: Lamellas, joints: JointRules) -> float:
    """From a lamella's centre line to the end of the screws through it, m."""
    section, size = lamellas.section, joints.block_size
    return (section.layers - 1) / 2 * section.offset + section.thickness / 2 + size.nut + 2 * size.pitch


def no_room(axis: BeamAxis, ends: BeamEnds, folds: Floats, lamellas: Lamellas, joints: JointRules) -> InputError:
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


def _in_the_way(axis: BeamAxis, along: Floats, sides: Floats, low: Floats, high: Floats) -> Booleans:
    """Plates from `low` to `high` (e,) on the rim that another lamella, `sides` wide to either side, runs into."""
    turn = axis.piece.length if axis.piece.closed else 0.0
    order = np.argsort(np.round(along, 6), kind="stable")
    begin, end = (along - sides)[order], (along + sides)[order]
    blocked = np.zeros(len(along), bool)
    for shift in (-1, 1):
        other = np.roll(np.arange(len(order)), -shift)
        wrapped = (other - np.arange(len(order)) != shift) * shift * turn
        apart = begin[other] + wrapped - high[order] if shift > 0 else low[order] - (end[other] + wrapped)
        valid = np.ones(len(order), bool) if turn else other - np.arange(len(order)) == shift
        blocked[order] |= valid & (apart < 0) & (len(order) > 1)
    return blocked


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
