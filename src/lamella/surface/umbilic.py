"""Surfaces on which every point is umbilic: spheres and planes, which have no net of lamellas."""

from __future__ import annotations

import numpy as np

from lamella.errors import InputError
from lamella.surface.closed_form import ClosedForm
from lamella.surface.sampling import places

# (k1 - k2) / 2 over the larger curvature below which a piece is a sphere, and over 1 / size below which it is flat
LEAST_DEVIATION, LEAST_BEND = 1e-3, 1e-6


def refuse_umbilic(surface: ClosedForm) -> None:
    """Raise an `InputError` where a surface is a sphere or a plane for all purposes.

    The isothermic coordinates are the integral of (H^2 - K)^(1/4) times the principal directions: where H^2 = K
    all directions bend alike, and nothing tells where a lamella should go.
    """
    at = surface.at(places(surface, 9, 17)[0])
    k1, k2 = at.principal_curvatures
    half = np.abs(at.deviator)
    largest = np.maximum(np.abs(k1), np.abs(k2)).max()
    size = float(np.linalg.norm(np.ptp(at.position, axis=0)))
    if half.max() < LEAST_BEND / size:
        what = f"flat: (k1 - k2) / 2 is at most {half.max():.2g} 1/m on a piece of {size:.3g} m"
    elif half.max() < LEAST_DEVIATION * largest:
        what = (
            f"a piece of a sphere of radius {1 / largest:.4g} m: (k1 - k2) / 2 is at most {half.max() / largest:.1e} "
            f"of the curvature (limit {LEAST_DEVIATION:g})"
        )
    else:
        return
    raise InputError(
        f"the {surface.kind} is {what}. There every point is umbilic: all directions bend alike, so no net of "
        "lamellas is singled out",
        "choose a wider neck, or a piece that is bent more in one direction than in the other",
        "surface",
    )
