r"""Rotations of space in bulk: exponential, logarithm, and the logarithm's derivative.

A rotation is a matrix, its logarithm the rotation vector :math:`\theta`, its axis times its angle. Where a rotation is
followed by a small one, :math:`\exp(u) \exp(\theta) = \exp(\theta + A u + ...)`, with

.. math:: A(\theta) w = w - \tfrac12 \theta \times w + c(|\theta|^2) \, \theta \times (\theta \times w), \qquad
   c(s) = \sum_{n \ge 1} \frac{2}{(2 \pi n)^2 - s} = \frac{1 - \tfrac12 \sqrt s \cot \tfrac12 \sqrt s}{s}

(the inverse of the left Jacobian of SO(3); J. C. Simo, L. Vu-Quoc, Computer Methods in Applied Mechanics and
Engineering 58 (1986) 79). The sum is that of the cotangent's poles: with its first one apart it is a power series that
is short wherever a logarithm can be, up to half a turn, and has no cancellation anywhere.
"""

from __future__ import annotations

import numpy as np
from scipy.special import zetac

from lamella.base.arrays import Floats

# of the power series behind the first pole: half a turn has s = pi^2, and each power is a sixteenth of the one before
POWERS = 18
_FIRST_POLE = 4 * np.pi**2
# sum over n >= 2 of 2 / (2 pi n)^(2 k), for the power k - 1 of s
_SERIES = 2 * zetac(2 * np.arange(1, POWERS + 1)) / _FIRST_POLE ** np.arange(1, POWERS + 1)
_FIRST = _SERIES[1:] * np.arange(1, POWERS)
_SECOND = _FIRST[1:] * np.arange(1, POWERS - 1)


def crossing(vectors: Floats) -> Floats:
    """Matrices (..., 3, 3) whose products with w are the vector products of (..., 3) with w."""
    result = np.zeros((*vectors.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[..., j, i] = vectors[..., k]
        result[..., i, j] = -vectors[..., k]
    return result


def exponential(vectors: Floats) -> Floats:
    """Rotations (..., 3, 3) of rotation vectors (..., 3)."""
    angle = np.sqrt(np.einsum("...i,...i", vectors, vectors))[..., None, None]
    cross = crossing(vectors)
    # sin(a) / a, and (1 - cos(a)) / a^2 without cancellation
    return np.asarray(
        np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * np.sinc(angle / (2 * np.pi)) ** 2 * (cross @ cross)
    )


def logarithm(rotations: Floats) -> Floats:
    """Rotation vectors (m, 3) of rotations (m, 3, 3), of length up to pi.

    By the quaternion, from the largest of its four numbers (S. W. Shepperd, Journal of Guidance and Control 1 (1978)
    223): as exact at half a turn as near no rotation at all.
    """
    r = rotations
    trace = r[:, 0, 0] + r[:, 1, 1] + r[:, 2, 2]
    # four times the products of the quaternion's numbers, row by row
    products = np.empty((len(r), 4, 4))
    products[:, 0, 0] = 1 + trace
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        products[:, i + 1, i + 1] = 1 + 2 * r[:, i, i] - trace
        products[:, 0, i + 1] = products[:, i + 1, 0] = r[:, k, j] - r[:, j, k]
        products[:, i + 1, j + 1] = products[:, j + 1, i + 1] = r[:, i, j] + r[:, j, i]
    largest = np.argmax(np.einsum("mii->mi", products), axis=1)
    quaternion = products[np.arange(len(r)), largest]
    quaternion /= np.sqrt(np.einsum("mi,mi->m", quaternion, quaternion))[:, None]
    quaternion *= np.where(quaternion[:, :1] < 0, -1.0, 1.0)
    sine = np.sqrt(np.einsum("mi,mi->m", quaternion[:, 1:], quaternion[:, 1:]))
    # angle over the sine of its half; 2 where both vanish
    tiny = sine < np.finfo(float).tiny
    ratio = np.where(tiny, 2.0, 2 * np.arctan2(sine, quaternion[:, 0]) / np.where(tiny, 1.0, sine))
    return np.asarray(ratio[:, None] * quaternion[:, 1:])


def orthonormal(rotations: Floats) -> Floats:
    """Rotations (m, 3, 3) freed from the rounding of many products: a step of Newton's method for the polar factor."""
    return np.asarray(1.5 * rotations - 0.5 * rotations @ (np.swapaxes(rotations, 1, 2) @ rotations))


def inverse_tangent_coefficient(square: Floats) -> tuple[Floats, Floats, Floats]:
    """c(s) of the module's formula and its first and second derivative, at s = square of the angle, up to pi^2."""
    pole = 1 / (_FIRST_POLE - square)
    return (
        2 * pole + np.polynomial.polynomial.polyval(square, _SERIES),
        2 * pole**2 + np.polynomial.polynomial.polyval(square, _FIRST),
        4 * pole**3 + np.polynomial.polynomial.polyval(square, _SECOND),
    )
