r"""How ends of beam elements hang on nodes: turned, beside them, and by a joint of one angle.

An end has the frame :math:`R Z(\varphi) O` and lies at :math:`x + R Z(\varphi) o`: x and R are the node's pose,
:math:`Z(\varphi)` turns about its third axis by the angle of the joint the end belongs to, O and o are fixed. So one
family of lamellas has :math:`\varphi` and the other has not: a scissor joint without a constraint, locked where its
angle is held. o is the distance of an eccentric layer.

With :math:`r = R Z o` and the axis :math:`a = R e_3` a motion (delta x, w, delta phi) moves the end by

.. math:: \delta x + w \times r + \delta\varphi \, a \times r + \tfrac12 w \times (w \times r)
   + \delta\varphi \, w \times (a \times r) + \tfrac12 \delta\varphi^2 a \times (a \times r), \qquad
   w + \delta\varphi \, a + \tfrac12 \delta\varphi \, w \times a .
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.structure.beam.columns import add_unit, cross, crossing, dot, element_last, outer, symmetric
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.beam.rotations import exponential

END_UNKNOWNS = 2 * NODE_UNKNOWNS
"""Of the two ends of an element; with the angles of their joints two more."""


@dataclass(frozen=True)
class Attachment:
    """Ends of m elements on nodes.

    Attributes
    ----------
    nodes : (m, 2) int
    turns : (m, 2, 3, 3)
        O: the end's frame in that of the node, turned by the joint.
    offsets : (m, 2, 3)
        o: from the node to the end, in the same frame, m.
    joints : (m, 2) int
        Joint whose angle turns the end; -1: none.
    """

    nodes: Integers
    turns: Floats
    offsets: Floats
    joints: Integers

    def indirect(self) -> Integers:
        """Elements of which an end has a joint or lies beside its node."""
        return np.flatnonzero((self.joints >= 0).any(1) | (self.offsets != 0).any((1, 2)))

    def unknowns(self, elements: Integers, nodes: int) -> Integers:
        """Unknowns of elements (e,) of a structure of so many nodes, (14, e); -1: the end has no joint."""
        ends = NODE_UNKNOWNS * self.nodes[elements][:, :, None] + np.arange(NODE_UNKNOWNS)
        joints = self.joints[elements]
        turning = np.where(joints >= 0, NODE_UNKNOWNS * nodes + joints, -1)
        return np.ascontiguousarray(np.concatenate((ends.reshape(-1, END_UNKNOWNS), turning), 1).T)

    def turned(self, poses: Poses) -> Floats:
        """R Z, the nodes' frames turned by the joints, (m, 2, 3, 3)."""
        frames = poses.frames[self.nodes]
        if not len(poses.angles):
            return np.asarray(frames)
        vectors = np.zeros((*self.joints.shape, 3))
        vectors[..., 2] = np.where(self.joints >= 0, poses.angles[self.joints], 0.0)
        return np.asarray(frames @ exponential(vectors))

    def ends(self, poses: Poses) -> tuple[Floats, Floats]:
        """Points (m, 2, 3) and frames (m, 2, 3, 3) of the ends."""
        turned = self.turned(poses)
        points = poses.points[self.nodes] + np.einsum("mkij,mkj->mki", turned, self.offsets)
        return points, turned @ self.turns

    def levers(self, poses: Poses, elements: Integers) -> Levers:
        """Of elements (e,)."""
        turned = self.turned(poses)[elements]
        lever = np.einsum("mkij,mkj->mki", turned, self.offsets[elements])
        axis = np.where(self.joints[elements][..., None] >= 0, turned[..., 2], 0.0)
        return Levers(element_last(lever), element_last(axis))


@dataclass(frozen=True)
class Levers:
    """r and a of the module, both (2, 3, e); a is 0 where an end has no joint."""

    lever: Floats
    axis: Floats

    def first(self) -> Floats:
        """Motion of the ends by that of nodes and joints, (12, 14, e)."""
        result = np.zeros((END_UNKNOWNS, END_UNKNOWNS + 2, self.lever.shape[-1]))
        result[np.arange(END_UNKNOWNS), np.arange(END_UNKNOWNS)] = 1
        for end in (0, 1):
            shift, turn = slice(6 * end, 6 * end + 3), slice(6 * end + 3, 6 * end + 6)
            result[shift, turn] = -crossing(self.lever[end])
            result[shift, END_UNKNOWNS + end] = cross(self.axis[end], self.lever[end])
            result[turn, END_UNKNOWNS + end] = self.axis[end]
        return result

    def second(self, on_ends: Floats) -> Floats:
        """Second derivatives by which forces and moments (12, e) on the ends add to the stiffness, (14, 14, e)."""
        result = np.zeros((END_UNKNOWNS + 2, END_UNKNOWNS + 2, self.lever.shape[-1]))
        for end in (0, 1):
            force, moment = on_ends[6 * end : 6 * end + 3], on_ends[6 * end + 3 : 6 * end + 6]
            lever, axis = self.lever[end], self.axis[end]
            turn, joint = slice(6 * end + 3, 6 * end + 6), END_UNKNOWNS + end
            result[turn, turn] = symmetric(outer(force, lever))
            add_unit(result[turn, turn], -dot(force, lever))
            round_axis = cross(axis, lever)
            mixed = cross(round_axis, force) + 0.5 * cross(axis, moment)
            result[turn, joint] = result[joint, turn] = mixed
            result[joint, joint] = dot(force, cross(axis, round_axis))
        return result
