"""Edge beams: tubes or flat bars along the rim, in segments, with end plates for the lamellas and base plates.

A beam's axis runs at one distance beside the rim, and its cross section turns with the surface's normal. Segments are
cut midway between the ends of lamellas that are nearest to them, so that no end plate lies on a joint of the beam; in
corners of the rim they are mitred. What a segment is bent to is told by the curvatures of its axis c: with the forward
direction T, the normal n and m = T x n outwards, T' = -kg m + kn n and the twist of the section is tg = n' . m: a tube
is bent to the radius 1 / sqrt(kg^2 + kn^2), a flat bar about its weak axis by kg, and is cut from a plate to the
curvature kn and twisted by tg.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.message import Message
from lamella.base.wording import counted
from lamella.fabrication.flat import outline_points
from lamella.hardware.axis_ends import BeamAxis, BeamEnds, EdgeBeamAxes, beside, extent
from lamella.hardware.bar_pattern import bar_pattern
from lamella.hardware.base_plates import base_plates
from lamella.hardware.beam_axes import LEAST_ANGLE
from lamella.hardware.bores import Bores
from lamella.hardware.end_plates import end_plates
from lamella.hardware.item import Item, Places
from lamella.hardware.rules import MM, JointRules
from lamella.hardware.shape import Sweep
from lamella.strip.lamellas import Lamellas

SAG = 2e-5
"""m; how far straight pieces of a bent beam, as it is drawn, may leave its axis."""

TWIST_SAG = 4e-5
"""m; how far triangles on a twisted bar may leave its faces."""

PIECES_MAX = 4000
"""Straight pieces of a beam at most."""

CONGRUENT_SEGMENTS = 1e-4
"""m; segments that differ by less anywhere are made alike."""

LEAST_SEGMENT = 0.05
"""m; what is shorter is no segment."""

STRAIGHT = 1e-3
"""1/m; a beam that is bent less is straight."""


@dataclass(frozen=True, eq=False)
class EdgeBeams:
    """Beams with all that is on them.

    Attributes
    ----------
    items : tuple of Item
    bores : Bores
        Of the layers.
    keep_clear : (q,)
        By stop, how far from it no shear block may reach, m.
    warnings : tuple of Message
    """

    items: tuple[Item, ...]
    bores: Bores
    keep_clear: Floats
    warnings: tuple[Message, ...]


def edge_beams(lamellas: Lamellas, found: EdgeBeamAxes, joints: JointRules) -> EdgeBeams:
    """Beams, end plates and base plates.

    Parameters
    ----------
    lamellas : Lamellas
    found : EdgeBeamAxes
    joints : JointRules
    """
    network = lamellas.network
    plates = end_plates(lamellas, found, joints)
    segments: list[Item] = []
    for number, axis in enumerate(found.axes):
        places = np.sort(found.ends.along[found.ends.axes == number])
        segments += _segments(axis, places, found.axes)
    items = _alike(segments)
    items += plates.items
    items += base_plates(found.axes)
    keep_clear = np.zeros(len(network.stop_nodes))
    keep_clear[_stops(lamellas, found.ends)] = plates.reach
    # no block beyond the joint at which a lamella ends
    keep_clear[_stops(lamellas, found.left_out)] = found.left_out.inner
    return EdgeBeams(tuple(items), plates.bores, keep_clear, tuple(_notes(found, network.ids)))


def _stops(lamellas: Lamellas, ends: BeamEnds) -> Integers:
    """Of the network, at some ends."""
    offsets = lamellas.network.stop_offsets
    return np.where(ends.last, offsets[ends.lamellas + 1] - 1, offsets[ends.lamellas])


def _notes(found: EdgeBeamAxes, ids: tuple[str, ...]) -> list[Message]:
    notes = []
    left_out = [ids[k] for k in found.left_out.lamellas.tolist()]
    every = counted(len(found.ends) + len(left_out) + found.loose + found.askew, "lamella end")
    if left_out:
        some = ", ".join(left_out[:5]) + (", ..." if len(left_out) > 5 else "")
        notes.append(
            Message(
                "ends_at_their_joint",
                f"{len(left_out)} of {every} at edge beams ({some}) are in the way of a steeper one or of a corner of "
                "the rim: these lamellas end at their last joint instead of at the beam; another number of cells moves "
                "them",
            )
        )
    if found.loose:
        notes.append(
            Message(
                "ends_without_plate",
                f"{found.loose} of {every} at edge beams have no room for an end plate, and no joint holds them: leave "
                "these short lamellas out, or choose another number of cells",
            )
        )
    if found.askew:
        notes.append(
            Message(
                "ends_askew",
                f"{found.askew} of {every} at edge beams meet the rim at less than {np.degrees(LEAST_ANGLE):g} deg "
                "and are not joined to its beam",
            )
        )
    return notes


def _segments(axis: BeamAxis, places: Floats, axes: tuple[BeamAxis, ...]) -> list[Item]:
    """The segments along one piece of the rim, with lamella ends at places, m."""
    begin, end = extent(axis, axes, axis.distance)
    bounds = _bounds(axis, places, begin, end)
    items = []
    for number, (low, high) in enumerate(zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)):
        if high - low < LEAST_SEGMENT:
            continue
        mitred = (number == 0 and not axis.piece.closed, number == len(bounds) - 2 and not axis.piece.closed)
        items.append(_segment(axis, low, high, mitred, axes))
    return items


def _alike(segments: list[Item]) -> list[Item]:
    """Segments that are congruent within `CONGRUENT_SEGMENTS` as one item."""
    kinds: list[list[Item]] = []
    for item in segments:
        kind = next((one for one in kinds if _congruent(one[0], item)), None)
        if kind is None:
            kinds.append([item])
        else:
            kind.append(item)
    found = []
    for number, kind in enumerate(kinds):
        places = Places(
            np.concatenate([item.places.origins for item in kind]),
            np.concatenate([item.places.axes for item in kind]),
            tuple(label for item in kind for label in item.places.labels),
        )
        found.append(replace(kind[0], id=f"edge-{number + 1}", places=places))
    return found


def _congruent(one: Item, other: Item) -> bool:
    if (one.material, one.description.split(",")[0]) != (other.material, other.description.split(",")[0]):
        return False
    (a,), (b,) = one.shape, other.shape
    if not (isinstance(a, Sweep) and isinstance(b, Sweep)) or len(a.points) != len(b.points):
        return False
    if (a.cuts is None) != (b.cuts is None) or np.abs(a.points - b.points).max() > CONGRUENT_SEGMENTS:
        return False
    turned = np.abs(a.up - b.up).max()
    if a.cuts is not None and b.cuts is not None:
        turned = max(turned, np.abs(a.cuts - b.cuts).max())
    # over a cross section
    return bool(turned * np.abs(outline_points(a.outline)).max() < CONGRUENT_SEGMENTS)


def _bounds(axis: BeamAxis, places: Floats, begin: float, end: float) -> Floats:
    """Parameters at which segments begin and end, m, the true lengths in between at most as asked for."""
    piece = axis.piece
    if piece.closed:
        begin = _widest(places, piece.length)
        end = begin + piece.length
        places = begin + np.sort(np.mod(places - begin, piece.length))
    middles = (places[1:] + places[:-1]) / 2
    fine = np.linspace(begin, end, 257)
    along = np.linalg.norm(np.diff(piece.frames(fine).beside(axis.distance), axis=0), axis=1)
    true = np.append(0.0, np.cumsum(along))
    whole = float(true[-1])
    number = int(np.ceil(whole / axis.rules.segment - 1e-9))
    at = np.interp(middles, fine, true)
    bounds = [begin]
    done = 0.0
    for left in range(number, 0, -1):
        # as equal as the places between the ends allow
        if whole - done <= axis.rules.segment * (1 + 1e-9):
            break
        wanted = done + (whole - done) / left
        free = np.flatnonzero((at > done + LEAST_SEGMENT) & (at <= done + axis.rules.segment))
        done = float(at[free[np.argmin(np.round(np.abs(at[free] - wanted), 6))]]) if len(free) else wanted
        bounds.append(float(np.interp(done, true, fine)))
    return np.array([*bounds, end])


def _widest(places: Floats, length: float) -> float:
    """Middle of the widest gap between places around a closed piece, m."""
    if len(places) < 2:
        return 0.0
    gaps = np.diff(np.append(places, places[0] + length))
    k = int(np.argmax(np.round(gaps, 6)))
    return float(places[k] + gaps[k] / 2)


def _segment(axis: BeamAxis, low: float, high: float, mitred: tuple[bool, bool], axes: tuple[BeamAxis, ...]) -> Item:
    """One segment in axes of its own: x along it in its middle, y along the surface's normal there."""
    curve = axis.piece.frames(np.linspace(low, high, 257))
    middle = curve.beside(axis.distance)
    length = float(np.linalg.norm(np.diff(middle, axis=0), axis=1).sum())
    kn, kg, tg = _bend(middle, curve.up)
    bend = np.hypot(kn, kg)
    pieces = int(np.clip(np.ceil(length * np.sqrt(bend.max() / (8 * SAG))), 1, PIECES_MAX))
    if not axis.beam.round:
        # two triangles on a twisted face leave it by tg h step / 4
        twisted = np.abs(tg).max() * axis.beam.height * length / (4 * TWIST_SAG)
        pieces = int(np.clip(np.ceil(twisted), pieces, PIECES_MAX))
    frames = axis.piece.frames(np.linspace(low, high, pieces + 1))
    points = frames.beside(axis.distance)
    cuts = _cuts(axis, frames.ahead, mitred, axes)
    here = axis.piece.frames(np.array([(low + high) / 2]))
    origin = here.beside(axis.distance)[0]
    own = np.stack([here.ahead[0], here.up[0], here.out[0]])
    shape = Sweep(
        axis.beam.outline,
        (points - origin) @ own.T,
        frames.up @ own.T,
        axis.beam.holes,
        None if cuts is None else cuts @ own.T,
    )
    label = f"{axis.label}, {round(MM * low)} to {round(MM * high)} mm"
    places = Places(origin[None], own[None], (label,))
    text = f"{axis.beam.name}, {MM * shape.length:.1f} mm, {_bent_to(axis, kn, kg, tg)}"
    rules = axis.rules
    pattern = None
    if not axis.beam.round and np.abs(kn).max() >= STRAIGHT:
        pattern = bar_pattern(middle, curve.up, kn, axis.beam.height, 2 * axis.beam.reach, cuts)
    return Item(
        "edge",
        "edge_beam",
        text,
        rules.material,
        rules.density,
        (shape,),
        places,
        plate=pattern is not None,
        length=shape.length,
        pattern=pattern,
    )


