"""What the stage "lamellas" computes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lamella.base.material import Material
from lamella.network.network import Network
from lamella.stages.lamellas.optimising import Optimised
from lamella.strip.developable_strips import DevelopableStrips
from lamella.strip.lamellas import Lamellas
from lamella.strip.sizing import Sizing


@dataclass(frozen=True)
class LamellasOutput:
    """The strips of a net.

    Attributes
    ----------
    network : Network
    lamellas : Lamellas
    material_name : str
    material : Material
    made : object or None
        What made the net, as `lamella.stages.network.stage.NetworkOutput.made`.
    developable : DevelopableStrips or None
        Along the same lamellas, where the project asks for them.
    optimised : Optimised or None
        Where some of these do not exist everywhere: their borders moved until they do.
    sizing : Sizing or None
        Largest measures, where the project asks for them.
    """

    network: Network
    lamellas: Lamellas
    material_name: str
    material: Material
    made: Any
    developable: DevelopableStrips | None = None
    optimised: Optimised | None = None
    sizing: Sizing | None = None

    @cached_property
    def corner_stresses(self) -> dict[str, Any]:
        """Utilisation next to the boundary's corners, by key of the summary."""
        return self.made.corner_stresses(self.lamellas.utilisation) if self.made else {}
