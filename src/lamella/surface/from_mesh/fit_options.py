"""How the surface of a mesh is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class FitOptions:
    """How the surface of a mesh is made.

    Attributes
    ----------
    mean_curvature : "fit" or float
        H with respect to the mesh's normal, 1/m; "fit": that of the surface nearest to the mesh.
    corner_angle : float
        The border has a corner where it turns by more, degrees.
    order : int
        Of the elements, 2 to 4.
    tolerance : float
        Largest |H - H0|, or wanted jump of the curvature between elements, over the curvature scale.
    most_nodes : int
        Limit of the elements' nodes.
    deviation : float
        Largest departure of the mesh from constant mean curvature that is still taken to mean one, over the curvature
        scale.
    """

    mean_curvature: Literal["fit"] | float = "fit"
    corner_angle: float = 40.0
    order: int = 4
    tolerance: float = 2e-3
    most_nodes: int = 100_000
    deviation: float = 0.1
