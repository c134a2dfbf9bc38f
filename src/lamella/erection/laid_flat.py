"""The flat state of a net: what it does once its joints are free."""

from __future__ import annotations

import numpy as np

from lamella.base.progress import Progress, silent
from lamella.erection.release import released
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.structure import Structure

# rad: a net of which a joint, let go, turns farther is folding up
FOLDING = np.radians(75.0)


def laid_flat(locked: Equilibrium, free: Structure, progress: Progress = silent) -> Equilibrium:
    """The flat state; with the mean of the joints' angles kept where the net would fold up.

    Parameters
    ----------
    locked : Equilibrium
        The designed shape, all joints locked.
    free : Structure
        As of `lamella.erection.release.released`.
    progress : callable

    Raises
    ------
    InputError
        It does not come to rest.
    """
    alone = released(locked, free, progress=progress)
    if np.abs(alone.poses.angles).max(initial=0.0) < FOLDING:
        return alone
    loose = ~free.held_joints
    weights = np.zeros(free.poses.unknowns)
    weights[NODE_UNKNOWNS * len(free.poses.points) :][loose] = 1 / np.sqrt(loose.sum())
    return released(locked, free, weights, progress)
