"""Equilibria on the way that a device drives a net along."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.erection.release import DESIGN_NUDGE
from lamella.erection.way import Snap
from lamella.structure.controls import LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.pseudo_transient import settled
from lamella.structure.static import loaded


@dataclass(frozen=True, eq=False)
class Found:
    """A state on the way.

    Attributes
    ----------
    here : Equilibrium
    share : float
    snap : Snap or None
        Where the net snapped to it.
    """

    here: Equilibrium
    share: float
    snap: Snap | None = None


def device_states(
    begin: Equilibrium, states: int, towards: Floats, named: int, progress: Progress = silent
) -> Iterator[Found]:
    """States at equal shares of the way, as far as it leads.

    Where the equilibrium that is followed becomes unstable the net leaves it for the side of a shape, as a flat net
    leaves its plane; where it ends, at a limit point, the net snaps to another one, if there is one at that share.

    Parameters
    ----------
    begin : Equilibrium
        At the load factor 0; 1 is the whole way.
    states : int
        Of the way, both ends counted.
    towards : (n, 3)
        Places of all nodes in the shape to whose side it goes, m.
    named : int
        The first so many nodes are those of the network, one of which names a limit point.
    progress : callable
    """
    here = begin
    yield Found(here, 0.0)
    for number in range(1, states):
        share = number / (states - 1)
        progress(Report.detail(f"driven to {100 * share:.0f} %", share))
        try:
            after, snapped = loaded(here, share), False
        except InputError:
            after, snapped = here, True
        if snapped or after.negative:
            points = after.poses.points + DESIGN_NUDGE * (towards - after.poses.points)
            control = LoadControl(share)
            try:
                after = settled(replace(after, poses=replace(after.poses, points=points)), control, control)
            except InputError:
                return
        yield Found(after, share, farthest(here, after, share, number, named) if snapped else None)
        here = after


def farthest(before: Equilibrium, after: Equilibrium, share: float, state: int, named: int) -> Snap:
    """The node of the network that moved farthest from one equilibrium to another, of the first `named`."""
    moved = np.linalg.norm(after.poses.points - before.poses.points, axis=1)[:named]
    node = int(np.round(moved, 9).argmax())
    return Snap(share, state, node, float(moved[node]))
