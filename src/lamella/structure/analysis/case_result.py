"""What is known of a structure under one load case."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.result import Result
from lamella.structure.analysis.edge_use import edge_use
from lamella.structure.analysis.strip_use import StripUse, strip_use
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.model.model import Model


@dataclass(frozen=True, repr=False, eq=False)
class CaseResult(Result):
    """An equilibrium under a load case, or the last one that was found on the way to it.

    Attributes
    ----------
    name : str
    model : Model
    equilibrium : Equilibrium
    rest : Equilibrium
        The same structure without the case's loads.
    reason : str
        Why the case's loads were not reached; empty: they were.
    buckling : (b,)
        Load factors at which it buckles, by linear buckling about this state, or about the last stable one on the way
        to it.
    before : tuple of Equilibrium
        States on the way to `equilibrium`, at smaller load factors.
    modes : (b, 6 n + k)
        Motions of buckling, of largest number 1.
    """

    name: str
    model: Model
    equilibrium: Equilibrium
    rest: Equilibrium
    reason: str
    buckling: Floats
    before: tuple[Equilibrium, ...] = ()
    modes: Floats = field(default_factory=lambda: np.zeros((0, 0)))

    def _line(self) -> str:
        how = f"load factor {self.load_factor:.4g} of 1" if self.reason else "reached"
        return f"{self.name!r}, {how}, {1e3 * self.displacement_max:.4g} mm, utilisation {self.utilisation_max:.2f}"

    @property
    def converged(self) -> bool:
        """Whether the whole load was reached."""
        return not self.reason

    @property
    def stable(self) -> bool:
        """Whether the equilibrium is one that stays."""
        return self.equilibrium.negative == 0

    @property
    def load_factor(self) -> float:
        """Share of the case's loads that was reached; 1 for the residual state, which has none."""
        return self.equilibrium.factor if self.reason else 1.0

    @property
    def load_total(self) -> Floats:
        """Sum of the forces that act, N, (3,)."""
        here, structure = self.equilibrium, self.equilibrium.structure
        nodes = here.loads.forces_at(here.factor)[: 6 * len(here.poses.points)].reshape(-1, 6)[:, :3].sum(0)
        lines = here.loads.constant_lines + here.factor * here.loads.lines
        return np.asarray(nodes + structure.beams.law.length @ lines)

    @property
    def reaction_total(self) -> Floats:
        """Sum of the forces of supports and springs on the structure, N, (3,)."""
        return np.asarray(self.equilibrium.reactions[:, :3].sum(0))

    @property
    def displacements(self) -> Floats:
        """Of the network's nodes from the designed shape, m, (n, 3)."""
        return self.equilibrium.displacements[: self.model.nodes]

    @property
    def displacement_max(self) -> float:
        """Of a node of the network from the designed shape, m."""
        return float(np.linalg.norm(self.displacements, axis=1).max(initial=0.0))

    @property
    def deflection_max(self) -> float:
        """Of a node of the network from where it is without the case's loads, m."""
        by = self.displacements - self.rest.displacements[: self.model.nodes]
        return float(np.linalg.norm(by, axis=1).max(initial=0.0))

    @cached_property
    def use(self) -> StripUse:
        """Stresses of the strips."""
        return strip_use(self.model, self.equilibrium)

    @property
    def von_mises_max(self) -> float:
        """Of the strips, Pa, with residual stress."""
        return float(self.use.von_mises.max(initial=0.0))

    @property
    def edge_utilisation_max(self) -> float:
        """Of edge beams; 0 without."""
        return float(edge_use(self.model, self.equilibrium).max(initial=0.0))

    @property
    def utilisation_max(self) -> float:
        """Share of the material's strength, of strips and edge beams."""
        return max(float(self.use.utilisation.max(initial=0.0)), self.edge_utilisation_max)

    @cached_property
    def residual_share(self) -> float:
        """Of the largest von Mises stress: what there is at its place without the case's loads."""
        largest = np.unravel_index(self.use.von_mises.argmax(), self.use.von_mises.shape)
        return float(strip_use(self.model, self.rest).von_mises[largest] / self.use.von_mises[largest])

    @property
    def cable_forces(self) -> Floats:
        """Tension of the cables of each stretch between two nodes, N, (c,)."""
        return self.equilibrium.whole.cables.tension

    @property
    def slack(self) -> int:
        """Stretches of cable without tension."""
        state = self.equilibrium.whole.cables
        return int((~state.tight(state.force)).sum())
