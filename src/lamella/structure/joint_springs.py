r"""Springs that resist the turning of joints, beyond a free gap.

A slot is wider than the strip in it: the joint turns by its play before anything resists. With the angle phi, that at
rest phi0 and the gap g the spring has the moment :math:`k \, (|\varphi - \varphi_0| - g)` beyond the gap and none
within, and the energy that belongs to it, whose derivative is continuous.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Lean
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses


@dataclass(frozen=True)
class JointSprings(Lean):
    """s joints with springs.

    Attributes
    ----------
    joints : (s,) int
    stiffness : (s,)
        N m/rad.
    gap : (s,)
        Free to either side, rad.
    rest : (s,)
        Angle in the middle of the gap, rad.
    """

    joints: Integers
    stiffness: Floats
    gap: Floats
    rest: Floats

    def __len__(self) -> int:
        return len(self.joints)

    def unknowns(self, nodes: int) -> Integers:
        """Of a structure of so many nodes, (1, s)."""
        return (NODE_UNKNOWNS * nodes + self.joints)[None]

    def beyond(self, poses: Poses) -> Floats:
        """How far the joints are turned beyond their gaps, with the sign of the turn, rad, (s,)."""
        turn = poses.angles[self.joints] - self.rest
        return np.asarray(np.sign(turn) * np.maximum(np.abs(turn) - self.gap, 0.0))

    def energy(self, beyond: Floats) -> Floats:
        """J, (s,)."""
        return np.asarray(0.5 * self.stiffness * beyond**2)

    def forces(self, beyond: Floats) -> Floats:
        """Derivative of the energy: moments, N m, (1, s)."""
        return np.asarray(self.stiffness * beyond)[None]

    def tangent(self, beyond: Floats) -> Floats:
        """(1, 1, s); nothing within the gap."""
        return np.where((beyond != 0) | (self.gap == 0), self.stiffness, 0.0)[None, None]


def make_joint_springs(
    poses: Poses, stiffness: ArrayLike, *, gap: ArrayLike = 0.0, joints: ArrayLike | None = None
) -> JointSprings:
    """Springs that are at rest in a pose.

    Parameters
    ----------
    poses : Poses
    stiffness : (s,) or float
        N m/rad.
    gap : (s,) or float
        Free to either side, rad.
    joints : (s,) int, optional
        Default: all.

    Raises
    ------
    InputError
        A joint that is not there; a stiffness that is not above 0; a gap below 0.
    """
    count = len(poses.angles)
    which = np.arange(count) if joints is None else np.atleast_1d(np.asarray(joints, np.int64))
    missing = np.flatnonzero((which < 0) | (which >= count))
    if len(missing):
        raise InputError(f"there is no joint {which[missing[0]]}", f"there are {count}, the first is 0", "joints")
    stiff, free = (np.broadcast_to(np.asarray(x, float), len(which)).copy() for x in (stiffness, gap))
    bad = np.flatnonzero(~(np.isfinite(stiff) & (stiff > 0)))
    if len(bad):
        raise InputError(
            f"the stiffness of joint {which[bad[0]]} is {stiff[bad[0]]!r}",
            "it has to be finite and above 0",
            "stiffness",
        )
    bad = np.flatnonzero(~(np.isfinite(free) & (free >= 0)))
    if len(bad):
        raise InputError(
            f"the gap of joint {which[bad[0]]} is {free[bad[0]]!r}", "it has to be finite and 0 or more", "gap"
        )
    return JointSprings(which, stiff, free, poses.angles[which].copy())


def no_joint_springs() -> JointSprings:
    """None at all."""
    none = np.zeros(0)
    return JointSprings(np.zeros(0, np.int64), none, none, none)
