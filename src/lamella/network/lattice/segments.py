"""Pieces of lamella between neighbouring stops, on the lattice of a closed form."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.blocks import blocks
from lamella.network.lattice.domain import Domain
from lamella.network.lattice.lattice import Lattice

# parameters at which the speed is taken at a time: temporaries of a whole large net cost more than what is computed
SPEEDS_AT_ONCE = 64_000


class Segments:
    """The pieces of lamella between neighbouring stops, each with a parameter 0 <= sigma <= 1.

    Attributes
    ----------
    owner : (s,) int
        Lamella of each segment.
    first_stop : (s,) int
        The stop it starts from; it ends at the next one.
    span : (s,)
        Length in cells.
    """

    def __init__(self, domain: Domain, lattice: Lattice) -> None:
        self.domain, lines = domain, lattice.lines
        owner = lattice.owner
        first = np.flatnonzero(owner[:-1] == owner[1:])
        self.owner = owner[first]
        self.first_stop = first
        self.sheet = lines.sheet[self.owner]
        self.base, self.direction = lines.base[self.owner], lines.direction[self.owner]
        self.t, self.span = lattice.t[first], lattice.t[first + 1] - lattice.t[first]
        # a ray's first cell is straight in zeta, where the surface is smooth, not in the cell plane
        self.radial = lines.singular[self.owner] & (self.t == 0)

    def where(self, segment: Integers, sigma: Floats) -> tuple[Complexes, Complexes]:
        """Places zeta and d zeta / d sigma at parameters of segments, arrays of equal shape (k,)."""
        radial = self.radial[segment]
        t = self.t[segment] + np.where(radial, 1.0, sigma) * self.span[segment]
        point = self.base[segment] + t * self.direction[segment]
        zeta = self.domain.place(self.sheet[segment], point)
        velocity = self.domain.velocity(self.sheet[segment], point, self.direction[segment])
        derivative = velocity * self.span[segment]
        return np.where(radial, sigma * zeta, zeta), np.where(radial, zeta, derivative)

    def speed(self, segment: Integers, sigma: Floats) -> Floats:
        """Arc length per sigma, m, at parameters (p,) of segments (s,), shape (s, p)."""
        speed = np.empty((len(segment), len(sigma)))
        for block in blocks(len(segment), max(SPEEDS_AT_ONCE // len(sigma), 1)):
            some = segment[block]
            zeta, derivative = self.where(np.repeat(some, len(sigma)), np.tile(sigma, len(some)))
            speed[block] = (self.domain.surface.metric(zeta) * np.abs(derivative)).reshape(-1, len(sigma))
        return speed
