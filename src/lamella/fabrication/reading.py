"""Reading a drawing back: where its slots and node marks are along each centre line."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import numpy as np
from numpy.typing import NDArray

from lamella.fabrication.dxf_text import APPLICATION

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SlotReading:
    """What a drawing says of one part, measured on its outline alone.

    Attributes
    ----------
    slots : (k,)
        Ascending distances of the slots' feet from the strip's start along the centre line, mm.
    marks : (n,)
        Ascending distances of the node centre lines, mm.
    length : float
        Of the centre line, mm.
    height : float
        mm.
    curvature : float
        Of the centre line, 1/mm, > 0 where it bends towards the +n side.
    outline : (v, 3)
        x, y (mm) and bulge.
    """

    slots: Floats
    marks: Floats
    length: float
    height: float
    curvature: float
    outline: Floats


def read_slots(path: Path) -> dict[str, SlotReading]:
    """Measure the parts of a drawing that `write_drawings` wrote.

    Only the order of an outline's vertices is taken for granted: the first is the start's corner on the -n
    side, and they run counter-clockwise.

    Parameters
    ----------
    path : Path
        ``A.dxf``, ``B.dxf`` or ``sheets.dxf``.

    Returns
    -------
    dict of str to SlotReading
        By part id; the second and further copies of a part on the sheets are told as "A1#2", "A1#3", ...
    """
    outlines: dict[str, Floats] = {}
    lines: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for entity in ezdxf.readfile(str(path)).modelspace():
        layer = entity.dxf.layer
        if layer == "CUT":
            outlines[_name(entity)] = np.array(entity.get_points("xyb"), float)
        elif layer == "MARK" and entity.dxftype() == "LINE":
            middle = 0.5 * (entity.dxf.start + entity.dxf.end)
            lines[_name(entity)].append((middle.x, middle.y))
    return {name: _measure(outline, lines[name]) for name, outline in outlines.items()}


def _name(entity: ezdxf.entities.DXFGraphic) -> str:
    """Part id and copy from an entity's extended data."""
    tags = {tag.code: tag.value for tag in entity.get_xdata(APPLICATION)}
    return str(tags[1000]) if tags[1071] == 1 else f"{tags[1000]}#{tags[1071]}"


def _measure(outline: Floats, marks: list[tuple[float, float]]) -> SlotReading:
    """Stations of an outline's notches and of marks."""
    points, bulges = outline[:, :2], outline[:, 2]
    ahead = np.roll(points, -1, axis=0) - points
    behind = np.roll(ahead, 1, axis=0)
    straight = bulges == 0.0
    turn = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    reflex = (turn < 0) & straight & np.roll(straight, 1)
    foot = reflex & np.roll(reflex, -1)
    feet = 0.5 * (points + np.roll(points, -1, axis=0))[foot]
    start, height = 0.5 * (points[0] + points[-1]), float(np.hypot(*(points[-1] - points[0])))
    corner = _end_corner(points, straight, height)
    end = 0.5 * (points[corner] + points[corner + 1])
    places = np.concatenate((feet, np.array(marks).reshape(-1, 2), end[None]))
    if np.all(straight):
        along = end - start
        stations, curvature = (places - start) @ along / np.hypot(*along), 0.0
    else:
        longest = int(np.argmax(np.abs(bulges)))
        b, (dx, dy) = bulges[longest], ahead[longest]
        centre = 0.5 * (2 * points[longest] + ahead[longest]) + np.array([-dy, dx]) * (1 - b * b) / (4 * b)
        # the lower edge runs from start to end, the upper one backwards
        sign = float(np.sign(b)) * (1.0 if longest <= corner else -1.0)
        radius = sign * float(np.hypot(*(start - centre)))
        first = start - centre
        others = places - centre
        angle = np.arctan2(first[0] * others[:, 1] - first[1] * others[:, 0], others @ first)
        # the end of a strip that turns through more than half a circle comes round from the other side
        angle = np.mod(sign * angle, 2 * np.pi)
        stations, curvature = angle * abs(radius), 1 / radius
    return SlotReading(
        np.sort(stations[: len(feet)]),
        np.sort(stations[len(feet) : -1]),
        float(stations[-1]),
        height,
        curvature,
        outline,
    )


def _end_corner(points: Floats, straight: NDArray[np.bool_], height: float) -> int:
    """Index of the end's -n corner: its edge is straight and as long as the strip is high.

    Slots are on one side only, so one of the edges is a single segment: either the end's corner is the
    second vertex, or it is the last but two.
    """
    size = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    candidates = [1, len(points) - 3]
    error = [abs(size[index] - height) if straight[index] else np.inf for index in candidates]
    return candidates[int(np.argmin(error))]
