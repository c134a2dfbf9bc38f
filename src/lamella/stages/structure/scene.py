"""What the view shows of a structure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from lamella.view.scene.layer import InstancesLayer
from lamella.view.scene.scene import Shown

if TYPE_CHECKING:
    from lamella.structure.model.model import Model

SUPPORT_SIZE = 0.3
"""Height of a support's pyramid over the median cell edge."""
SUPPORT_COLOUR = "#c0452f"
PYRAMID = np.array([[0, 0, 0], [-0.5, -0.5, -1], [0.5, -0.5, -1], [0.5, 0.5, -1], [-0.5, 0.5, -1]], float)
PYRAMID_FACES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [1, 4, 3], [1, 3, 2]])


def supports_scene(model: Model) -> Iterator[Shown]:
    """A pyramid below each node that is supported."""
    network = model.lamellas.network
    nodes = np.flatnonzero(model.supports.supported)
    if not len(nodes) or not len(network.cell_edges):
        return
    yield InstancesLayer(
        name="supports",
        label="Support",
        groups=("Supports",),
        material="plain",
        colour=SUPPORT_COLOUR,
        ids=tuple(f"support of node {node}" for node in nodes.tolist()),
        owner=np.arange(len(nodes)),
        positions=SUPPORT_SIZE * float(np.median(network.cell_edges)) * PYRAMID,
        faces=PYRAMID_FACES,
        origins=network.node_points[nodes],
        axes=np.tile(np.eye(3), (len(nodes), 1, 1)),
    )
