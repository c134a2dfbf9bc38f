"""What drives a net from flat to its designed shape: one number, a weighted sum of its joints' angles.

The mean of the angles would not do: by symmetry it is often the same all the way. Each joint is weighted by what it has
to turn from flat to designed, so that the sum grows steadily, and the moments that drive it are in proportion to the
same weights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses

# rad: turns less than this are rounding, and no direction to drive in
LEAST_JOINT_TURN = 1e-6
# of a share of the way: what is beyond is rounding
SHARE_DIGITS = 12


@dataclass(frozen=True)
class Driver:
    """A weighted sum of joints' angles that goes from one value to another.

    Attributes
    ----------
    weights : (6 n + k,)
        Of the joints' angles, the sum of their squares 1; 0 of all other unknowns.
    flat, designed : float
        Sum of the weighted angles at either end, rad.
    """

    weights: Floats
    flat: float
    designed: float

    @classmethod
    def between(cls, flat: Poses, designed: Poses) -> Driver:
        """From the joints' angles of one pose to those of another.

        Raises
        ------
        InputError
            No joint turns.
        """
        turn = designed.angles - flat.angles
        size = float(np.linalg.norm(turn))
        if not size > LEAST_JOINT_TURN * np.sqrt(max(len(turn), 1)):
            raise InputError(
                "no joint turns between the two states: there is nothing to be driven",
                "the net is as it will be; leave the erection out",
                "joints",
            )
        weights = np.concatenate((np.zeros(NODE_UNKNOWNS * len(flat.points)), turn / size))
        return cls(weights, float(turn @ flat.angles / size), float(turn @ designed.angles / size))

    @property
    def span(self) -> float:
        """From flat to designed, rad."""
        return self.designed - self.flat

    def share(self, poses: Poses) -> float:
        """Of the way from flat (0) to designed (1)."""
        angles = self.weights[NODE_UNKNOWNS * len(poses.points) :]
        # minus zero is no share
        return round((float(angles @ poses.angles) - self.flat) / self.span, SHARE_DIGITS) + 0.0
