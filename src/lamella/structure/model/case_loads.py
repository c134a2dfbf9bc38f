"""Load cases of a net on its model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.actions.load_case import GRAVITY, LoadCase
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.loads import Loads, no_loads
from lamella.structure.model.model import Model, line_weights

STRAND_EXPANSION = 16e-6
"""1/K; of stainless steel, EN 10088-1."""


def case_loads(model: Model, case: LoadCase, node_masses: Floats | None = None) -> Loads:
    """Loads of a case.

    Parameters
    ----------
    model : Model
    case : LoadCase
    node_masses : (n,), optional
        Of what hangs on the network's nodes beside strips and cables, kg; it weighs and does not swing.
    """
    structure = model.structure
    forces = np.zeros(structure.poses.unknowns)
    nodes = forces[: NODE_UNKNOWNS * len(structure.poses.points)].reshape(-1, NODE_UNKNOWNS)
    nodes[: model.nodes, :3] = case.node_forces
    nodes[: model.nodes, 3:] = case.node_moments
    weight = GRAVITY * case.self_weight
    masses = np.zeros(len(structure.poses.points))
    if node_masses is not None:
        masses[: model.nodes] = node_masses
    cables = structure.cables
    np.add.at(masses, cables.attachment.nodes, (cables.mass * cables.length / 2)[:, None])
    nodes[:, :3] += masses[:, None] * weight
    motions = np.zeros_like(forces)
    rows = motions[: NODE_UNKNOWNS * len(structure.poses.points)].reshape(-1, NODE_UNKNOWNS)
    rows[: model.nodes] = np.where(structure.held[: model.nodes], case.settlements, 0.0)
    lines = line_weights(model)[:, None] * weight
    rims = np.array([kind.material.expansion for kind in model.rims.sections], float)[model.rims.section]
    strips = np.full(len(model.lines.length), model.lamellas.material.expansion)
    warmer = case.temperature * np.concatenate((strips, rims))
    return replace(
        no_loads(structure),
        forces=forces,
        lines=lines,
        motions=motions,
        swelling=warmer,
        cable_swelling=STRAND_EXPANSION * case.temperature,
    )
