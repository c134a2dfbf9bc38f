"""How a net is modelled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from lamella.base.errors import InputError, require_positive

JointKind = Literal["locked", "hinged", "springs"]
LayerModel = Literal["combined", "each"]
SlotModel = Literal["reduced", "whole"]

MOST_ELEMENTS = 64
"""In a cell edge; bending under tension dies out within a few thicknesses, which no beam model follows farther."""


@dataclass(frozen=True)
class ModelRules:
    """Choices of a structural model.

    Attributes
    ----------
    elements : int
        Beam elements in a cell edge.
    layers : "combined" or "each"
        "combined": a lamella is one line of beams with the stiffness of all its layers beside each other, which slip
        on one another between nodes. "each": every layer is a line of its own, eccentric at the nodes, coupled by
        shear blocks.
    joints : "locked", "hinged" or "springs"
        Where two lamellas cross, of their angle about the node's normal: kept, free, or resisted by springs.
    joint_stiffness : float
        Of such a spring, N m/rad.
    joint_gap : float
        By which a joint turns freely to either side before its spring resists, rad.
    slots : "reduced" or "whole"
        Whether slots take stiffness from the strips, see `lamella.structure.model.slots`.
    slot_width : float
        m.
    hub_radius : float
        Around singular nodes, m: strips begin there on a rigid hub.
    block_spacing : float
        Largest distance of shear blocks, m; 0: none.
    near_design : bool
        Whether elements are exact to first order about the designed shape (`lamella.structure.beam.turning`). What
        untwists them, as laying a net flat does, is for elements without.
    """

    elements: int = 4
    layers: LayerModel = "combined"
    joints: JointKind = "locked"
    joint_stiffness: float = 0.0
    joint_gap: float = 0.0
    slots: SlotModel = "reduced"
    slot_width: float = 0.0
    hub_radius: float = 0.0
    block_spacing: float = 0.0
    near_design: bool = True

    def __post_init__(self) -> None:
        """Raise an `InputError` for rules that are none."""
        for key, value, known in (
            ("layers", self.layers, get_args(LayerModel)),
            ("joints", self.joints, get_args(JointKind)),
            ("slots", self.slots, get_args(SlotModel)),
        ):
            if value not in known:
                raise InputError(f"{key} = {value!r}", f"choose one of {', '.join(known)}", key)
        if not 1 <= self.elements <= MOST_ELEMENTS:
            raise InputError(
                f"elements = {self.elements!r} is out of range", f"it has to be from 1 to {MOST_ELEMENTS}", "elements"
            )
        if self.joints == "springs":
            require_positive(joint_stiffness=self.joint_stiffness)
        for key in ("joint_gap", "slot_width", "hub_radius", "block_spacing"):
            value = getattr(self, key)
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"{key} = {value!r} is out of range", f"{key} has to be finite and 0 or more", key)
