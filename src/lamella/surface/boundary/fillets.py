"""Corners of a loop rounded by fillets whose curvature rises from that of the one side and falls to that of the other.

Where the curvature of a boundary jumps, as from a line to an arc, the curvature of a film has a logarithm, and where
its derivative jumps, that of the film's curvature has one: a circular fillet trades a corner for two such places. These
fillets are polynomials of degree 7 that meet their sides with position, tangent, curvature and the derivative of the
curvature.

Between straight sides in the direction of a and b that turn by w, with the fillet's ends at the distance d from the
corner, the fillet over u = -1 .. 1 is, along a + b and along b - a,

    p'(u) = d cos(w/2) [m + 35/16 (1 - m) (1 - u^2)^3],    q''(u) = 15/8 d sin(w/2) m (1 - u^2)^2

with the speed m d at its ends. It is tightest in the middle, or nearly so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb, cos, pi, sin, sqrt

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.wording import rounded
from lamella.surface.boundary.curve import Loop, Sliding, make_loop, place
from lamella.surface.boundary.pieces import Pieces, stack

FILLET_DEGREE = 7
FLAT_SPEED = 6 / 7
"""Speed of a fillet at its ends over d, for small turns: the one with the least curvature."""

LEAST_TURN = 2.0 * pi / 180
"""Radians: fillets of smaller turns would be shorter than a hundredth of their radius, and elements with them."""

MOST_TURN = 0.97 * pi
"""Radians: a corner that turns back further is a cusp, and its fillet a hairpin."""

LEFT = 0.02
"""Of a side between two fillets, at least."""

FILLET_NEAR = 0.8
"""Of the given radius: a smaller one is reported."""

FILLET_PLACES = 401
"""Along a fillet, for its least radius."""


@dataclass(frozen=True, eq=False)
class _Corners:
    """Corners that are rounded.

    Attributes
    ----------
    arc : (c,)
        Arc length, m, ascending.
    turn : (c,)
        Radians.
    """

    arc: Floats
    turn: Floats


def rounded_loop(loop: Loop, radius: float, where: str = "") -> Loop:
    """A loop with its corners replaced by fillets; those at the ends of sliding parts stay.

    Parameters
    ----------
    loop : Loop
    radius : float
        Least radius of curvature of a fillet between straight sides, m.
    where : str, optional
        Key for messages.

    Raises
    ------
    InputError
        Two fillets overlap, or a corner turns back.
    """
    found = _corners(loop)
    if not len(found.arc):
        return replace(
            loop,
            remarks=(
                *loop.remarks,
                Message("fillets_none", f"corner_radius has no corner of {np.degrees(LEAST_TURN):g} degrees to round"),
            ),
        )
    reach = radius * np.array([tangent_length(turn) for turn in found.turn.tolist()])
    _refuse_cusps(loop, found, where)
    _refuse_overlaps(loop, found, reach, radius, where)
    pieces, old = _filleted(loop, found, reach)
    fillet = old < 0
    tightest = _least_radius(pieces, np.flatnonzero(fillet))
    remarks = loop.remarks
    if tightest < FILLET_NEAR * radius:
        remarks += (
            Message(
                "fillets_tight",
                f"corner_radius = {radius:g} m: between sides that bend fillets have radii down to {tightest:.3g} m",
            ),
        )
    # elements that begin and end with a fillet: half as many nodes reach the same tolerance
    ends = fillet | np.roll(fillet, 1)
    return make_loop(loop.name, pieces, _sliding(loop, old), remarks=remarks, kept=ends, where=where)


def tangent_length(turn: float) -> float:
    """Distance from the corner at which a fillet of least radius 1 begins, for straight sides that turn, radians."""
    u = np.linspace(0, 1, FILLET_PLACES)
    c, s, m = cos(turn / 2), sin(turn / 2), _speed(turn)
    rest = 1 - u**2
    along, along2 = c * (m + 35 / 16 * (1 - m) * rest**3), -35 * 6 / 16 * c * (1 - m) * u * rest**2
    across, across2 = 15 / 8 * s * m * (u - 2 * u**3 / 3 + u**5 / 5), 15 / 8 * s * m * rest**2
    return float(((along * across2 - across * along2) / np.hypot(along, across) ** 3).max())


def _speed(turn: float) -> float:
    """Speed of a fillet at its ends over the distance of its ends from the corner, near that of least curvature."""
    return FLAT_SPEED * sqrt(cos(turn / 2))


def _corners(loop: Loop) -> _Corners:
    """Corners of a loop that turn, but for those that a sliding part has."""
    held = np.ones(len(loop.corners), bool)
    for slide in loop.slides:
        into = np.mod(loop.corners - slide.start + 1e-9, 1.0)
        held &= into > slide.end - slide.start + 2e-9
    kept = held & (loop.turns > LEAST_TURN)
    return _Corners(loop.corners[kept] * loop.length, loop.turns[kept])


def _refuse_cusps(loop: Loop, found: _Corners, where: str) -> None:
    worst = int(found.turn.argmax())
    if found.turn[worst] > MOST_TURN:
        raise InputError(
            f"the loop {loop.name!r} turns back at {place(loop.at(found.arc[worst] / loop.length))} by "
            f"{np.degrees(found.turn[worst]):.4g} degrees: a fillet there would be a hairpin (limit "
            f"{np.degrees(MOST_TURN):.4g})",
            "open the corner, or leave corner_radius out",
            where,
        )


def _refuse_overlaps(loop: Loop, found: _Corners, reach: Floats, radius: float, where: str) -> None:
    """Refuse fillets that take more than the side between them has."""
    # where a part slides a side ends, without a fillet
    ends = [slide.start * loop.length for slide in loop.slides] + [slide.end * loop.length for slide in loop.slides]
    at = np.append(found.arc, np.mod(ends, loop.length))
    taken = np.append(reach, np.zeros(len(ends)))
    order = np.lexsort((taken, at))
    at, taken = at[order], taken[order]
    side = np.diff(np.append(at, at[0] + loop.length))
    share = (taken + np.roll(taken, -1)) / np.maximum((1 - LEFT) * side, 1e-300)
    # sides between what slides have no fillet
    worst = int(share.argmax())
    if share[worst] <= 1:
        return
    first, second = (place(loop.at(at[(worst + k) % len(at)] / loop.length)) for k in (0, 1))
    most = rounded(radius / float(share[worst]), up=False)
    raise InputError(
        f"corner_radius = {radius:g} m: the side of the loop {loop.name!r} between its corners at {first} and {second} "
        f"is {side[worst]:.4g} m long, and their fillets take {taken[worst]:.4g} + "
        f"{taken[(worst + 1) % len(at)]:.4g} m of it",
        f"write corner_radius = {most:g} or less",
        where,
    )


def _filleted(loop: Loop, found: _Corners, reach: Floats) -> tuple[Pieces, Integers]:
    """Pieces of the rounded loop, and which of the loop's each is of, (m,); -1: a fillet."""
    length = loop.course.length
    starts, stops = found.arc + reach, np.roll(found.arc - reach, -1)
    stops[-1] += length
    sides, names = zip(*(_between(loop, *ends) for ends in zip(starts, stops, strict=True)), strict=True)
    parts: list[Pieces] = []
    old: list[Integers] = []
    for k, (side, name) in enumerate(zip(sides, names, strict=True)):
        following = (k + 1) % len(sides)
        speed = 2 * _speed(float(found.turn[following])) * float(reach[following])
        parts += [side, _fillet(side, sides[following], speed)]
        old += [name, np.array([-1])]
    return stack(parts).transformed(1.0, loop.course.origin), np.concatenate(old)


