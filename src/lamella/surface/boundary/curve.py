"""Boundary loops: closed curves by arc length, with their corners and the parts that may slide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.onward import onward
from lamella.base.result import Shown
from lamella.base.wording import counted
from lamella.surface.boundary.arc_length import Course
from lamella.surface.boundary.pieces import Pieces

CORNER_ANGLE = 1e-6
"""Radians. A larger jump of the tangent is a corner.

Every jump counts, however small, because no element may run across one: an edge of length h that does misses the curve
by h angle / 4, and the surface's curvature there by angle / h. Below 1e-6 that is less than the finest tolerance; it is
also what drawings that are rounded to micrometres leave at tangent joints.
"""

CURVATURE_JUMP = 1e-2
"""Over the loop's length. A larger jump of the curvature is a corner, tangent or not: where a line goes over into an
arc the curvature of a film has a logarithm, which no polynomial follows, and no element may run across.
"""

THIRD_JUMP, KNOT_GAP = 1.0, 1 / 30
"""Over the loop's length squared; of its length. A cubic spline's third derivative jumps at its points, by 250 / n over
n of them on a circle, and the curvature of a film with it in all directions: no element should run across either. Knots
that lie closer than the gap jump less, and would ask for more elements than they save.
"""

_COMPARED = 200
"""Places of a loop that are compared with those of another one."""

_STANDSTILL = 1e-9
"""Of a piece's mean speed: a slower end has no tangent."""


@dataclass(frozen=True, eq=False)
class Slide:
    """A part of a loop that is free to slide, on a plane or along lines of one direction.

    Attributes
    ----------
    start, end : float
        Fractions of the loop's length, 0 <= start < 1, start < end <= start + 1; a whole loop: 0 and 1.
    point, normal : (3,) or None
        The plane, m, with its unit normal.
    direction : (3,) or None
        Unit direction of the line every point slides along: the wall above the curve.
    """

    start: float
    end: float
    point: Floats | None = None
    normal: Floats | None = None
    direction: Floats | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Loop(Shown):
    """A closed curve with the fraction t of its arc length as parameter, periodic with period 1.

    Attributes
    ----------
    name : str
    course : Course
        The exact curve.
    corners : (c,)
        t where the tangent jumps by more than `CORNER_ANGLE`, the curvature by more than `CURVATURE_JUMP`, its
        derivative by more than `THIRD_JUMP`, a fillet begins or ends, or a sliding part does; sorted.
    turns : (c,)
        Jump of the tangent at each corner, radians in 0..pi.
    smooth : (c,) bool
        Which corners are none to the eye: at most the curvature's derivative jumps there, and a film's curvature is
        bounded.
    slides : tuple of Slide
    remarks : tuple of Message
        What was done to a curve of a file.

    Examples
    --------
    >>> import lamella
    >>> loop = lamella.circle((0, 0, 0), 2.0)
    >>> loop.at(0.25).round(6) + 0.0
    array([0., 2., 0.])
    >>> print(f"{loop.curvature(0.1):.6f}")
    0.500000
    """

    name: str
    course: Course = field(repr=False)
    corners: Floats
    turns: Floats
    smooth: Booleans
    slides: tuple[Slide, ...] = ()
    remarks: tuple[Message, ...] = ()

    def _line(self) -> str:
        name = f"{self.name}: " if self.name else ""
        return f"{name}{self.length:.6g} m, {counted(int((~self.smooth).sum()), 'corner')}"

    @property
    def length(self) -> float:
        """m."""
        return self.course.length

    @property
    def size(self) -> float:
        """Diagonal of the bounding box of the curve's control points, m."""
        return self.course.pieces.extent

    def _locate(self, t: ArrayLike) -> tuple[Integers, Floats, tuple[int, ...]]:
        fraction = np.asarray(t, float)
        arc = np.mod(fraction, 1.0) * self.length
        return *self.course.locate(arc.ravel()), fraction.shape

    def at(self, t: ArrayLike) -> Floats:
        """Points of the curve.

        Parameters
        ----------
        t : (...)
            Any real fractions of the length.

        Returns
        -------
        (..., 3)
            m.
        """
        piece, s, shape = self._locate(t)
        position = self.course.pieces.evaluate(piece, s)[0] + self.course.origin
        return np.asarray(position.reshape(*shape, 3))

    def tangent(self, t: ArrayLike) -> Floats:
        """Unit tangents (..., 3); at a corner that of the curve behind it."""
        piece, s, shape = self._locate(t)
        return _unit(self.course.pieces.evaluate(piece, s)[1]).reshape(*shape, 3)

    def curvature(self, t: ArrayLike) -> Floats:
        """Curvature of the curve, 1/m, (...), not negative; at a corner that of the curve behind it."""
        piece, s, shape = self._locate(t)
        _, first, second = self.course.pieces.evaluate(piece, s)
        turning = np.linalg.norm(np.cross(first, second), axis=-1)
        return np.asarray((turning / np.linalg.norm(first, axis=-1) ** 3).reshape(shape))

    def reversed(self) -> Loop:
        """The loop run through the other way, from the same first point: `at(t)` is the old `at(-t)`."""
        corners = np.mod(-self.corners, 1.0)
        order = np.argsort(corners)
        slides = []
        for slide in self.slides:
            start = (1.0 - slide.end) % 1.0
            slides.append(replace(slide, start=start, end=start + slide.end - slide.start))
        pieces = self.course.pieces.reversed().transformed(1.0, self.course.origin)
        return Loop(
            self.name,
            Course(pieces),
            corners[order],
            self.turns[order],
            self.smooth[order],
            tuple(slides),
            self.remarks,
        )

    def rounded(self, radius: float) -> Loop:
        """The loop with its corners rounded to a least radius, m; those at the ends of parts that slide stay.

        Examples
        --------
        >>> import lamella
        >>> square = lamella.polyline([[0, 0, 0], [6, 0, 2], [6, 6, 0], [0, 6, 2]])
        >>> square.rounded(0.4)
        Loop(24.3243 m, 0 corners)
        """
        loop: Loop = onward("lamella.surface.boundary.fillets.rounded_loop")(self, radius, "radius")
        return loop

    def sliding(
        self, *, normal: ArrayLike | None = None, point: ArrayLike | None = None, direction: ArrayLike | None = None
    ) -> Loop:
        """The loop free to slide: on a plane, which the surface then meets at 90 degrees, or along lines.

        Parameters
        ----------
        normal, point : (3,), optional
            Of the plane; through the loop's first point when no point is given, m.
        direction : (3,), optional
            Of the lines, instead.

        Examples
        --------
        >>> import lamella
        >>> lamella.circle((0, 0, 0), 3.0).sliding(normal=(0, 0, 1)).slides[0].normal
        array([0., 0., 1.])
        """
        if (normal is None) == (direction is None):
            raise InputError(
                "a loop slides on a plane or along lines", "give a normal (and a point), or a direction", "normal"
            )

        def unit(vector: ArrayLike | None) -> Floats | None:
            return None if vector is None else _unit(np.asarray(vector, float))

        on = None if normal is None else np.asarray(self.at(0.0) if point is None else point, float)
        return replace(self, slides=(Slide(0.0, 1.0, on, unit(normal), unit(direction)),))

    def scaled(self, factor: float, shift: ArrayLike = (0.0, 0.0, 0.0)) -> Loop:
        """The loop of the points factor x + shift, factor > 0, shift (3,) in m."""
        if not factor > 0:
            raise ValueError(f"factor = {factor!r} has to be above 0")
        move = np.asarray(shift, float)
        pieces = self.course.pieces.transformed(factor, factor * self.course.origin + move)
        slides = tuple(
            replace(slide, point=None if slide.point is None else factor * slide.point + move) for slide in self.slides
        )
        return replace(self, course=Course(pieces), slides=slides)


