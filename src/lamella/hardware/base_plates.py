"""Base plates of the edge beams: where a rim lies on the ground its beam stands on horizontal plates with anchors.

A stretch of the rim within `ON_GROUND` of the ground has plates at both its ends and in
between; one that is shorter than a plate has one, at its lowest point. A plate's upper face is at the lowest point of
the beam above it, to which it is welded.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.hardware.axis_ends import BeamAxis
from lamella.hardware.end_plates import CONTACT
from lamella.hardware.item import Item, Places
from lamella.hardware.rules import MM
from lamella.hardware.shape import Prism, circle, rectangle

ON_GROUND = 0.02
"""m; a rim that is as far from the ground is on it."""

GROUND_STEP = 0.01
"""m; between places at which the height of a beam is looked at."""

ANCHOR_HOLE = 1.1
"""Of a hole in a base plate over its anchor's thread."""

ANCHOR_EDGE = 1.5
"""Hole diameters from an anchor's hole to the plate's edge."""


def base_plates(axes: tuple[BeamAxis, ...]) -> list[Item]:
    """Base plates of all beams on the ground, those of equal measures alike."""
    groups: dict[tuple[float, ...], list[tuple[BeamAxis, Floats]]] = {}
    for axis in axes:
        if axis.rules.ground is not None:
            rules = axis.rules
            key = (rules.base_plate, rules.base_plate_thickness, rules.anchor, rules.density)
            groups.setdefault(key, []).append((axis, _places(axis)))
    items: list[Item] = []
    for group in groups.values():
        some = [(axis, along) for axis, along in group if len(along)]
        if some:
            items.append(_item(some, f"base-{len(items) + 1}"))
    return items


def _lowest(axis: BeamAxis, along: Floats) -> Floats:
    """Heights of the beam's lowest points at parameters, m."""
    frames = axis.piece.frames(along)
    middle = frames.beside(axis.distance)
    if axis.beam.round:
        return np.asarray(middle[:, 2] - axis.beam.reach * np.hypot(frames.up[:, 2], frames.out[:, 2]))
    down = axis.beam.height / 2 * np.abs(frames.up[:, 2]) + axis.beam.reach * np.abs(frames.out[:, 2])
    return np.asarray(middle[:, 2] - down)


def _places(axis: BeamAxis) -> Floats:
    """Parameters of the plates' middles, m."""
    rules, piece = axis.rules, axis.piece
    count = int(np.ceil(piece.length / GROUND_STEP)) + 1
    along = np.linspace(0.0, piece.length, count, endpoint=not piece.closed)
    low = _lowest(axis, along)
    on_ground = np.abs(piece.frames(along).points[:, 2] - float(rules.ground or 0.0)) <= ON_GROUND
    found: list[Floats] = []
    for begin, end in _stretches(on_ground, piece.closed):
        index = np.arange(begin, end + 1) % count
        first = along[begin]
        length = float(np.linspace(0, piece.length, count, endpoint=not piece.closed)[1] * (end - begin))
        if length <= 2 * rules.base_plate:
            found.append(along[index[np.argmin(np.round(low[index], 6))]][None])
            continue
        free = length - rules.base_plate
        number = int(np.ceil(free / rules.base_spacing - 1e-9)) + 1
        if end - begin >= count - 1 and piece.closed:
            found.append(first + np.arange(number) * piece.length / number)
        else:
            found.append(first + rules.base_plate / 2 + np.linspace(0.0, free, number))
    return np.concatenate(found) if found else np.empty(0)


def _stretches(mask: Booleans, closed: bool) -> list[tuple[int, int]]:
    """First and last index of every run of True; beyond the end where a closed run goes on at the start."""
    if mask.all():
        return [(0, len(mask) - 1)]
    start = int(np.flatnonzero(~mask)[0]) if closed else 0
    turned = np.roll(mask, -start)
    edges = np.diff(np.concatenate([[False], turned, [False]]).astype(np.int64))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(start + int(a), start + int(b)) for a, b in zip(begins, ends, strict=True)]


def _apart(origins: Floats, side: float) -> Integers:
    """Plates that are clear of those before them: in a corner of the rim two beams stand on one."""
    kept: list[int] = []
    for k in range(len(origins)):
        if all(np.linalg.norm(origins[k] - origins[j]) > side * np.sqrt(2) for j in kept):
            kept.append(k)
    return np.array(kept, np.int64)


def _item(some: list[tuple[BeamAxis, Floats]], name: str) -> Item:
    rules = some[0][0].rules
    hole = ANCHOR_HOLE * rules.anchor
    off = rules.base_plate / 2 - ANCHOR_EDGE * hole
    holes = tuple(circle(hole, (x * off, y * off)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    thickness = rules.base_plate_thickness
    plate = Prism(rectangle(rules.base_plate, rules.base_plate), -thickness, 0.0, holes)
    origins, axes = [], []
    labels: tuple[str, ...] = ()
    for axis, along in some:
        frames = axis.piece.frames(along)
        middle = frames.beside(axis.distance)
        beside = along[:, None] + np.linspace(-0.5, 0.5, 9) * rules.base_plate * np.sqrt(2)
        middle[:, 2] = _lowest(axis, beside.ravel()).reshape(beside.shape).min(axis=1) - CONTACT
        x = frames.ahead * (1.0, 1.0, 0.0)
        size = np.linalg.norm(x, axis=1)[:, None]
        x = np.where(size > 1e-6, x / np.maximum(size, 1e-6), np.array([1.0, 0.0, 0.0]))
        up = np.tile([0.0, 0.0, 1.0], (len(x), 1))
        origins.append(middle)
        axes.append(np.stack([x, np.cross(up, x), up], axis=1))
        labels += tuple(f"{axis.label}, {round(MM * place)} mm" for place in along.tolist())
    places = Places(np.concatenate(origins), np.concatenate(axes), labels)
    places = places.chosen(_apart(places.origins, rules.base_plate))
    side = MM * rules.base_plate
    text = f"base plate {side:g} x {side:g} x {MM * thickness:g} mm, 4 anchors M{MM * rules.anchor:g}"
    return Item(name, "base plate", text, rules.material, rules.density, (plate,), places, plate=True)
