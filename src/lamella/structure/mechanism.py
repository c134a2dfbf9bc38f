"""What moves freely: a motion that meets no resistance, named by its node."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.sparse import Factor, SingularError, SymmetricPattern
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.structure import Structure

# of the stiffness's diagonal, added so that a matrix without an inverse gets one: the first with which it has one
MECHANISM_SHIFTS = (1e-14, 1e-12, 1e-10)
# of the energy of a motion to that of the same motions of each unknown alone: less is no resistance, but rounding. A
# cantilever of 4,000 elements has 4e-15.
LEAST_RESISTANCE = 1e-15
MECHANISM_ROUNDS = 4
_WAYS = ("moves along x", "moves along y", "moves along z", "turns about x", "turns about y", "turns about z")


class MechanismError(InputError):
    """A part of a structure moves freely.

    Attributes
    ----------
    node : int or None
        The one that moves most; None: it is the angle of a joint.
    way : str
        How, in words.
    """

    def __init__(self, message: str, remedy: str, where: str, node: int | None, way: str) -> None:
        super().__init__(message, remedy, where)
        self.node, self.way = node, way


def freest_motion(structure: Structure, blocks: list[Floats]) -> tuple[Floats, float]:
    """The motion that meets the least resistance, (6 n + k,) of largest number 1, and its resistance.

    By inverse iteration on the stiffness of element blocks, scaled by its diagonal: the resistance is the smallest
    eigenvalue of that matrix by size, whatever the units.
    """
    pattern, free = structure.pattern, structure.free
    entries = structure.entries(blocks)
    columns = np.repeat(np.arange(pattern.size), np.diff(pattern.columns))
    on_diagonal = pattern.rows == columns
    diagonal = np.abs(entries[on_diagonal])
    scale = np.where(diagonal > 0, diagonal, 1.0)
    factored = _nearly(pattern, entries, np.where(on_diagonal, scale[columns], 0.0))
    matrix = pattern.matrix(entries)
    vector = np.random.default_rng(0).standard_normal(pattern.size) / np.sqrt(scale)
    for _ in range(MECHANISM_ROUNDS):
        vector = factored.solve(scale * vector)
        vector /= np.sqrt(vector @ (scale * vector))
    motion = np.zeros(structure.poses.unknowns)
    motion[free] = vector / np.abs(vector).max()
    return motion, float(vector @ (matrix @ vector))


def _nearly(pattern: SymmetricPattern, entries: Floats, diagonal: Floats) -> Factor:
    """Factorisation of a matrix with a little more on its diagonal."""
    for shift in MECHANISM_SHIFTS[:-1]:
        try:
            return pattern.factor(entries + shift * diagonal)
        except SingularError:
            continue
    return pattern.factor(entries + MECHANISM_SHIFTS[-1] * diagonal)


def refuse_mechanism(structure: Structure, blocks: list[Floats]) -> None:
    """Refuse a structure of which a part moves freely.

    Raises
    ------
    MechanismError
        Names the node that moves most, and how.
    """
    try:
        motion, resistance = freest_motion(structure, blocks)
    except SingularError:
        return
    if abs(resistance) > LEAST_RESISTANCE:
        return
    nodes = NODE_UNKNOWNS * len(structure.poses.points)
    # shifts and the arcs that rotations make, alike
    size = np.abs(motion)
    size[:nodes].reshape(-1, NODE_UNKNOWNS)[:, 3:] *= structure.size
    most = int(size.argmax())
    node, way = divmod(most, NODE_UNKNOWNS)
    what, turns = f"node {node}", _WAYS[way]
    if most >= nodes:
        what, turns = f"joint {most - nodes}", "turns"
    raise MechanismError(
        f"{what} {turns} and nothing resists",
        "support it, or connect it to what is supported",
        "structure",
        node if most < nodes else None,
        turns,
    )
