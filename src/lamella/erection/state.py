"""One state of a net on its way from flat to designed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.result import Result
from lamella.erection.flatness import fitted_plane
from lamella.erection.joint_angles import designed_angles
from lamella.erection.stiffness_gap import stiffness_gap
from lamella.structure.beam.fibre_stress import strip_stresses
from lamella.structure.beam.poses import Poses
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.model.model import Model

# a stress of less than this times Young's modulus is rounding
ROUNDING_STRAIN = 1e-12


@dataclass(frozen=True, repr=False, eq=False)
class State(Result):
    """A net with its joints at some angles.

    Attributes
    ----------
    share : float
        Of the way from flat (0) to designed (1).
    poses : Poses
        Of the structural model's nodes; those of the network come first.
    energy : float
        Elastic, of all layers, J.
    driver : float
        What drives the joints towards the designed shape, N m: each by as much as its weight says.
    stable : bool
        Whether it stays so with the driver held.
    stiffness_gap : float or None
        See `lamella.erection.stiffness_gap`.
    height : float
        Extent of the nodes along the normal of their plane of least squares, m.
    angles : (k,)
        Between the lamellas at `Model.joint_nodes`, from A to B about the normal, degrees.
    bending, torsion, strong_axis, helix, von_mises : float
        Largest stresses, Pa.
    """

    share: float
    poses: Poses
    energy: float
    driver: float
    stable: bool
    stiffness_gap: float | None
    height: float
    angles: Floats
    bending: float
    torsion: float
    strong_axis: float
    helix: float
    von_mises: float

    def _line(self) -> str:
        return f"{100 * self.share:.0f} % of the way, {self.energy:.4g} J, driver {self.driver:.4g} N m"

    @classmethod
    def of(cls, model: Model, equilibrium: Equilibrium, share: float, driver: float, *, stable: bool) -> State:
        """What is told of an equilibrium."""
        section, network = model.lamellas.section, model.lamellas.network
        stresses = strip_stresses(
            equilibrium.state, model.lamellas.material, section.height, section.thickness, layers=section.layers
        )
        least = ROUNDING_STRAIN * model.lamellas.material.youngs_modulus
        angles = designed_angles(network, model.joint_nodes) + equilibrium.poses.angles
        return cls(
            share=share,
            poses=equilibrium.poses,
            energy=float(equilibrium.state.energy.sum()),
            driver=driver,
            stable=stable,
            stiffness_gap=stiffness_gap(equilibrium),
            height=fitted_plane(equilibrium.poses.points[: model.nodes]).height,
            angles=np.degrees(angles),
            bending=_largest(stresses.bending, least),
            torsion=_largest(stresses.torsion, least),
            strong_axis=_largest(stresses.layer, least),
            helix=_largest(stresses.helix_edge, least),
            von_mises=_largest(stresses.von_mises, least),
        )


def _largest(values: Floats, least: float) -> float:
    """By size; 0 where it is less than that, which is rounding."""
    largest = float(np.abs(values).max(initial=0.0))
    return largest if largest > least else 0.0
