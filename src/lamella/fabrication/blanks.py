"""Pieces as they are laid on stock: their extents, turned so that circular ones open upwards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.flat import extents
from lamella.fabrication.part import Part


@dataclass(frozen=True)
class Blank:
    """A piece turned so that it opens upwards: its tips, not its middle, are its highest points.

    Attributes
    ----------
    piece : int
        Its number among all pieces.
    half_width, bow, top, bottom : float
        Half its extent along x, how far its centre line leaves an arc, greatest and least y, m.
    length : float
        Of the centre line, m.
    half_angle : float
        Half of what the centre line turns through, rad.
    radius, height : float
        m; the radius is 0 where it is straight.
    turned : bool
        Whether the part is turned by 180 degrees.
    """

    piece: int
    half_width: float
    bow: float
    top: float
    bottom: float
    length: float
    half_angle: float
    radius: float
    height: float
    turned: bool


def blank_of(part: Part) -> Blank:
    """The blank of a part, its piece's number 0."""
    left, low, right, high = part.bounds
    turned = part.curvature < 0
    if turned:
        low, high = -high, -low
    curvature = abs(part.curvature)
    radius = 1 / curvature if curvature else 0.0
    half_angle = 0.5 * curvature * part.length
    return Blank(0, max(right, -left), part.bow, high, low, part.length, half_angle, radius, part.height, turned)


def plain_blanks(lengths: Floats, height: float, curvature: float, bow: float) -> list[Blank]:
    """Blanks of strips of given lengths (p,), m, on an arc that they leave by `bow` (m) at most."""
    half_widths, rises = extents(lengths, height, curvature)
    bend = abs(curvature)
    radius = 1 / bend if bend else 0.0
    lean = 0.0 if bend else bow
    return [
        Blank(k, half, bow, rise + lean, -0.5 * height - lean, length, 0.5 * bend * length, radius, height, False)
        for k, (length, half, rise) in enumerate(
            zip(np.asarray(lengths).tolist(), half_widths.tolist(), rises.tolist(), strict=True)
        )
    ]


def longest_first(blanks: list[Blank]) -> list[Blank]:
    """The same by length; rounded, so that noise in equal lengths does not reorder pieces."""
    return sorted(blanks, key=lambda blank: (-round(blank.length, 7), blank.piece))
