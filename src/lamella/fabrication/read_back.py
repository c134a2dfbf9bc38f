"""Reading a drawing back: where its slots and node marks are along each centre line."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.axis import QUARTER, Axis
from lamella.files.write.dxf_text import APPLICATION

# what the bulge of a quarter of a circle is known to
QUARTER_GRAIN = 1e-6
# sine of the turn at a corner: edges that go over into each other do not turn at all
SHARP_CORNER = 0.5


@dataclass(frozen=True)
class SlotReadBack:
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
        Of the centre line, 1/mm, > 0 where it bends towards the +n side; the mean where it varies.
    outline : (v, 3)
        x, y (mm) and bulge.
    holes : (b, 3)
        Distance along the centre line, height over it and diameter of round holes, mm.
    corners : (2, 2)
        Of the start and of the end the distances along the centre line of the corners at the -n and at the +n edge,
        mm; equal but where it is cut obliquely.
    """

    slots: Floats
    marks: Floats
    length: float
    height: float
    curvature: float
    outline: Floats
    holes: Floats
    corners: Floats


def read_slots(path: Path) -> dict[str, SlotReadBack]:
    """Measure the parts of a drawing that `write_drawings` wrote.

    Only the order of an outline's vertices is taken for granted: the first is the start's corner on the -n
    side, and they run counter-clockwise.

    Parameters
    ----------
    path : Path
        ``A.dxf``, ``B.dxf`` or ``sheets.dxf``.

    Returns
    -------
    dict of str to SlotReadBack
        By part id; the second and further copies of a part on the sheets are told as "A1#2", "A1#3", ...
    """
    outlines: dict[str, Floats] = {}
    circles: dict[str, list[Floats]] = defaultdict(list)
    lines: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for entity in ezdxf.readfile(str(path)).modelspace():
        layer = entity.dxf.layer
        if layer == "CUT":
            points = np.array(entity.get_points("xyb"), float)
            # two half circles are a hole
            if len(points) == 2:
                circles[_name(entity)].append(points)
            else:
                outlines[_name(entity)] = points
        elif layer == "MARK" and entity.dxftype() == "LINE":
            middle = 0.5 * (entity.dxf.start + entity.dxf.end)
            lines[_name(entity)].append((middle.x, middle.y))
    return {name: _measure(outline, lines[name], circles[name]) for name, outline in outlines.items()}


def _name(entity: ezdxf.entities.DXFGraphic) -> str:
    """Part id and copy from an entity's extended data."""
    tags = {tag.code: tag.value for tag in entity.get_xdata(APPLICATION)}
    return str(tags[1000]) if tags[1071] == 1 else f"{tags[1000]}#{tags[1071]}"


