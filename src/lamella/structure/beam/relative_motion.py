r"""What one end of a beam element sees of the other one, with first and second derivatives.

The element's centre line is a helix: the frame at its end a moves along :math:`\exp` of one screw to the frame at b
(the exponential of rigid motions; V. Sonneville, A. Cardona, O. Bruls, Computer Methods in Applied Mechanics and
Engineering 268 (2014) 451). In the moving frame tangent and curvature are alike all along, so

.. math:: \theta = \log(R_b R_a^T), \qquad v = x_b - x_a, \qquad \rho = A(\theta) v,

turned into the frame at a, say everything: :math:`R_a^T \rho` is the centre line's length and direction in the moving
frame, :math:`R_a^T \theta` twist and bending times length. A rigid motion of both ends changes neither, exactly.

Small motions of the ends are a shift of x and a rotation w with :math:`R \to \exp(w) R`, both in global axes. With
:math:`y = \delta x_b - \delta x_a`, :math:`u = w_b - w_a` and :math:`\alpha = w_a`, seen from the frame at a,

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
from lamella.structure.beam.columns import (
    add_unit,
    cross,
    crossing,
    dot,
    element_last,
    outer,
    product,
    symmetric,
    transposed,
    turned_product,
)
from lamella.structure.beam.rotations import exponential, inverse_tangent_coefficient, logarithm


@dataclass(frozen=True)
class RelativeMotion:
    """Relative motion of the ends of m elements; the element is the last axis.

    Attributes
    ----------
    frame : (3, 3, m)
        R_a, its columns t, u, n.
    local_rho, local_theta : (3, m)
        rho and theta in the frame at a.
    theta, v : (3, m)
        Global, see the module.
    coefficient : three of (m,)
        c, c', c'' of `inverse_tangent_coefficient`.
    inverse_tangent : (3, 3, m)
        A.
    bending : (3, 3, m)
        N.
    """

    frame: Floats
    local_rho: Floats
    local_theta: Floats
    theta: Floats
    v: Floats
    coefficient: tuple[Floats, Floats, Floats]
    inverse_tangent: Floats
    bending: Floats

    @classmethod
    def between(cls, points: Floats, frames: Floats) -> RelativeMotion:
        """Of ends at points (m, 2, 3) with frames (m, 2, 3, 3)."""
        (first, second), (start, end) = element_last(frames), element_last(points)
        local_theta = element_last(logarithm(np.moveaxis(turned_product(first, second), -1, 0)))
        theta, v = product(first, local_theta), end - start
        square, along = dot(theta, theta), dot(theta, v)
        c, c1, c2 = inverse_tangent_coefficient(square)
        turned = theta * along - v * square
        rho = v - 0.5 * cross(theta, v) + c * turned
        matrix = -0.5 * crossing(theta) + c * outer(theta, theta)
        add_unit(matrix, 1 - c * square)
        bent = 0.5 * crossing(v) + c * (outer(theta, v) - 2 * outer(v, theta)) + 2 * c1 * outer(turned, theta)
        add_unit(bent, c * along)
        return cls(first, turned_product(first, rho), local_theta, theta, v, (c, c1, c2), matrix, bent)

    def frame_at_b(self) -> Floats:
        """R_b, (3, 3, m)."""
        return product(self.frame, element_last(exponential(self.local_theta.T)))

    def on_ends(self, by_rho: Floats, by_theta: Floats) -> Floats:
        """Forces and moments on the ends, (12, m), of x_a, w_a, x_b, w_b, by what is conjugate to rho and theta."""
        force, moment = self._on_relative(by_rho, by_theta)
        arm = cross(force, self.v)
        return np.concatenate((-force, arm - moment, force, moment))

    def _on_relative(self, by_rho: Floats, by_theta: Floats) -> tuple[Floats, Floats]:
        """What is conjugate to v and to u."""
        on_theta = by_theta + turned_product(self.bending, by_rho)
        return turned_product(self.inverse_tangent, by_rho), turned_product(self.inverse_tangent, on_theta)

    def strain_motion(self, motions: Floats) -> tuple[Floats, Floats]:
        """Small changes of rho and theta, (3, m) each, by small motions of the ends (12, m)."""
        x_a, w_a, x_b, w_b = motions.reshape(4, 3, -1)
        turn = product(self.inverse_tangent, w_b - w_a)
        shift = x_b - x_a + cross(self.v, w_a)
        return product(self.inverse_tangent, shift) + product(self.bending, turn), turn

    def stiffness(self, inner: Floats, by_rho: Floats, by_theta: Floats) -> Floats:
        """Second derivatives on the ends, symmetric, (12, 12, m).

        Parameters
        ----------
        inner : (6, 6, m)
            Second derivatives with respect to rho and theta, global.
        by_rho, by_theta : (3, m)
            First ones.
        """
        a, n, v = self.inverse_tangent, self.bending, self.v
        rr, rt, tt = inner[:3, :3], inner[:3, 3:], inner[3:, 3:]
        on_v, on_u = self._on_relative(by_rho, by_theta)
        # in v and theta
        by_both = product(rr, n) + rt
        vt = turned_product(a, by_both) + transposed(self._slope(by_rho))
        corner = turned_product(n, rt)
        tt = tt + turned_product(n, product(rr, n)) + corner + transposed(corner) + self._curvature(by_rho)
        # in y, u and alpha
        yy, yu = turned_product(a, product(rr, a)), product(vt, a)
        on_theta = by_theta + turned_product(n, by_rho)
        uu = turned_product(a, product(tt, a)) + symmetric(turned_product(a, self._slope(on_theta)))
        lever = crossing(v)
        ya = product(yy, lever) - crossing(on_v)
        ua = turned_product(yu, lever) - 0.5 * crossing(on_u)
        aa = turned_product(lever, product(yy, lever)) + symmetric(outer(on_v, v))
        add_unit(aa, -dot(on_v, v))
        return _on_both_ends(yy, yu, uu, ya, ua, aa)

    def _slope(self, by: Floats) -> Floats:
        """Matrix M with delta . M w = by . (dA(theta)[delta] w), (3, 3, m)."""
        theta, (c, c1, _) = self.theta, self.coefficient
        along, square = dot(by, theta), dot(theta, theta)
        result = 0.5 * crossing(by) + outer(c * by, theta) - outer(2 * c * theta, by)
        result += outer(2 * c1 * theta, theta * along - by * square)
        add_unit(result, c * along)
        return result

    def _curvature(self, by: Floats) -> Floats:
        """Second derivative of by . A(theta) v with respect to theta, (3, 3, m)."""
        theta, v, (c, c1, c2) = self.theta, self.v, self.coefficient
        by_theta, theta_v, by_v, square = dot(by, theta), dot(theta, v), dot(by, v), dot(theta, theta)
        g = by_theta * theta_v - square * by_v
        slope = by * theta_v + v * by_theta - 2 * theta * by_v
        result = symmetric(outer(2 * c * by, v) + outer(4 * c1 * theta, slope) + outer(4 * c2 * g * theta, theta))
        add_unit(result, 2 * c1 * g - 2 * c * by_v)
        return result


def _on_both_ends(yy: Floats, yu: Floats, uu: Floats, ya: Floats, ua: Floats, aa: Floats) -> Floats:
    """Matrices (12, 12, m) of the ends, of the blocks (3, 3, m) in y, u and alpha."""
    uy, ay, au = transposed(yu), transposed(ya), transposed(ua)
    rows = (
        (yy, yu - ya, -yy, -yu),
        (uy - ay, uu - ua - au + aa, ay - uy, au - uu),
        (-yy, ya - yu, yy, yu),
        (-uy, ua - uu, uy, uu),
    )
    result = np.empty((4, 3, 4, 3, yy.shape[-1]))
    for i, row in enumerate(rows):
        for j, block in enumerate(row):
            result[i, :, j] = block
    return result.reshape(12, 12, -1)
