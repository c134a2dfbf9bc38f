"""Boundary curves from plain numbers: what `lamella.film` is found between."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.base.errors import InputError, require_positive
from lamella.surface.boundary import arcs, splines
from lamella.surface.boundary.curve import Loop, make_loop
from lamella.surface.boundary.joining import join_in_order
from lamella.surface.boundary.pieces import Pieces, lines
from lamella.surface.boundary.point_list import clean_points

UP = (0.0, 0.0, 1.0)


def circle(center: ArrayLike, radius: float, normal: ArrayLike = UP, *, name: str = "") -> Loop:
    """A circle, counter-clockwise seen from the tip of its normal.

    Parameters
    ----------
    center : (3,)
        m.
    radius : float
        m.
    normal : (3,)
        Of any length.
    name : str
        What messages and files call it.

    Raises
    ------
    InputError
        A radius that is not above 0, or a normal without length.

    Examples
    --------
    >>> import lamella
    >>> lamella.circle((0, 0, 0), 3.0)
    Loop(18.8496 m, 0 corners)
    """
    require_positive(radius=radius)
    axis = _vector("normal", normal)
    if not np.linalg.norm(axis) > 0:
        raise InputError("the normal has no length", "give the direction of the circle's axis", "normal")
    return make_loop(name, arcs.circle(_vector("center", center), radius, axis))


def ellipse(center: ArrayLike, major: ArrayLike, minor: ArrayLike, *, name: str = "") -> Loop:
    """The ellipse center + cos(a) major + sin(a) minor.

    Parameters
    ----------
    center, major, minor : (3,)
        m; the half axes need not be at right angles.
    name : str
        What messages and files call it.

    Examples
    --------
    >>> import lamella
    >>> lamella.ellipse((0, 0, 0), (6, 0, 0), (0, 4.5, 0))
    Loop(33.1552 m, 0 corners)
    """
    half_axes = _vector("major", major), _vector("minor", minor)
    if not np.linalg.norm(np.cross(*half_axes)) > 0:
        raise InputError("the half axes are parallel", "give two that span the ellipse's plane", "minor")
    return make_loop(name, arcs.ellipse_arc(_vector("center", center), *half_axes, 0.0, 2 * np.pi))


def spline(points: ArrayLike, *, name: str = "") -> Loop:
    """A smooth closed curve through points: quintic from seven points on, cubic through fewer.

    Parameters
    ----------
    points : (n, 3)
        m; the last one may repeat the first.
    name : str
        What messages and files call it.

    Raises
    ------
    InputError
        Too few points, the same one twice in a row, or so uneven that the curve would swing out between them.

    Examples
    --------
    >>> import lamella
    >>> lamella.spline([[3, 0, 0.5], [0, 2, -0.5], [-3, 0, 0.5], [0, -2, -0.5]])
    Loop(16.2523 m, 0 corners)
    """
    return make_loop(name, splines.closed_spline(clean_points(points, closed=True, where="points"), where="points"))


def polyline(points: ArrayLike, *, name: str = "") -> Loop:
    """A closed polygon of straight sides, its corners kept; `Loop.rounded` rounds them.

    Parameters
    ----------
    points : (n, 3)
        m; the last one may repeat the first.
    name : str
        What messages and files call it.

    Examples
    --------
    >>> import lamella
    >>> lamella.polyline([[0, 0, 0], [6, 0, 2], [6, 6, 0], [0, 6, 2]])
    Loop(25.2982 m, 4 corners)
    """
    return make_loop(name, lines(clean_points(points, closed=True, where="points"), closed=True))


def arc(start: ArrayLike, middle: ArrayLike, end: ArrayLike) -> Pieces:
    """An open arc of a circle through three points, (3,) each, m: a part for `joined`.

    Raises
    ------
    InputError
        They lie on a line.

    Examples
    --------
    >>> import lamella
    >>> half = lamella.arc((3, 0, 0), (0, 0, 3), (-3, 0, 0))
    >>> lamella.joined([half, [[-3, 0, 0], [3, 0, 0]]])
    Loop(15.4248 m, 2 corners)
    """
    found = arcs.arc_through(_vector("start", start), _vector("middle", middle), _vector("end", end))
    if found is None:
        raise InputError(
            "start, middle and end of the arc lie on a line, or two of them are one", "move the middle", "middle"
        )
    return found


def joined(parts: Sequence[Pieces | ArrayLike], *, name: str = "") -> Loop:
    """A closed curve of parts that follow each other, the first one behind the last.

    Parameters
    ----------
    parts : sequence
        Arcs (`lamella.arc`), and points (n, 3) in m of straight lines from one to the next.
    name : str
        What messages and files call it.

    Raises
    ------
    InputError
        A gap between two parts.

    Examples
    --------
    >>> import lamella
    >>> ends = [lamella.arc((3, y, 0), (0, y, 3), (-3, y, 0)) for y in (0, 8)]
    >>> vault = [ends[0], [(-3, 0, 0), (-3, 8, 0)], ends[1].reversed(), [(3, 8, 0), (3, 0, 0)]]
    >>> lamella.joined(vault)
    Loop(34.8496 m, 4 corners)
    """
    pieces = [
        part if isinstance(part, Pieces) else lines(clean_points(part, closed=False, where=f"parts[{k}]"), closed=False)
        for k, part in enumerate(parts)
    ]
    if not pieces:
        raise InputError("there are no parts", "give arcs and lists of points", "parts")
    return make_loop(name, join_in_order(pieces, [f"parts[{k}]" for k in range(len(pieces))], "parts"))


def as_loop(curve: Loop | ArrayLike) -> Loop:
    """A loop as it is, or the spline through points (n, 3)."""
    return curve if isinstance(curve, Loop) else spline(curve)


def _vector(name: str, value: ArrayLike) -> Floats:
    vector = np.asarray(value, float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f"{name} = {value!r}", "three finite numbers are expected", name)
    return vector
