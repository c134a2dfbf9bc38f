r"""Where a structure comes to rest that an equilibrium lets go: past snaps, which no path of equilibria leads through.

Pseudo-transient continuation (C. T. Kelley, D. E. Keyes, SIAM Journal on Numerical Analysis 35 (1998) 508): all
unknowns move against a drag, an implicit step in time at a time, so that the energy falls and what is come to is
stable. The drag of a step are springs that are at rest where it begins. It is lessened while steps are easy, and at the
end there is none.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.structure.beam.poses import Poses
from lamella.structure.controls import Control
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.joint_springs import JointSprings
from lamella.structure.newton import StepError, step
from lamella.structure.node_springs import NodeSprings
from lamella.structure.stability import is_stable
from lamella.structure.structure import Structure

# first drag, of the bending stiffness 12 E I / l^3 of an element about its weak axis
FIRST_DRAG = 1e-3
# what it is multiplied by after a step that did not converge, and after an easy one
MORE_DRAG, LESS_DRAG = 10.0, 0.2
# iterations of a step that is easy
EASY_ITERATIONS = 5
# motion in a step, over the structure's size and in radians, after which drag is left out
NEARLY_AT_REST = 1e-4
MOST_DRAGGED_STEPS = 400
# of the first drag: with more than this nothing would move, and something else is wrong
MOST_DRAG = 1e9


def settled(start: Equilibrium, control: Control, onward: Control, held: Floats | None = None) -> Equilibrium:
    """The stable equilibrium that is come to from a pose out of balance.

    Parameters
    ----------
    start : Equilibrium
        Its poses need not be in balance.
    control : Control
        Of the first step: what is asked for.
    onward : Control
        Of all others: that it is kept.
    held : (6 n + k,), optional
        Weights of the sum of unknowns that they hold, see `lamella.structure.stability`.

    Raises
    ------
    InputError
        It does not come to rest.
    """
    structure = start.structure
    bending = np.array([kind.bending_n for kind in structure.beams.sections])[structure.beams.section]
    length = structure.beams.law.length
    first = drag = FIRST_DRAG * float(np.mean(12 * bending / length**3))
    # rotations are dragged by as much as the shifts that they make an element's length away
    lever = float(np.mean(length))
    here, asked, resting = start, control, False
    for _ in range(MOST_DRAGGED_STEPS):
        if resting:
            last = _step(here, asked, held)
            if last is not None:
                return last
            resting = False
        moved = _step(replace(here, structure=_dragged(structure, here.poses, drag, lever)), asked, held)
        if moved is None:
            drag *= MORE_DRAG
            if drag > MOST_DRAG * first:
                break
            continue
        resting = _motion(here.poses, moved.poses, structure.size) < NEARLY_AT_REST
        asked, here = onward, replace(moved, structure=structure)
        if moved.iterations <= EASY_ITERATIONS:
            drag *= LESS_DRAG
    raise InputError(
        f"the structure does not come to rest in {MOST_DRAGGED_STEPS} steps from the load factor {start.factor:.6g}",
        "the structure gives way there, or nothing holds a part of it",
        "structure",
    )


def _step(start: Equilibrium, control: Control, held: Floats | None) -> Equilibrium | None:
    """A stable equilibrium; None where it is not found, or an unstable one."""
    try:
        found = step(start, control)
    except StepError:
        return None
    return found if is_stable(found, held) else None


def _dragged(structure: Structure, poses: Poses, drag: float, lever: float) -> Structure:
    """The structure with further springs on all unknowns, at rest in a pose."""
    own, joints = structure.node_springs, structure.joint_springs
    nodes, angles = len(poses.points), len(poses.angles)
    stiffness = drag * np.tile([1.0, 1.0, 1.0, lever**2, lever**2, lever**2], (nodes, 1))
    node_springs = NodeSprings(
        np.concatenate((own.nodes, np.arange(nodes))),
        np.concatenate((own.stiffness, stiffness)),
        np.concatenate((own.points, poses.points)),
        np.concatenate((own.frames, poses.frames)),
        np.concatenate((own.one_way, np.zeros(nodes, bool))),
    )
    joint_springs = JointSprings(
        np.concatenate((joints.joints, np.arange(angles))),
        np.concatenate((joints.stiffness, np.full(angles, drag * lever**2))),
        np.concatenate((joints.gap, np.zeros(angles))),
        np.concatenate((joints.rest, poses.angles)),
    )
    return structure.on_springs(node_springs, joint_springs)


def _motion(one: Poses, other: Poses, size: float) -> float:
    """Largest shift over a size, or turn of a joint, between two poses."""
    shift = np.abs(other.points - one.points).max() / size
    return float(max(shift, np.abs(other.angles - one.angles).max(initial=0.0)))
