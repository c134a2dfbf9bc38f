"""The structural model of a net: beams along its lamellas, joints, cables, supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.material import MATERIALS, Material
from lamella.base.result import Result
from lamella.base.wording import counted
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Lamellas
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.beam.attachment import Attachment
from lamella.structure.beam.beams import Beams, make_beams
from lamella.structure.beam.cross_section import CrossSection, flat_strip
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.beam.relative_motion import RelativeMotion
from lamella.structure.beam.turning import turning
from lamella.structure.joint_springs import JointSprings, make_joint_springs, no_joint_springs
from lamella.structure.model.block_nodes import block_places
from lamella.structure.model.bracing import brace
from lamella.structure.model.curve_samples import CurveSamples
from lamella.structure.model.divisions import Divisions
from lamella.structure.model.layer_sections import layers_section
from lamella.structure.model.lines import Lines
from lamella.structure.model.node_poses import bare_nodes, joint_numbers, node_frames
from lamella.structure.model.rim_beams import RimBeams, rim_beams
from lamella.structure.model.rules import ModelRules
from lamella.structure.model.slots import slotted
from lamella.structure.node_springs import make_node_springs
from lamella.structure.structure import Structure


@dataclass(frozen=True, repr=False, eq=False)
class Model(Result):
    """A net as a structure.

    Attributes
    ----------
    lamellas : Lamellas
    rules : ModelRules
    structure : Structure
        Its first nodes are those of the network, in its order; its joints are at `joint_nodes`.
    lines : Lines
        Where the elements of lamellas are, the first ones.
    rims : RimBeams
        Those of edge beams, which come after them.
    joint_nodes : (k,) int
        Node of the network of each joint; none where joints are locked.
    supports : NodeSupports
    edge_beams : EdgeBeamAxes or None
    materials : mapping
        Those of edge beams by name.
    """

    lamellas: Lamellas
    rules: ModelRules
    structure: Structure
    lines: Lines
    rims: RimBeams
    joint_nodes: Integers
    supports: NodeSupports
    edge_beams: EdgeBeamAxes | None
    materials: Mapping[str, Material]

    def _line(self) -> str:
        structure = self.structure
        return (
            f"{counted(len(structure.beams), 'element')}, {counted(len(structure.poses.points), 'node')}, "
            f"{counted(len(self.joint_nodes), 'joint')}, {counted(len(structure.cables), 'cable')}"
        )

    @property
    def nodes(self) -> int:
        """Of the network."""
        return len(self.lamellas.network.node_points)


def make_model(
    lamellas: Lamellas,
    supports: NodeSupports,
    rules: ModelRules | None = None,
    *,
    cables: CableRules | None = None,
    edge_beams: EdgeBeamAxes | None = None,
    materials: Mapping[str, Material] = MATERIALS,
) -> Model:
    """The model of a net as it was designed: curved and twisted strips, whose natural state is flat.

    Nothing is imposed: the residual stress is what strips have that were cut straight, or to one radius, and are where
    they were designed to be.

    Parameters
    ----------
    lamellas : Lamellas
    supports : NodeSupports
        Of the network's nodes.
    rules : ModelRules, optional
    cables : CableRules, optional
        Default: no cables.
    edge_beams : EdgeBeamAxes, optional
        Default: none.
    materials : mapping
        Those of edge beams by name.

    Raises
    ------
    InputError
        Rules that contradict each other.
    """
    rules = ModelRules() if rules is None else rules
    network, section = lamellas.network, lamellas.section
    joints = joint_numbers(network)
    loose = rules.joints != "locked"
    angles = np.zeros(int((joints >= 0).sum()) if loose else 0)
    poses = Poses(network.node_points, node_frames(network), angles)
    divisions = Divisions.of(network, rules.elements, rules.hub_radius)
    if rules.layers == "each" and section.layers > 1:
        poses, lines = _layer_lines(lamellas, divisions, poses, rules)
        kind = flat_strip(lamellas.material, section.height, section.thickness)
    else:
        centre = CurveSamples.of_centre_lines(network)
        lines = Lines.along(lamellas, centre, divisions, poses, _at_nodes(lamellas, divisions), -1)
        kind = layers_section(lamellas.material, section)
    poses = _with_inner(poses, lines)
    rims = rim_beams(network, edge_beams, poses, rules.elements, materials)
    poses = _with_inner(poses, rims)
    beams = _beams(lamellas, lines, rims, poses, kind, rules)
    if rules.near_design:
        beams = turning(beams, poses)
    structure = _supported(lamellas, poses, beams, supports)
    structure = replace(
        structure, cables=brace(network, poses, cables, section.height), joint_springs=_springs(poses, rules)
    )
    at_joints = np.flatnonzero(joints >= 0) if loose else joints[:0]
    return Model(lamellas, rules, structure, lines, rims, at_joints, supports, edge_beams, materials)


def divided(model: Model, elements: int) -> Model:
    """The same net on the same supports with another number of elements in a cell edge, and its cables as they are."""
    rules = replace(model.rules, elements=elements)
    other = make_model(model.lamellas, model.supports, rules, edge_beams=model.edge_beams, materials=model.materials)
    return replace(other, structure=replace(other.structure, cables=model.structure.cables))


def _beams(
    lamellas: Lamellas, lines: Lines, rims: RimBeams, poses: Poses, kind: CrossSection, rules: ModelRules
) -> Beams:
    """Elements of lamellas, whose natural state is flat, and of edge beams, which are as they were bent."""
    of_lamellas, of_rims = len(lines.length), len(rims.nodes)
    cut = lamellas.cut_curvatures[lines.lamella]
    nodes = np.concatenate((lines.nodes, rims.nodes))
    turns = np.concatenate((lines.turns, rims.turns))
    offsets = np.concatenate((lines.offsets, rims.offsets))
    joints = np.concatenate((lines.joints, np.full((of_rims, 2), -1)))
    points, frames = Attachment(nodes, turns, offsets, joints).ends(poses)
    motion = RelativeMotion.between(points[of_lamellas:], frames[of_lamellas:])
    present = np.linalg.norm(motion.local_rho, axis=0)
    beams = make_beams(
        nodes,
        np.concatenate((lines.length, present)),
        (kind, *(one.section for one in rims.sections)),
        section=np.concatenate((np.zeros(of_lamellas, np.int64), rims.section + 1)),
        natural=np.outer(np.concatenate((cut, np.zeros(of_rims))), (0.0, -1.0, 0.0)),
        turns=turns,
        offsets=offsets,
        joints=joints,
    )
    beams = beams.unstrained(poses, np.arange(len(beams)) >= of_lamellas)
    if lamellas.section.layer_curves == "cut":
        # what lies on the centre lines of the surface is cut straight, or to one radius, as it is
        beams = _cut_to_their_own(beams, poses, lines.layer >= 0 if not lamellas.section.level else lines.layer >= -1)
    if rules.slots == "whole":
        return beams
    slots = np.concatenate((lines.crossed.sum(1), np.zeros(of_rims)))
    return slotted(beams, slots.astype(float), lamellas.section.height, rules.slot_width)


def _cut_to_their_own(beams: Beams, poses: Poses, some: Booleans) -> Beams:
    """The same, of which some of the first elements are of strips with the outline of their own curve.

    They are bent about the weak axis and twisted, and not bent about the strong one.
    """
    count = len(some)
    points, frames = beams.attachment.ends(poses)
    turn = RelativeMotion.between(points[:count], frames[:count]).local_theta[1] / beams.law.length[:count]
    natural = beams.law.natural.copy()
    natural[:count, 1] = np.where(some, turn, natural[:count, 1])
    return beams.with_natural(natural)


def _at_nodes(lamellas: Lamellas, divisions: Divisions) -> Integers:
    """Node of the network at the ends of edges, -1 between them, (e, elements + 1)."""
    shared = np.full(divisions.arclengths.shape, -1)
    shared[:, [0, -1]] = lamellas.network.stop_nodes[divisions.stops]
    return shared


def _layer_lines(lamellas: Lamellas, divisions: Divisions, poses: Poses, rules: ModelRules) -> tuple[Poses, Lines]:
    """Lines of all layers, and the nodes with those of the shear blocks."""
    network = lamellas.network
    shared = _at_nodes(lamellas, divisions)
    blocks = block_places(network, divisions, rules.block_spacing)
    shared[blocks] = len(poses.points) + np.arange(int(blocks.sum()))
    lamella = np.broadcast_to(divisions.lamella[:, None], blocks.shape)
    points, frames = CurveSamples.of_centre_lines(network).at(lamella[blocks], divisions.arclengths[blocks])
    poses = replace(poses, points=np.concatenate((poses.points, points)), frames=np.concatenate((poses.frames, frames)))
    lines: Lines | None = None
    there = poses
    for row in range(lamellas.section.layers):
        own = Lines.along(lamellas, CurveSamples.of_layer(lamellas, row), divisions, there, shared, row)
        there = _with_inner(there, own)
        lines = own if lines is None else lines.joined(own)
    assert lines is not None
    return poses, lines


def _with_inner(poses: Poses, lines: Lines | RimBeams) -> Poses:
    """The nodes that are there, and those of lines after them."""
    return replace(
        poses,
        points=np.concatenate((poses.points, lines.points)),
        frames=np.concatenate((poses.frames, lines.frames)),
    )


def _supported(lamellas: Lamellas, poses: Poses, beams: Beams, supports: NodeSupports) -> Structure:
    """The structure on its supports; nodes that no lamella reaches are held."""
    count = len(lamellas.network.node_points)
    held, springs = np.zeros((len(poses.points), NODE_UNKNOWNS), bool), np.zeros((len(poses.points), NODE_UNKNOWNS))
    held[:count], springs[:count] = supports.fixed, supports.springs
    held[bare_nodes(lamellas.network)] = True
    springs[held] = 0.0
    free: Booleans = np.zeros(len(poses.angles), bool)
    return Structure(poses, beams, held, free, node_springs=make_node_springs(poses, springs))


def _springs(poses: Poses, rules: ModelRules) -> JointSprings:
    if rules.joints != "springs" or not len(poses.angles):
        return no_joint_springs()
    return make_joint_springs(poses, rules.joint_stiffness, gap=rules.joint_gap)


def line_weights(model: Model) -> Floats:
    """Mass of the elements per natural length, kg/m, (m,)."""
    beams = model.structure.beams
    return np.array([section.mass for section in beams.sections], float)[beams.section]
