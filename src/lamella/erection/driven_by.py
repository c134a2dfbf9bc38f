"""A net driven as people do on site: by cables, a crane, a ring, moved supports."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.erection.device_states import Found, device_states, farthest
from lamella.erection.erection import Erection
from lamella.erection.flat_shape import FlatShape
from lamella.erection.flatness import fitted_plane
from lamella.erection.free_net import free_net
from lamella.erection.ground import Ground
from lamella.erection.laid_flat import laid_flat
from lamella.erection.moved_nodes import Lift
from lamella.erection.release import released
from lamella.erection.rigged import Device, Rigged
from lamella.erection.rigid_holds import rigid_holds
from lamella.erection.rigid_motion import moved_onto
from lamella.erection.rigid_turn import RigidTurn
from lamella.erection.state import State
from lamella.erection.turned_joints import TurnedJoints
from lamella.erection.warnings import erection_warnings
from lamella.erection.way import Way
from lamella.strip.lamellas import Lamellas
from lamella.structure.beam.poses import Poses
from lamella.structure.controls import LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.model.model import Model
from lamella.structure.model.node_poses import bare_nodes
from lamella.structure.newton import StepError, step
from lamella.structure.pseudo_transient import settled
from lamella.structure.static import at_rest

Start = Literal["flat", "designed"]
Side = Literal["designed", "other"]


def driven_by(
    lamellas: Lamellas,
    device: Device,
    *,
    states: int = 20,
    elements: int = 2,
    start: Start = "flat",
    side: Side = "designed",
    ground: Ground | None = None,
    progress: Progress = silent,
) -> Erection:
    """A net with free joints that a device drives.

    Parameters
    ----------
    lamellas : Lamellas
    device : Device
        A `Ropes`, `Lift`, `Ring`, `Together` or `TurnedJoints`.
    states : int
        Of the way, both ends counted, at equal shares of what the device does.
    elements : int
        Beam elements in a cell edge.
    start : "flat" or "designed"
        What the way begins in; the designed shape with free joints, held by the device alone.
    side : "designed" or "other"
        To which side of its plane a net goes that may leave it to either one.
    ground : Ground, optional
        Default: the net has no weight.
    progress : callable

    Returns
    -------
    Erection
        With a `way`. States are where the net lies with the device's axis upwards where it weighs, else where it was
        designed. Where no further state is found the way ends before: `Way.stop`.

    Raises
    ------
    InputError
        As `lamella.erection.erect.erect`; a device that does not suit the net; a lift of what has no weight.
    """
    if states < 2:
        raise InputError(f"states = {states}", "both ends are states: at least 2", "states")
    ground = Ground() if ground is None else ground
    if isinstance(device, Lift) and not (ground.gravity or len(ground.props)):
        raise InputError("a net without weight is lifted as a whole", "let it weigh", "gravity")
    model = free_net(lamellas, elements)
    free = model.structure
    progress(Report.step("joints locked: how far it springs back"))
    locked = at_rest(replace(free, held_joints=np.ones_like(free.held_joints)), no_loads(free))
    rigged, begin, turn = _begun(model, locked, device, start, ground, progress)
    progress(Report.step(f"driven: {device.kind}"))
    nodes = slice(0, model.nodes)
    found = list(device_states(begin, states, _towards(turn.of(free.poses), begin.poses, side), model.nodes, progress))
    told = [
        State.of(model, one.here, one.share, rigged.drive(one.here), stable=one.here.negative == 0) for one in found
    ]
    if not ground.gravity:
        told = [replace(one, poses=turn.back.of(one.poses)) for one in told]
    off = moved_onto(locked.poses.points[nodes], free.poses.points[nodes])
    result = Erection(
        model=model,
        driver=None,
        each_joint=False,
        states=tuple(told),
        flat=FlatShape.of(model, told[0].poses, laid=start == "flat"),
        held=False,
        hold=0.0,
        locked=State.of(model, locked, 1.0, 0.0, stable=locked.negative == 0),
        spring_back=float(off.max()),
        warnings=(),
        way=_way(model, device, rigged, found, states, start, ground),
    )
    return replace(result, warnings=tuple(erection_warnings(result)))


def _way(
    model: Model, device: Device, rigged: Rigged, found: list[Found], states: int, start: Start, ground: Ground
) -> Way:
    nodes = slice(0, model.nodes)
    designed, last = model.structure.poses.points[nodes], found[-1]
    before = found[-2] if len(found) > 1 else last
    return Way(
        kind=device.kind,
        start=start,
        unit="N m" if isinstance(device, TurnedJoints) else "N",
        gravity=ground.gravity,
        travel=rigged.travel,
        nodes=rigged.nodes,
        forces=np.array([rigged.forces(one.here) for one in found]).reshape(len(found), -1),
        snaps=tuple(one.snap for one in found if one.snap is not None),
        stop=None
        if len(found) == states
        else farthest(before.here, last.here, last.share, len(found) - 1, model.nodes),
        off_design=float(moved_onto(last.here.poses.points[nodes], designed).max()),
    )


def _begun(
    model: Model, locked: Equilibrium, device: Device, start: Start, ground: Ground, progress: Progress
) -> tuple[Rigged, Equilibrium, RigidTurn]:
    """The rigged net, the equilibrium that its way begins in, and the motion that brings the device's axis upwards."""
    free = model.structure
    nodes = slice(0, model.nodes)
    poses = free.poses
    if start == "flat":
        progress(Report.step("joints let go: how it lies flat"))
        poses = laid_flat(locked, free, progress).poses
    points = poses.points[nodes]
    up = device.up(points)
    if up is None:
        up = fitted_plane(points, poses.frames[nodes, :, 2]).axes[2]
    turn = RigidTurn.upright(up, points.mean(0))
    there = turn.of(poses)
    held = np.zeros_like(free.held)
    held[bare_nodes(model.lamellas.network)] = True
    rigged = device.rig(replace(free, poses=there, held=held))
    rigged = ground.under(rigged, model, _raised(there.points[nodes], turn.of(free.poses).points[nodes]))
    rigged = _steadied(rigged, model, ground.gravity)
    if start == "designed":
        progress(Report.step("joints let go, held by the device"))
        return rigged, _let_go(rigged, progress), turn
    return rigged, _resting(Equilibrium(rigged.structure, rigged.loads, 0.0, there, 0, 0)), turn