@dataclass(frozen=True, eq=False)
class Sliding:
    """A run of pieces of a loop that slides, before the loop's length is known.

    Attributes
    ----------
    first, count : int
        The pieces.
    point, normal, direction : (3,) or None
        As in `Slide`, of any length.
    """

    first: int
    count: int
    point: Floats | None = None
    normal: Floats | None = None
    direction: Floats | None = None


def make_loop(
    name: str,
    pieces: Pieces,
    sliding: Sequence[Sliding] = (),
    *,
    remarks: tuple[Message, ...] = (),
    drawn: Booleans | None = None,
    kept: Booleans | None = None,
    where: str = "",
) -> Loop:
    """A loop from pieces that join end to end, the last one with the first.

    Parameters
    ----------
    name : str
    pieces : Pieces
        m.
    sliding : sequence of Sliding, optional
    remarks : tuple of Message, optional
        What was done to the curve.
    drawn : (m,) bool, optional
        Which pieces begin at a knot of the curve as it was drawn, where only some do.
    kept : (m,) bool, optional
        Which pieces no element runs into from the one before, however smooth the curve: smooth corners at least.
    where : str, optional
        Key for messages.

    Raises
    ------
    InputError
        Numbers that are not finite, no length, or a place where the curve stands still.
    """
    called = f"the loop {name!r}" if name else "the loop"
    if not np.isfinite(pieces.controls).all():
        raise InputError(f"{called} has coordinates that are not finite numbers", "give finite numbers in m", where)
    if not pieces.controls[..., 3].min() > 0:
        raise InputError(
            f"{called} has a weight that is not positive", "rebuild the curve with positive weights", where
        )
    if not pieces.extent > 0:
        raise InputError(f"{called} has no length: all its points are one", "give at least three points", where)
    course = Course(pieces)
    _check_moving(called, course, where)
    m = pieces.count
    one, zero = np.ones(m), np.zeros(m)
    _, behind, bent_behind = course.pieces.evaluate(np.arange(m), zero)
    _, before, bent_before = course.pieces.evaluate(np.arange(m) - 1, one)
    turn = angle_between(_unit(before), _unit(behind))
    jump = np.linalg.norm(_curvature(behind, bent_behind) - _curvature(before, bent_before), axis=1)
    corner = (turn > CORNER_ANGLE) | (jump * course.length > CURVATURE_JUMP)
    joints = np.append(course.joints, course.length) / course.length
    knots = np.ones(m, bool) if drawn is None else drawn
    # from each knot to the next one
    gap = np.zeros(m)
    gap[knots] = np.diff(np.append(joints[:-1][knots], 1.0 + joints[:-1][knots][:1]))
    bend = np.linalg.norm(_curvature_slopes(course, 0.0) - np.roll(_curvature_slopes(course, 1.0), 1, 0), axis=1)
    near = gap.copy()
    near[knots] = np.minimum(gap[knots], np.roll(gap[knots], 1))
    knot = ~corner & (bend * course.length**2 > THIRD_JUMP) & (near > KNOT_GAP)
    if kept is not None:
        knot |= kept
    marks = [(part.first, part.first + part.count) for part in sliding if part.count < m]
    for first, last in marks:
        corner[[first, last % m]] = True
    knot &= ~corner
    every = corner | knot
    slides = tuple(
        Slide(
            float(joints[part.first]),
            float(joints[part.first + part.count]),
            part.point,
            None if part.normal is None else _unit(part.normal),
            None if part.direction is None else _unit(part.direction),
        )
        for part in sliding
    )
    return Loop(name, course, joints[:-1][every], turn[every], knot[every], slides, remarks)


