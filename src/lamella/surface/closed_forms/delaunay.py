"""Delaunay's unduloid and nodoid: revolution surfaces of constant mean curvature."""

from __future__ import annotations

from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError, require_positive
from lamella.base.root import root_between
from lamella.base.wording import rounded
from lamella.surface.closed_forms.elliptic import epsilon, first_kind, jacobi, quarter_period
from lamella.surface.closed_forms.revolution import Profile, SurfaceOfRevolution

# below this ratio of radii the elliptic functions, whose parameter 1 - ratio^2 is rounded, lose too many digits
LEAST_RATIO = 1e-4


class Delaunay(SurfaceOfRevolution):
    """Meridian r = r_m / dn(x, m), x = r_M H U, m = 1 - (r_m / r_M)^2, from the neck at z = 0.

    z = T U + r_M (E(am x | m) - m sn x cn x / dn x), which is r_M [E(am(x + K) | m) - E(m)].
    """

    def __init__(self, neck_radius: float, bulge_radius: float, flux_sign: int) -> None:
        require_positive(neck_radius=neck_radius, bulge_radius=bulge_radius)
        if not LEAST_RATIO * bulge_radius <= neck_radius:
            raise InputError(
                f"neck_radius = {neck_radius:g} m is too little for bulge_radius = {bulge_radius:g} m (at least "
                f"{LEAST_RATIO:g} of it): the surface is a row of spheres, on which every point is umbilic, joined by "
                "tiny catenoids",
                f"write neck_radius = {rounded(LEAST_RATIO * bulge_radius, up=True):g} or more; for a piece near the "
                "neck alone, a catenoid",
                "neck_radius",
            )
        self.neck_radius, self.bulge_radius = neck_radius, bulge_radius
        self.mean_curvature = 1.0 / (bulge_radius + flux_sign * neck_radius)
        self.flux = flux_sign * self.mean_curvature * bulge_radius * neck_radius
        self._m1 = (neck_radius / bulge_radius) ** 2

    @property
    def period(self) -> float:
        """U from neck to neck, 2 K(m) / (r_M H)."""
        return 2 * quarter_period(self._m1) / (self.bulge_radius * self.mean_curvature)

    def radius_at(self, u: Floats) -> Floats:
        return np.asarray(self.neck_radius / jacobi(self.bulge_radius * self.mean_curvature * u, self._m1).dn)

    def profile(self, u: Floats) -> Profile:
        rate = self.bulge_radius * self.mean_curvature
        f = jacobi(rate * u, self._m1)
        m = 1.0 - self._m1
        bend = m * f.sn * f.cn / f.dn
        r = self.neck_radius / f.dn
        return Profile(
            r,
            self.flux * u + self.bulge_radius * (epsilon(rate * u, f, self._m1) - bend),
            r * bend * rate,
            self.mean_curvature * r**2 + self.flux,
        )


class Unduloid(Delaunay):
    """Unduloid between two heights, z = 0 at a neck; normal towards the axis, H = 1 / (r_M + r_m) > 0.

    Parameters
    ----------
    neck_radius, bulge_radius : float
        Smallest and largest radius r_m <= r_M, m; equal radii are a cylinder.
    height : (float, float)
        z0 < z1, m; several periods allowed.

    Examples
    --------
    >>> import lamella
    >>> lamella.Unduloid(1.0, 2.0, (-2.0, 3.0))
    Unduloid(mean curvature 0.333333 1/m, 41.73 m2)
    """

    kind = "unduloid"

    def __init__(self, neck_radius: float, bulge_radius: float, height: tuple[float, float]) -> None:
        if neck_radius > bulge_radius:
            raise InputError(
                f"neck_radius = {neck_radius:g} m is above bulge_radius = {bulge_radius:g} m",
                "the neck is the smallest radius, the bulge the largest: swap them",
                "neck_radius",
            )
        super().__init__(neck_radius, bulge_radius, 1)
        self.outline = self.between(*height)

    def describe(self) -> dict[str, Any]:
        """Length of a full period, m."""
        return {"period": float(self.profile(np.array([self.period])).z[0])}


class Nodoid(Delaunay):
    """Neck branch of a nodoid, |z| below the fold; normal away from the axis at the neck, H > 0.

    Parameters
    ----------
    neck_radius, bulge_radius : float
        Smallest and largest radius r_m < r_M of the whole nodoid, m; H = 1 / (r_M - r_m).
    height : (float, float)
        z0 < z1, m, inside (-fold, fold), where r^2 = r_M r_m at the fold.

    Examples
    --------
    >>> import lamella
    >>> lamella.Nodoid(0.5, 1.5, (-0.1, 0.1))
    Nodoid(mean curvature 1 1/m, 0.6549 m2)
    """

    kind = "nodoid"

    def __init__(self, neck_radius: float, bulge_radius: float, height: tuple[float, float]) -> None:
        if neck_radius >= bulge_radius:
            raise InputError(
                f"neck_radius = {neck_radius:g} m is not below bulge_radius = {bulge_radius:g} m "
                "(H = 1 / (bulge_radius - neck_radius) has to be positive and finite)",
                "the neck is the smallest radius, the bulge the largest",
                "neck_radius",
            )
        super().__init__(neck_radius, bulge_radius, -1)
        fold = self.fold
        for z in height:
            if abs(z) >= fold:
                raise InputError(
                    f"z = {z:g} m lies at or beyond the nodoid's fold: |z| < {fold:.6g} m for these radii",
                    "only the branch around the neck is offered: keep height within "
                    f"[{-rounded(0.99 * fold, up=False):g}, {rounded(0.99 * fold, up=False):g}], or widen the radii",
                    "height",
                )
        self.outline = self.between(*height)

    @property
    def fold(self) -> float:
        """Height of the fold r^2 = r_M r_m, where the meridian turns back, m."""
        return float(abs(self.profile(np.array([self._fold_parameter])).z[0]))

    @property
    def _fold_parameter(self) -> float:
        # dn^2 = r_m / r_M there, that is sn^2 = 1 / (1 + r_m / r_M)
        sine = np.array([np.sqrt(1 / (1 + self.neck_radius / self.bulge_radius))])
        return float(first_kind(sine, 1 - self._m1)[0]) / (self.bulge_radius * self.mean_curvature)

    def parameter_at_height(self, z: float) -> float:
        reach = self._fold_parameter
        return root_between(lambda u: float(self.profile(np.array([u])).z[0]) - z, -reach, reach, tolerance=1e-15)

    def describe(self) -> dict[str, Any]:
        """Height of the fold, m."""
        return {"fold": self.fold}
