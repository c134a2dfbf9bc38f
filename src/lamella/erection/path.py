"""Equilibria on the way from flat to designed, as one number drives the joints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.erection.driver import Driver
from lamella.erection.release import released
from lamella.structure.controls import DisplacementControl, LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.pseudo_transient import settled
from lamella.structure.static import displacement_path, loaded
from lamella.structure.structure import Structure


def driven_states(
    locked: Equilibrium, free: Structure, driver: Driver, states: int, progress: Progress = silent
) -> Iterator[Equilibrium]:
    """States at equal shares of the way, from designed to flat, as a weighted sum of the joints' angles is driven.

    On the side of the designed shape there is no choice: flat nets may leave their plane in two ways, and from the
    curved one each is the continuation of itself. The first state has joints held by the driver alone, not each at its
    designed angle.

    Parameters
    ----------
    locked : Equilibrium
        The designed shape, all joints locked.
    free : Structure
        As of `lamella.erection.release.released`.
    driver : Driver
    states : int
        Of the way, both ends counted.
    progress : callable

    Yields
    ------
    Equilibrium
        Its load factor is what drives the net towards the designed shape, N m.

    Raises
    ------
    InputError
        No equilibrium is found beyond some share.
    """
    here = released(locked, free, driver.weights, progress)
    yield here
    part = -driver.span / (states - 1)
    for left in range(states - 2, -1, -1):
        _tell(progress, left, states)
        here = _onward(here, driver, part)
        yield here


def _onward(here: Equilibrium, driver: Driver, part: float) -> Equilibrium:
    """The next state; where no path leads to it the one that the net snaps to."""
    try:
        *_, last = displacement_path(here, driver.weights, part)
    except InputError:
        control, kept = (DisplacementControl(driver.weights, by) for by in (part, 0.0))
        return settled(here, control, kept, driver.weights)
    return last


def turned_states(
    locked: Equilibrium, driver: Driver, states: int, progress: Progress = silent
) -> Iterator[Equilibrium]:
    """The same states where each joint is turned to its own angle, all in proportion.

    Parameters
    ----------
    locked : Equilibrium
        The designed shape, all joints locked.
    driver : Driver
    states : int
    progress : callable

    Yields
    ------
    Equilibrium
        Its load factor is the share of the way back; the joints' moments are its forces there, see `joint_moment`.

    Raises
    ------
    InputError
        No equilibrium is found beyond some share.
    """
    structure = locked.structure
    loads = replace(no_loads(structure), motions=-driver.span * driver.weights)
    here = replace(locked, loads=loads, factor=0.0)
    yield here
    for left in range(states - 2, -1, -1):
        _tell(progress, left, states)
        share = 1 - left / (states - 1)
        try:
            here = loaded(here, share)
        except InputError:
            here = settled(here, LoadControl(share), LoadControl(share))
        yield here


def joint_moment(equilibrium: Equilibrium, driver: Driver) -> float:
    """What is conjugate to the weighted sum of the angles where each joint is held, N m."""
    joints = len(equilibrium.poses.angles)
    own = np.asarray(equilibrium.internal[-joints:])
    return float(driver.weights[-joints:] @ own)


def _tell(progress: Progress, left: int, states: int) -> None:
    progress(Report.detail(f"driven to {100 * left / (states - 1):.0f} %", (states - 1 - left) / (states - 1)))
