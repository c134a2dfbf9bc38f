"""All hardware of a structure: joints, hubs, shear blocks, and the holes that parts need for them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.wording import counted
from lamella.fabrication.part import Parts
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.hardware.bores import Bores, drilled
from lamella.hardware.cables import cables
from lamella.hardware.edge_beams import edge_beams
from lamella.hardware.grid_joint import grid_joints, seats
from lamella.hardware.hubs import hubs, singular_rays
from lamella.hardware.item import Hardware, Item
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import MM, CableRules, JointRules
from lamella.hardware.shear_blocks import shear_blocks
from lamella.hardware.splices import cuts, splice_length, splices
from lamella.hardware.stacked_joint import joint_length, stacked_joints, stacked_upper
from lamella.network.network import SINGULAR, Network
from lamella.strip.lamellas import Lamellas

# deg: keys that let a joint turn farther do not fix it
LARGE_PLAY = 3.0


@dataclass(frozen=True, eq=False)
class Joined:
    """Hardware of a structure, and its parts with holes for it.

    Attributes
    ----------
    hardware : Hardware
    parts : Parts
    """

    hardware: Hardware
    parts: Parts


def make_hardware(
    lamellas: Lamellas,
    parts: Parts,
    rules: JointRules,
    cable_rules: CableRules | None = None,
    beams: EdgeBeamAxes | None = None,
) -> Joined:
    """Hardware for lamellas and their parts.

    Parameters
    ----------
    lamellas : Lamellas
    parts : Parts
        Of these lamellas, before they are drilled.
    rules : JointRules
    cable_rules : CableRules, optional
        Without it there are no cables; they need washers.
    beams : EdgeBeamAxes, optional
        Edge beams, whose trims the parts were made with.

    Raises
    ------
    InputError
        Measures that contradict each other or the net.
    """
    section, network = lamellas.section, lamellas.network
    rules.check(section)
    if cable_rules is not None and not rules.washer:
        raise InputError("cables are clamped by the bolts of the joints", "write washer = true", "washer")
    items: list[Item] = []
    bores = []
    notes: list[Message] = []
    frames = NodeFrames.of(network)
    half_joint = half_joint_of(lamellas, rules)
    keep_clear = np.full(len(network.stop_nodes), half_joint)
    if rules.washer:
        above = np.zeros(len(frames))
        if cable_rules is not None:
            top = _upper(frames, lamellas, rules) + rules.washer_thickness
            made_cables = cables(network, frames, section, top, rules, cable_rules)
            items += made_cables.items
            above = made_cables.above
        make = stacked_joints if section.level else grid_joints
        joints = make(frames, lamellas, rules, clamp=above)
        items += joints.items
        notes += _loose(joints.angle_play)
    hub_radius = _hub_radius(parts, network)
    if rules.hub and (network.node_kinds == SINGULAR).any():
        made = hubs(lamellas, rules, hub_radius, _room(lamellas, half_joint))
        items += made.items
        bores.append(made.bores)
        reach = np.zeros(len(network.node_points))
        reach[list(made.reach)] = list(made.reach.values())
        keep_clear = np.maximum(keep_clear, reach[network.stop_nodes])
    keep_clear = np.where(
        network.node_kinds[network.stop_nodes] == SINGULAR, np.maximum(keep_clear, hub_radius), keep_clear
    )
    if beams is not None:
        edge = edge_beams(lamellas, beams, rules)
        items += edge.items
        bores.append(edge.bores)
        keep_clear = np.maximum(keep_clear, edge.keep_clear)
        notes += edge.warnings
    if rules.block_spacing and section.layers > 1:
        blocks = shear_blocks(lamellas, rules, keep_clear, _spliced(parts, lamellas, rules))
        items += blocks.items
        bores.append(blocks.bores)
        left_out = 0 if beams is None else int((beams.left_out.inner > 0).sum())
        notes += _without(blocks.cells_without - left_out, len(network.cell_edges), rules)
    drilled_parts = drilled(parts, lamellas, Bores.of(bores))
    if rules.splice:
        joined = splices(drilled_parts, lamellas, rules)
        items += joined.items
        drilled_parts = joined.parts
    return Joined(Hardware(tuple(items), tuple(notes)), drilled_parts)


def half_joint_of(lamellas: Lamellas, rules: JointRules) -> float:
    """From a node to where its joint ends along its lamellas, m."""
    section = lamellas.section
    if section.level and rules.washer:
        return joint_length(rules, lamellas) / 2
    if rules.washer:
        return rules.star_length(section, NodeFrames.of(lamellas.network).least_angle) / 2
    return section.offset * section.layers / 2


def _upper(frames: NodeFrames, lamellas: Lamellas, rules: JointRules) -> Floats:
    """Height over the surface of what washers or plates lie on, m, (q,)."""
    if lamellas.section.level:
        return stacked_upper(frames, lamellas, rules)
    reach = rules.star_length(lamellas.section, frames.least_angle) / 2
    return lamellas.section.height / 2 + seats(frames, lamellas, reach)[0]


def _hub_radius(parts: Parts, network: Network) -> float:
    """From singular nodes to the strips' ends, m."""
    singular = network.node_kinds[network.stop_nodes] == SINGULAR
    ends = [0.0]
    for part in parts.parts:
        if not len(part.nodes):
            continue
        first = int(network.stop_offsets[part.lamella]) + part.first_node
        if singular[first]:
            ends.append(part.start - float(part.nodes[0]))
        if singular[first + len(part.nodes) - 1]:
            ends.append(float(part.nodes[-1]) - part.end)
    return max(ends)


def _spliced(parts: Parts, lamellas: Lamellas, rules: JointRules) -> Floats:
    """Lamella, arc length and half length of every splice, (c, 3); of every cut where there are none."""
    reach = splice_length(rules) / 2 if rules.splice else 0.0
    found = [(cut.lamella, cut.arclength(lamellas), reach) for cut in cuts(parts, lamellas)]
    return np.array(found, float).reshape(-1, 3)


def _room(lamellas: Lamellas, half_joint: float) -> dict[int, float]:
    """By singular node: from it to where the next joint begins on its rays, m."""
    network = lamellas.network
    owner = network.stop_owner
    found = {}
    for rays in singular_rays(lamellas):
        ends = []
        for lamella, start in zip(rays.lamellas.tolist(), rays.starts.tolist(), strict=True):
            away = np.abs(network.stop_arclengths[owner == lamella] - start)
            ends.append(away[away > 0].min(initial=np.inf))
        found[rays.node] = float(min(ends)) - half_joint
    return found


def _loose(angle_play: float) -> Iterator[Message]:
    if angle_play > LARGE_PLAY:
        yield Message(
            "joints_loose",
            f"keys let the joints turn by up to {angle_play:.2g} deg: the strips lean and twist so much between a "
            "node's axis and their edges; lower strips or a larger offset help",
        )


def _without(cells: int, all_cells: int, rules: JointRules) -> Iterator[Message]:
    if cells:
        yield Message(
            "blocks_left_out",
            f"{cells} of {counted(all_cells, 'cell')} are too short for a shear block {MM * rules.block_length:g} mm "
            "long between their joints",
        )
