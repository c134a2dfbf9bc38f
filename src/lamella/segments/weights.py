"""Masses and centres of strips and hardware, by node and by segment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part, Parts
from lamella.hardware.item import Hardware, Item
from lamella.hardware.shape import Prism, Sweep
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

# m: nodes that are equally near to something but for rounding
EQUALLY_NEAR = 1e-6


@dataclass(frozen=True, eq=False)
class Weights:
    """Masses of pieces, where they are, and the node each goes with.

    Attributes
    ----------
    parts : (p,)
        Mass of all of each part's pieces, kg.
    part_centres : (p, 3)
        m.
    part_nodes : (p,) int
        The first of each part's nodes.
    items : tuple of float
        Mass of one piece of each item of the hardware, kg.
    places : tuple of (q, 3)
        Where its pieces are, m.
    place_nodes : tuple of (q,) int
        The node each goes with: the nearest, of equally near ones the first.
    nodes : (n,)
        What goes with each node, kg: hardware, and its strips to the middle of their cells.
    """

    parts: Floats
    part_centres: Floats
    part_nodes: Integers
    items: tuple[float, ...]
    places: tuple[Floats, ...]
    place_nodes: tuple[Integers, ...]
    nodes: Floats

    @classmethod
    def of(cls, parts: Parts, hardware: Hardware, lamellas: Lamellas) -> Weights:
        """Of all strips and hardware."""
        network = lamellas.network
        masses = np.array([part.quantity * part.mass for part in parts.parts])
        centres = np.array([_centre(part, lamellas) for part in parts.parts]).reshape(-1, 3)
        nodes = np.zeros(len(network.node_points))
        first = np.zeros(len(masses), np.int64)
        for k, part in enumerate(parts.parts):
            own, shares = _shares(part, network)
            first[k] = own[0]
            np.add.at(nodes, own, masses[k] * shares)
        places = tuple(item.places.world(_middle(item)[None])[:, 0] for item in hardware)
        near = tuple(_nearest(network.node_points, points) for points in places)
        items = tuple(item.mass for item in hardware)
        for own, mass in zip(near, items, strict=True):
            np.add.at(nodes, own, mass)
        return cls(masses, centres, first, items, places, near, nodes)


def part_stops(part: Part, network: Network) -> Integers:
    """Stops of a part's nodes: those of its lamella that lie on it, in order."""
    begin, end = int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1])
    return np.arange(begin, end)[part.first_node : part.first_node + len(part.nodes)]


def _shares(part: Part, network: Network) -> tuple[Integers, Floats]:
    """Nodes of a part, and the share of its length that is nearest to each."""
    nodes = network.stop_nodes[part_stops(part, network)]
    middles = 0.5 * (part.nodes[1:] + part.nodes[:-1])
    ends = np.clip(np.concatenate([[part.start], middles, [part.end]]), part.start, part.end)
    return nodes, np.diff(ends) / part.length


def _centre(part: Part, lamellas: Lamellas) -> Floats:
    """Of the centre line between a part's ends, m."""
    network = lamellas.network
    span = slice(int(network.sample_offsets[part.lamella]), int(network.sample_offsets[part.lamella + 1]))
    stations = lamellas.layers.stations[max(part.layer - 1, 0), span]
    points = network.sample_points[span]
    if network.closed[part.lamella]:
        # a ring begins half a cell before its first node
        stations = np.concatenate([stations[:-1] - (stations[-1] - stations[0]), stations])
        points = np.concatenate([points[:-1], points])
    inner = (stations > part.start) & (stations < part.end)
    at = np.concatenate([[part.start], stations[inner], [part.end]])
    along = np.column_stack([np.interp(at, stations, points[:, k]) for k in range(3)])
    # beyond the rim it goes on straight
    for end, inwards, sign in ((0, 1, -1), (-1, -2, 1)):
        beyond = at[end] - stations[end]
        if sign * beyond > 0:
            tangent = (points[end] - points[inwards]) / (stations[end] - stations[inwards])
            along[end] = points[end] + beyond * tangent
    steps = np.diff(at)
    return np.asarray(0.5 * (steps[:, None] * (along[1:] + along[:-1])).sum(axis=0) / steps.sum())


def _middle(item: Item) -> Floats:
    """Centre of gravity of a piece in its own axes, m."""
    volumes = np.array([shape.volume for shape in item.shape])
    centres = [_sweep_middle(one) if isinstance(one, Sweep) else _prism_middle(one) for one in item.shape]
    return np.asarray(volumes @ np.array(centres) / volumes.sum())


def _sweep_middle(sweep: Sweep) -> Floats:
    steps = np.linalg.norm(np.diff(sweep.points, axis=0), axis=1)
    middles = 0.5 * (sweep.points[1:] + sweep.points[:-1])
    return np.asarray(steps @ middles / steps.sum())


def _prism_middle(prism: Prism) -> Floats:
    """Of the cross section, its holes taken off, at half the height."""
    outer, first = _moments(prism.outline)
    for hole in prism.holes:
        area, moment = _moments(hole)
        outer, first = outer - area, first - moment
    return np.append(first / outer, 0.5 * (prism.low + prism.high))


def _moments(outline: Floats) -> tuple[float, Floats]:
    """Area and first moments of an outline, arcs in straight parts."""
    points = outline_points(outline)
    cross = points[:-1, 0] * points[1:, 1] - points[1:, 0] * points[:-1, 1]
    return float(cross.sum() / 2), cross @ (points[:-1] + points[1:]) / 6


def _nearest(nodes: Floats, points: Floats) -> Integers:
    """The nearest node to each point; of those that are equally near the first."""
    from scipy.spatial import cKDTree

    distance, index = cKDTree(nodes).query(points, k=min(4, len(nodes)))
    distance, index = np.reshape(distance, (len(points), -1)), np.reshape(index, (len(points), -1))
    near = distance <= distance[:, :1] + EQUALLY_NEAR
    return np.asarray(np.where(near, index, len(nodes)).min(axis=1))
