"""Shapes of hardware: prisms along a local z axis, whose outlines are straight lines and arcs.

An outline is a closed polyline (v, 3) of x, y in m and the bulge of the segment to the next vertex (the tangent of a
quarter of the arc's angle, as in DXF), counter-clockwise; so are the outlines of holes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.fabrication.flat import circle, outline_area

__all__ = ["Bent", "Prism", "Sweep", "circle", "crossed", "hexagon", "polygon", "rectangle", "rhombus", "slot"]


@dataclass(frozen=True, eq=False)
class Prism:
    """A plate or a bar between two heights.

    Attributes
    ----------
    outline : (v, 3)
    low, high : float
        Its lower and its upper end on the local z axis, m.
    holes : tuple of (w, 3)
        Outlines of what is cut out.
    """

    outline: Floats
    low: float
    high: float
    holes: tuple[Floats, ...] = ()

    @property
    def area(self) -> float:
        """Of the cross section, m2."""
        return outline_area(self.outline) - sum(outline_area(hole) for hole in self.holes)

    @property
    def volume(self) -> float:
        """m3."""
        return self.area * (self.high - self.low)


@dataclass(frozen=True, eq=False)
class Sweep:
    """A bar of one cross section along a polyline; in its corners it is mitred.

    Attributes
    ----------
    outline : (v, 3)
        Cross section: x to the left of the polyline, y along `up`.
    points : (k, 3)
        Of the polyline, m; equal at both ends where it closes.
    up : (k, 3)
        Where the cross section's y points, about.
    holes : tuple of (w, 3)
        Outlines of what is hollow.
    cuts : (2, 3), optional
        Normals of the planes that cut its start and its end; perpendicular to it where they are not given. Cut through
        the axis, it keeps its volume.
    """

    outline: Floats
    points: Floats
    up: Floats
    holes: tuple[Floats, ...] = ()
    cuts: Floats | None = None

    @property
    def closed(self) -> bool:
        """Whether it comes back to its first point."""
        return bool(np.array_equal(self.points[0], self.points[-1]))

    @property
    def area(self) -> float:
        """Of the cross section, m2."""
        return outline_area(self.outline) - sum(outline_area(hole) for hole in self.holes)

    @property
    def length(self) -> float:
        """Of the polyline, m."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    @property
    def volume(self) -> float:
        """m3."""
        return self.area * self.length


@dataclass(frozen=True, eq=False)
class Bent:
    """A plate in its place, bent and twisted.

    Attributes
    ----------
    rings : tuple of (n, 2)
        Corners of its flat outline, counter-clockwise, and of its holes, clockwise; their heights are scaled down,
        so that triangles between them are short along the strip.
    low, high : (v, 3)
        Where the corners, one ring after the other, lie on either face, m; seen from `high` it is not mirrored.
    """

    rings: tuple[Floats, ...]
    low: Floats
    high: Floats


def polygon(points: ArrayLike) -> Floats:
    """Outline of straight lines through points (v, 2), m."""
    corners = np.asarray(points, float)
    return np.column_stack([corners, np.zeros(len(corners))])


def rectangle(length: float, width: float, centre: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Outline of a rectangle along x, m."""
    half = np.array([[-length, -width], [length, -width], [length, width], [-length, width]]) / 2
    return polygon(half + centre)


def slot(length: float, width: float, centre: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Outline of an elongated hole along x with round ends, m; `length` from end to end."""
    x, y = centre
    reach = max(length - width, 0.0) / 2
    if reach == 0.0:
        return circle(width, centre)
    return np.array(
        [
            [x - reach, y - width / 2, 0.0],
            [x + reach, y - width / 2, 1.0],
            [x + reach, y + width / 2, 0.0],
            [x - reach, y + width / 2, 1.0],
        ]
    )


def hexagon(across_flats: float) -> Floats:
    """Outline of a nut, m."""
    angles = np.arange(6) * np.pi / 3 + np.pi / 6
    return polygon(across_flats / np.sqrt(3) * np.column_stack([np.cos(angles), np.sin(angles)]))


def crossed(half_length: float, half_width: float, angle: float) -> Floats:
    """Outline of two bars of equal width that cross, m.

    Parameters
    ----------
    half_length, half_width : float
        From the crossing to a bar's end, and half of what it is wide.
    angle : float
        From the first bar, which lies along x, to the second one, rad, 0 to pi.

    Returns
    -------
    (12, 3) array
    """
    first = np.array([1.0, 0.0])
    second = np.array([np.cos(angle), np.sin(angle)])
    rays = [first, second, -first, -second]
    corners = []
    for ray, following in zip(rays, [*rays[1:], rays[0]], strict=True):
        left = np.array([-ray[1], ray[0]])
        corners += [half_length * ray - half_width * left, half_length * ray + half_width * left]
        # where the left side of this ray meets the right side of the next one
        turn = np.arctan2(ray[0] * following[1] - ray[1] * following[0], ray @ following)
        corners.append(half_width * (left + ray / np.tan(turn / 2)) if turn else half_width * left)
    return polygon(corners)


def rhombus(half_width: float, angle: float) -> Floats:
    """Outline of what two crossing bars of a half width have in common, m; `angle` as in `crossed`."""
    along = half_width / np.sin(angle)
    first, second = np.array([1.0, 0.0]), np.array([np.cos(angle), np.sin(angle)])
    return polygon(
        [
            -along * first - along * second,
            along * first - along * second,
            along * first + along * second,
            along * second - along * first,
        ]
    )
