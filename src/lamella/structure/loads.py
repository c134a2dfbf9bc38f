"""What acts on a structure, at the load factor 1."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.state import StructureState
from lamella.structure.structure import Structure


@dataclass(frozen=True)
class Loads:
    """Loads that all grow with one factor, and those that are there already.

    Attributes
    ----------
    forces : (6 n + k,)
        Dead forces (N) and moments (N m) at the unknowns. Moments are conjugate to rotations along exp(w) R, so that
        the tangent stiffness is symmetric (semitangential moments: J. H. Argyris et al., Computer Methods in Applied
        Mechanics and Engineering 17 (1979) 105); about an axis that the rotation keeps they are ordinary dead moments.
    lines : (m, 3)
        Dead loads on elements, N/m of natural length, global.
    motions : (6 n + k,)
        Prescribed motion of held unknowns: shifts, m, and rotation vectors about fixed axes, rad.
    natural : (m, 3)
        Change of the elements' natural curvature, 1/m.
    swelling : (m,)
        Stretch of the elements that needs no force: of a change of temperature.
    cable_swelling : float or (c,)
        The same of all cables, or of each: one that is shortened has less than 0.
    constant_forces, constant_lines : (6 n + k,), (m, 3)
        The same at any load factor.
    """

    forces: Floats
    lines: Floats
    motions: Floats
    natural: Floats
    swelling: Floats
    cable_swelling: Floats | float
    constant_forces: Floats
    constant_lines: Floats

    @property
    def strain_free(self) -> bool:
        """Whether elements keep their natural shape whatever the load factor."""
        return not (self.natural.any() or self.swelling.any() or np.any(self.cable_swelling))

    def forces_at(self, factor: float) -> Floats:
        """Forces at the unknowns at a load factor, (6 n + k,)."""
        return np.asarray(self.constant_forces + factor * self.forces)

    def state(self, structure: Structure, factor: float, poses: Poses) -> StructureState:
        """A structure in a pose under the line loads and natural curvatures of a load factor."""
        beams = structure.beams
        if self.natural.any():
            beams = beams.with_natural(beams.law.natural + factor * self.natural)
        if self.swelling.any():
            beams = beams.swollen(factor * self.swelling)
        state = beams.at(poses, self.constant_lines + factor * self.lines)
        return structure.at(poses, state, cable_swelling=factor * self.cable_swelling)


def no_loads(structure: Structure) -> Loads:
    """Nothing acts."""
    unknowns, elements = np.zeros(structure.poses.unknowns), np.zeros((len(structure.beams), 3))
    return Loads(unknowns, elements, unknowns, elements, np.zeros(len(elements)), 0.0, unknowns, elements)


def make_loads(
    structure: Structure,
    *,
    forces: dict[int, tuple[float, ...]] | None = None,
    joints: dict[int, float] | None = None,
    lines: ArrayLike = 0.0,
    motions: dict[int, tuple[float, ...]] | None = None,
    natural: ArrayLike = 0.0,
    swelling: ArrayLike = 0.0,
) -> Loads:
    """Loads at nodes, each six numbers, along and about x, y, z, and on elements.

    Parameters
    ----------
    structure : Structure
    forces : dict of int to six floats
        Force (N) and moment (N m) by node.
    joints : dict of int to float
        Moment that opens a joint's angle, N m, by joint.
    lines : (m, 3) or (3,)
        Dead load on elements, N/m of natural length, global.
    motions : dict of int to six floats
        Shift (m) and rotation vector (rad) by node; 0 where nothing is held.
    natural : (m, 3) or (3,)
        Change of natural curvature, 1/m.
    swelling : (m,) or float
        Stretch that needs no force.

    Raises
    ------
    InputError
        A node or a joint that is not there; a motion of what is not held; numbers that are not finite.
    """
    vectors = [_at_nodes(structure, name, given or {}) for name, given in (("forces", forces), ("motions", motions))]
    loose = np.flatnonzero((vectors[1] != 0) & ~structure.held_unknowns)
    if len(loose):
        raise InputError(
            f"node {loose[0] // NODE_UNKNOWNS} is moved and not held there", "hold what is moved", "motions"
        )
    for joint, moment in (joints or {}).items():
        count = len(structure.poses.angles)
        if not 0 <= joint < count or not np.isfinite(moment):
            raise InputError(f"moment {moment!r} at joint {joint}", f"joints are 0 to {count - 1}", "joints")
        vectors[0][structure.poses.unknowns - count + joint] += moment
    rows = [_on_elements(structure, name, given) for name, given in (("lines", lines), ("natural", natural))]
    longer = np.broadcast_to(np.asarray(swelling, float), len(structure.beams)).copy()
    if not np.isfinite(longer).all():
        raise InputError(f"swelling = {swelling!r}", "give finite numbers", "swelling")
    loads = replace(no_loads(structure), forces=vectors[0], motions=vectors[1])
    return replace(loads, lines=rows[0], natural=rows[1], swelling=longer)


def _at_nodes(structure: Structure, name: str, given: dict[int, tuple[float, ...]]) -> Floats:
    nodes = len(structure.poses.points)
    vector = np.zeros(structure.poses.unknowns)
    for node, values in given.items():
        if not 0 <= node < nodes:
            raise InputError(f"there is no node {node}", f"nodes are 0 to {nodes - 1}", name)
        if len(values) != NODE_UNKNOWNS or not np.isfinite(values).all():
            raise InputError(f"{name} of node {node} = {values!r}", "give six finite numbers", name)
        vector[NODE_UNKNOWNS * node : NODE_UNKNOWNS * (node + 1)] += values
    return vector


def _on_elements(structure: Structure, name: str, given: ArrayLike) -> Floats:
    rows = np.broadcast_to(np.asarray(given, float), (len(structure.beams), 3)).copy()
    bad = np.flatnonzero(~np.isfinite(rows).all(1))
    if len(bad):
        raise InputError(f"{name} of element {bad[0]} is {rows[bad[0]].tolist()}", "give finite numbers", name)
    return rows
