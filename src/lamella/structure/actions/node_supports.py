"""What holds the nodes of a net: fixed shifts and rotations, and springs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.base.wording import counted
from lamella.network.network import Network
from lamella.structure.actions.places import NamedRims, Place, nodes_at

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
"""Shifts along and rotations about the global axes, in the order of a node's unknowns."""


@dataclass(frozen=True, eq=False, repr=False)
class NodeSupports(Result):
    """Supports of a network's nodes, in its order; columns are `DIRECTIONS`, global axes.

    Attributes
    ----------
    fixed : (n, 6) bool
        What is held.
    springs : (n, 6)
        Stiffness of springs to the ground, N/m and N m/rad; 0: none.
    """

    fixed: Booleans
    springs: Floats

    def __post_init__(self) -> None:
        """Raise an `InputError` for stiffnesses that are none, or of what is held."""
        if self.fixed.shape != self.springs.shape or self.fixed.shape[1:] != (len(DIRECTIONS),):
            raise InputError(
                f"fixed has the shape {self.fixed.shape}, springs {self.springs.shape}",
                "both have a row of six for each node",
                "supports",
            )
        bad = np.argwhere(~(np.isfinite(self.springs) & (self.springs >= 0)))
        if len(bad):
            node, column = bad[0]
            raise InputError(
                f"the spring of node {node} in {DIRECTIONS[column]} is {self.springs[node, column]:g}",
                "stiffnesses are finite and not negative",
                "spring",
            )

    def _line(self) -> str:
        held = counted(int(self.fixed.any(1).sum()), "node")
        return f"{held} fixed, {counted(int((self.springs > 0).any(1).sum()), 'node')} on springs"

    @property
    def supported(self) -> Booleans:
        """Nodes that are held or on springs, (n,)."""
        return np.asarray((self.fixed | (self.springs > 0)).any(1))


def no_supports(count: int) -> NodeSupports:
    """Nothing holds so many nodes."""
    return NodeSupports(np.zeros((count, len(DIRECTIONS)), bool), np.zeros((count, len(DIRECTIONS))))


@dataclass(frozen=True)
class SupportRule:
    """What is held in a place.

    Attributes
    ----------
    place : Place
    fixed : tuple of str
        Of `DIRECTIONS`.
    springs : mapping
        Stiffness by direction, N/m and N m/rad.
    """

    place: Place
    fixed: tuple[str, ...] = ("x", "y", "z")
    springs: Mapping[str, float] = field(default_factory=dict)


def supports_of(network: Network, rules: Sequence[SupportRule], rims: NamedRims) -> NodeSupports:
    """Supports of a net's nodes: where rules share a node, what one of them fixes is fixed, and springs add up.

    Raises
    ------
    InputError
        A rule that holds no node, its number in `where` ("supports[1].ground").
    """
    none = no_supports(len(network.node_points))
    fixed, springs = none.fixed, none.springs
    for k, rule in enumerate(rules):
        try:
            nodes = nodes_at(network, rule.place, rims)
        except InputError as error:
            raise InputError(error.message, error.remedy, f"supports[{k}].{error.where}") from None
        for way in rule.fixed:
            fixed[nodes, DIRECTIONS.index(way)] = True
        for way, stiffness in rule.springs.items():
            springs[nodes, DIRECTIONS.index(way)] += stiffness
    return NodeSupports(fixed, np.where(fixed, 0.0, springs))
