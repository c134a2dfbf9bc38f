"""The structure of a project but for one change: of its strips, joints, supports, or without a part."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.project.structure_analyses_tables import SensitivityTable, VariantTable
from lamella.project.structure_tables import JointStiffnessTable, StructureTable
from lamella.stages.actions_of_tables import Actions
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.stage import Upstream
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.actions.sliding_feet import sliding_feet

IN_SPACE = 3
MM = 1e3

Other = Callable[[NodeSupports, Floats], NodeSupports]
"""Supports of nodes at points (n, 3) that have others."""


@dataclass(frozen=True)
class Variant:
    """What is changed.

    Attributes
    ----------
    name : str
    strips : mapping
        Keys of [lamella].
    joints : "locked", "hinged", JointStiffnessTable or None
    without : tuple of str
        Tables of the project: "cables", "edge_beam".
    supports : callable or None
    """

    name: str
    strips: Mapping[str, Any] = field(default_factory=dict)
    joints: Any = None
    without: tuple[str, ...] = ()
    supports: Other | None = None

    def applied(self, up: Upstream, actions: Actions) -> tuple[Upstream, Actions]:
        """What is modelled instead; hardware is as it was.

        Raises
        ------
        InputError
            Strips that cannot be.
        """
        project = up.project
        table = project.structure or StructureTable()
        if self.joints is not None:
            table = table.model_copy(update={"joints": self.joints})
        changes: dict[str, Any] = {"structure": table} | dict.fromkeys(self.without)
        if self.strips:
            changes["lamella"] = project.lamella.model_copy(update=dict(self.strips))
        other = replace(up, project=project.model_copy(update=changes))
        if self.strips:
            made = up.outputs["lamellas"]
            lamellas = strips_of(other.project, up.surface)(up.outputs["network"].network)
            outputs = dict(up.outputs) | {"lamellas": replace(made, network=lamellas.network, lamellas=lamellas)}
            other = replace(other, outputs=outputs)
        if self.supports is not None:
            points = up.outputs["network"].network.node_points
            actions = replace(actions, supports=self.supports(actions.supports, points))
        return other, actions


def variant_of(table: VariantTable) -> Variant:
    """Of a table [[structure.variant]]."""
    strips = {key: value for key in ("layers", "thickness", "height") if (value := getattr(table, key)) is not None}
    joints = JointStiffnessTable(stiffness=table.joints) if isinstance(table.joints, float) else table.joints
    without = tuple(part.replace("edge beams", "edge_beam") for part in table.without)
    feet: dict[str | None, Other | None] = {None: None, "fixed": _fixed_feet, "sliding": sliding_feet}
    return Variant(table.name, strips, joints, without, feet[table.feet])


def sensitivity_variants(table: SensitivityTable, thickness: float) -> Iterator[Variant]:
    """Joints and supports of each stiffness, strips of a thickness (m) that are thicker and thinner."""
    for stiffness in table.joints:
        yield Variant(f"joints {stiffness:g} N m/rad", joints=JointStiffnessTable(stiffness=stiffness))
    for stiffness in table.supports:
        yield Variant(f"supports {stiffness:g} N/m", supports=_on_springs(stiffness))
    if table.thickness:
        for sign in (1, -1):
            by = sign * table.thickness
            yield Variant(f"thickness {MM * by:+g} mm", strips={"thickness": thickness + by})


def _on_springs(stiffness: float) -> Other:
    def other(supports: NodeSupports, points: Floats) -> NodeSupports:
        fixed, springs = supports.fixed.copy(), supports.springs.copy()
        springs[:, :IN_SPACE] = np.where(fixed[:, :IN_SPACE], stiffness, springs[:, :IN_SPACE])
        fixed[:, :IN_SPACE] = False
        return NodeSupports(fixed, springs)

    return other


def _fixed_feet(supports: NodeSupports, points: Floats) -> NodeSupports:
    fixed, springs = supports.fixed.copy(), supports.springs.copy()
    fixed[supports.supported, :IN_SPACE] = True
    springs[fixed] = 0.0
    return NodeSupports(fixed, springs)
