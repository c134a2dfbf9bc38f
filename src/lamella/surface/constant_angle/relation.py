"""What makes lamellas of one normal curvature cross at one angle.

A line at the angle phi to the first principal direction has the normal curvature A k1 + B k2, A = cos^2 phi and
B = sin^2 phi (Euler). Where that is a constant c, two families of lines of normal curvature c cross at 2 phi, bisected
by the first principal direction: a linear Weingarten surface. With D = (k1 - k2) / 2 it reads

    H + cos(2 phi) D = c,

which for 90 degrees is a surface of constant mean curvature. Points with k1 = k2 have both equal to c: where c = 0 the
surface has no umbilics but flat points.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.limits import LARGEST_NODE_ANGLE, LEAST_NODE_ANGLE


@dataclass(frozen=True)
class Relation:
    """A k1 + B k2 = c.

    Attributes
    ----------
    angle : float
        2 phi, between the lamellas, degrees.
    normal_curvature : float
        c, 1/m.
    """

    angle: float
    normal_curvature: float

    def __post_init__(self) -> None:
        if not LEAST_NODE_ANGLE <= self.angle <= LARGEST_NODE_ANGLE:
            raise InputError(
                f"angle = {self.angle:g} deg is out of range: has to be from {LEAST_NODE_ANGLE:g} to "
                f"{LARGEST_NODE_ANGLE:g}",
                "write an angle in that range, 90 for a surface of constant mean curvature",
                "angle",
            )

    @cached_property
    def cosine(self) -> float:
        """cos 2 phi; 0 at 90 degrees."""
        return 0.0 if self.angle == 90 else float(np.cos(np.radians(self.angle)))

    def mean_curvature(self, deviator: Floats) -> Floats:
        """H where the size of the trace-free shape operator is D, 1/m each, of any shape."""
        return self.normal_curvature - self.cosine * deviator

    def between(self, share: float, start: Relation) -> Relation:
        """What lies on the way from another one: a share of it in the angle and in c."""
        return Relation(
            start.angle + share * (self.angle - start.angle),
            start.normal_curvature + share * (self.normal_curvature - start.normal_curvature),
        )
