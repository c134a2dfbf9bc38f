"""The tangent plane at a place of a surface as the complex plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Complexes, Floats
from lamella.surface.element.inverse_map import find_places
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.points import SurfacePoints


@dataclass(frozen=True)
class TangentPlane:
    """The plane at an umbilic as the complex plane; `middles` are those of the surface's elements."""

    places: Places
    at: SurfacePoints
    middles: cKDTree

    @classmethod
    def of(cls, surface: ElementSurface, umbilics: Umbilics) -> list[TangentPlane]:
        """One for each umbilic."""
        middles = cKDTree(surface.nodes[surface.connectivity.faces].mean(1))
        count = len(umbilics.orders)
        places = [umbilics.places[number : number + 1] for number in range(count)]
        return [cls(place, surface.at(place), middles) for place in places]

    def turn(self, e_u: Floats) -> Complexes:
        """Factor (n,) from deviators in the frame of the plane to those in frames along e_u (n, 3)."""
        along = e_u @ self.at.e_u[0] + 1j * (e_u @ self.at.e_v[0])
        return np.asarray((along / np.abs(along)) ** 2)

    def down(self, points: Floats) -> Complexes:
        """Complex coordinates (...,) of points (..., 3), m."""
        off = points - self.at.position[0]
        return np.asarray(off @ self.at.e_u[0] + 1j * (off @ self.at.e_v[0]))

    def up(self, z: Complexes, surface: ElementSurface, start: Places | None = None) -> tuple[Places, Floats]:
        """Places and points (n, 3) of the surface above z (n,), searched from given ones or the nearest elements."""
        axes = np.stack([self.at.e_u[0], self.at.e_v[0]])
        foot = self.at.position[0] + np.stack([z.real, z.imag], 1) @ axes
        if start is None:
            start = Places(self.middles.query(foot)[1], np.full((len(z), 2), 1 / 3))
        target = np.stack([z.real, z.imag])

        def coordinates(where: Places) -> Floats:
            jet = surface.polynomials.jet(where)
            jet[0] -= self.at.position[0][:, None]
            return np.asarray(np.matmul(axes, jet))

        places, found = find_places(surface.connectivity, coordinates, start, target, lambda *_: None)
        lost = np.flatnonzero(~found)
        if len(lost):
            # beyond the rim: the nearest place
            nearest, _ = surface.closest(foot[lost])
            places.element[lost], places.local[lost] = nearest.element, nearest.local
        return places, surface.frames(places).position
