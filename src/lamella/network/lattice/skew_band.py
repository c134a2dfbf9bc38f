"""Lines of a given normal curvature on a surface of revolution, as straight lines of a plane of their own.

By Euler's formula a line at the angle phi to the first principal direction has normal curvature
kn = H + mu^2 cos 2 phi, so that given kn the angle follows: cos 2 phi = (kn - H) / mu^2. On a surface of revolution
mu^2 = |T| / r^2 changes along the meridian alone: the lines are V -+ p(U) = const with

    dp/dU = sqrt((1 + c) / (1 - c)) for T > 0 (d1 along the parallel), its inverse for T < 0,   c = (kn - H) r^2 / |T|,

straight in the plane of p + i V. At kn = H they are the lamellas that cross at 90 degrees, p = U; those of kn = 0 are
asymptotic lines.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Chebyshev

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.lattice.domain import Band, Rim
from lamella.network.pattern import Pattern
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Ring
from lamella.surface.closed_forms.revolution import SurfaceOfRevolution
from lamella.surface.darboux import Darboux, lamella_darboux
from lamella.surface.points import SurfacePoints

# degrees; families that cross at less make no net
CROSSING_ANGLE_MIN = 20.0
# share of the range that is kept back, so that its ends hold when four digits of them are written
RANGE_MARGIN = 1e-3
# degrees of the series for dp/dU to begin with and at most, and what its last terms may be
SERIES_DEGREE, MOST_DEGREE, SERIES_TAIL = 32, 4096, 1e-13
# Newton's steps for U of given p
PROFILE_NEWTON_STEPS = 60


def check_normal_curvature(surface: ClosedForm, wanted: float) -> None:
    """Refuse a normal curvature that lines do not have everywhere on a surface, or cross at too small an angle.

    Raises
    ------
    InputError
    """
    key = "normal_curvature"
    if wanted == surface.mean_curvature:
        return
    # on other surfaces lines are traced (`lamella.network.streamlines.applicability`)
    assert isinstance(surface, SurfaceOfRevolution)
    u = np.linspace(surface.outline.start, surface.outline.end, 2001)
    # the principal curvatures are H -+ |T| / r^2
    half = abs(surface.flux) / float(surface.radius_at(u).max()) ** 2
    reach = half * np.cos(np.radians(CROSSING_ANGLE_MIN))
    middle = surface.mean_curvature
    low, high = (middle + (1 - RANGE_MARGIN) * way * reach for way in (-1, 1))
    if abs(wanted - middle) > reach:
        raise InputError(
            f"normal_curvature = {wanted:g} 1/m: where the surface is widest normal curvatures run from "
            f"{middle - half:.4g} to {middle + half:.4g} 1/m, and lines have to cross at {CROSSING_ANGLE_MIN:g} deg "
            "or more",
            f"choose a value from {rounded(low, up=True):g} to {rounded(high, up=False):g} 1/m, or a piece of the "
            "surface that is less wide",
            key,
        )


class SkewBand(Band):
    """A band whose lines have a normal curvature of their own: U is a function of the plane's p."""

    def __init__(self, surface: SurfaceOfRevolution, step: float, pattern: Pattern) -> None:
        super().__init__(surface, step, pattern)
        assert pattern.normal_curvature is not None
        self.ends = self.outline
        excess = (pattern.normal_curvature - surface.mean_curvature) / abs(surface.flux)
        power = 0.5 if surface.flux > 0 else -0.5

        def rate(u: Floats) -> Floats:
            c = excess * surface.radius_at(u) ** 2
            return np.asarray(((1 + c) / (1 - c)) ** power)

        domain, degree = [self.ends.start, self.ends.end], SERIES_DEGREE
        series = Chebyshev.interpolate(rate, degree, domain=domain)
        while np.abs(series.coef[-4:]).max() > SERIES_TAIL * np.abs(series.coef).max() and degree < MOST_DEGREE:
            degree *= 2
            series = Chebyshev.interpolate(rate, degree, domain=domain)
        self._rate, self._p = rate, series.integ(lbnd=0.0)
        # lines are clipped in the plane of p
        self.outline = Ring(*(float(self._p(u)) for u in domain))

    def _u(self, p: Floats) -> Floats:
        """U of given p; a little beyond the ends too, where lines are asked for nodes near the rim."""
        ends, low, high = self.outline, self.ends.start, self.ends.end
        inside = np.clip(p, ends.start, ends.end)
        u = low + (inside - ends.start) / (ends.end - ends.start) * (high - low)
        below, above = np.full_like(u, low), np.full_like(u, high)
        for _ in range(PROFILE_NEWTON_STEPS):
            residual = self._p(u) - inside
            below, above = np.where(residual < 0, u, below), np.where(residual > 0, u, above)
            moved = u - residual / self._rate(u)
            moved = np.where((moved >= below) & (moved <= above), moved, (below + above) / 2)
            change = np.abs(moved - u).max(initial=0.0)
            u = moved
            if change <= 4e-16 * (high - low):
                break
        return np.asarray(u + (p - inside) / self._rate(u))

    def place(self, sheet: Integers, point: Complexes) -> Complexes:
        plane = super().place(sheet, point)
        return np.asarray(self._u(plane.real) + 1j * plane.imag, np.complex128)

    def velocity(self, sheet: Integers, point: Complexes, direction: Complexes) -> Complexes:
        plane = self.slope * direction
        return np.asarray(plane.real / self._rate(self.place(sheet, point).real) + 1j * plane.imag, np.complex128)

    def rim(self, where: Complexes) -> Rim:
        return super().rim(np.asarray(self._p(where.real) + 1j * where.imag, np.complex128))


def line_darboux(points: SurfacePoints, heading: Complexes) -> Darboux:
    """Darboux curvatures of lines of constant normal curvature, which turn in the isothermic plane.

    cos 2 phi = (kn - H) / mu^2 along the line gives d phi / ds = cot(2 phi) d(ln mu) / ds, which adds to the geodesic
    curvature of a line that is straight there (`lamella.surface.darboux.lamella_darboux`).
    """
    straight = lamella_darboux(points, heading)
    turned = points.deviator * heading**2
    along = (np.conj(points.log_mu_gradient) * heading).real
    return Darboux(straight.kn, np.asarray(straight.kg + turned.real / turned.imag * along), straight.tg)
