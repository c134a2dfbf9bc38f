"""What is engraved on a part: its nodes' centre lines, the mark of its start and upper side, its id."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.part import Part
from lamella.fabrication.stroke_font import text_strokes, text_width

# a line this near to an end (m) would burn along the cut
ENGRAVING_NEAR_END = 1e-6


@dataclass(frozen=True)
class Engraving:
    """Lines on a part, in the part's own frame, m.

    Attributes
    ----------
    nodes : (n, 2, 2)
        Node centre lines: two points each.
    arrow : (3, 2)
        Closed triangle near the start, in the +n half, that points to the end.
    strokes : tuple of (k, 2)
        Polylines of the part's label.
    """

    nodes: Floats
    arrow: Floats
    strokes: tuple[Floats, ...]


def engrave(part: Part) -> Engraving:
    """Lay out the engraving of a part so that none of it lies where material is removed."""
    stations = part.nodes[(part.nodes > part.start + ENGRAVING_NEAR_END) & (part.nodes < part.end - ENGRAVING_NEAR_END)]
    side = 0.5 * part.height if part.from_above else -0.5 * part.height
    reach = 0.5 * part.slot_width
    if len(part.slots):
        edge = part.axis.edge_stations(part.slots, side, reach) - part.slots
        reach = max(reach, float(edge.max()))
    marks = (stations, stations)
    cuts = (part.slots - reach, part.slots + reach)
    upper = _gaps(part, (marks, cuts) if part.from_above else (marks,), part.start)
    arrow_at, arrow_size = _room(upper, 0.05 * part.height, 0.25 * part.height)
    arrow = part.place(arrow_at + arrow_size * np.array([0.0, 1.0, 0.0]), part.height * np.array([0.12, 0.245, 0.37]))
    # the half without slots; on B that is the arrow's half too
    begin = part.start if part.from_above else arrow_at + arrow_size
    strokes = _id_strokes(part, _gaps(part, (marks,), begin), begin)
    return Engraving(_node_lines(part, stations, side, reach), arrow, strokes)


def _node_lines(part: Part, stations: Floats, side: float, reach: float) -> Floats:
    """Lines across the strip; from the slot's foot on where a slot takes the rest."""
    from_edge = np.full(len(stations), side)
    if len(part.slots) and len(stations):
        after = np.clip(np.searchsorted(part.slots, stations), 1, max(len(part.slots) - 1, 1))
        after = np.minimum(after, len(part.slots) - 1)
        ahead, behind = part.slots[after] - stations, part.slots[np.maximum(after - 1, 0)] - stations
        nearest = np.where(np.abs(ahead) < np.abs(behind), ahead, behind)
        k = part.axis.curvatures[part.axis.piece(stations)]
        # the foot is straight: off the slot's axis it leaves the circle of the centre line
        sagitta = nearest * np.sinc(0.5 * k * nearest / np.pi) * np.sin(0.5 * k * nearest)
        foot = -sagitta / np.cos(k * nearest) - np.sign(side) * part.slot_play
        from_edge = np.where(np.abs(nearest) <= reach + ENGRAVING_NEAR_END, foot, from_edge)
    ends = np.stack((from_edge, np.full(len(stations), -side)), axis=1)
    return part.place(stations[:, None], ends)


def _gaps(part: Part, obstacles: tuple[tuple[Floats, Floats], ...], begin: float) -> Floats:
    """Free intervals of stations between obstacles, (g, 2)."""
    low = np.concatenate([pair[0] for pair in obstacles])
    high = np.concatenate([pair[1] for pair in obstacles])
    order = np.argsort(low, kind="stable")
    ahead = np.append(low[order], part.end)
    behind = np.maximum.accumulate(np.append(begin, np.maximum(high[order], begin)))
    return np.stack((behind, np.maximum(ahead, behind)), axis=1)


def _room(gaps: Floats, margin: float, wanted: float) -> tuple[float, float]:
    """Where the first gap with room begins, else the widest one, and the length to take there."""
    free = gaps[:, 1] - gaps[:, 0]
    enough = free >= wanted + 2 * margin
    chosen = int(np.argmax(enough)) if enough.any() else int(np.argmax(free))
    margin = min(margin, 0.2 * float(free[chosen]))
    return float(gaps[chosen, 0]) + margin, min(wanted, float(free[chosen]) - 2 * margin)


def _id_strokes(part: Part, gaps: Floats, begin: float) -> tuple[Floats, ...]:
    """The label along the middle of the half without slots."""
    full, least = 0.3 * part.height, 0.08 * part.height
    ratio = text_width(part.label)
    margin = 0.05 * part.height
    at, room = _room(gaps, margin, full * ratio)
    if room < least * ratio:
        # legible across node lines is better than illegible between them
        at, room = _room(np.array([[begin, part.end]]), margin, 2 * least * ratio)
    size = min(full, room / ratio)
    middle = -0.25 * part.height if part.from_above else 0.25 * part.height
    strokes = text_strokes(part.label)
    points = np.concatenate(strokes) if strokes else np.empty((0, 2))
    placed = part.place(at + size * points[:, 0], middle + size * (points[:, 1] - 0.5))
    ends = np.cumsum([len(stroke) for stroke in strokes]).tolist()
    return tuple(placed[end - len(stroke) : end] for stroke, end in zip(strokes, ends, strict=True))
