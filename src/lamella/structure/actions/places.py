"""Nodes of a net by their place: on a boundary, on the ground, around a point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.vectors import diagonal
from lamella.network.network import BOUNDARY, Network
from lamella.structure.actions.rim_edges import rim_edges, rim_loops

RIM = "rim"
"""All boundaries together."""

GROUND_TOLERANCE = 0.01
"""m."""


@dataclass(frozen=True)
class Place:
    """Where nodes are: one of boundary, ground and near.

    Attributes
    ----------
    boundary : str
        Name of a boundary, or "rim" for all of them; "": not by it.
    ground : float or None
        Height z, m: nodes below it, and up to `tolerance` (m) above it.
    near : (x, y, z) or None
        Nodes up to `radius` (m) from this point, without one the nearest node.
    """

    boundary: str = ""
    ground: float | None = None
    tolerance: float = GROUND_TOLERANCE
    near: tuple[float, float, float] | None = None
    radius: float | None = None


@dataclass(frozen=True, eq=False)
class NamedRims:
    """Boundaries of a net by name.

    Attributes
    ----------
    names : tuple of str
    loops : (n,) int
        Index of the boundary that each node lies on, -1 inside.
    edges : (e, 2) int
        Neighbouring nodes along the boundaries.
    """

    names: tuple[str, ...]
    loops: Integers
    edges: Integers

    def on(self, name: str) -> Booleans:
        """Nodes on a boundary, (n,).

        Raises
        ------
        InputError
            There is none of that name.
        """
        if name == RIM:
            return np.asarray(self.loops >= 0)
        if name not in self.names:
            from difflib import get_close_matches

            near = get_close_matches(name, (RIM, *self.names), 1, 0.5)
            raise InputError(
                f"there is no boundary {name!r}" + (f", did you mean {near[0]!r}?" if near else ""),
                f"boundaries are {', '.join(self.names)}; {RIM} is all of them",
                "boundary",
            )
        return np.asarray(self.loops == self.names.index(name))


def named_rims(network: Network, names: Mapping[int, str] | None = None, loops: Integers | None = None) -> NamedRims:
    """The boundaries of a net.

    Parameters
    ----------
    network : Network
    names : mapping, optional
        Names of the surface's boundaries, by number.
    loops : (n,) int, optional
        Number of the surface's boundary that each boundary node lies on. Without it boundaries are told by the faces:
        a net of two that lie above each other has "lower" and "upper" ones, others "outer border" (the longest),
        "border 2" and so on.
    """
    edges = rim_edges(network)
    on_rim = network.node_kinds == BOUNDARY
    if loops is not None and names is not None:
        return NamedRims(tuple(names[k] for k in sorted(names)), np.where(on_rim, loops, -1), edges)
    found = rim_loops(network, edges)
    count = int(found.max(initial=-1)) + 1
    points = network.node_points
    ends = points[edges]
    length = np.bincount(found[edges[:, 0]], np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), count)
    heights = [points[found == k, 2] for k in range(count)]
    if count == 2 and _apart(*heights):
        order = np.argsort([height.mean() for height in heights])
        called = ["lower", "upper"]
    else:
        order = np.lexsort((np.arange(count), -np.round(length / (length.max(initial=0.0) or 1.0), 6)))
        called = ["border"] if count == 1 else ["outer border", *(f"border {k}" for k in range(2, count + 1))]
    rank = np.empty(count + 1, np.int64)
    rank[order], rank[count] = np.arange(count), -1
    return NamedRims(tuple(called), rank[found], edges)


def _apart(one: Floats, other: Floats) -> bool:
    """Whether two boundaries lie at heights of their own."""
    return bool(one.max() < other.min() or other.max() < one.min())


def refuse_far(points: Floats, near: tuple[float, float, float], away: float) -> None:
    """Refuse a place whose nearest node is farther than the net is large.

    Raises
    ------
    InputError
    """
    size = diagonal(points)
    if away > size:
        raise InputError(
            f"the node nearest to {coordinates(near)} is {away:.4g} m away, and the net is {size:.4g} m large",
            "write the point in metres, as the drawing has it",
            "near",
        )


def nodes_at(network: Network, place: Place, rims: NamedRims) -> Integers:
    """Nodes in a place, in their order.

    Raises
    ------
    InputError
        No node is there: how far the nearest one is.
    """
    points = network.node_points
    if place.boundary:
        found = np.flatnonzero(rims.on(place.boundary))
        if not len(found):
            raise InputError(f"no node lies on the boundary {place.boundary!r}", "choose a denser net", "boundary")
        return found
    if place.ground is not None:
        found = np.flatnonzero(points[:, 2] <= place.ground + place.tolerance)
        if not len(found):
            lowest = int(np.argmin(points[:, 2]))
            above = float(points[lowest, 2]) - place.ground
            raise InputError(
                f"no node stands on the ground: the lowest one, at {coordinates(points[lowest])}, is {above:.4g} m "
                f"above it and the tolerance is {place.tolerance:g} m",
                "raise ground, or its tolerance",
                "ground",
            )
        return found
    assert place.near is not None
    away = np.linalg.norm(points - np.array(place.near), axis=1)
    nearest = int(np.argmin(np.round(away, 9)))
    if place.radius is None:
        refuse_far(points, place.near, float(away[nearest]))
        return np.array([nearest])
    found = np.flatnonzero(away <= place.radius)
    if not len(found):
        raise InputError(
            f"no node within {place.radius:g} m of {coordinates(place.near)}: the nearest one, at "
            f"{coordinates(points[nearest])}, is {away[nearest]:.4g} m away",
            "raise radius, or leave it out for the nearest node",
            "radius",
        )
    return found
