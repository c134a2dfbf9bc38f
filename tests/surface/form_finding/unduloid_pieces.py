"""Pieces of unduloids between rings: `lamella.surface.closed_forms.delaunay`."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq, fsolve

from lamella.surface.closed_forms.delaunay import Delaunay


class Piece:
    """Of an unduloid, symmetric about its neck or its bulge, between rings of a radius."""

    def __init__(self, neck: float, bulge: float, radius: float, *, about_bulge: bool) -> None:
        self.surface = Delaunay(neck, bulge, 1)
        self.middle = self.surface.period / 2 if about_bulge else 0.0
        lift = self._at(self.middle)[1]
        self._lift = lift
        self.end = brentq(lambda u: self._at(self.middle + u)[0] - radius, 1e-9, self.surface.period / 2)
        u = np.polynomial.legendre.leggauss(60)
        s = self.end * (u[0] + 1) / 2
        p = self.surface.profile(self.middle + s)
        # half of it: integral of pi r^2 dz, with z_U as given by the profile
        self.volume = float(2 * np.pi * (p.r**2 * p.z_u * u[1]).sum() * self.end / 2)
        self.length = 2 * (self._at(self.middle + self.end)[1] - lift)

    def _at(self, u: float):
        p = self.surface.profile(np.array([u]))
        return float(p.r[0]), float(p.z[0])

    def radius_at(self, height):
        """By interpolation of the exact meridian."""
        s = np.linspace(0, self.end, 4001)
        p = self.surface.profile(self.middle + s)
        return np.interp(np.abs(height), p.z - self._lift, p.r)


def unduloid_of_volume(radius: float, length: float, volume: float, *, about_bulge: bool) -> Piece:
    def off(x):
        piece = Piece(float(x[0]), float(x[1]), radius, about_bulge=about_bulge)
        return [piece.length / length - 1, piece.volume / volume - 1]

    part = volume / (np.pi * radius**2 * length)
    guess = (radius * 0.999, radius * part**0.7) if about_bulge else (radius * part**0.7, radius * (2 - part**0.7))
    return Piece(*fsolve(off, guess, xtol=1e-12), radius, about_bulge=about_bulge)
