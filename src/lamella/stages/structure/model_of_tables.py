"""The structural model that the tables of a project ask for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.hardware.rules import CableRules
from lamella.project.structure_tables import JointStiffnessTable, StructureTable
from lamella.project.tables import Project
from lamella.stages.actions_of_tables import Actions
from lamella.stages.fabrication.defaults import cable_rules
from lamella.stages.fabrication.making import edge_beams_of
from lamella.stages.stage import Upstream
from lamella.structure.actions.hardware_masses import hardware_masses
from lamella.structure.actions.load_case import LoadCase, combined
from lamella.structure.analysis.construction_order import CABLES, LOCKED
from lamella.structure.model.model import Model, make_model
from lamella.structure.model.rules import ModelRules

MODELLED = ("cable", "edge_beam")
"""Kinds of hardware that are parts of the model with a weight of their own."""


@dataclass(frozen=True, eq=False)
class Modelled:
    """A model and what is to be looked at on it.

    Attributes
    ----------
    model : Model
    cases : tuple of LoadCase
        Each load alone, then the combinations.
    node_masses : (n,)
        Of the hardware, kg.
    cables_later : CableRules or None
        Cables that are put on once the net has been let go, or in their stage of construction.
    construction : tuple of str
        Stages before the loads come; none: all is in place when the net is let go.
    """

    model: Model
    cases: tuple[LoadCase, ...]
    node_masses: Floats
    cables_later: CableRules | None
    construction: tuple[str, ...]


def model_of(up: Upstream, actions: Actions) -> Modelled:
    """The model of a project, with all defaults filled in."""
    project, lamellas = up.project, up.outputs["lamellas"].lamellas
    table = project.structure or StructureTable()
    cables = cable_rules(project)
    stages = stages_of(project, table)
    later = table.cables == "let go" or bool(stages)
    model = make_model(
        lamellas,
        actions.supports,
        model_rules(project, table),
        cables=None if later else cables,
        edge_beams=edge_beams_of(up, lamellas),
        materials=project.known_materials(),
    )
    combinations = tuple(combined(one.name, actions.loads, one.factors) for one in actions.combinations)
    masses = hardware_masses(lamellas.network, up.outputs["fabrication"].hardware, MODELLED)
    return Modelled(model, actions.loads + combinations, np.asarray(masses), cables if later else None, stages)


def stages_of(project: Project, table: StructureTable) -> tuple[str, ...]:
    """Stages of construction before the loads, without those that have nothing to do."""
    idle = {"loads on"}
    if table.joints != "locked":
        idle.add(LOCKED)
    if project.cables is None:
        idle.add(CABLES)
    return tuple(stage for stage in table.construction or () if stage not in idle)


def model_rules(project: Project, table: StructureTable) -> ModelRules:
    """The rules of the model."""
    joints, stiffness, gap = str(table.joints), 0.0, 0.0
    if isinstance(table.joints, JointStiffnessTable):
        joints, stiffness, gap = "springs", table.joints.stiffness, math.radians(table.joints.gap)
    if LOCKED in stages_of(project, table):
        # free until they are locked
        joints = "hinged"
    return ModelRules(
        elements=table.elements,
        layers=table.layers,
        joints=joints,  # type: ignore[arg-type]
        joint_stiffness=stiffness,
        joint_gap=gap,
        slots=table.slots,
        slot_width=project.fabrication.slot_width or 0.0,
        hub_radius=project.fabrication.hub_radius or 0.0,
        block_spacing=0.0 if project.joint is None else project.joint.block_spacing,
    )
