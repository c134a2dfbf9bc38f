"""Mass of what is bolted to the nodes of a net."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.hardware.item import Hardware, Item
from lamella.hardware.shape import Sweep
from lamella.network.network import Network

BAR_PIECES = 16
"""Pieces of a bar in a cell edge, each of which goes to its nearest node."""

HALFWAY = 1e-6
"""m; pieces are halfway between two nodes whose distances from them differ by less."""


def hardware_masses(network: Network, hardware: Hardware, without: tuple[str, ...] = ("cable",)) -> Floats:
    """Mass at each node of all pieces nearest to it, kg, (n,); of bars of the part of them that is nearest to it.

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
    step = float(np.median(network.cell_edges)) / BAR_PIECES if len(network.cell_edges) else np.inf
    spread = [_points(item, step) for item in items]
    points, each = (np.concatenate(one) for one in zip(*spread, strict=True))
    away, nearest = cKDTree(network.node_points).query(points, k=[1, min(2, len(masses))])
    # halfway between two nodes either takes half, whatever the last bits say
    share = np.where(np.ptp(away, axis=1) < HALFWAY, 0.5, 1.0)
    masses += np.bincount(nearest[:, 0], share * each, len(masses))
    return np.asarray(masses + np.bincount(nearest[:, -1], (1 - share) * each, len(masses)), float)


def _points(item: Item, step: float) -> tuple[Floats, Floats]:
    """Where the mass of all pieces of an item is, (p, 3), m, and how much of it, (p,), kg."""
    bars = [shape for shape in item.shape if isinstance(shape, Sweep)]
    if not bars or len(bars) < len(item.shape):
        return item.places.origins, np.full(item.quantity, item.mass)
    pieces = [_along(bar, step) for bar in bars]
    middles = np.concatenate([points for points, _ in pieces])
    masses = np.concatenate([item.density * bar.area * one for bar, (_, one) in zip(bars, pieces, strict=True)])
    return item.places.world(middles).reshape(-1, 3), np.tile(masses, item.quantity)


def _along(bar: Sweep, step: float) -> tuple[Floats, Floats]:
    """Middles (p, 3) and lengths (p,) of a bar's pieces, none longer than `step`, m."""
    chords = np.diff(bar.points, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    number = np.maximum(np.ceil(np.round(lengths / step, 6)), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(chords)), number)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number) + 0.5) / number[owner]
    return bar.points[owner] + share[:, None] * chords[owner], (lengths / number)[owner]
