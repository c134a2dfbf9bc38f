"""Exact line search: along a line, quadratic residuals are known from one evaluation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.arrays import Floats

# longest step over Gauss-Newton's; a full step is kept unless another is better by this share of the decrease
LONGEST, WORTH = 2.0, 1e-2


def best_length(
    residuals: Sequence[Floats], changes: Sequence[Floats], ends: Sequence[Floats], weights: Sequence[float]
) -> float:
    """Share t of a step d that makes the sum of squares least.

    With f quadratic, f(x + t d) = f + t J d + t^2 q, where q = f(x + d) - f - J d: the sum of squares is a quartic
    in t and its least value is a root of a cubic.

    Parameters
    ----------
    residuals, changes, ends : one array a constraint
        f(x), J d and f(x + d).
    weights : one a constraint
        Factor of its residuals.

    Returns
    -------
    float
        In (0, 2]; 1 where the full step is as good to rounding, so that quadratic convergence stays.
    """
    c = np.zeros(5)
    for f, change, end, weight in zip(residuals, changes, ends, weights, strict=True):
        if weight == 0 or not f.size:
            continue
        q = end - f - change
        quadratic = np.vdot(change, change) + 2 * np.vdot(f, q)
        quartic = [np.vdot(q, q), 2 * np.vdot(change, q), quadratic, 2 * np.vdot(f, change), np.vdot(f, f)]
        c += weight**2 * np.array(quartic)
    if not np.isfinite(c).all():
        return 1.0
    roots = np.roots(np.polyder(c))
    real = roots.real[np.abs(roots.imag) <= 1e-9 * np.abs(roots)]
    tried = np.concatenate([[1.0, LONGEST], real[(real > 0) & (real < LONGEST)]])
    values = np.polyval(c, tried)
    best = int(values.argmin())
    gain = c[4] - values[best]
    return float(tried[best]) if values[0] - values[best] > WORTH * gain else 1.0
