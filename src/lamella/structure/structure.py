"""A structure: beams on nodes, cables, springs, what is held, and its systems of equations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Lean
from lamella.base.sparse import SymmetricPattern
from lamella.base.vectors import diagonal
from lamella.structure.beam.beams import Beams, BeamState
from lamella.structure.beam.columns import product
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.cables import Cables, no_cables
from lamella.structure.joint_springs import JointSprings, no_joint_springs
from lamella.structure.node_springs import NodeSprings, no_node_springs
from lamella.structure.state import StructureState

# of the entries of a frame's square from the unit matrix; what rounding leaves in files of six digits is less
NOT_A_ROTATION = 1e-5


@dataclass(frozen=True)
class Structure(Lean):
    """Beams on nodes.

    Attributes
    ----------
    poses : Poses
        As it was put together: what loads are counted from, not necessarily in equilibrium.
    beams : Beams
    held : (n, 6) bool
        Shifts along and rotations about the global axes that supports hold.
    held_joints : (k,) bool
        Joints that are locked.
    cables : Cables
    node_springs : NodeSprings
    joint_springs : JointSprings
    """

    poses: Poses
    beams: Beams
    held: Booleans
    held_joints: Booleans
    cables: Cables = field(default_factory=no_cables)
    node_springs: NodeSprings = field(default_factory=no_node_springs)
    joint_springs: JointSprings = field(default_factory=no_joint_springs)

    def __post_init__(self) -> None:
        nodes = len(self.poses.points)
        self._check_poses()
        if self.held.shape != (nodes, NODE_UNKNOWNS):
            raise InputError(
                f"held has the shape {self.held.shape}",
                f"it has to be ({nodes}, {NODE_UNKNOWNS}): a row a node",
                "held",
            )
        if self.held_joints.shape != self.poses.angles.shape:
            raise InputError(
                f"held_joints has the shape {self.held_joints.shape}",
                f"it has to be {self.poses.angles.shape}: one a joint",
                "held_joints",
            )

    def _check_poses(self) -> None:
        """Refuse poses that are no numbers or no rotations, and beams on what is not there."""
        points, frames = self.poses.points, self.poses.frames
        bad = np.flatnonzero(~np.isfinite(points).all(1))
        if len(bad):
            raise InputError(f"node {bad[0]} is at {points[bad[0]].tolist()}", "coordinates have to be finite", "poses")
        off = np.abs(np.swapaxes(frames, 1, 2) @ frames - np.eye(3)).max(axis=(1, 2), initial=0.0)
        wrong = np.flatnonzero(~((off < NOT_A_ROTATION) & (np.linalg.det(frames) > 0)))
        if len(wrong):
            raise InputError(
                f"the frame of node {wrong[0]} is no rotation",
                "its columns are t, u = n x t and n, of unit length",
                "poses",
            )
        joints = len(self.poses.angles)
        for member, where, what, numbers, least, count in (
            ("element", "beams", "node", self.beams.attachment.nodes, 0, len(points)),
            ("element", "beams", "joint", self.beams.attachment.joints, -1, joints),
            ("cable", "cables", "node", self.cables.attachment.nodes, 0, len(points)),
            ("spring", "node_springs", "node", self.node_springs.nodes[:, None], 0, len(points)),
            ("spring", "joint_springs", "joint", self.joint_springs.joints[:, None], 0, joints),
        ):
            missing = np.flatnonzero(((numbers < least) | (numbers >= count)).any(1))
            if len(missing):
                raise InputError(
                    f"{member} {missing[0]} is on {what} {numbers[missing[0]].tolist()}",
                    f"there are {count}, the first is 0",
                    where,
                )

    @cached_property
    def size(self) -> float:
        """Diagonal of the box around its nodes, m."""
        return diagonal(self.poses.points)

    @cached_property
    def held_unknowns(self) -> Booleans:
        """(6 n + k,)."""
        return np.concatenate((self.held.ravel(), self.held_joints))

    @cached_property
    def free(self) -> Integers:
        """Unknowns that are not held."""
        return np.flatnonzero(~self.held_unknowns)

    @cached_property
    def unknowns(self) -> list[Integers]:
        """Of each element; -1: it has none there. Groups: those of `Beams.unknowns`, cables, springs of nodes and of
        joints."""
        nodes = len(self.poses.points)
        springs = [self.node_springs.unknowns(), self.joint_springs.unknowns(nodes)]
        return [*self.beams.unknowns(nodes), self.cables.unknowns(nodes), *springs]

    def on_springs(self, node_springs: NodeSprings, joint_springs: JointSprings) -> Structure:
        """The same on other springs. What is computed once for all is kept where they are on the same unknowns."""
        other = replace(self, node_springs=node_springs, joint_springs=joint_springs)
        same_nodes = np.array_equal(node_springs.nodes, self.node_springs.nodes)
        if same_nodes and np.array_equal(joint_springs.joints, self.joint_springs.joints):
            for name in ("held_unknowns", "free", "unknowns", "pattern"):
                if name in vars(self):
                    vars(other)[name] = vars(self)[name]
        return other

    def at(self, poses: Poses, beams: BeamState, *, cable_swelling: Floats | float = 0.0) -> StructureState:
        """In a pose, with its beams in it, and cables longer by a strain."""
        turns = self.joint_springs.beyond(poses)
        cables = self.cables.swollen(cable_swelling).at(poses)
        return StructureState(beams, cables, self.node_springs.at(poses), self.joint_springs, turns)

    @cached_property
    def pattern(self) -> SymmetricPattern:
        """Of the stiffness in the free unknowns."""
        number = np.full(self.poses.unknowns + 1, -1)
        number[self.free] = np.arange(len(self.free))
        pairs = []
        for unknowns in self.unknowns:
            first, second = np.tril_indices(len(unknowns))
            numbers = number[unknowns]
            pairs.append((numbers[first].ravel(), numbers[second].ravel()))
        one, other = (np.concatenate(side) for side in zip(*pairs, strict=True))
        return SymmetricPattern.from_pairs(one, other, len(self.free))

    def entries(self, blocks: list[Floats]) -> Floats:
        """Entries in `pattern` of a matrix of element blocks, in the groups of `unknowns`; last ones may be missing."""
        return self.pattern.assemble(np.concatenate([block[np.tril_indices(len(block))].ravel() for block in blocks]))

    def vector(self, parts: list[Floats]) -> Floats:
        """Sum of element vectors, in the groups of `unknowns`, of which last ones may be left out, (6 n + k,)."""
        size = self.poses.unknowns
        total = np.zeros(size + 1)
        for unknowns, part in zip(self.unknowns, parts, strict=False):
            # what has no unknown is counted to one place more
            places = np.where(unknowns < 0, size, unknowns)
            total += np.bincount(places.ravel(), part.ravel(), size + 1)
        return total[:-1]

    def gathered(self, motion: Floats) -> list[Floats]:
        """A motion (6 n + k,) as elements have it, in the groups of `unknowns`."""
        padded = np.append(motion, 0.0)
        return [padded[unknowns] for unknowns in self.unknowns]

    def multiplied(self, blocks: list[Floats], motion: Floats) -> Floats:
        """Product of a matrix of element blocks with a motion (6 n + k,), (6 n + k,)."""
        parts = [product(b, q) for b, q in zip(blocks, self.gathered(motion), strict=False)]
        return self.vector(parts)


def make_structure(poses: Poses, beams: Beams, held: dict[int, str], *, locked: Sequence[int] = ()) -> Structure:
    """A structure with supports at some nodes.

    Parameters
    ----------
    poses : Poses
    beams : Beams
    held : dict of int to str
        Held unknowns of nodes by name, blank between: "x y z" of shifts, "rx ry rz" of rotations, "all" of everything.
    locked : sequence of int
        Joints that keep their angle.

    Raises
    ------
    InputError
        A node or a joint that is not there; a name that is none.
    """
    names = ("x", "y", "z", "rx", "ry", "rz")
    mask = np.zeros((len(poses.points), NODE_UNKNOWNS), bool)
    for node, wanted in held.items():
        if not 0 <= node < len(mask):
            raise InputError(f"there is no node {node}", f"nodes are 0 to {len(mask) - 1}", "held")
        for name in names if wanted == "all" else wanted.split():
            if name not in names:
                raise InputError(f"{name!r} at node {node} is no support", f"use {', '.join(names)} or all", "held")
            mask[node, names.index(name)] = True
    locks = np.zeros(len(poses.angles), bool)
    for joint in locked:
        if not 0 <= joint < len(locks):
            raise InputError(f"there is no joint {joint}", f"there are {len(locks)} joints, the first is 0", "locked")
        locks[joint] = True
    return Structure(poses, beams, mask, locks)
