"""What the stage "fabrication" computes."""

from __future__ import annotations

from dataclasses import dataclass, field

from lamella.fabrication.part import Parts
from lamella.fabrication.sheet import Nesting
from lamella.hardware.item import Hardware


@dataclass(frozen=True)
class FabricationOutput:
    """Parts and where they lie on sheets.

    Attributes
    ----------
    parts : Parts
    nesting : Nesting
    surface_area : float
        m2.
    hardware : Hardware
        What joins the parts; nothing where the project has no table [joint].
    """

    parts: Parts
    nesting: Nesting
    surface_area: float
    hardware: Hardware = field(default_factory=Hardware)
