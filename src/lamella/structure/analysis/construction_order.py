"""A net put up in the order of the site: bent on props, joints locked, cables on, props away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.hardware.rules import CableRules
from lamella.structure.construction import continued
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.model.bracing import brace
from lamella.structure.model.model import Model
from lamella.structure.static import at_rest, loaded
from lamella.structure.structure import Structure

BENT, LOCKED, CABLES, RELEASED = "bent", "joints locked", "cables on", "props away"


def put_up(
    model: Model, stages: Sequence[str], cables: CableRules | None = None, *, progress: Progress = silent
) -> tuple[tuple[Equilibrium, ...], Model]:
    """Equilibrium at the end of every stage, and the model as it stands after the last one.

    Parameters
    ----------
    model : Model
        With free joints where a stage locks them, and without cables.
    stages : sequence of str
        "bent", all nodes of the net held where they were designed to be, as the first one; "joints locked" at the
        angles they have then, "cables on" with their prestress in the pose of that moment, "props away" to the
        supports alone, in any order.
    cables : CableRules, optional
        Default: no cables.
    progress : callable

    Raises
    ------
    InputError
        The first stage is another one, or a stage has nothing to do; a part moves freely; a stage has no equilibrium.
    """
    if not stages or stages[0] != BENT:
        raise InputError(f"stages = {list(stages)!r}", f"begin with {BENT!r}", "stages")
    structure = _propped(model)
    progress(Report.step(BENT))
    last = at_rest(structure, no_loads(structure))
    found = [last]
    for k, stage in enumerate(stages[1:], 1):
        progress(Report.step(stage, k / len(stages)))
        last = _next(model, stage, last, cables)
        found.append(last)
    return tuple(found), replace(model, structure=last.structure)


def _propped(model: Model) -> Structure:
    held = model.structure.held.copy()
    held[: model.nodes, :3] = True
    return replace(model.structure, held=held)


def _next(model: Model, stage: str, last: Equilibrium, cables: CableRules | None) -> Equilibrium:
    """The equilibrium at the end of a stage, without what is left of the way there."""
    structure = last.structure
    if stage == LOCKED:
        if not len(structure.held_joints):
            raise InputError("joints are locked from the first", "free them in the model's rules", "stages")
        after = replace(structure, held_joints=np.ones_like(structure.held_joints))
        return replace(last, structure=after, loads=no_loads(after))
    if stage == CABLES:
        if cables is None:
            raise InputError(f"there are no cables for the stage {stage!r}", "leave the stage out", "stages")
        lamellas = model.lamellas
        strung = brace(lamellas.network, last.poses, cables, lamellas.section.height)
        onward = continued(last, no_loads(structure), cables=strung)
    elif stage == RELEASED:
        onward = continued(last, no_loads(structure), replace(structure, held=model.structure.held))
    else:
        raise InputError(
            f"there is no stage {stage!r}", f"stages are {', '.join((BENT, LOCKED, CABLES, RELEASED))}", "stages"
        )
    end = loaded(onward)
    # of the forces that were taken away rounding is left
    own = Equilibrium(end.structure, no_loads(end.structure), 0.0, end.poses, end.negative, 0)
    return loaded(replace(own, factor=-1.0), 0.0)
