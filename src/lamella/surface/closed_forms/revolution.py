"""Surfaces of revolution with a constant Hopf coefficient: unduloid, nodoid, catenoid, cylinder."""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.errors import InputError
from lamella.base.root import root_between
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Ring
from lamella.surface.points import SurfacePoints


class Profile(NamedTuple):
    """Meridian: radius r, height z and their U-derivatives, where r_U^2 + z_U^2 = r^2."""

    r: Floats
    z: Floats
    r_u: Floats
    z_u: Floats


class SurfaceOfRevolution(ClosedForm):
    """Meridian turned about the z axis; U runs along the meridian, V is the angle, lambda = r.

    The Hopf coefficient is -flux / 2: k_V = H + flux / r^2, k_U = H - flux / r^2.

    Attributes
    ----------
    flux : float
        T, m: the first integral z_U - H r^2 (flux of the surface's force through a circle, over 2 pi).
    """

    flux: float
    outline: Ring

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        """Always: curves of any one normal curvature repeat around the axis (`lamella.network.lattice.skew_band`)."""
        return True

    @abstractmethod
    def profile(self, u: Floats) -> Profile:
        """Meridian at the parameter U, arrays of u's shape."""

    @abstractmethod
    def radius_at(self, u: Floats) -> Floats:
        """r at the parameter U, without the rest of the profile."""

    def parameter_at_height(self, z: float) -> float:
        """U where the meridian has height z (z is monotonic in U on the pieces offered)."""
        if z == 0.0:
            return 0.0

        def residual(u: float) -> float:
            return float(self.profile(np.array([u])).z[0]) - z

        sign = 1.0 if residual(1e-3) > residual(-1e-3) else -1.0
        reach = 1.0
        while residual(sign * np.sign(z) * reach) * np.sign(z) < 0:
            reach *= 2
        ends = sorted((0.0, sign * np.sign(z) * reach))
        return root_between(residual, *ends, tolerance=1e-15, relative=1e-15)

    def between(self, z0: float, z1: float) -> Ring:
        """The outline between two heights.

        Raises
        ------
        InputError
            The range is reversed, empty or not finite.
        """
        if not -np.inf < z0 < z1 < np.inf:
            raise InputError(f"height = ({z0:g}, {z1:g}) m is no range", "z0 has to be below z1, both finite", "height")
        ends = sorted(self.parameter_at_height(z) for z in (z0, z1))
        return Ring(*ends)

    def at(self, where: Complexes) -> SurfacePoints:
        p = self.profile(where.real)
        c, s = np.cos(where.imag), np.sin(where.imag)
        out, up = p.r_u / p.r, p.z_u / p.r
        position = np.column_stack([p.r * c, p.r * s, p.z])
        e_u = np.column_stack([out * c, out * s, up])
        e_v = np.column_stack([-s, c, np.zeros_like(c)])
        normal = np.column_stack([-up * c, -up * s, out])
        return self._points(where, (position, e_u, e_v, normal), p.r, out.astype(complex))

    def metric(self, where: Complexes) -> Floats:
        return self.radius_at(where.real)

    def hopf(self, where: Complexes) -> Complexes:
        return np.full(len(where), -self.flux / 2, complex)

    @property
    def root(self) -> complex:
        """sqrt(2 Q); the branch makes (u, v) = sqrt(T) (V, -U) for T > 0 and sqrt|T| (U, V) for T < 0."""
        return complex(0, -np.sqrt(self.flux)) if self.flux > 0 else complex(np.sqrt(-self.flux), 0)

    def isothermic(self, where: Complexes) -> Complexes:
        return self.root * where

    def from_isothermic(self, w: Complexes) -> Complexes:
        return w / self.root

    @property
    def whole_length(self) -> float:
        """u + v once around."""
        turn = self.root * 2j * np.pi
        return float(abs(turn.real + turn.imag))