def _measure(outline: Floats, marks: list[tuple[float, float]], circles: list[Floats]) -> SlotReadBack:
    """Stations of an outline's notches, of marks and of holes."""
    measured, outline = outline, _sharp(outline)
    points, bulges = outline[:, :2], outline[:, 2]
    ahead = np.roll(points, -1, axis=0) - points
    behind = np.roll(ahead, 1, axis=0)
    # the turn at each vertex, from the arc that comes to the one that leaves
    leave = np.arctan2(ahead[:, 1], ahead[:, 0]) - 2 * np.arctan(bulges)
    come = np.arctan2(behind[:, 1], behind[:, 0]) + 2 * np.arctan(np.roll(bulges, 1))
    turn = np.sin(leave - come)
    reflex = turn < -SHARP_CORNER
    foot = reflex & np.roll(reflex, -1)
    feet = 0.5 * (points + np.roll(points, -1, axis=0))[foot]
    # on the edge without notches the strip's end is the first corner; notches begin with one and a reflex one
    corners = np.flatnonzero(np.abs(turn) > SHARP_CORNER)
    corners = corners[(corners > 0) & (corners < len(points) - 1)]
    lower = not reflex[corners[0] + 1]
    corner = int(corners[0]) if lower else int(corners[-1]) - 1
    edge = np.arange(corner) if lower else np.arange(len(points) - 2, corner, -1)
    angle = 4 * np.arctan(bulges[edge]) * (1 if lower else -1)
    chord = np.hypot(*ahead[edge].T)
    arc = chord / np.sinc(0.5 * angle / np.pi)
    begin, other = (points[0], points[-1]) if lower else (points[-1], points[0])
    heading = float(leave[0]) if lower else float(come[-1]) + np.pi
    height = abs(_away(other - begin, heading, float(angle[0] / arc[0])))
    # an edge at the height z is shorter than the centre line by z times its turn
    z = -0.5 * height if lower else 0.5 * height
    steps = arc + angle * z
    knots = np.append(0.0, np.cumsum(steps))
    axis = Axis.of(knots, angle / steps)
    # from the axis' own frame into the drawing
    corner_place, far = axis.develop(knots[[0, -1]], z)
    turned = _angle(points[corner if lower else corner + 1] - begin) - _angle(far - corner_place)
    holes = np.array(circles).reshape(-1, 2, 3)[:, :, :2]
    ends = points[[0, -1, corner, corner + 1]]
    places = np.concatenate((ends, feet, np.array(marks).reshape(-1, 2), holes.mean(axis=1)))
    flat = _turned(places - begin, -turned) + corner_place
    stations = axis.stations(flat)
    start, end = float(stations[:2].min()), float(stations[2:4].max())
    stations = stations - start
    first = 4 + len(feet)
    last = first + len(marks)
    bored = _holes(axis, flat[last:], np.linalg.norm(holes[:, 1] - holes[:, 0], axis=1))
    bored[:, 0] -= start
    return SlotReadBack(
        np.sort(stations[4:first]),
        np.sort(stations[first:last]),
        end - start,
        height,
        float(angle.sum() / knots[-1]),
        measured,
        bored,
        stations[:4].reshape(2, 2),
    )


def _away(vector: Floats, heading: float, curvature: float) -> float:
    """Distance to the left of a circle through the origin, with a heading and a curvature there, of a point, signed."""
    ahead = float(vector[0] * np.cos(heading) + vector[1] * np.sin(heading))
    left = float(vector[1] * np.cos(heading) - vector[0] * np.sin(heading))
    square = ahead**2 + left**2
    return float((2 * left - curvature * square) / (1 + np.sqrt(1 + curvature**2 * square - 2 * curvature * left)))


def _sharp(outline: Floats) -> Floats:
    """The outline with the rounded corners of its slots, quarters of circles, drawn out to corners."""
    points, bulges = outline[:, :2], outline[:, 2]
    quarter = np.abs(np.abs(bulges) - QUARTER) < QUARTER_GRAIN
    if not quarter.any():
        return outline
    following = np.roll(points, -1, axis=0)
    half = (following - points) / 2
    # the corner lies beside the chord, on the side of the arc
    aside = np.column_stack([half[:, 1], -half[:, 0]]) * np.sign(bulges)[:, None]
    sharp = np.column_stack([np.where(quarter[:, None], points + half + aside, points), np.where(quarter, 0.0, bulges)])
    return np.asarray(sharp[~np.roll(quarter, 1)])


def _holes(axis: Axis, centres: Floats, diameters: Floats) -> Floats:
    """Station, height and diameter of holes, by their stations, then their heights, (b, 3)."""
    stations = axis.stations(centres)
    away, heading = centres - axis.develop(stations, 0.0), axis.heading(stations)
    holes = np.column_stack([stations, away[:, 1] * np.cos(heading) - away[:, 0] * np.sin(heading), diameters])
    # rounded, so that holes above each other come in the order of their heights
    return np.asarray(holes[np.lexsort((holes[:, 1], np.round(holes[:, 0], 6)))])


def _angle(vector: Floats) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def _turned(points: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]))
