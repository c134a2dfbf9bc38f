"""Where shear blocks couple the layers of a lamella."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans
from lamella.network.network import Network
from lamella.structure.model.divisions import Divisions


def block_places(network: Network, divisions: Divisions, spacing: float) -> Booleans:
    """Ends of elements that are at a shear block, (e, elements + 1).

    As many in each edge as `lamella.hardware.shear_blocks` puts there, each at the end of an element that is nearest.
    """
    blocks = np.zeros(divisions.arclengths.shape, bool)
    if not spacing or divisions.elements < 2:
        return blocks
    edges = np.diff(network.stop_arclengths[divisions.stops], axis=1)[:, 0]
    # rounded, so that equal cells have equally many
    number = np.ceil(np.round(edges / spacing, 6)).astype(np.int64)
    edge = np.repeat(np.arange(len(number)), number)
    share = (np.arange(len(edge)) - np.repeat(np.cumsum(number) - number, number) + 0.5) / number[edge]
    # halves of an element are rounded down, whatever the last bits
    nearest = np.ceil(np.round(share * divisions.elements, 6) - 0.5).astype(np.int64)
    blocks[edge, np.clip(nearest, 1, divisions.elements - 1)] = True
    return blocks