def _between(loop: Loop, start: float, stop: float) -> tuple[Pieces, Integers]:
    """The loop between two arc lengths, m, about its own origin, and the piece that each part of it is of."""
    course = loop.course
    tiny = 1e-12 * course.length
    joints = np.concatenate([course.joints + turn * course.length for turn in range(3)])
    inner = joints[(joints > start + tiny) & (joints < stop - tiny)]
    ends = np.concatenate([[start], inner, [stop]])
    piece = (np.searchsorted(joints, (ends[:-1] + ends[1:]) / 2, side="right") - 1) % course.pieces.count
    low, high = np.zeros(len(piece)), np.ones(len(piece))
    # a cut next to a joint is at it
    for end, k, values in ((start, 0, low), (stop, -1, high)):
        if np.abs(joints - end).min() > tiny:
            values[k] = course.locate(np.array([end % course.length]))[1][0]
    return course.pieces.cut(piece, low, high), np.asarray(piece)


def _fillet(before: Pieces, behind: Pieces, speed: float) -> Pieces:
    """The polynomial from the end of one side to the start of the next one, `speed` in m over its parameter."""
    start = _at_speed(_jet(before.controls[-1, ::-1]) * np.array([1, -1, 1, -1])[:, None], speed)
    end = _at_speed(_jet(behind.controls[0]), speed) * np.array([1, -1, 1, -1])[:, None]
    falling = np.array(
        [FILLET_DEGREE, FILLET_DEGREE * (FILLET_DEGREE - 1), FILLET_DEGREE * (FILLET_DEGREE - 1) * (FILLET_DEGREE - 2)]
    )
    halves = []
    for jet in (start, end):
        differences = np.concatenate([jet[:1], jet[1:] / falling[:, None]])
        halves.append([sum(comb(k, j) * differences[j] for j in range(k + 1)) for k in range(4)])
    controls = np.ones((1, FILLET_DEGREE + 1, 4))
    controls[0, :, :3] = [*halves[0], *halves[1][::-1]]
    return Pieces(controls)


