"""A net used as a mechanism: driven by its easiest motion from one angle of a joint to another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.ties import grid_of, rounded
from lamella.erection.device_states import farthest
from lamella.erection.driver import Driver
from lamella.erection.erection import Erection
from lamella.erection.flat_shape import FlatShape
from lamella.erection.free_net import free_net
from lamella.erection.joint_angles import designed_angles
from lamella.erection.release import STIFF, released
from lamella.erection.rigid_motion import moved_onto
from lamella.erection.state import State
from lamella.erection.warnings import erection_warnings
from lamella.erection.way import RangeOfMotion, Snap, Way
from lamella.strip.lamellas import Lamellas
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.joint_springs import make_joint_springs
from lamella.structure.loads import no_loads
from lamella.structure.model.model import Model
from lamella.structure.stability import is_stable
from lamella.structure.static import at_rest, displacement_path
from lamella.structure.structure import Structure
from lamella.structure.tangent import Tangent


def as_mechanism(
    lamellas: Lamellas,
    least: float,
    most: float,
    *,
    node: int | None = None,
    states: int = 20,
    elements: int = 2,
    progress: Progress = silent,
) -> Erection:
    """A net with free joints, driven between two angles of one of them.

    What drives it are moments on all joints in proportion to what each turns in the easiest motion of the designed
    shape: the one that costs least energy for the sum of squares of all joints' turns.

    Parameters
    ----------
    lamellas : Lamellas
    least, most : float
        Angles of the joint at `node`, from A to B, deg.
    node : int, optional
        Of the network, with a joint; default: the one that turns most in the easiest motion.
    states : int
        At equal parts of that angle, both ends counted.
    elements : int
        Beam elements in a cell edge.
    progress : callable

    Returns
    -------
    Erection
        With a `way` of the kind "angles" and `motion`. States that cannot be reached are left out.

    Raises
    ------
    InputError
        A node without a joint that turns; no motion; fewer than two states.
    """
    if states < 2:
        raise InputError(f"states = {states}", "both ends are states: at least 2", "states")
    model = free_net(lamellas, elements)
    free = model.structure
    progress(Report.step("joints locked: how far it springs back"))
    locked = at_rest(replace(free, held_joints=np.ones_like(free.held_joints)), no_loads(free))
    weights, joint = _driven(model, locked, node)
    progress(Report.step("joints let go, held by the driver"))
    begin = released(locked, free, weights, progress)
    progress(Report.step("driven as a mechanism"))
    designed = float(designed_angles(lamellas.network, model.joint_nodes)[joint])
    goals = np.linspace(np.radians(least), np.radians(most), states) - designed
    up = goals >= begin.poses.angles[joint]
    rising, risen = _states(model, begin, joint, goals[up], progress)
    falling, fallen = _states(model, begin, joint, goals[~up][::-1], progress)
    found = [*falling[::-1], *rising]
    if not found:
        raise InputError(
            f"no state between {least:g} and {most:g} deg is reached from the designed {np.degrees(designed):.4g} deg",
            "choose angles nearer to that",
            "least",
        )
    angles = np.array([one.poses.angles[joint] for one in found])
    span = angles[-1] - angles[0] or 1.0
    told = tuple(
        State.of(
            model,
            one,
            round(float((angle - angles[0]) / span), 12) + 0.0,
            one.factor,
            stable=is_stable(one, weights),
        )
        for one, angle in zip(found, angles.tolist(), strict=True)
    )
    off = moved_onto(locked.poses.points[: model.nodes], free.poses.points[: model.nodes])
    sums = [float(weights @ _angles(one)) for one in (found[0], found[-1])]
    result = Erection(
        model=model,
        driver=Driver(weights, *sums),
        each_joint=False,
        states=told,
        flat=FlatShape.of(model, told[0].poses, laid=False),
        held=False,
        hold=0.0,
        locked=State.of(model, locked, 1.0, 0.0, stable=locked.negative == 0),
        spring_back=float(off.max()),
        warnings=(),
        way=Way(
            kind="angles",
            start="designed",
            unit="N m",
            gravity=False,
            travel=float(span),
            nodes=np.zeros(0, np.int64),
            forces=np.zeros((len(found), 0)),
            snaps=(),
            stop=risen or fallen,
            off_design=float(moved_onto(found[-1].poses.points[: model.nodes], free.poses.points[: model.nodes]).max()),
        ),
        motion=RangeOfMotion(
            int(model.joint_nodes[joint]), *(float(np.degrees(designed + angles[k])) for k in (0, -1))
        ),
    )
    return replace(result, warnings=tuple(erection_warnings(result)))


def _angles(here: Equilibrium) -> Floats:
    return np.concatenate((np.zeros(NODE_UNKNOWNS * len(here.poses.points)), here.poses.angles))


def _driven(model: Model, locked: Equilibrium, node: int | None) -> tuple[Floats, int]:
    """Weights of the joints' angles, and the joint that is told of, which opens."""
    free = model.structure
    weights = easiest_motion(locked, free)
    turns = weights[len(weights) - len(free.held_joints) :]
    if node is None:
        joint = int(rounded(np.abs(turns), grid_of(1.0)).argmax())
    else:
        at = np.flatnonzero(model.joint_nodes == node)
        joint = int(at[0]) if len(at) else -1
        if joint < 0 or not turns[joint]:
            raise InputError(f"node {node} has no joint that turns", "choose a node where two lamellas cross", "at")
    return weights * np.sign(turns[joint]), joint


