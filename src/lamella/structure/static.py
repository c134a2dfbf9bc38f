"""Equilibrium under loads by steps that find their own length."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.beam.relative_motion import RelativeMotion
from lamella.structure.controls import ArcLengthControl, DisplacementControl, LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads, no_loads
from lamella.structure.mechanism import refuse_mechanism
from lamella.structure.newton import StepError, step
from lamella.structure.pseudo_transient import settled
from lamella.structure.structure import Structure

# iterations of a step after which the next one may be twice as long
EASY_ITERATIONS = 5
# of the first step: no step is shorter
SHORTEST_STEP = 1 / 4096
# in which residual stress is let go
RELEASE_STEPS = 8


def at_rest(structure: Structure, loads: Loads) -> Equilibrium:
    """Equilibrium at the load factor 0, from the structure's own pose: residual stress and constant loads alone.

    Raises
    ------
    InputError
        A part of the structure moves freely; no equilibrium is found.
    """
    own = Equilibrium(structure, loads, 0.0, structure.poses, 0, 0)
    refuse_mechanism(structure, own.whole.stiffness(own.whole.stress))
    try:
        return step(own, LoadControl(0.0))
    except StepError:
        pass
    try:
        return released(structure, loads)
    except InputError:
        return settled(own, LoadControl(0.0), LoadControl(0.0))


def equilibrium(structure: Structure, loads: Loads, *, factor: float = 1.0, steps: int = 1) -> Equilibrium:
    """The equilibrium at a load factor, from `at_rest` by `load_path`."""
    return loaded(at_rest(structure, loads), factor, steps=steps)


def loaded(start: Equilibrium, factor: float = 1.0, *, steps: int = 1) -> Equilibrium:
    """The last of `load_path`, or the start where it has that load factor."""
    last = start
    for here in load_path(start, factor, steps=steps):
        last = here
    return last


def load_path(start: Equilibrium, factor: float = 1.0, *, steps: int = 1) -> Iterator[Equilibrium]:
    """Equilibria on the way to a load factor, the last one at it.

    Parameters
    ----------
    start : Equilibrium
    factor : float
        Load factor to reach.
    steps : int
        Steps to begin with; one that does not converge is halved, after easy ones they get longer up to the first's
        length.

    Raises
    ------
    InputError
        No equilibrium is found beyond some load factor, which is named.
    """
    here = start
    longest = length = (factor - here.factor) / steps
    while here.factor != factor:
        # what rounding leaves is no step of its own
        last = abs(factor - here.factor) <= abs(length) * (1 + 1e-9)
        target = factor if last else here.factor + length
        try:
            here = step(here, LoadControl(target))
        except StepError as error:
            length = _shorter(here, target - here.factor, longest, error)
            continue
        yield here
        if here.iterations <= EASY_ITERATIONS and abs(length) < abs(longest):
            length *= 2


def displacement_path(start: Equilibrium, weights: Floats, by: float, *, steps: int = 1) -> Iterator[Equilibrium]:
    """Equilibria while a weighted sum of unknowns grows by a given amount, whatever load that takes.

    Where the loads' forces are those weights the load factor is the force that drives the sum, and its work the change
    of energy: the angles of joints that open a structure, weighted by what they have to turn.

    Parameters
    ----------
    start : Equilibrium
    weights : (6 n + k,)
        Of the unknowns; a 1 at 6 times a node, plus 0 to 2, for one shift.
    by : float
        From `start` on.
    steps : int
        As `load_path`.

    Raises
    ------
    InputError
        No equilibrium is found beyond some load factor; loads that change natural curvatures.
    """
    _refuse_natural(start.loads)
    here, longest, length, left = start, by / steps, by / steps, by
    while left:
        part = left if abs(left) <= abs(length) * (1 + 1e-9) else length
        try:
            here = step(here, DisplacementControl(weights, part))
        except StepError as error:
            length = _shorter(here, part, longest, error)
            continue
        left -= part
        yield here
        if here.iterations <= EASY_ITERATIONS and abs(length) < abs(longest):
            length *= 2


def arc_length_path(start: Equilibrium, length: float, *, longest: float | None = None) -> Iterator[Equilibrium]:
    """Equilibria along the path without an end, past limit points; the first step raises the load factor.

    Parameters
    ----------
    start : Equilibrium
    length : float
        Of the first step, m, see `ArcLengthControl`.
    longest : float, optional
        Up to which steps get longer after easy ones; default: as the first one.

    Raises
    ------
    InputError
        No equilibrium is found beyond some load factor; loads that change natural curvatures.
    """
    _refuse_natural(start.loads)
    here, first, most, before = start, length, longest or length, np.zeros(start.poses.unknowns)
    while True:
        try:
            after = step(here, ArcLengthControl(length, before))
        except StepError as error:
            length = _shorter(here, length, first, error)
            continue
        before = _shifts(here.poses, after.poses)
        here = after
        yield here
        if here.iterations <= EASY_ITERATIONS and length < most:
            length = min(2 * length, most)


def released(structure: Structure, loads: Loads) -> Equilibrium:
    """Equilibrium at the load factor 0 of beams that are held in the structure's pose, and let go little by little.

    Elements begin with the curvature that they have as their natural one, which then becomes their own.

    Raises
    ------
    InputError
        No equilibrium is found beyond some share of the residual stress.
    """
    law = structure.beams.law
    points, frames = structure.beams.attachment.ends(structure.poses)
    present = (RelativeMotion.between(points, frames).local_theta / law.length).T
    held = replace(structure, beams=structure.beams.with_natural(present))
    none = no_loads(structure)
    going = replace(none, constant_forces=loads.constant_forces, constant_lines=loads.constant_lines)
    going = replace(going, natural=law.natural - present)
    start = Equilibrium(held, going, 0.0, structure.poses, 0, 0)
    try:
        first = step(start, LoadControl(0.0))
    except StepError as error:
        raise _no_equilibrium(start, error) from None
    last = loaded(first, steps=RELEASE_STEPS)
    return replace(last, structure=structure, loads=loads, factor=0.0)


def _shorter(here: Equilibrium, length: float, longest: float, error: StepError) -> float:
    """Half of a step's length.

    Raises
    ------
    InputError
        The step is as short as it may be.
    """
    if abs(length) <= SHORTEST_STEP * abs(longest):
        raise _no_equilibrium(here, error) from None
    return length / 2


def _no_equilibrium(here: Equilibrium, error: StepError) -> InputError:
    return InputError(
        f"no equilibrium is found beyond the load factor {here.factor:.6g}: {error}",
        "the structure gives way there, or nothing holds a part of it",
        "loads",
    )


def _refuse_natural(loads: Loads) -> None:
    if not loads.strain_free:
        raise InputError(
            "changes of elements' natural shape are not followed past limit points", "use load_path", "loads"
        )


def _shifts(one: Poses, other: Poses) -> Floats:
    """Motion (6 n + k,) with the shifts between two poses, and no rotations."""
    motion = np.zeros(one.unknowns)
    nodes = motion[: NODE_UNKNOWNS * len(one.points)].reshape(-1, NODE_UNKNOWNS)
    nodes[:, :3] = other.points - one.points
    return motion