def _jet(controls: Floats) -> Floats:
    """Position and three derivatives by the parameter at the start of a rational piece (degree + 1, 4): (4, 3)."""
    degree, points = len(controls) - 1, controls
    homogeneous = np.zeros((4, 4))
    factor = 1.0
    for k in range(min(degree, 3) + 1):
        homogeneous[k] = factor * points[0]
        points, factor = np.diff(points, axis=0), factor * (degree - k)
    jet = np.zeros((4, 3))
    # Leibniz's rule for w x
    for k in range(4):
        known = sum((comb(k, j) * homogeneous[j, 3] * jet[k - j] for j in range(1, k + 1)), np.zeros(3))
        jet[k] = (homogeneous[k, :3] - known) / homogeneous[0, 3]
    return jet


def _at_speed(jet: Floats, speed: float) -> Floats:
    """The jet (4, 3) by a parameter along which the curve is run through at an even speed, m."""
    position, first, second, third = jet
    v = np.linalg.norm(first)
    dv = first @ second / v
    ddv = (second @ second + first @ third - dv**2) / v
    # of the old parameter by the new one
    s1 = speed / v
    s2 = -speed * dv * s1 / v**2
    s3 = -speed * (ddv * s1**2 + dv * s2 - 2 * dv**2 * s1**2 / v) / v**2
    return np.stack(
        [position, first * s1, second * s1**2 + first * s2, third * s1**3 + 3 * second * s1 * s2 + first * s3]
    )


def _least_radius(pieces: Pieces, fillets: Integers) -> float:
    """m."""
    which = np.repeat(fillets, FILLET_PLACES)
    _, first, second = pieces.evaluate(which, np.tile(np.linspace(0, 1, FILLET_PLACES), len(fillets)))
    curvature = np.linalg.norm(np.cross(first, second), axis=1) / np.linalg.norm(first, axis=1) ** 3
    return float(1 / curvature.max())


def _sliding(loop: Loop, old: Integers) -> list[Sliding]:
    """The loop's sliding parts by the pieces of the rounded one."""
    joints, count = loop.course.joints / loop.length, len(loop.course.joints)
    result = []
    for slide in loop.slides:
        if slide.end - slide.start == 1:
            first, last = 0, len(old)
        else:
            begin = int(np.abs(joints - slide.start).argmin())
            end = (int(np.abs(np.append(joints, 1.0) - slide.end % 1.0).argmin()) - 1) % count
            first, last = int(np.flatnonzero(old == begin)[0]), int(np.flatnonzero(old == end)[-1]) + 1
        parts = last - first if last > first else last + len(old) - first
        result.append(Sliding(first, parts, slide.point, slide.normal, slide.direction))
    return result
