"""A net laid flat, and driven from there to its designed shape."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.erection.device_states import farthest
from lamella.erection.driver import Driver
from lamella.erection.erection import Erection
from lamella.erection.flat_shape import FlatShape
from lamella.erection.free_net import free_net
from lamella.erection.laid_flat import laid_flat
from lamella.erection.path import driven_states, joint_moment, turned_states
from lamella.erection.rigid_motion import moved_onto
from lamella.erection.state import State
from lamella.erection.warnings import erection_warnings
from lamella.erection.way import Snap
from lamella.strip.lamellas import Lamellas
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.model.model import Model
from lamella.structure.stability import is_stable
from lamella.structure.static import at_rest

# over the largest force or moment of the locked net, in N and N m
ROUNDING_MOMENT = 1e-9
# of the net's size: farther from the locked shape the driver alone does not hold the net in it
LET_GO = 0.1


def erect(lamellas: Lamellas, *, states: int = 20, elements: int = 2, progress: Progress = silent) -> Erection:
    """The flat state of a net and its way to the designed shape.

    One number drives all joints, their angles weighted by what they have to turn. Where that alone would let the net
    go elsewhere, each joint is turned to its own angle instead.

    Parameters
    ----------
    lamellas : Lamellas
    states : int
        Both ends counted.
    elements : int
        Beam elements in a cell edge.
    progress : callable

    Raises
    ------
    InputError
        A net without joints; one that does not come to rest; fewer than two states.
    """
    if states < 2:
        raise InputError(f"states = {states}", "both ends are states: at least 2", "states")
    model = free_net(lamellas, elements)
    free = model.structure
    held = replace(free, held_joints=np.ones_like(free.held_joints))
    progress(Report.step("joints locked: how far it springs back"))
    locked = at_rest(held, no_loads(held))
    progress(Report.step("joints let go: how it lies flat"))
    lying = laid_flat(locked, free, progress)
    driver = Driver.between(lying.poses, locked.poses)
    progress(Report.step("driven from the designed shape to flat"))
    told, each_joint, stop = _states(model, locked, lying, driver, states, progress)
    off = moved_onto(locked.poses.points[: model.nodes], free.poses.points[: model.nodes])
    result = Erection(
        model=model,
        driver=driver,
        each_joint=each_joint,
        states=told,
        flat=FlatShape.of(model, lying.poses),
        held=bool(lying.loads.forces.any()),
        hold=_moment(lying, float(np.abs(locked.internal).max())),
        locked=State.of(model, locked, 1.0, 0.0, stable=locked.negative == 0),
        spring_back=float(off.max()),
        warnings=(),
        stop=stop,
    )
    return replace(result, warnings=tuple(erection_warnings(result)))


def _moment(lying: Equilibrium, largest: float) -> float:
    """On each joint, N m; 0 where it is rounding of the largest force or moment."""
    moment = abs(lying.factor) * float(np.abs(lying.loads.forces).max(initial=0.0))
    return moment if moment > ROUNDING_MOMENT * largest else 0.0


def _states(
    model: Model, locked: Equilibrium, lying: Equilibrium, driver: Driver, states: int, progress: Progress
) -> tuple[tuple[State, ...], bool, Snap | None]:
    """From flat to designed; whether each joint had to be turned; and where no equilibrium was found on the way."""

    def driven(found: Iterable[Equilibrium]) -> list[State]:
        return [
            State.of(model, one, driver.share(one.poses), one.factor, stable=is_stable(one, driver.weights))
            for one in found
        ]

    if not lying.loads.forces.any():
        way = driven_states(locked, model.structure, driver, states, progress)
        first = next(way)
        nodes = slice(0, model.nodes)
        away = float(moved_onto(first.poses.points[nodes], locked.poses.points[nodes]).max())
        if away <= LET_GO * model.structure.size:
            found, whole = _reached(way)
            if whole:
                return tuple(driven([first, *found])[::-1]), False, None
    found, whole = _reached(turned_states(locked, driver, states, progress))
    turned = [
        State.of(model, one, driver.share(one.poses), joint_moment(one, driver), stable=one.negative == 0)
        for one in found
    ]
    if whole:
        return tuple(turned[::-1]), True, None
    # the flat state is known whatever lies between
    flat = State.of(model, lying, 0.0, 0.0, stable=lying.negative == 0)
    before = found[-2] if len(found) > 1 else lying
    stop = farthest(before, found[-1], turned[-1].share, states - len(found), model.nodes)
    return (flat, *turned[::-1]), True, stop


def _reached(way: Iterator[Equilibrium]) -> tuple[list[Equilibrium], bool]:
    """The states of a way up to where no further equilibrium is found, and whether that is its end."""
    found: list[Equilibrium] = []
    try:
        found.extend(way)
    except InputError:
        return found, False
    return found, True
