"""What makes loops no boundary of a surface: sizes, spikes, crossings, each named with its place."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from lamella.base.errors import InputError
from lamella.base.limits import LEAST_LENGTH
from lamella.surface.boundary.crossings import Touch, closest_touch
from lamella.surface.boundary.curve import Loop, Slide, place
from lamella.surface.boundary.knots import is_knotted

MOST_SIZE = 5000.0
"""m. No gridshell is that large, a drawing in millimetres is."""

SIZE_RATIO_MAX = 1e4
"""Size of the largest loop over that of the smallest: beyond it one is a slip of the unit or of the decimal point."""

DISTANCE_MIN = 1e-6
"""Of a loop's size: places nearer than this touch."""

LEAST_CORNER = 1.0
"""Degrees between the two sides of a corner; below it the surface there is a thread."""

LEAST_TURN = 1e-3
"""Radians; a boundary that turns by less has no corner there that needs elements of its own."""

NODES_PER_CORNER = 500, 2500
"""Nodes that a film has around a corner to be known to a tolerance of `CORNER_TOLERANCE`: no fewer, and about no more.

Measured on ellipses drawn as polygons and zigzags of 12 to 50 corners, which turn by 7 to 80 degrees: 1,500 to 2,700.
"""

CORNER_TOLERANCE = 2e-2

FEW_CORNERS = 100
"""A film of no more is looked for with any number of nodes: it fails soon where these are few."""

LITTLE_TURN = 20.0
"""Degrees; corners of polygons that are meant turn by more, and steps of a curve by less."""

_STRAIGHT = 1e-6
"""Width over length: a loop that is no wider encloses nothing."""

_SAMPLES, _PIECE_SAMPLES = 720, 4


def check_loops(loops: Sequence[Loop]) -> None:
    """Refuse loops that no surface can have as its boundary.

    Parameters
    ----------
    loops : sequence of Loop
        The outer one first.

    Raises
    ------
    InputError
        What is wrong, with the place; `where` is the number of the loop, "loops[1]".
    """
    for k, loop in enumerate(loops):
        where = _key(k)
        _check_size(loop, where)
        _check_straight(loop, where)
        _check_corners(loop, where)
        for slide in loop.slides:
            _check_slide(loop, slide, where)
    sizes = np.array([loop.size for loop in loops])
    small = int(np.argmin(sizes))
    if sizes.max() > SIZE_RATIO_MAX * sizes[small]:
        large = loops[int(np.argmax(sizes))]
        raise InputError(
            f"the loop {loops[small].name!r} is {sizes[small]:.4g} m large and {large.name!r} {sizes.max():.4g} m: "
            f"over {SIZE_RATIO_MAX:,.0f} times as large",
            "check the unit and the decimal points of both",
            _key(small),
        )
    touch = closest_touch(loops, DISTANCE_MIN)
    if touch:
        raise _touching(loops, touch)
    if len(loops) == 1 and is_knotted(loops[0]):
        raise InputError(
            f"the loop {loops[0].name!r} is knotted: no surface without holes that does not cross itself spans a knot",
            "undo the knot: let the curve pass over itself where it passes below, or draw it without the crossing",
            _key(0),
        )


