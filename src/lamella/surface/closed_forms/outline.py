"""Where a closed-form surface ends: its piece of the parameter plane zeta = U + i V."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Ring:
    """start <= U <= end, V once around (period 2 pi)."""

    start: float
    end: float


@dataclass(frozen=True)
class Rectangle:
    """0 < width by height, its lower left corner at zeta = corner."""

    corner: complex
    width: float
    height: float


@dataclass(frozen=True)
class Disc:
    """|zeta| <= radius."""

    radius: float


@dataclass(frozen=True)
class Square:
    """Scherk's square |x|, |y| <= extent, in gudermannian parameters |X|, |Y| <= gd^-1(extent)."""

    half_side: float
    """gd^-1(extent)"""


Outline = Ring | Rectangle | Disc | Square
