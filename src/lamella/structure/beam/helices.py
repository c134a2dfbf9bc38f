r"""The centre lines of elements between their ends.

With the screw :math:`(\rho, \theta)` from an element's first end to its second one, in the frame at the first
(`lamella.structure.beam.relative_motion`), a helix has at the share s the frame :math:`R_a \exp(s \theta)` and lies at
:math:`x_a + R_a V(s \theta) \, s \rho` with the left Jacobian of rotations

.. math:: V(\theta) = 1 + \frac{1 - \cos |\theta|}{|\theta|^2} [\theta]
   + \frac{|\theta| - \sin |\theta|}{|\theta|^3} [\theta]^2 .

What of :math:`\rho` is across the tangents at the ends is that of an S-bend (`lamella.structure.beam.strains`), which
leaves both ends along their tangents: it grows with :math:`3 s^2 - 2 s^3` in place of s.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.relative_motion import RelativeMotion
from lamella.structure.beam.rotations import crossing, exponential

# below this angle, rad, the last coefficient is its Taylor series: what is left out is a share of 1e-16
SMALL_ANGLE = 0.05


def points_between(points: Floats, frames: Floats, shares: Floats) -> tuple[Floats, Floats]:
    """Points and frames along elements.

    Parameters
    ----------
    points, frames : (m, 2, 3), (m, 2, 3, 3)
        Of their ends, see `lamella.structure.beam.attachment.Attachment.ends`.
    shares : (p,) or (m, p)
        Of the elements' lengths from their first ends on, 0 to 1.

    Returns
    -------
    points, frames : (m, p, 3), (m, p, 3, 3)
    """
    motion = RelativeMotion.between(points, frames)
    rho, theta = motion.local_rho.T[:, None], motion.local_theta.T[:, None]
    share = np.broadcast_to(shares, (len(points), shares.shape[-1]))[..., None]
    turned = share * theta
    first = frames[:, 0][:, None]
    bent = share**2 * (3 - 2 * share)
    grown = np.concatenate((share, bent, bent), axis=2)
    shift = np.einsum("mpij,mpj->mpi", _left_jacobian(turned), grown * rho)
    along = points[:, 0][:, None] + np.einsum("mqij,mpj->mpi", first, shift)
    return np.asarray(along), np.asarray(first @ exponential(turned))


def _left_jacobian(vectors: Floats) -> Floats:
    """V of rotation vectors (..., 3), (..., 3, 3)."""
    angle = np.sqrt(np.einsum("...i,...i", vectors, vectors))[..., None, None]
    cross = crossing(vectors)
    half = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    small = angle < SMALL_ANGLE
    safe = np.where(small, 1.0, angle)
    square = angle**2
    series = (1 - square / 20 * (1 - square / 42 * (1 - square / 72 * (1 - square / 110)))) / 6
    rest = np.where(small, series, (safe - np.sin(safe)) / safe**3)
    return np.asarray(np.eye(3) + half * cross + rest * (cross @ cross))
