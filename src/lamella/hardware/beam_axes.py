"""Axes of the edge beams: curves beside the rim, and where lamellas meet them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.fabrication.defaults import END_DISTANCE_MIN
from lamella.fabrication.trims import Trims
from lamella.hardware.axis_ends import ROOM, BeamAxis, BeamEnds, EdgeBeamAxes, end_lengths
from lamella.hardware.classes import classes
from lamella.hardware.edge_rules import EdgeBeamRules
from lamella.hardware.end_room import plated
from lamella.hardware.rims import RimPiece, rim_pieces
from lamella.hardware.rules import MM, JointRules
from lamella.network.network import BOUNDARY, Network
from lamella.strip.lamellas import Lamellas, Section, crossings
from lamella.strip.layer_map import LayerMap

LEAST_ANGLE = np.radians(20.0)
"""Lamellas that meet a rim at less are not joined to its beam."""

ROUNDS = 6
"""Steps for the place where a strip meets a beam, and for the nearest place of a rim, which converge quadratically."""

FOLD_STEP = 0.5
"""deg; folds of end plates that differ by less are made alike."""

SLOTS = 4.0
"""Thicknesses of a strip that a slot takes beyond the outermost layer that goes through it."""


@dataclass(frozen=True, eq=False)
class _RimEnds:
    """Ends of open lamellas on the rim, (e,) each; `stops` and where on which piece of the rim."""

    stops: Integers
    lamellas: Integers
    last: Booleans
    pieces: Integers
    along: Floats
    inner: Floats


def edge_beam_axes(
    lamellas: Lamellas, rules: Mapping[int, EdgeBeamRules], joints: JointRules, half_joint: float
) -> EdgeBeamAxes:
    """Axes along the rims that have a beam.

    Parameters
    ----------
    lamellas : Lamellas
    rules : mapping of int to EdgeBeamRules
        By boundary loop.
    joints : JointRules
    half_joint : float
        From a node to where its joint ends along its lamellas, m.

    Raises
    ------
    InputError
        Measures with which nothing can be made, or that leave no room for a slot.
    """
    section, network = lamellas.section, lamellas.network
    pieces = rim_pieces(network.surface) if network.surface is not None else ()
    for one in rules.values():
        one.check(section, joints)
    found = _rim_ends(network, pieces)
    tangents = network.sample_tangents[network.sample_offsets[found.lamellas] + network.stop_samples[found.stops]]
    axes: list[BeamAxis] = []
    which = np.full(len(pieces), -1)
    folds = np.full(len(found.stops), np.nan)
    for number, piece in enumerate(pieces):
        if piece.loop not in rules:
            continue
        one = rules[piece.loop]
        mine = found.pieces == number
        along = np.abs(np.einsum("ij,ij->i", tangents[mine], piece.frames(found.along[mine]).ahead))
        folds[mine] = np.arccos(np.minimum(along, 1.0))
        which[number] = len(axes)
        axes.append(BeamAxis(piece, one, one.beam, 0.0))
    joined = (which[found.pieces] >= 0) if len(pieces) else np.zeros(0, bool)
    steep = joined & (np.nan_to_num(folds) >= LEAST_ANGLE)
    of_axis = which[found.pieces[steep]] if len(pieces) else np.zeros(0, np.int64)
    axes = _placed(axes, of_axis, folds[steep], found.inner[steep], section, joints, half_joint)
    ends, trims = _met(lamellas, axes, found, np.flatnonzero(steep), of_axis)
    ends = _with_plates(lamellas, axes, ends, joints, half_joint)
    without = ends.legs == 0
    held = without & np.isfinite(ends.inner)
    return EdgeBeamAxes(
        tuple(axes),
        ends.chosen(~without),
        ends.chosen(held),
        int((without & ~held).sum()),
        _shortened(lamellas, trims, ends.chosen(held), half_joint),
        int((joined & ~steep).sum()),
    )


def _with_plates(
    lamellas: Lamellas, axes: list[BeamAxis], ends: BeamEnds, joints: JointRules, half_joint: float
) -> BeamEnds:
    """The ends with those plates for which there is room; folds that differ little are made alike."""
    kind, sizes = classes(np.degrees(ends.folds), FOLD_STEP)
    towards, legs, bends = np.zeros((3, len(ends)))
    for number, axis in enumerate(axes):
        mine = np.flatnonzero(ends.axes == number)
        if not len(mine):
            continue
        made = plated(lamellas, axes, axis, ends.chosen(mine), np.radians(sizes)[kind[mine]], joints, half_joint)
        some = mine[made.ends]
        towards[some], legs[some], bends[some] = made.towards, made.legs, made.folds
    return replace(ends, towards=towards, legs=legs, bends=bends)


def _shortened(lamellas: Lamellas, trims: Trims, ends: BeamEnds, half_joint: float) -> Trims:
    """Trims with some ends square behind their last joint instead of at the beam."""
    section, network = lamellas.section, lamellas.network
    reach = max(half_joint, (section.layers - 1) / 2 * section.offset + END_DISTANCE_MIN)
    stations = trims.stations.copy()
    crossing = crossings(network)[network.stop_nodes]
    for lamella, last in zip(ends.lamellas.tolist(), ends.last.tolist(), strict=True):
        own = np.arange(network.stop_offsets[lamella], network.stop_offsets[lamella + 1])
        own = own[crossing[own]]
        joint, sense = (own[-1], 1.0) if last else (own[0], -1.0)
        square = lamellas.layers.stop_stations[:, joint] + sense * reach
        at_beam = stations[lamella, :, int(last)]
        # a joint next to the rim keeps the end at the beam
        stations[lamella, :, int(last)] = sense * np.minimum(sense * square[:, None], sense * at_beam)
    return Trims(stations)


def _rim_ends(network: Network, pieces: tuple[RimPiece, ...]) -> _RimEnds:
    owner, nodes = network.stop_owner, network.stop_nodes
    first = np.flatnonzero(np.arange(len(nodes)) == network.stop_offsets[owner])
    last = np.flatnonzero(np.arange(len(nodes)) == network.stop_offsets[owner + 1] - 1)
    stops = np.concatenate([first, last])
    at_end = np.repeat([False, True], [len(first), len(last)])
    kept = (network.node_kinds[nodes[stops]] == BOUNDARY) & ~network.closed[owner[stops]]
    if not pieces:
        kept[:] = False
    stops, at_end = stops[kept], at_end[kept]
    points = network.node_points[nodes[stops]]
    away, along = np.full((2, len(pieces), len(stops)), np.inf)
    for number, piece in enumerate(pieces):
        away[number], along[number] = _nearest(piece, points)
    which = np.argmin(np.round(away, 9), axis=0) if len(stops) else np.zeros(0, np.int64)
    return _RimEnds(
        stops, owner[stops], at_end, which, along[which, np.arange(len(stops))], _inner(network, stops, at_end)
    )


def _nearest(piece: RimPiece, points: Floats) -> tuple[Floats, Floats]:
    """Distances of points (q, 3) from the rim, and parameters of the nearest places, m."""
    apart = np.linalg.norm(piece.points[None] - points[:, None], axis=2)
    chords = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(piece.points, axis=0), axis=1)))
    along = chords[np.argmin(apart, axis=1)] if len(points) else np.empty(0)
    for _ in range(ROUNDS):
        there = piece.frames(along)
        off = points - there.points
        bend = np.einsum("ij,ij->i", off, there.bend)
        along = piece.wrapped(along + np.einsum("ij,ij->i", off, there.ahead) / np.maximum(1 - bend, 0.5))
    off = np.linalg.norm(piece.frames(along).points - points, axis=1) if len(points) else np.empty(0)
    return off, along


def _inner(network: Network, stops: Integers, at_end: Booleans) -> Floats:
    """Arc length from ends back to the next crossing, m; 0 where lamellas cross on the rim."""
    crossing = crossings(network)[network.stop_nodes]
    owner = network.stop_owner
    place = np.where(crossing, network.stop_arclengths, np.nan)
    low, high = np.full((2, len(network.ids)), np.nan)
    some = np.flatnonzero(crossing)
    # the first crossing of each lamella, and the last one
    low[owner[some[::-1]]], high[owner[some]] = place[some[::-1]], place[some]
    at = network.stop_arclengths[stops]
    inner = np.where(at_end, at - high[owner[stops]], low[owner[stops]] - at)
    return np.where(np.isnan(inner), np.inf, inner)


def _placed(
    axes: list[BeamAxis],
    of_axis: Integers,
    folds: Floats,
    inner: Floats,
    section: Section,
    joints: JointRules,
    half_joint: float,
) -> list[BeamAxis]:
    """Axes at their distances: given, or as the joints next to the rim need."""
    needed = np.zeros(len(axes))
    for number, axis in enumerate(axes):
        mine = of_axis == number
        first, rest = end_lengths(folds[mine], axis.rules, section, joints)
        short = (first + rest + half_joint + ROOM - inner[mine]) * np.sin(folds[mine])
        most = short.max(initial=-np.inf) + axis.rules.end_plate / 2 + axis.beam.reach
        needed[number] = np.ceil(MM * max(most, 0.0)) / MM
    loops = np.array([axis.piece.loop for axis in axes])
    found = []
    for axis in axes:
        given = axis.rules.distance
        # one distance all around a loop: its pieces meet in its corners
        distance = float(needed[loops == axis.piece.loop].max()) if given is None else given
        found.append(BeamAxis(axis.piece, axis.rules, axis.beam, distance))
    return found


def _met(
    lamellas: Lamellas, axes: list[BeamAxis], found: _RimEnds, some: Integers, of_axis: Integers
) -> tuple[BeamEnds, Trims]:
    """Where strips meet the beams."""
    network, section = lamellas.network, lamellas.section
    trims = np.full((len(network.ids), section.layers, 2, 2), np.nan)
    along, arclengths, folds = np.empty((3, len(some)))
    heights = np.array([-0.5, 0.5]) * section.height
    beyond = np.full(len(some), np.inf)
    maps: list[LayerMap] = []
    inner: list[LayerMap] = []
    # both ends of a lamella one after the other
    order = np.argsort(found.lamellas[some], kind="stable").tolist()
    for place, k in enumerate(order):
        end = int(some[k])
        lamella, last, axis = int(found.lamellas[end]), bool(found.last[end]), axes[int(of_axis[k])]
        if not place or lamella != found.lamellas[some[order[place - 1]]]:
            maps, inner = _maps(lamellas, lamella)
        start = np.array([network.stop_arclengths[found.stops[end]]])
        begin = found.along[[end]]
        met = [_meets(one, axis.piece, start, begin, np.zeros(1), axis.middle) for one in inner]
        arclengths[k] = sum(float(station[0]) for station, _ in met) / 2
        along[k] = sum(float(place[0]) for _, place in met) / 2
        _, ahead, normal, _ = inner[0].frames(arclengths[[k]])
        beam = axis.piece.frames(along[[k]]).ahead[0]
        flat = ahead[0] - (ahead[0] @ normal[0]) * normal[0]
        folds[k] = np.arccos(min(abs(float(flat @ beam)) / float(np.linalg.norm(flat)), 1.0))
        for row, one in enumerate(maps):
            first = float(lamellas.layers.stop_stations[row, found.stops[end]])
            stations, _ = _meets(one, axis.piece, np.full(2, first), np.repeat(begin, 2), heights, axis.trim)
            trims[lamella, row, int(last)] = stations
            beyond[k] = min(beyond[k], float(((stations - first) * (1 if last else -1)).min()))
    none = np.zeros(len(some))
    ends = BeamEnds(
        found.lamellas[some],
        found.last[some],
        of_axis,
        found.along[some],
        along,
        arclengths,
        folds,
        found.inner[some],
        none,
        none,
        none,
    )
    _check_slots(lamellas, axes, ends, beyond)
    return ends, Trims(trims)


def _maps(lamellas: Lamellas, lamella: int) -> tuple[list[LayerMap], list[LayerMap]]:
    """All layers of a lamella by their stations; the two innermost ones, or the middle one twice, by arc length."""
    network, layers = lamellas.network, lamellas.section.layers
    span = slice(int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1]))
    maps = [LayerMap.of(lamellas, lamella, row) for row in range(layers)]
    inner = []
    for row in (layers // 2, (layers - 1) // 2):
        # layers that are alike have the same stations
        alike = np.array_equal(lamellas.layers.stations[row, span], network.sample_arclengths[span])
        inner.append(maps[row] if alike else LayerMap.of(lamellas, lamella, row, by_arclength=True))
    return maps, inner


def _meets(
    layer: LayerMap, piece: RimPiece, stations: Floats, along: Floats, heights: Floats, distance: float
) -> tuple[Floats, Floats]:
    """Stations (q,) at which points at heights over a layer's curve lie at a distance outwards of a rim, and where.

    (X - p) . m = distance and (X - p) . T = 0 for X = c + z n and the rim's point p, T and m.
    """
    for _ in range(ROUNDS):
        point, ahead, normal, turning = layer.frames(stations)
        rim = piece.frames(along)
        off = point + heights[:, None] * normal - rim.points
        rate = ahead + heights[:, None] * turning
        step = (distance - np.einsum("ij,ij->i", off, rim.out)) / np.einsum("ij,ij->i", rate, rim.out)
        stations = stations + step
        off = off + step[:, None] * rate
        along = along + np.einsum("ij,ij->i", off, rim.ahead) / (1 - np.einsum("ij,ij->i", off, rim.bend))
    return stations, along


def _check_slots(lamellas: Lamellas, axes: list[BeamAxis], ends: BeamEnds, beyond: Floats) -> None:
    """Require room for the slots of the last crossings in strips that end `beyond` (e,) the rim's node, m."""
    section = lamellas.section
    outer = (section.layers - 1) / 2 * section.offset + SLOTS * section.thickness
    left = ends.inner + beyond - outer
    if left.min(initial=np.inf) >= 0:
        return
    worst = int(np.argmin(left))
    axis = axes[int(ends.axes[worst])]
    needed = axis.distance - float(left[worst])
    raise InputError(
        f"distance = {axis.distance:g} m: at the edge beam {lamellas.network.ids[ends.lamellas[worst]]} would end "
        f"{MM * (left[worst] + outer):.4g} mm beyond its last crossing, whose slots take {MM * outer:.4g} mm",
        f"write distance = {rounded(needed, up=True):g} or more, or leave it out",
        "distance",
    )