def easiest_motion(locked: Equilibrium, free: Structure) -> Floats:
    """What joints turn in the motion that costs least energy for the sum of squares of all turns, (6 n + k,).

    It is the lowest mode x of K x = r J x, J the unit matrix of the joints' angles and zero elsewhere. Springs in the
    joints add to every r alike, so that they change no mode, and make K positive definite.

    Parameters
    ----------
    locked : Equilibrium
        All joints locked.
    free : Structure
        The same with free joints.

    Returns
    -------
    (6 n + k,)
        Sum of squares 1; 0 but for free joints.
    """
    loose = np.flatnonzero(~free.held_joints)
    moments = np.abs(locked.internal[len(locked.internal) - len(free.held_joints) + loose])
    stiffness = STIFF * max(float(moments.max(initial=0.0)), np.finfo(float).tiny)
    sprung = replace(free, joint_springs=make_joint_springs(locked.poses, stiffness, joints=loose))
    tangent = Tangent.of(Equilibrium(sprung, no_loads(sprung), 0.0, locked.poses, 0, 0))
    unit = [np.zeros_like(block) for block in tangent.blocks[:-1]]
    unit.append(np.ones_like(tangent.blocks[-1]))
    _, motions = tangent.modes(unit, 1)
    weights = np.zeros_like(motions[0])
    first = len(weights) - len(free.held_joints)
    weights[first + loose] = motions[0, first + loose]
    return np.asarray(weights / np.linalg.norm(weights))


def _states(
    model: Model, begin: Equilibrium, joint: int, goals: Floats, progress: Progress
) -> tuple[list[Equilibrium], Snap | None]:
    """At some angles of a joint, one after the other; and where the way ends before."""
    control = np.zeros(begin.poses.unknowns)
    control[len(control) - len(begin.poses.angles) + joint] = 1.0
    here = begin
    found: list[Equilibrium] = []
    for number, goal in enumerate(goals.tolist()):
        progress(Report.detail(f"joint turned by {np.degrees(goal):.1f} deg", number / len(goals)))
        before = here
        try:
            for onward in displacement_path(before, control, goal - before.poses.angles[joint]):
                here = onward
        except InputError:
            return found, farthest(before, here, float(number / len(goals)), number, model.nodes)
        found.append(here)
    return found, None
