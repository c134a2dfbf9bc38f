r"""What one end of a beam element sees of the other one, with first and second derivatives.

The element's centre line is a helix: the frame at its end a moves along :math:`\exp` of one screw to the frame at b
(the exponential of rigid motions; V. Sonneville, A. Cardona, O. Bruls, Computer Methods in Applied Mechanics and
Engineering 268 (2014) 451). In the moving frame tangent and curvature are alike all along, so

.. math:: \theta = \log(R_a^T R_b), \qquad v = R_a^T (x_b - x_a), \qquad \rho = A(\theta) v

say everything: :math:`\rho` is the centre line's length and direction in the moving frame, :math:`\theta` twist and
bending times length. A rigid motion of both ends changes neither, exactly.

Small motions of the ends are a shift of x and a rotation w with :math:`R \to \exp(w) R`, both in global axes. With
:math:`y = R_a^T (\delta x_b - \delta x_a)`, :math:`u = R_a^T (w_b - w_a)` and :math:`\alpha = R_a^T w_a`

.. math:: \delta\theta = A u, \qquad \delta v = y + v \times \alpha, \qquad
   \delta\rho = A \delta v + N \delta\theta, \qquad N = \partial (A v) / \partial\theta .

Second derivatives are those along :math:`\exp(w) R`, so that they are symmetric:
:math:`\exp(-\alpha) \exp(\alpha + u) = \exp(u - \tfrac12 \alpha \times u + ...)` adds terms in u and :math:`\alpha`,
:math:`\exp(-\alpha)(v + y)` those in y and :math:`\alpha`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.vectors import crosses, dots
from lamella.structure.beam.rotations import crossing, inverse_tangent_coefficient, logarithm


def _column(values: Floats) -> Floats:
    return values[:, None, None]


def _outer(one: Floats, other: Floats) -> Floats:
    return np.asarray(one[:, :, None] * other[:, None, :])


def _symmetric(matrices: Floats) -> Floats:
    return np.asarray(0.5 * (matrices + np.swapaxes(matrices, 1, 2)))


@dataclass(frozen=True)
class RelativeMotion:
    """Relative motion of the ends of m elements.

    Attributes
    ----------
    frame : (m, 3, 3)
        R_a, its columns t, u, n.
    theta, rho, v : (m, 3)
        See the module.
    coefficient : three of (m,)
        c, c', c'' of `inverse_tangent_coefficient`.
    inverse_tangent : (m, 3, 3)
        A.
    bending : (m, 3, 3)
        N.
    """

    frame: Floats
    theta: Floats
    rho: Floats
    v: Floats
    coefficient: tuple[Floats, Floats, Floats]
    inverse_tangent: Floats
    bending: Floats

    @classmethod
    def between(cls, points: Floats, frames: Floats) -> RelativeMotion:
        """Of ends at points (m, 2, 3) with frames (m, 2, 3, 3)."""
        first = frames[:, 0]
        theta = logarithm(np.swapaxes(first, 1, 2) @ frames[:, 1])
        v = np.einsum("mij,mi->mj", first, points[:, 1] - points[:, 0])
        square = dots(theta, theta)
        c, c1, c2 = inverse_tangent_coefficient(square)
        along = dots(theta, v)
        turned = theta * along[:, None] - v * square[:, None]
        rho = v - 0.5 * crosses(theta, v) + c[:, None] * turned
        matrix = np.eye(3) - 0.5 * crossing(theta)
        matrix = matrix + _column(c) * (_outer(theta, theta) - _column(square) * np.eye(3))
        bent = 0.5 * crossing(v) + _column(c) * (_column(along) * np.eye(3) + _outer(theta, v) - 2 * _outer(v, theta))
        bent += _column(2 * c1) * _outer(turned, theta)
        return cls(first, theta, rho, v, (c, c1, c2), matrix, bent)

    def first(self) -> Floats:
        """Derivative of (rho, theta) with respect to (y, u, alpha), (m, 6, 9)."""
        a = self.inverse_tangent
        result = np.zeros((len(a), 6, 9))
        result[:, :3, :3] = a
        result[:, :3, 3:6] = self.bending @ a
        result[:, :3, 6:] = a @ crossing(self.v)
        result[:, 3:, 3:6] = a
        return result

    def second(self, by_rho: Floats, by_theta: Floats) -> Floats:
        """Second derivative of by_rho . rho + by_theta . theta for fixed (m, 3) each, (m, 9, 9) in (y, u, alpha)."""
        a, v = self.inverse_tangent, self.v
        # what acts on v, on theta in all, and on u
        on_v = np.einsum("mij,mi->mj", a, by_rho)
        on_theta = by_theta + np.einsum("mij,mi->mj", self.bending, by_rho)
        on_u = np.einsum("mij,mi->mj", a, on_theta)
        mixed = np.swapaxes(a, 1, 2) @ self._slope(by_rho)
        result = np.zeros((len(a), 9, 9))
        result[:, 3:6, :3] = mixed
        result[:, 3:6, 3:6] = np.swapaxes(a, 1, 2) @ self._curvature(by_rho) @ a + _symmetric(
            np.swapaxes(a, 1, 2) @ self._slope(on_theta)
        )
        result[:, 6:, :3] = crossing(on_v)
        result[:, 6:, 3:6] = np.swapaxes(mixed @ crossing(v), 1, 2) + 0.5 * crossing(on_u)
        result[:, 6:, 6:] = _symmetric(_outer(on_v, v)) - _column(dots(on_v, v)) * np.eye(3)
        result[:, :3, 3:6] = np.swapaxes(mixed, 1, 2)
        result[:, :3, 6:] = np.swapaxes(result[:, 6:, :3], 1, 2)
        result[:, 3:6, 6:] = np.swapaxes(result[:, 6:, 3:6], 1, 2)
        return result

    def _slope(self, by: Floats) -> Floats:
        """Matrix M with delta . M w = by . (dA(theta)[delta] w)."""
        theta, (c, c1, _) = self.theta, self.coefficient
        along, square = dots(by, theta), dots(theta, theta)
        result = 0.5 * crossing(by) + _column(c) * (
            _outer(by, theta) + _column(along) * np.eye(3) - 2 * _outer(theta, by)
        )
        result += _column(2 * c1) * _outer(theta, theta * along[:, None] - by * square[:, None])
        return np.asarray(result)

    def _curvature(self, by: Floats) -> Floats:
        """Second derivative of by . A(theta) v with respect to theta."""
        theta, v, (c, c1, c2) = self.theta, self.v, self.coefficient
        by_theta, theta_v, by_v, square = dots(by, theta), dots(theta, v), dots(by, v), dots(theta, theta)
        g = by_theta * theta_v - square * by_v
        slope = by * theta_v[:, None] + v * by_theta[:, None] - 2 * theta * by_v[:, None]
        result = _column(2 * c) * (_symmetric(_outer(by, v)) - _column(by_v) * np.eye(3))
        result += _column(4 * c1) * _symmetric(_outer(theta, slope)) + _column(2 * c1 * g) * np.eye(3)
        result += _column(4 * c2 * g) * _outer(theta, theta)
        return np.asarray(result)

    def on_ends(self, on_relative: Floats) -> Floats:
        """Forces and moments on the ends, global, (m, 12): x_a, w_a, x_b, w_b; of (m, 9) conjugate to (y, u, alpha)."""
        turned = np.einsum("mij,mkj->mki", self.frame, on_relative.reshape(-1, 3, 3))
        force, moment, both = turned[:, 0], turned[:, 1], turned[:, 2]
        return np.concatenate((-force, both - moment, force, moment), 1)

    def stiffness_on_ends(self, on_relative: Floats) -> Floats:
        """Matrices (m, 12, 12) of the ends in global axes, of symmetric (m, 9, 9) in (y, u, alpha)."""
        m = len(self.frame)
        # turned on one side, and by symmetry on the other one
        half = (self.frame[:, None] @ on_relative.reshape(m, 3, 3, 9)).reshape(m, 9, 9)
        whole = (self.frame[:, None] @ np.swapaxes(half, 1, 2).reshape(m, 3, 3, 9)).reshape(m, 3, 3, 3, 3)
        (yy, yu, ya), (uy, uu, ua), (ay, au, aa) = ([whole[:, i, :, j] for j in range(3)] for i in range(3))
        rows = (
            (yy, yu - ya, -yy, -yu),
            (uy - ay, uu - ua - au + aa, ay - uy, au - uu),
            (-yy, ya - yu, yy, yu),
            (-uy, ua - uu, uy, uu),
        )
        result = np.empty((m, 4, 3, 4, 3))
        for i, row in enumerate(rows):
            for j, block in enumerate(row):
                result[:, i, :, j] = block
        return result.reshape(m, 12, 12)

    def relative(self, motions: Floats) -> Floats:
        """(y, u, alpha), (m, 9), of small motions of the ends (m, 12)."""
        parts = motions.reshape(-1, 4, 3)
        differences = np.stack((parts[:, 2] - parts[:, 0], parts[:, 3] - parts[:, 1], parts[:, 1]), 1)
        return np.asarray(np.einsum("mij,mki->mkj", self.frame, differences).reshape(-1, 9))
