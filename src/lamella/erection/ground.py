"""A net that weighs: its own weight, a floor under it, props that raise nodes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.erection.rigged import Rigged
from lamella.structure.actions.load_case import GRAVITY
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.model.model import Model, line_weights
from lamella.structure.node_springs import floor_springs

# m: by which a net sinks into its floor where it lies evenly
SINK = 1e-4


@dataclass(frozen=True, eq=False)
class Ground:
    """What a net stands on while it is driven.

    Attributes
    ----------
    gravity : bool
        Whether it weighs, and lies on a floor without friction at the height of its lowest node.
    props : (q,) int
        Nodes that props raise from where they lie to the height that they are designed for.
    node_masses : (n,) or None
        Of what hangs on the network's nodes beside strips, kg.
    """

    gravity: bool = False
    props: Integers = field(default_factory=lambda: np.zeros(0, np.int64))
    node_masses: Floats | None = None

    def under(self, rigged: Rigged, model: Model, raised: Floats) -> Rigged:
        """A rigged structure with what it stands on.

        Parameters
        ----------
        rigged : Rigged
        model : Model
        raised : (n,)
            By how much each node of the network is higher in the designed shape, m.
        """
        if len(self.props):
            rigged = self._propped(rigged, raised)
        if not self.gravity:
            return rigged
        structure, loads = rigged.structure, rigged.loads
        reached = np.unique(model.lamellas.network.stop_nodes)
        lines = np.outer(line_weights(model), (0.0, 0.0, -GRAVITY))
        forces = np.zeros(structure.poses.unknowns)
        weight = float(GRAVITY * line_weights(model) @ structure.beams.law.length)
        if self.node_masses is not None:
            vertical = forces[: NODE_UNKNOWNS * len(structure.poses.points)].reshape(-1, NODE_UNKNOWNS)[:, 2]
            vertical[: model.nodes] -= GRAVITY * self.node_masses
            weight += float(GRAVITY * self.node_masses.sum())
        points, frames = structure.poses.points[reached], structure.poses.frames[reached]
        floor = floor_springs(reached, float(points[:, 2].min()), weight / (SINK * len(reached)), points, frames)
        standing = replace(structure, node_springs=floor)
        return replace(rigged, structure=standing, loads=replace(loads, constant_lines=lines, constant_forces=forces))

    def _propped(self, rigged: Rigged, raised: Floats) -> Rigged:
        held, motions = rigged.structure.held.copy(), rigged.loads.motions.copy()
        props = self.props[~held[self.props, 2]]
        held[props, 2] = True
        motions[NODE_UNKNOWNS * props + 2] = raised[props]
        return replace(
            rigged,
            structure=replace(rigged.structure, held=held),
            loads=replace(rigged.loads, motions=motions),
            nodes=np.concatenate((rigged.nodes, props)),
        )
