"""What the stage "network" computes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lamella.network.network import Network
from lamella.network.written_lines import angle_figures

if TYPE_CHECKING:
    from lamella.network.elements.element_network import ElementNetwork
    from lamella.network.streamlines.streamline_network import TracedNetwork


@dataclass(frozen=True)
class NetworkOutput:
    """A net, with what the algorithm that made it knows besides.

    Attributes
    ----------
    network : Network
    requested : str
        The density, in words.
    made : ElementNetwork or TracedNetwork or None
        None of closed forms, whose nets are exact.
    adjustment : dict
        Figures of the change of the boundary; empty where it was not adjusted.
    """

    network: Network
    requested: str
    made: ElementNetwork | TracedNetwork | None
    adjustment: dict[str, Any]

    @property
    def described(self) -> dict[str, Any]:
        """Further figures by key of the summary."""
        return self.network.figures

    @cached_property
    def angles(self) -> dict[str, float]:
        """Of the node angles on the surface."""
        return angle_figures(self.network.node_angles[None])
