"""Decisions that do not hang on the last bits of the numbers they are made from.

Linear algebra and elementary functions differ by a few units in the last place between processors. Symmetric designs
make exact ties (equal edges, four points on a circle, a vertex half-way between two samples), and a tie that is decided
by such a difference gives another mesh on another machine. So what a mesh is made from is rounded first, to a grid that
is coarse against rounding and fine against any element: equal numbers then are equal on every machine. On that grid
differences and squared distances are exact, as they need less than 53 bits; comparisons of what is not exact are made
with a margin.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers

# differences of angles (rad), and of shapes and lengths in parts of themselves, that decide nothing
MARGIN = 1e-6
# a surface is this many bits larger than the grid its points are rounded to: some 1e-6 of its size
BITS = 20
# bits that are kept of a wanted size, and by which the smallest is larger than the grid for vertices of its elements
SIZE_BITS, VERTEX_BITS = 10, 9
# sizes of common designs are no powers of two times this: the grid would change there by a factor of two
ASIDE = 1.2361


def grid_of(extent: float, bits: int = BITS) -> float:
    """Width of the grid for points of a surface, or an element, of an extent, both m: a power of two."""
    return float(2.0 ** (np.frexp(extent * ASIDE)[1] - bits))


def rounded(values: Floats, grid: float) -> Floats:
    """Values moved to the nearest multiple of a grid."""
    return np.asarray(np.rint(values / grid) * grid)


def shortened(values: Floats, bits: int = BITS) -> Floats:
    """Values rounded to a number of significant bits."""
    mantissa, exponent = np.frexp(values)
    return np.asarray(np.ldexp(np.rint(np.ldexp(mantissa, bits)), exponent - bits))


def nearest_whole(values: Floats) -> Floats:
    """Nearest whole numbers; halves, and what is nearer to them than the margin, go up."""
    return np.asarray(np.floor(values + (0.5 + MARGIN)))


def least_axis(vectors: Floats) -> Integers:
    """Coordinate in which unit vectors (..., 3) are smallest, the first of equal ones, (...)."""
    return np.asarray(np.rint(np.abs(vectors) / MARGIN).argmin(-1))
