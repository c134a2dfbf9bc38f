"""Loads as they are described, on areas, lines and points, and the load cases of a net that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.errors import InputError
from lamella.network.network import Network
from lamella.structure.actions.load_case import LoadCase, no_load
from lamella.structure.actions.node_supports import DIRECTIONS, NodeSupports
from lamella.structure.actions.places import NamedRims, Place, nodes_at
from lamella.structure.actions.tributary import tributary_areas, tributary_lengths

Vector = tuple[float, float, float]
DOWN: Vector = (0.0, 0.0, -1.0)
LoadKind = Literal["self_weight", "area", "line", "point", "temperature", "settlement"]


@dataclass(frozen=True)
class Region:
    """A part of a surface by place and by where its normal turns; all that is given has to hold.

    Attributes
    ----------
    coefficient : float
    near, radius
        Up to so far (m) from a point.
    low, high
        In a box between two corners, m.
    facing
        The normal has a positive component along it.
    """

    coefficient: float
    near: Vector | None = None
    radius: float | None = None
    low: Vector | None = None
    high: Vector | None = None
    facing: Vector | None = None

    def holds(self, points: Floats, normals: Floats) -> Booleans:
        """Whether places with their normals are in it, (n,)."""
        inside = np.ones(len(points), bool)
        if self.near is not None and self.radius is not None:
            inside &= np.linalg.norm(points - np.array(self.near), axis=1) <= self.radius
        if self.low is not None and self.high is not None:
            inside &= ((points >= np.array(self.low)) & (points <= np.array(self.high))).all(1)
        if self.facing is not None:
            inside &= normals @ np.array(self.facing) > 0
        return inside


@dataclass(frozen=True)
class LoadRule:
    """A load, a case of its own.

    Attributes
    ----------
    name : str
    kind : str
    value : float
        N/m2 of an area load, N/m of a line, N of a point, K, m of a settlement, multiples of the weight.
    direction : (x, y, z) or "normal"
        Of any length; "normal": an area load along the surface's normals.
    per : "true" or "plan"
        Area load on the true area, or on the area as it is seen along the direction.
    coefficient : float
        Of an area load, outside all regions.
    regions : tuple of Region
        The first one that holds a node counts.
    place : Place or None
        Of line and point loads and of settlements.
    moment : (x, y, z)
        N m, of a point load.
    """

    name: str
    kind: LoadKind
    value: float
    direction: Vector | Literal["normal"] = DOWN
    per: Literal["true", "plan"] = "true"
    coefficient: float = 1.0
    regions: tuple[Region, ...] = ()
    place: Place | None = None
    moment: Vector = (0.0, 0.0, 0.0)

    @property
    def unit(self) -> Floats:
        """Its direction of length 1, (3,).

        Raises
        ------
        InputError
            It has none.
        """
        if self.direction == "normal":
            raise InputError('"normal" is the direction of area loads', "give three numbers", "direction")
        vector = np.array(self.direction, float)
        length = float(np.linalg.norm(vector))
        if not (np.isfinite(length) and length > 0):
            raise InputError(
                f"the direction {self.direction} has no length", "give a vector such as (0, 0, -1)", "direction"
            )
        return vector / length


def load_cases(network: Network, rules: Sequence[LoadRule], rims: NamedRims) -> tuple[LoadCase, ...]:
    """A load case for each load.

    Parameters
    ----------
    network : Network
    rules : sequence of LoadRule
    rims : NamedRims

    Raises
    ------
    InputError
        A load that acts on no node or has no direction, its number in `where` ("loads[1].direction").
    """
    cases = []
    for k, rule in enumerate(rules):
        try:
            cases.append(_case(network, rule, rims))
        except InputError as error:
            raise InputError(error.message, error.remedy, f"loads[{k}].{error.where}") from None
    return tuple(cases)


def refuse_loose_settlements(cases: Sequence[LoadCase], supports: NodeSupports) -> None:
    """Refuse settlements of what no support holds.

    Raises
    ------
    InputError
        The load's number in `where` ("loads[1].direction").
    """
    for k, case in enumerate(cases):
        loose = np.argwhere((case.settlements != 0) & ~supports.fixed)
        if len(loose):
            node, way = loose[0].tolist()
            raise InputError(
                f"node {node} is not fixed in {DIRECTIONS[way]}, where the load {case.name!r} moves it",
                "settle what is fixed, or in a direction in which it is",
                f"loads[{k}].direction",
            )


def _case(network: Network, rule: LoadRule, rims: NamedRims) -> LoadCase:
    none = no_load(rule.name, len(network.node_points))
    if rule.kind == "self_weight":
        return replace(none, self_weight=rule.value * rule.unit)
    if rule.kind == "temperature":
        return replace(none, temperature=rule.value)
    if rule.kind == "area":
        return replace(none, node_forces=area_forces(network, rule))
    assert rule.place is not None
    if rule.kind == "line":
        return replace(none, node_forces=_line_forces(network, rule, rims, rule.place))
    nodes = nodes_at(network, rule.place, rims)
    if rule.kind == "settlement":
        settlements = none.settlements.copy()
        settlements[nodes, :3] = rule.value * rule.unit
        return replace(none, settlements=settlements)
    forces, moments = none.node_forces.copy(), none.node_moments.copy()
    # the given force and moment is that of all nodes together
    if rule.value:
        forces[nodes] = rule.value / len(nodes) * rule.unit
    moments[nodes] = np.array(rule.moment) / len(nodes)
    return replace(none, node_forces=forces, node_moments=moments)


def area_forces(network: Network, rule: LoadRule) -> Floats:
    """Forces of an area load at the nodes, N, (n, 3).

    Along a direction d: p c A d, with the true area A of a node's share or the area seen along d; along the normal:
    p c times its vector area, which is exact for faces of any shape. Seen along d is what a part of the surface would
    show alone: where it folds over itself, both parts are loaded; `facing` of a region leaves one of them out.

    Raises
    ------
    InputError
        No direction; regions that hold no node.
    """
    areas = tributary_areas(network)
    size = rule.value * _coefficients(network, rule)
    if rule.direction == "normal":
        return size[:, None] * areas.vectors
    area = areas.seen_along(rule.unit) if rule.per == "plan" else areas.true
    return np.outer(size * area, rule.unit)


def _coefficients(network: Network, rule: LoadRule) -> Floats:
    """Of an area load at the nodes, (n,)."""
    found = np.full(len(network.node_points), rule.coefficient)
    free = np.ones(len(found), bool)
    for k, region in enumerate(rule.regions):
        inside = region.holds(network.node_points, network.node_normals)
        if not inside.any():
            raise InputError(
                "no node is in this region", "compare it with the points in nodes.csv, or leave it out", f"regions[{k}]"
            )
        found[free & inside] = region.coefficient
        free &= ~inside
    return found


def _line_forces(network: Network, rule: LoadRule, rims: NamedRims, place: Place) -> Floats:
    """Forces of a line load along a boundary: half of each edge between two of its nodes goes to either one."""
    on_it = rims.on(place.boundary)
    edges = rims.edges[on_it[rims.edges].all(1)]
    if not len(edges):
        raise InputError(f"no edge lies on the boundary {place.boundary!r}", "choose a denser net", "boundary")
    return np.outer(rule.value * tributary_lengths(network, edges), rule.unit)
