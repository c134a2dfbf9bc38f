"""Results in the coordinates of the drawing, where the program measures from a point of it."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from lamella.base.drawing_origin import Origin
from lamella.network.network import Network
from lamella.surface.mesh import SurfaceMesh

Drawn = TypeVar("Drawn", SurfaceMesh, Network)


def in_drawing(points: Drawn, origin: Origin) -> Drawn:
    """A mesh or a network in the drawing's coordinates."""
    if not any(origin):
        return points
    own = ("node_points", "sample_points") if isinstance(points, Network) else ("points",)
    return replace(points, **{key: getattr(points, key) + np.array(origin) for key in own})
