"""Curvatures of lamella curves in the Darboux frame (t, u = n x t, n)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats, SurfacePoints


class Darboux(NamedTuple):
    """Normal curvature kn = t'.n, geodesic curvature kg = t'.u and geodesic torsion tg = u'.n, 1/m, each (n,)."""

    kn: Floats
    kg: Floats
    tg: Floats


def lamella_darboux(points: SurfacePoints, heading: NDArray[np.complex128]) -> Darboux:
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
