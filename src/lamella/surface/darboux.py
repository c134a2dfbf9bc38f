"""Curvatures of lamella curves in the Darboux frame (t, u = n x t, n)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.surface.points import SurfacePoints


class Darboux(NamedTuple):
    """Normal curvature kn = t'.n, geodesic curvature kg = t'.u and geodesic torsion tg = u'.n, 1/m, each (n,)."""

    kn: Floats
    kg: Floats
    tg: Floats


def lamella_darboux(points: SurfacePoints, heading: Complexes) -> Darboux:
    """Darboux curvatures of the lamellas through points, exact where the surface is.

    Parameters
    ----------
    points : SurfacePoints
        On a surface of constant mean curvature.
    heading : (n,) complex
        Unit tangents of the lamellas, as components in the points' frames.

    Returns
    -------
    Darboux
        kn = S t . t and tg = S t . u (paper section 2, with n' = -kn t - tg u). A lamella is straight in the
        isothermic plane, whose metric is mu^2 times the surface's; the geodesic curvature of a straight line
        in a conformal metric gives kg = u . grad ln mu.
    """
    turned = points.deviator * heading**2
    kg = np.ascontiguousarray((np.conj(points.log_mu_gradient) * 1j * heading).real)
    return Darboux(points.mean_curvature + turned.real, kg, -turned.imag)


def sideways_slope(points: SurfacePoints, heading: Complexes) -> Floats:
    r"""Change of the normal curvature from a curve to the parallel curves beside it, d kn / d u, 1/m^2, (n,).

    The equation of Codazzi, :math:`(\nabla_u h)(t, t) = (\nabla_t h)(t, u)`, in geodesic parallel coordinates about a
    curve gives

    .. math:: \partial_u \kappa_n = \tau_g' + 2 \kappa_g (\kappa_n - H),

    which is tg' along lamellas, where kn = H. With the mean curvature constant the deviator D is that of a holomorphic
    differential: its covariant derivative along x is 2 D conj(grad ln mu) x, so that nothing is differentiated here.

    Parameters
    ----------
    points, heading
        See `lamella_darboux`; any curves.

    Returns
    -------
    (n,)
        Exact where the surface is; 0 at an umbilic itself, where the gradient of ln mu is not defined.
    """
    turned = points.deviator * heading**2
    slope = -2 * (turned * np.conj(points.log_mu_gradient) * heading).imag
    return np.where(turned == 0, 0.0, slope)
