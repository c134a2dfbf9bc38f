"""Cubic B-splines through densely sampled curves, with no more control points than a tolerance needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from lamella.base.arrays import Floats

DEGREE = 3
SPLINE_TOLERANCE = 1e-7
"""Largest distance of a written curve from its samples, as a share of the curve's length."""

COARSEST = 16


@dataclass(frozen=True)
class Spline:
    """A clamped cubic B-spline.

    Attributes
    ----------
    knots : (n + 4,)
        Knots, the end ones four times.
    controls : (n, d)
        Control points.
    """

    knots: Floats
    controls: Floats


def fit_spline(parameters: Floats, values: Floats, ends: Floats, tolerance: float) -> Spline:
    """Interpolate every s-th sample, with the largest power of two s that keeps all of them in tolerance.

    Parameters
    ----------
    parameters : (n,)
        Increasing, n >= 2; arc lengths of the samples, say.
    values : (n, d)
        Samples; for d = 6 two curves of three coordinates each, which then share their knots.
    ends : (2, d)
        Derivatives by the parameter at the first and the last sample.
    tolerance : float
        Largest difference in any coordinate at the samples left out.

    Returns
    -------
    Spline
        Passes through first and last sample exactly and through the others within ``tolerance``.
    """
    conditions = ([(1, ends[0])], [(1, ends[1])])
    last = len(parameters) - 1
    stride = COARSEST
    while True:
        stride = min(stride, 1 << (last.bit_length() - 1))
        kept = np.rint(np.linspace(0, last, -(-last // stride) + 1)).astype(np.int64)
        spline = make_interp_spline(parameters[kept], values[kept], k=DEGREE, bc_type=conditions, check_finite=False)
        if stride == 1:
            break
        error = float(np.abs(spline(parameters) - values).max())
        if error <= tolerance:
            break
        # The error falls with the fourth power of the stride; aim a little below the tolerance.
        steps = int(np.ceil(np.log2(1.25 * error / tolerance) / 4))
        stride = max(1, stride >> max(1, steps))
    return Spline(knots=spline.t, controls=spline.c)
