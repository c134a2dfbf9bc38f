"""Surfaces on which every point is umbilic: spheres and planes, which have no net of lamellas."""

from __future__ import annotations

from typing import Any

import numpy as np

from lamella.base.errors import InputError
from lamella.base.vectors import diagonal
from lamella.surface.points import SurfacePoints
from lamella.surface.surface import Surface

# (k1 - k2) / 2 over the larger curvature below which a piece is a sphere, and over 1 / size below which it is flat
LEAST_DEVIATION, LEAST_BEND = 1e-3, 1e-6


def umbilic_reason(points: SurfacePoints, least: float = LEAST_DEVIATION) -> str | None:
    """What a surface is where it is a sphere or a plane for all purposes, None elsewhere.

    Parameters
    ----------
    points : SurfacePoints
        Spread over the whole surface.
    least : float
        (k1 - k2) / 2 over the larger curvature below which a piece is a sphere.

    Returns
    -------
    str or None
        To be put after "the surface is".
    """
    k1, k2 = points.principal_curvatures
    half = np.abs(points.deviator)
    largest = np.maximum(np.abs(k1), np.abs(k2)).max()
    size = diagonal(points.position)
    if largest < LEAST_BEND / size:
        return f"flat: (k1 - k2) / 2 is at most {half.max():.2g} 1/m on a piece of {size:.3g} m"
    if half.max() < max(least * largest, LEAST_BEND / size):
        radius = 1 / np.abs(points.mean_curvature).mean()
        return (
            f"a piece of a sphere of radius {radius:.4g} m: (k1 - k2) / 2 is at most {half.max() / largest:.1e} "
            f"of the curvature (limit {least:g})"
        )
    return None


def refuse_umbilic(surface: Surface[Any]) -> None:
    """Raise an `InputError` for the net of a surface that is a sphere or a plane for all purposes.

    As a surface it is as good as any other. But the isothermic coordinates are the integral of (H^2 - K)^(1/4) times
    the principal directions: where H^2 = K all directions bend alike, and nothing tells where a lamella should go.
    """
    what = umbilic_reason(surface.check_points())
    if what:
        raise InputError(
            f"the surface is {what}. There every point is umbilic: all directions bend alike, so no net of "
            "lamellas is singled out",
            "choose a surface that is bent more in one direction than in the other",
            "surface",
        )
