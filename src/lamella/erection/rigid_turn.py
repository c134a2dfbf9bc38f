"""A rigid motion of poses and back."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.poses import Poses

# sine of an angle that is none
NO_TURN = 1e-12


@dataclass(frozen=True)
class RigidTurn:
    """x -> turned x + shift.

    Attributes
    ----------
    turned : (3, 3)
        Rotation.
    shift : (3,)
        m.
    """

    turned: Floats
    shift: Floats

    @classmethod
    def upright(cls, up: Floats, centre: Floats) -> RigidTurn:
        """The least rotation that brings a direction upwards, about a point."""
        z = up / np.linalg.norm(up)
        axis = np.cross(z, (0.0, 0.0, 1.0))
        sine, cosine = float(np.linalg.norm(axis)), float(z[2])
        if sine < NO_TURN:
            turned = np.diag([1.0, np.sign(cosine), np.sign(cosine)])
        else:
            k = axis / sine
            cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
            turned = np.eye(3) + sine * cross + (1 - cosine) * cross @ cross
        return cls(turned, centre - turned @ centre)

    @property
    def back(self) -> RigidTurn:
        """The inverse."""
        return RigidTurn(self.turned.T, -self.turned.T @ self.shift)

    def of(self, poses: Poses) -> Poses:
        """Poses moved by it."""
        return replace(poses, points=poses.points @ self.turned.T + self.shift, frames=self.turned @ poses.frames)
