"""Supports, loads and combinations that the tables of a project ask for, on its net."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.drawing_origin import Origin, drawing_origin
from lamella.base.errors import InputError
from lamella.base.wording import loop_names
from lamella.network.network import Network
from lamella.project.load_tables import LoadTable, RegionTable
from lamella.project.structure_tables import PlacedTable, StructureTable
from lamella.project.tables import Project
from lamella.stages.keys import key_of, keys
from lamella.structure.actions.combinations import (
    Action,
    Combination,
    PartialFactors,
    Ultimate,
    serviceability_combinations,
    ultimate_combinations,
)
from lamella.structure.actions.load_case import LoadCase
from lamella.structure.actions.load_rules import LoadRule, Region, Vector, load_cases, refuse_loose_settlements
from lamella.structure.actions.node_supports import NodeSupports, SupportRule, supports_of
from lamella.structure.actions.places import GROUND_TOLERANCE, NamedRims, Place, named_rims
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface


@dataclass(frozen=True, eq=False)
class Actions:
    """What holds a net and what acts on it.

    Attributes
    ----------
    supports : NodeSupports
    loads : tuple of LoadCase
        One for each table [[load]].
    combinations : tuple of Combination
        Those that are listed, then those of EN 1990 that are asked for.
    """

    supports: NodeSupports
    loads: tuple[LoadCase, ...]
    combinations: tuple[Combination, ...]


def actions_of(project: Project, network: Network, surface: Surface[Any]) -> Actions:
    """Supports, loads and combinations of a project.

    Raises
    ------
    InputError
        A support that holds no node, a load that acts on nothing, by their keys.
    """
    rims, origin = rims_of(project, network, surface), drawing_origin(surface)
    rules = [
        SupportRule(_place(table, origin), table.fixed or (), table.spring.given() if table.spring else {})
        for table in project.support or ()
    ]
    with keys("structure", supports="support"):
        supports = supports_of(network, rules, rims)
    loads = [_load(table, origin) for table in project.load or ()]
    try:
        cases = load_cases(network, loads, rims)
        refuse_loose_settlements(cases, supports)
    except InputError as error:
        key = key_of(error.where, "structure", loads="load").replace(".regions[", ".region[")
        raise InputError(error.message, error.remedy, key) from None
    return Actions(supports, cases, combinations_of(project))


def combinations_of(project: Project) -> tuple[Combination, ...]:
    """Combinations that are listed and those that are made from the categories of the loads.

    Raises
    ------
    InputError
        There are too many.
    """
    table = project.structure or StructureTable()
    listed = tuple(Combination(one.name, dict(one.factors)) for one in project.combination or ())
    named = [_action(load) for load in project.load or ()]
    made: tuple[Combination, ...] = ()
    with keys("structure", category="load.category"):
        if table.combinations != "listed":
            expression = cast(Ultimate, table.combinations.removeprefix("EN 1990 "))
            made += ultimate_combinations(named, PartialFactors(**table.factors.model_dump()), expression)
        if table.serviceability != "none":
            made += serviceability_combinations(named, table.serviceability)
    # a listed one takes the place of that of its name
    names = {one.name for one in listed}
    return listed + tuple(one for one in made if one.name not in names)


def rims_of(project: Project, network: Network, surface: Surface[Any]) -> NamedRims:
    """Boundaries of a net by the names of the project's curves, or by their own."""
    if not isinstance(surface, ElementSurface):
        return named_rims(network)
    rim_nodes = surface.connectivity.rim_nodes
    nearest = cKDTree(surface.nodes[rim_nodes.ravel()]).query(network.node_points)[1]
    loops = np.repeat(surface.rim_loop, rim_nodes.shape[1])[nearest]
    names = [table.name for table in getattr(project.surface, "boundary", ())]
    return named_rims(network, dict(enumerate(names or loop_names(int(surface.rim_loop.max()) + 1))), loops)


def _action(table: LoadTable) -> Action:
    return Action(table.name, table.acts_as, table.psi, table.group or "")


def _place(table: PlacedTable, origin: Origin) -> Place:
    return Place(
        table.boundary or "",
        None if table.ground is None else table.ground - origin[2],
        table.tolerance or GROUND_TOLERANCE,
        _from(table.near, origin),
        table.radius,
    )


def _from(point: Vector | None, origin: Origin) -> Vector | None:
    """A point of the drawing as the program measures it."""
    if point is None:
        return None
    x, y, z = (here - there for here, there in zip(point, origin, strict=True))
    return x, y, z


def _region(table: RegionTable, origin: Origin) -> Region:
    near, low, high = (_from(getattr(table, key), origin) for key in ("near", "low", "high"))
    return Region(table.coefficient, near, table.radius, low, high, table.facing)


def _load(table: LoadTable, origin: Origin) -> LoadRule:
    regions = tuple(_region(one, origin) for one in table.region or ())
    coefficient = table.coefficient
    if coefficient is None:
        coefficient = 0.0 if regions else 1.0
    return LoadRule(
        table.name,
        table.kind,
        table.value or 0.0,
        table.direction or (0.0, 0.0, -1.0),
        table.per or "true",
        coefficient,
        regions,
        _place(table, origin),
        table.moment or (0.0, 0.0, 0.0),
    )