def check_corner_count(loops: Sequence[Loop], most_nodes: int, tolerance: float) -> None:
    """Refuse more corners than a number of nodes has elements for, before a film is looked for.

    Parameters
    ----------
    loops : sequence of Loop
    most_nodes : int
        Of the film.
    tolerance : float
        Of its curvature, over the curvature scale; nothing is known of the nodes of larger ones than
        `CORNER_TOLERANCE`.

    Raises
    ------
    InputError
    """
    turning = [loop.turns[loop.turns > LEAST_TURN] for loop in loops]
    counts = [len(turns) for turns in turning]
    fewest, usual = NODES_PER_CORNER
    if tolerance > CORNER_TOLERANCE or sum(counts) <= max(FEW_CORNERS, most_nodes // fewest):
        return
    k = int(np.argmax(counts))
    spline = 'write interpolation = "spline", which makes a smooth curve of its points'
    turn = float(np.degrees(np.median(turning[k])))
    keep = f"keep at most {max(most_nodes // usual, 3):,} of its corners; or, where its points mean a curve, {spline}"
    raise InputError(
        f"the boundary has {sum(counts):,} corners, {counts[k]:,} of them in the loop {loops[k].name!r}, half of which "
        f"turn by {turn:.2g} deg or more: a film needs {fewest:,} nodes around each at least, and "
        f"most_nodes = {most_nodes:,} leave that for {most_nodes // fewest:,}",
        spline if turn < LITTLE_TURN else keep,
        _key(k),
    )


def _key(k: int) -> str:
    return f"loops[{k}]"


def _check_size(loop: Loop, where: str) -> None:
    if loop.size < LEAST_LENGTH:
        raise InputError(
            f"the loop {loop.name!r} is only {loop.size:.4g} m large (limit {LEAST_LENGTH:g} m)",
            "lengths are in metres",
            where,
        )
    if loop.size > MOST_SIZE:
        raise InputError(
            f"the loop {loop.name!r} is {loop.size:,.0f} m large (limit {MOST_SIZE:,.0f} m): this looks like "
            "millimetres",
            'lengths are in metres: divide these by 1000; for a file write its unit, unit = "mm"',
            where,
        )


def _check_straight(loop: Loop, where: str) -> None:
    pieces = loop.course.pieces
    # evenly in each piece's own parameter, both ends included: what is straight is straight anywhere
    s = np.linspace(0, 1, max(-(-_SAMPLES // pieces.count), _PIECE_SAMPLES))
    points = pieces.evaluate(np.repeat(np.arange(pieces.count), len(s)), np.tile(s, pieces.count))[0]
    points = points - points.mean(axis=0)
    length, width, _ = np.linalg.svd(points, compute_uv=False)
    if width <= _STRAIGHT * length:
        raise InputError(
            f"the loop {loop.name!r} is a straight line there and back: it encloses nothing",
            "move at least one point off the line",
            where,
        )


def _check_corners(loop: Loop, where: str) -> None:
    between = 180 - np.degrees(loop.turns)
    sharp = np.flatnonzero(between < LEAST_CORNER)
    if len(sharp):
        t = loop.corners[sharp[0]]
        raise InputError(
            f"the loop {loop.name!r} has a spike at {place(loop.at(t))}, {t * loop.length:.4g} m along it: it turns "
            f"back by {180 - between[sharp[0]]:.4g} deg, which leaves {between[sharp[0]]:.2g} deg between its sides "
            f"(limit {LEAST_CORNER:g} deg)",
            "take the point at the spike out, or move it",
            where,
        )


def _check_slide(loop: Loop, slide: Slide, where: str) -> None:
    t = slide.start + (slide.end - slide.start) * (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    points = loop.at(t)
    if slide.point is not None and slide.normal is not None:
        height = np.abs((points - slide.point) @ slide.normal)
        k = int(np.argmax(height))
        if height[k] > DISTANCE_MIN * loop.size:
            raise InputError(
                f"the loop {loop.name!r} slides on a plane but leaves it: at {place(points[k])}, "
                f"{t[k] % 1 * loop.length:.4g} m along it, it is {height[k]:.4g} m away",
                "lay the points of the sliding part on the plane, or move the plane to them",
                f"{where}.slide" if len(loop.slides) == 1 and slide.end - slide.start == 1 else where,
            )
    if slide.direction is not None:
        across = np.linalg.norm(np.cross(loop.tangent(t), slide.direction), axis=1)
        k = int(np.argmin(across))
        if across[k] < math.sin(math.radians(LEAST_CORNER)):
            raise InputError(
                f"the loop {loop.name!r} runs along its own direction of sliding at {place(points[k])}, "
                f"{t[k] % 1 * loop.length:.4g} m along it",
                "choose a direction across the curve: that of the wall above it",
                where,
            )


def _touching(loops: Sequence[Loop], touch: Touch) -> InputError:
    first, second = (loops[k] for k in touch.loops)
    at, (one, other) = place(touch.points[0]), np.round(touch.arcs, 9)
    if first is second:
        message = (
            f"the loop {first.name!r} crosses or touches itself at {at}: {one:.4g} m and {other:.4g} m along it "
            f"(of {first.length:.4g} m)"
        )
        remedy = "move the points there, or leave some out"
    else:
        message = (
            f"the loops {first.name!r} and {second.name!r} cross or touch each other at {at}: {one:.4g} m along the "
            f"first, {other:.4g} m along the second"
        )
        remedy = "move one of them; loops have to keep apart"
    return InputError(message, remedy, _key(max(touch.loops)))