def _let_go(rigged: Rigged, progress: Progress) -> Equilibrium:
    """From the designed shape with locked joints."""
    freed = rigged.structure
    standing = at_rest(replace(freed, held_joints=np.ones_like(freed.held_joints)), rigged.loads)
    if freed.held_joints.all():
        return replace(standing, structure=freed)
    return released(standing, freed, progress=progress, loads=rigged.loads)


def _resting(begin: Equilibrium) -> Equilibrium:
    """Near a pose that was at rest without the device and without weight."""
    try:
        found = step(begin, LoadControl(0.0))
    except StepError:
        found = begin
    if found is not begin and found.negative == 0:
        return found
    return settled(begin, LoadControl(0.0), LoadControl(0.0))


def _raised(lying: Floats, designed: Floats) -> Floats:
    """By how much nodes are higher in the designed shape when both have their lowest node on the floor, m."""
    return np.asarray((designed[:, 2] - designed[:, 2].min()) - (lying[:, 2] - lying[:, 2].min()))


def _steadied(rigged: Rigged, model: Model, floor: bool) -> Rigged:
    """With what keeps it from moving as a rigid body."""
    structure = rigged.structure
    able = np.zeros(len(structure.poses.points), bool)
    able[np.unique(model.lamellas.network.stop_nodes)] = True
    held = structure.held[:, :3] & able[:, None]
    if floor:
        held = held.copy()
        held[able, 2] = True
    more = structure.held.copy()
    more[:, :3] |= rigid_holds(structure.poses.points, held, able, rigged.nodes)
    return replace(rigged, structure=replace(structure, held=more))


def _towards(designed: Poses, begin: Poses, side: Side) -> Floats:
    """Places in the designed shape, or in its image on the other side of the plane that a net begins in, (n, 3)."""
    points = designed.points.copy()
    if side == "other":
        points[:, 2] = 2 * begin.points[:, 2].mean() - points[:, 2]
    return points
