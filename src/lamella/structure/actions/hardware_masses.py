"""Mass of what is bolted to the nodes of a net."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.hardware.item import Hardware
from lamella.network.network import Network

HALFWAY = 1e-6
"""m; pieces are halfway between two nodes whose distances from them differ by less."""


def hardware_masses(network: Network, hardware: Hardware, without: tuple[str, ...] = ("cable",)) -> Floats:
    """Mass at each node of all pieces nearest to it, kg, (n,).

    Parameters
    ----------
    network : Network
    hardware : Hardware
    without : tuple of str
        Kinds of hardware that are parts of the structural model with a weight of their own.

    Returns
    -------
    (n,)
        Its sum is the mass of those pieces. Half of a cell edge is the farthest that a mass is moved, by which a cell
        of washers, bolts and blocks keeps its weight and not quite its centre.
    """
    masses = np.zeros(len(network.node_points))
    items = [item for item in hardware if item.kind not in without and item.quantity]
    if not items:
        return masses
    origins = np.concatenate([item.places.origins for item in items])
    each = np.repeat([item.mass for item in items], [item.quantity for item in items])
    away, nearest = cKDTree(network.node_points).query(origins, k=[1, min(2, len(masses))])
    # halfway between two nodes either takes half, whatever the last bits say
    share = np.where(np.ptp(away, axis=1) < HALFWAY, 0.5, 1.0)
    masses += np.bincount(nearest[:, 0], share * each, len(masses))
    return np.asarray(masses + np.bincount(nearest[:, -1], (1 - share) * each, len(masses)), float)
