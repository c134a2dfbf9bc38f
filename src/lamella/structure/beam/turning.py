r"""Stiffness of elements that turn along themselves: twisted or bent as they stand.

A moment that is the same all along an element in space is not so in the strip's own axes: where the strip is twisted by
tg, a strong-axis moment M has the part :math:`-M \, tg \, s` about the weak axis at the distance s from the middle. A
strip 100 x 1.5 mm is 4,400 times as stiff about the one as about the other, so an element of the length L yields by
:math:`1 + (tg L)^2 E I_u / 12 E I_n` as much: three times at 4 degrees of twist. Short elements turn so little that it
does not matter; here it is taken into account, so that longer ones do as well.

With the force P and the moment M at the middle, in its axes, the section at s, at :math:`x(s)` from the middle and
turned by :math:`R(s)`, has :math:`R^T P` and :math:`R^T (M - x \times P)`, together :math:`B(s) (P, M)`. With F of the
section

.. math:: f = \int B^T F B \, ds

is the flexibility against a relative motion at the middle. Of the screw :math:`\xi` from end to end, whose parts are
the strains of `lamella.structure.beam.strains`, such a motion is

.. math:: \delta\xi = S \, \eta, \qquad S = \frac{\tfrac12 ad_\xi}{\sinh \tfrac12 ad_\xi}
   = 1 - \tfrac1{24} ad_\xi^2 + \tfrac7{5760} ad_\xi^4 - ...

(from the symmetric product :math:`\exp(\tfrac12\xi) \exp(\eta) \exp(\tfrac12\xi)`), so that strains have the
flexibility :math:`S f S^T`. What its inverse differs from the stiffness of the same element if it did not turn acts on
what the strains differ from those of the pose: there nothing is changed, and to first order about it the element is
exact. But for stretch, which stays by itself: that a bent element gets longer as it straightens is no matter of first
order where it is under the tension of residual stress.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.beams import Beams
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import crossing, exponential

SECTION = ("axial", "shear_u", "shear_n", "torsion", "bending_u", "bending_n")
"""What a section resists P and M with."""

SYMMETRIC_PRODUCT = (1.0, -1 / 24, 7 / 5760, -31 / 967680)
"""Of S in powers of the square of ad; the next one is below 1e-8 where an element turns by half a radian."""

# exact for what is turned by up to half a radian to eight digits
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


def turning(beams: Beams, poses: Poses) -> Beams:
    """Beams that know how they turn along themselves in a pose.

    About it they are exact to first order; where natural curvatures change later on, that is taken for strain.
    """
    law, state = beams.law, beams.at(poses)
    length = law.length
    screw = np.concatenate((state.motion.local_rho, state.motion.local_theta)).T
    resists = [np.array([getattr(kind, name) for kind in beams.sections], float)[beams.section] for name in SECTION]
    flexible = 1 / np.stack(resists, 1)
    more = np.zeros((len(beams), 6, 6))
    straight = np.zeros_like(screw)
    straight[:, 0] = length
    symmetric = _symmetric_product(screw)
    for place, weight in zip(_PLACES / 2, _WEIGHTS / 2, strict=True):
        own = _section_forces(place * screw) @ np.swapaxes(symmetric, 1, 2)
        plain = _section_forces(place * straight)
        for sign, forces in ((1, own), (-1, plain)):
            part = np.swapaxes(forces, 1, 2) @ (flexible[:, :, None] * forces)
            more += sign * weight * length[:, None, None] * part
    stiffness = law.stiffness[1:6].T
    # strains are the screw over the length
    whole = more[:, 1:, 1:] / length[:, None, None] ** 2
    axes = np.arange(5)
    whole[:, axes, axes] += 1 / stiffness
    coupling = np.linalg.inv(whole)
    coupling[:, axes, axes] -= stiffness
    coupling = (coupling + np.swapaxes(coupling, 1, 2)) / 2
    by_element = np.ascontiguousarray(np.moveaxis(coupling, 0, -1))
    return replace(beams, law=replace(law, coupling=by_element, reference=law.measures(state.strains.values)))


def _section_forces(screw: Floats) -> Floats:
    """Forces and moments of the section that a screw (m, 6) leads to from the middle, by those there, (m, 6, 6)."""
    turn = screw[:, 3:]
    rotation = exponential(turn)
    # the shift of the screw: the integral of its rotations, by Gauss' rule
    shift = np.zeros_like(turn)
    for place, weight in zip((1 + _PLACES) / 2, _WEIGHTS / 2, strict=True):
        shift += weight * np.einsum("mij,mj->mi", exponential(place * turn), screw[:, :3])
    result = np.zeros((len(screw), 6, 6))
    back = np.swapaxes(rotation, 1, 2)
    result[:, :3, :3] = result[:, 3:, 3:] = back
    result[:, 3:, :3] = -back @ crossing(shift)
    return result


def _symmetric_product(screw: Floats) -> Floats:
    """S of screws (m, 6), (m, 6, 6)."""
    ad = np.zeros((len(screw), 6, 6))
    ad[:, :3, :3] = ad[:, 3:, 3:] = crossing(screw[:, 3:])
    ad[:, :3, 3:] = crossing(screw[:, :3])
    square, power = ad @ ad, np.tile(np.eye(6), (len(screw), 1, 1))
    result = np.zeros_like(ad)
    for coefficient in SYMMETRIC_PRODUCT:
        result += coefficient * power
        power = power @ square
    return result
