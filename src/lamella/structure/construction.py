"""Construction in the order of reality: the next stage begins where the last one ended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.structure.beam.poses import Poses
from lamella.structure.cables import Cables
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads
from lamella.structure.structure import Structure


def continued(
    last: Equilibrium, loads: Loads, structure: Structure | None = None, cables: Cables | None = None
) -> Equilibrium:
    """The last stage's equilibrium as the load factor 0 of the next stage.

    Parameters
    ----------
    last : Equilibrium
    loads : Loads
        Of the next stage, on top of what acts at the end of the last one.
    structure : Structure, optional
        Of the next stage: the same nodes and beams with other supports and locks. What held there and holds no more is
        taken away with the load factor: its force goes from what it was to 0. Default: as it was.
    cables : Cables, optional
        Put on in this stage, in place of those there were: what they pull comes with the load factor.

    Returns
    -------
    Equilibrium
        To go on from, with `lamella.structure.static.load_path`.

    Raises
    ------
    InputError
        The structure has other nodes or beams.
    """
    after = last.structure if structure is None else structure
    if after.poses.unknowns != last.poses.unknowns or len(after.beams) != len(last.structure.beams):
        raise InputError("the next stage has other nodes or beams", "change supports and locks only", "structure")
    natural = after.beams.law.natural + last.factor * last.loads.natural
    beams = after.beams.with_natural(natural).swollen(last.factor * last.loads.swelling)
    there = after.cables.swollen(last.factor * last.loads.cable_swelling)
    released = last.structure.held_unknowns & ~after.held_unknowns
    support = np.where(released, last.internal - last.loads.forces_at(last.factor), 0.0)
    after = replace(after, beams=beams, cables=there if cables is None else cables)
    if cables is not None:
        support = support + _pull(after, last.poses) - _pull(replace(after, cables=there), last.poses)
    onward = replace(
        loads,
        forces=loads.forces - support,
        constant_forces=loads.constant_forces + last.loads.forces_at(last.factor) + support,
        constant_lines=loads.constant_lines + last.loads.constant_lines + last.factor * last.loads.lines,
    )
    return Equilibrium(after, onward, 0.0, last.poses, last.negative, 0)


def _pull(structure: Structure, poses: Poses) -> Floats:
    """Forces that hold the ends of the cables in a pose, as the unknowns have them, (6 n + k,)."""
    groups = [np.zeros(unknowns.shape) for unknowns in structure.unknowns]
    groups[2] = structure.cables.at(poses).forces()
    return structure.vector(groups)
