"""Boundary curves by the numbers that make them, which can be changed: points, a circle, a curve and its place."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.errors import InputError
from lamella.base.limits import MOST_MOVE, MOST_SCALE, MOST_TILT
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.curve import Loop, make_loop
from lamella.surface.boundary.fillets import rounded_loop
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.boundary.waves import waved

# points of a loop for its middle
LOOP_SAMPLES = 1000

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Circle:
    """A circle, counter-clockwise about its normal.

    Attributes
    ----------
    center : (x, y, z)
        m.
    radius : float
        m.
    normal : (x, y, z)
    """

    center: Triple
    radius: float
    normal: Triple = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Place:
    """Where a curve is put: turned and scaled about its middle, the centroid of its length, then shifted and waved.

    Attributes
    ----------
    shift : (x, y, z)
        m.
    scale : float
    turn : (x, y, z)
        Along the axis, as long as the angle, degrees.
    waves : tuple of (x, y, z)
        Shifts in waves along the curve, m: an even one, then of cos and sin of 2 pi t, 4 pi t, ...
    """

    shift: Triple = (0.0, 0.0, 0.0)
    scale: float = 1.0
    turn: Triple = (0.0, 0.0, 0.0)
    waves: tuple[Triple, ...] = ()


@dataclass(frozen=True)
class Adjust:
    """How far a curve may be changed; what is 0 is held.

    Attributes
    ----------
    move : float
        Shift of the curve, m.
    scale : float
        Change of size, as a share of it.
    tilt : float
        Turn about any axis, degrees.
    points : float
        Shift of any of its points by all waves along it together, m.
    keep_height : bool
        Shifts in x and y only.

    Raises
    ------
    InputError
        A limit that is out of range.
    """

    move: float = 0.0
    scale: float = 0.0
    tilt: float = 0.0
    points: float = 0.0
    keep_height: bool = False

    def __post_init__(self) -> None:
        for name, most in (("move", MOST_MOVE), ("scale", MOST_SCALE), ("tilt", MOST_TILT), ("points", MOST_MOVE)):
            value = getattr(self, name)
            if not 0 <= value <= most:
                raise InputError(
                    f"{name} = {value:g} is out of range: has to be at least 0 and at most {most:g}",
                    f"write a {name} in this range",
                    name,
                )
        if self.keep_height and (self.scale or self.tilt):
            raise InputError(
                "scale and tilt change heights, which keep_height holds",
                "leave scale and tilt out, or keep_height",
                "keep_height",
            )


@dataclass(frozen=True)
class BoundaryCurve:
    """A closed curve of a boundary: one of points, circle and drawn.

    Attributes
    ----------
    name : str
    points : tuple of (x, y, z), optional
        Of the drawing, m, the first not repeated.
    interpolation : "spline" or "polyline"
        How points are joined.
    circle : Circle, optional
        Of the drawing.
    drawn : Loop, optional
        A curve that is made of anything else, measured from the origin.
    slides : bool
        Whether a part of it slides: such curves are not adjusted.
    place : Place, optional
        Where a circle or a drawn curve is put.
    corner_radius : float, optional
        Of fillets, m.
    adjust : Adjust, optional
        How far the curve may be changed.
    origin : (x, y, z)
        Point of the drawing that the loop is measured from, m.
    """

    name: str
    points: tuple[Triple, ...] | None = None
    interpolation: Literal["spline", "polyline"] = "spline"
    circle: Circle | None = None
    drawn: Loop | None = field(default=None, compare=False)
    slides: bool = False
    place: Place | None = None
    corner_radius: float | None = None
    adjust: Adjust | None = None
    origin: Origin = NOWHERE

    def loop(self, where: str = "") -> Loop:
        """The curve itself, measured from the origin, not checked yet.

        Parameters
        ----------
        where : str, optional
            What the caller calls this curve, for messages.

        Raises
        ------
        InputError
            Points through which no curve can be laid, or fillets for which there is no room.
        """
        loop = self._as_drawn(where)
        if self.place is not None:
            loop = placed(loop, self.place, where)
        if self.corner_radius is not None:
            loop = rounded_loop(loop, self.corner_radius, f"{where}.corner_radius")
        return loop if self.place is None or not self.place.waves else _waved(loop, self.place, where)

    def _as_drawn(self, where: str) -> Loop:
        if self.drawn is not None:
            return self.drawn
        if self.circle is not None:
            ring = self.circle
            center = np.array(ring.center) - np.array(self.origin)
            return make_loop(self.name, circle(center, ring.radius, np.array(ring.normal)), where=where)
        assert self.points is not None
        points = np.array(self.points) - np.array(self.origin)
        given = clean_points(points, closed=True, where=f"{where}.points")
        splined = self.interpolation == "spline"
        pieces = closed_spline(given, where=f"{where}.points") if splined else lines(given, closed=True)
        return make_loop(self.name, pieces, where=where)


def placed(loop: Loop, place: Place, where: str = "") -> Loop:
    """A held loop turned and scaled about the centroid of its length, and shifted."""
    middle = loop.at(np.arange(LOOP_SAMPLES) / LOOP_SAMPLES).mean(0)
    turn = Rotation.from_rotvec(np.radians(place.turn)).as_matrix()
    # the pieces of a course are measured from its origin
    shift = middle + np.array(place.shift) + place.scale * turn @ (loop.course.origin - middle)
    pieces = loop.course.pieces.transformed(place.scale, shift, turn)
    return make_loop(loop.name, pieces, remarks=loop.remarks, where=where)


def _waved(loop: Loop, place: Place, where: str) -> Loop:
    """A held loop shifted in waves along it."""
    pieces, drawn = waved(loop, np.array(place.waves))
    kept = drawn.copy()
    # where elements end stays so, whatever a wave smooths
    kept[drawn] = np.isin(loop.course.joints / loop.length, loop.corners)
    return make_loop(loop.name, pieces, drawn=drawn, kept=kept, remarks=loop.remarks, where=where)
