"""Joints let go: what a net of bent strips does when its joints are free to turn.

Springs in the joints that hold them at the angles they are locked at, weakened until there are none. That is stable for
longer than taking the joints' moments away would be; where the net snaps all the same, it is followed to where it comes
to rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report, silent
from lamella.structure.beam.poses import Poses
from lamella.structure.controls import Control, DisplacementControl, LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.joint_springs import JointSprings, make_joint_springs
from lamella.structure.loads import Loads, no_loads
from lamella.structure.newton import StepError, step
from lamella.structure.pseudo_transient import settled
from lamella.structure.stability import is_stable
from lamella.structure.structure import Structure

# first stiffness of the springs, over the largest moment in a joint (a turn by a thousandth of a radian); as a share of
# that moment what is no spring any more
STIFF, GONE = 1e3, 1e-3
# what the stiffness is multiplied by in a step: the first time, at the least, and at the most: where so small a change
# finds no equilibrium the net snaps
FIRST_SPRING_RATIO, LEAST_SPRING_RATIO, MOST_SPRING_RATIO = 0.25, 0.1, 0.9
# share of the way to the designed shape
DESIGN_NUDGE = 1e-3
# iterations of a step after which the next one may be twice as long
EASY_ITERATIONS = 5


def released(
    locked: Equilibrium,
    free: Structure,
    driver: Floats | None = None,
    progress: Progress = silent,
    loads: Loads | None = None,
) -> Equilibrium:
    """A structure whose locked joints are let go.

    Parameters
    ----------
    locked : Equilibrium
        All joints locked.
    free : Structure
        The same with its joints free but for those that stay locked.
    driver : (6 n + k,), optional
        Weights of the joints' angles: their sum is kept, by a moment on each joint in proportion to its weight.
    progress : callable
    loads : Loads, optional
        That act all the time, and those that the way goes on with.

    Returns
    -------
    Equilibrium
        Stable, joints free; its load factor is the driver's moment, N m, 0 without.

    Raises
    ------
    InputError
        It does not come to rest.
    """
    loose = np.flatnonzero(~free.held_joints)
    moments = np.abs(locked.internal[len(locked.internal) - len(free.held_joints) + loose])
    largest = float(moments.max(initial=0.0))
    stiffness, ratio = STIFF * largest, FIRST_SPRING_RATIO
    springs = make_joint_springs(locked.poses, max(stiffness, np.finfo(float).tiny), joints=loose)
    free = replace(free, joint_springs=springs)
    loads = no_loads(free) if loads is None else loads
    if driver is not None:
        loads = replace(loads, forces=driver)
    here = Equilibrium(free, loads, 0.0, locked.poses, 0, 0)
    kept: Control = LoadControl(0.0) if driver is None else DisplacementControl(driver, 0.0)
    last, trial = stiffness, stiffness
    while True:
        sprung = _sprung(free, springs, trial)
        progress(Report.detail(f"joints let go: springs of {trial:.3g} N m/rad"))
        try:
            here = step(replace(here, structure=sprung), kept)
        except StepError:
            if ratio < MOST_SPRING_RATIO and trial < stiffness:
                ratio = ratio**0.5
                trial = last * ratio
                continue
            here = settled(replace(here, structure=sprung), kept, kept, driver)
            ratio = FIRST_SPRING_RATIO
        if not is_stable(here, driver):
            here = settled(_nudged(here, locked.poses), kept, kept, driver)
        if trial == 0:
            return replace(here, structure=replace(free, joint_springs=_none(springs)))
        if here.iterations <= EASY_ITERATIONS:
            ratio = max(ratio**2, LEAST_SPRING_RATIO)
        last, trial = trial, trial * ratio
        if trial < GONE * largest or largest == 0:
            trial = 0.0


def _sprung(structure: Structure, springs: JointSprings, stiffness: float) -> Structure:
    """With joint springs of another stiffness."""
    even = replace(springs, stiffness=np.full(len(springs), stiffness))
    return structure.on_springs(structure.node_springs, even)


def _nudged(here: Equilibrium, towards: Poses) -> Equilibrium:
    """Out of balance by a little, towards another pose: the way that a net buckles in is not left to rounding."""
    points = here.poses.points + DESIGN_NUDGE * (towards.points - here.poses.points)
    return replace(here, poses=replace(here.poses, points=points))


def _none(springs: JointSprings) -> JointSprings:
    return JointSprings(springs.joints[:0], springs.stiffness[:0], springs.gap[:0], springs.rest[:0])
