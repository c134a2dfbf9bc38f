"""Nodes that are held and moved: lifted, drawn in around an axis, moved together."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.erection.flatness import fitted_plane
from lamella.erection.rigged import Rigged
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.loads import no_loads
from lamella.structure.structure import Structure

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Lift:
    """Nodes lifted, free to go sideways.

    Attributes
    ----------
    nodes : (p,) int
    by : float
        m.
    """

    nodes: Integers
    by: float

    @property
    def kind(self) -> str:
        return "lift"

    def up(self, points: Floats) -> Floats | None:
        return None

    def rig(self, structure: Structure) -> Rigged:
        return moved_nodes(structure, self.nodes, np.tile(self.by * UP, (len(self.nodes), 1)), UP != 0)


@dataclass(frozen=True, eq=False)
class Ring:
    """Nodes of a ring drawn in to its axis, or pushed out: free to go along it.

    Attributes
    ----------
    nodes : (p,) int
    factor : float
        Of their distances from the axis at the end, over those at the beginning. The axis goes through their centre,
        along the normal of their plane of least squares.
    """

    nodes: Integers
    factor: float

    @property
    def kind(self) -> str:
        return "radius"

    def up(self, points: Floats) -> Floats | None:
        return np.asarray(fitted_plane(points[self.nodes]).axes[2])

    def rig(self, structure: Structure) -> Rigged:
        at = structure.poses.points[self.nodes]
        motions = (self.factor - 1) * (at - at.mean(0)) * (1 - UP)
        return moved_nodes(structure, self.nodes, motions, UP == 0)


@dataclass(frozen=True, eq=False)
class Together:
    """Supports moved towards their centre on the floor, each by the same length; they hold all shifts.

    Attributes
    ----------
    nodes : (p,) int
    by : float
        m.
    """

    nodes: Integers
    by: float

    @property
    def kind(self) -> str:
        return "supports"

    def up(self, points: Floats) -> Floats | None:
        return None

    def rig(self, structure: Structure) -> Rigged:
        """Raise an `InputError` where they would meet."""
        at = structure.poses.points[self.nodes]
        away = (at.mean(0) - at) * (1 - UP)
        distance = np.linalg.norm(away, axis=1)
        if len(self.nodes) < 2 or not self.by < distance.min():
            raise InputError(
                f"{len(self.nodes)} supports are moved by {self.by:g} m and the nearest one is "
                f"{float(distance.min(initial=0.0)):.4g} m from their centre",
                "move two or more, by less than that",
                "supports.by",
            )
        return moved_nodes(structure, self.nodes, self.by * away / distance[:, None], np.ones(3, bool))


def moved_nodes(structure: Structure, nodes: Integers, motions: Floats, ways: Floats) -> Rigged:
    """Nodes held along some of x, y, z and moved there.

    Parameters
    ----------
    structure : Structure
    nodes : (p,) int
    motions : (p, 3)
        m.
    ways : (3,) bool
    """
    held = structure.held.copy()
    held[np.ix_(nodes, np.flatnonzero(ways))] = True
    rigged = replace(structure, held=held)
    along = np.zeros(structure.poses.unknowns)
    rows = along[: NODE_UNKNOWNS * len(structure.poses.points)].reshape(-1, NODE_UNKNOWNS)
    rows[nodes, :3] = motions
    travel = float(np.linalg.norm(motions, axis=1).max())
    return Rigged(rigged, replace(no_loads(rigged), motions=along), travel, nodes)
