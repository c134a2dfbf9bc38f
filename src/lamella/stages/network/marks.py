"""Places that warnings about a net speak of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.cell_sizes import large_cells, small_cells
from lamella.network.network import SEAM, Network
from lamella.stages.network.warnings import SMALL
from lamella.view.scene.scene import Mark


def network_marks(network: Network, height: float) -> Iterator[Mark]:
    """Where the net does not meet itself, cells that are too large or too small, faces and umbilics left out.

    Parameters
    ----------
    network : Network
    height : float
        Of the strips, m.
    """
    places: Mapping[str, Any] = {
        "net_open": network.node_points[network.node_kinds == SEAM],
        "faces_left_out": network.node_points[network.faces_left_out],
        "cells_large": [one.point for one in large_cells(network)[1]],
        "cells_small": [one.point for one in small_cells(network, SMALL * height)[1]],
        "umbilics_missed": [one["point"] for one in network.describe().get("umbilics", ()) if not one["node"]],
    }
    for key, points in places.items():
        if len(points):
            found: Floats = np.asarray(points, np.float64).reshape(-1, 3)
            yield Mark(key, found)