def _bend(points: Floats, up: Floats) -> tuple[Floats, Floats, Floats]:
    """kn, kg and tg of an axis with points and normals (k, 3), at its inner points, 1/m."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)[:, None]
    ahead = np.diff(points, axis=0) / step
    half = (step[1:] + step[:-1]) / 2
    turn = (ahead[1:] - ahead[:-1]) / half
    # beside a rim along which the surface twists the axis is not square to the rim's normals
    along = np.concatenate([ahead[:1], ahead[1:] + ahead[:-1], ahead[-1:]])
    along /= np.linalg.norm(along, axis=1)[:, None]
    square = up - np.einsum("ij,ij->i", up, along)[:, None] * along
    square /= np.linalg.norm(square, axis=1)[:, None]
    normal = square[1:-1]
    out = np.cross(along[1:-1], normal)
    twist = (square[2:] - square[:-2]) / (2 * half)
    return tuple(np.einsum("ij,ij->i", one, two) for one, two in ((turn, normal), (-turn, out), (twist, out)))


def _bent_to(axis: BeamAxis, kn: Floats, kg: Floats, tg: Floats) -> str:
    """What the workshop has to know of a segment's shape."""
    if axis.beam.round:
        bend = np.hypot(kn, kg)
        return _radius(bend)
    parts = [_radius(np.abs(kg)) + " about its weak axis", "cut " + _radius(np.abs(kn))]
    turn = np.degrees(np.abs(tg).max())
    return ", ".join(parts) + (f", twisted by up to {turn:.3g} deg/m" if turn > 0.05 else ", not twisted")


def _radius(bend: Floats) -> str:
    if bend.max() < STRAIGHT:
        return "straight"
    least, most = MM / bend.max(), MM / max(bend.min(), STRAIGHT)
    return f"radius {least:.0f} mm" if most < 1.01 * least else f"radius {least:.0f} mm or more"


def _cuts(axis: BeamAxis, ahead: Floats, mitred: tuple[bool, bool], axes: tuple[BeamAxis, ...]) -> Floats | None:
    """Planes of mitres at the ends of a segment."""
    if not any(mitred):
        return None
    cuts = ahead[[0, -1]].copy()
    for side, (here, step) in enumerate(zip(mitred, (-1, 1), strict=True)):
        other = beside(axis, axes, step) if here else None
        if other is None:
            continue
        at = np.array([other.piece.length if step < 0 else 0.0])
        both = cuts[side] + other.piece.frames(at).ahead[0]
        size = float(np.linalg.norm(both))
        if size > 0.2:
            cuts[side] = both / size
    return cuts