def _check_moving(called: str, course: Course, where: str) -> None:
    """Refuse a curve that stands still: it has no tangent there, and no accurate arc length."""
    piece = np.concatenate([course.cell_piece, course.cell_piece])
    s = np.concatenate([course.cell_start, course.cell_stop])
    position, first, _ = course.pieces.evaluate(piece, s)
    speed = np.linalg.norm(first, axis=-1)
    mean = np.diff(np.append(course.joints, course.length))
    slowest = int(np.argmin(speed / np.maximum(mean[piece], 1e-300)))
    if not speed[slowest] > _STANDSTILL * mean[piece[slowest]]:
        raise InputError(
            f"{called} has a cusp or stacked control points at {place(position[slowest] + course.origin)}: its "
            "parametrisation stands still there",
            "rebuild the curve there, or split it into parts",
            where,
        )


def place(point: Floats) -> str:
    """A point in a message."""
    # nanometres are rounding
    return f"({coordinates(np.round(point, 9) + 0.0, 6)}) m"


def farthest_move(begin: Sequence[Loop], end: Sequence[Loop]) -> float:
    """How far the places at the same parameters of loops are moved at most, m."""
    t = np.arange(_COMPARED) / _COMPARED
    return max(float(np.linalg.norm(new.at(t) - old.at(t), axis=1).max()) for old, new in zip(begin, end, strict=True))


def angle_between(a: Floats, b: Floats) -> Floats:
    """Angles between unit vectors (n, 3), radians in 0..pi, exact for small and for straight angles."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("...i,...i", a, b)))


def _curvature(first: Floats, second: Floats) -> Floats:
    """Curvature vectors (n, 3), 1/m, from derivatives by any parameter."""
    square = (first**2).sum(1)[:, None]
    return np.asarray((second - (second * first).sum(1)[:, None] / square * first) / square)


def _curvature_slopes(course: Course, end: float) -> Floats:
    """Derivatives by the arc length of the curvature vectors at the beginning (0) or end (1) of each piece, 1/m^2."""
    m = course.pieces.count
    # three values inside the piece: exact for a parabola
    step = 1e-4 if end == 0 else -1e-4
    speed = np.linalg.norm(course.pieces.evaluate(np.arange(m), np.full(m, end))[1], axis=1)[:, None]
    at = [course.pieces.evaluate(np.arange(m), np.full(m, end + k * step))[1:] for k in range(3)]
    a, b, c = (_curvature(first, second) for first, second in at)
    slope = (-1.5 * a + 2 * b - 0.5 * c) / step
    return np.asarray(slope / speed)


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
