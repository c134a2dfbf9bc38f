"""What braces a net: nothing, cables on its diagonals, edge beams, both."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from lamella.base.material import MATERIALS, Material
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Lamellas
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.model.model import Model, make_model
from lamella.structure.model.rules import ModelRules

NONE = "none"
"""Joints alone."""


@dataclass(frozen=True, eq=False)
class Bracings:
    """What a net may be braced by.

    Attributes
    ----------
    cables, edge_beams
        None: there are none.
    materials : mapping
        Those of edge beams by name.
    """

    cables: CableRules | None = None
    edge_beams: EdgeBeamAxes | None = None
    materials: Mapping[str, Material] = field(default_factory=lambda: MATERIALS)

    @property
    def names(self) -> tuple[str, ...]:
        """ "cables", "edge_beams", "both": those that are there."""
        found = [key for key, on in (("cables", self.cables), ("edge_beams", self.edge_beams)) if on is not None]
        return (*found, "both") if len(found) == 2 else tuple(found)

    def model(self, lamellas: Lamellas, supports: NodeSupports, elements: int, name: str) -> Model:
        """A net with locked joints that is braced by one of `names`, or by "none"."""
        return make_model(
            lamellas,
            supports,
            ModelRules(elements=elements, joints="locked", slots="whole", near_design=False),
            cables=self.cables if name in ("cables", "both") else None,
            edge_beams=self.edge_beams if name in ("edge_beams", "both") else None,
            materials=self.materials,
        )

    def models(self, lamellas: Lamellas, supports: NodeSupports, elements: int) -> Iterator[tuple[str, Model]]:
        """Of each of `names`, after that without bracing."""
        for name in (NONE, *self.names):
            yield name, self.model(lamellas, supports, elements, name)
