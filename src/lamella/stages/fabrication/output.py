"""What the stage "fabrication" computes."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.fabrication.part import Parts
from lamella.fabrication.sheet import Nesting


@dataclass(frozen=True)
class FabricationOutput:
    """Parts and where they lie on sheets.

    Attributes
    ----------
    parts : Parts
    nesting : Nesting
    surface_area : float
        m2.
    """

    parts: Parts
    nesting: Nesting
    surface_area: float
