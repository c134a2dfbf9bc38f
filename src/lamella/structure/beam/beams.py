"""Beam elements in bulk: energy, forces and stiffness of all of them at once.

Geometrically exact elements of two nodes whose centre line is a helix: of any size of motion, exact wherever curvature
and twist are constant. `lamella.structure.beam.relative_motion` has the kinematics, `lamella.structure.beam.strains`
the strains, `lamella.structure.beam.attachment` how ends hang on nodes; here they are put together by the chain rule.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Lean
from lamella.structure.beam.attachment import END_UNKNOWNS, Attachment, Levers
from lamella.structure.beam.columns import element_last, product, turned_product
from lamella.structure.beam.cross_section import CrossSection
from lamella.structure.beam.line_loads import LineLoads
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.relative_motion import RelativeMotion
from lamella.structure.beam.strains import StrainLaw, Strains


@dataclass(frozen=True)
class Beams(Lean):
    """m beam elements.

    Attributes
    ----------
    attachment : Attachment
    law : StrainLaw
    sections : tuple of CrossSection
    section : (m,) int
        Which of them each element has.
    """

    attachment: Attachment
    law: StrainLaw
    sections: tuple[CrossSection, ...]
    section: Integers

    def __len__(self) -> int:
        return len(self.law.length)

    @cached_property
    def indirect(self) -> Integers:
        """Elements that do not hang on their nodes directly."""
        return self.attachment.indirect()

    @cached_property
    def direct(self) -> Integers:
        """The other ones."""
        return np.setdiff1d(np.arange(len(self)), self.indirect)

    def unknowns(self, nodes: int) -> list[Integers]:
        """Unknowns of a structure of so many nodes, of elements `direct` (12, d) and of `indirect` (14, i).

        Vectors and matrices of elements come in the same two groups, the element last: (12, d), (12, 12, d) and so on.
        """
        return [
            self.attachment.unknowns(self.direct, nodes)[:END_UNKNOWNS],
            self.attachment.unknowns(self.indirect, nodes),
        ]

    def with_natural(self, natural: Floats) -> Beams:
        """The same with other natural curvatures (m, 3), 1/m: tg0, -kn0, kg0."""
        return replace(self, law=replace(self.law, natural=natural))

    def unstrained(self, poses: Poses, some: Booleans) -> Beams:
        """The same, of which some elements (m,) have their natural shape in a pose, but for their length."""
        motion = RelativeMotion.between(*self.attachment.ends(poses))
        law, size = self.law, np.sqrt((motion.local_rho**2).sum(0))
        natural = np.where(some[:, None], (motion.local_theta / law.length).T, law.natural)
        bends = np.where(some, motion.local_rho[1:] / size, law.bends)
        return replace(self, law=replace(law, natural=natural, bends=bends))

    def swollen(self, swelling: Floats) -> Beams:
        """The same, longer by a strain (m,) that needs no force."""
        return replace(self, law=replace(self.law, swelling=self.law.swelling + swelling))

    def at(self, poses: Poses, lines: Floats | None = None) -> BeamState:
        """Strains and what follows from them, in a pose.

        Parameters
        ----------
        poses : Poses
        lines : (m, 3), optional
            Dead loads, N/m of natural length, global.
        """
        points, frames = self.attachment.ends(poses)
        motion = RelativeMotion.between(points, frames)
        levers = self.attachment.levers(poses, self.indirect) if len(self.indirect) else None
        strains = Strains.of(self.law, motion.local_rho, motion.local_theta)
        return BeamState(self, motion, strains, levers, LineLoads(self.law.length, element_last(frames[..., 0]), lines))


@dataclass(frozen=True)
class BeamState(Lean):
    """Beam elements in a pose, under line loads."""

    beams: Beams
    motion: RelativeMotion
    strains: Strains
    levers: Levers | None
    lines: LineLoads

    @cached_property
    def stress(self) -> Floats:
        """What is conjugate to `Strains.values`, (7, m)."""
        return self.beams.law.stress(self.strains.values)

    @property
    def energy(self) -> Floats:
        """Elastic energy of each element, J, (m,)."""
        return self.beams.law.energy(self.strains.values)

    @cached_property
    def _first(self) -> Floats:
        """Derivative of the strains with respect to rho and theta in global axes, (7, 6, m)."""
        local = self.strains.first.reshape(2 * len(self.strains.first), 3, -1)
        turned = np.einsum("ajm,ijm->aim", local, self.motion.frame)
        return np.asarray(turned.reshape(self.strains.first.shape))

    def on_ends(self, stress: Floats) -> Floats:
        """Forces (N) and moments (N m) that hold the ends under a stress (7, m) and the line loads, global, (12, m)."""
        by_motion = turned_product(self._first, stress)
        return self.motion.on_ends(by_motion[:3], by_motion[3:]) - self.lines.on_ends()

    def forces(self) -> list[Floats]:
        """Derivative of elastic energy and line loads' potential with respect to the unknowns, by `Beams.unknowns`."""
        return self.on_nodes(self.on_ends(self.stress))

    def on_nodes(self, on_ends: Floats) -> list[Floats]:
        """Forces and moments on the ends (12, m) as the unknowns have them, in the groups of `Beams.unknowns`."""
        if self.levers is None:
            return [on_ends, np.zeros((END_UNKNOWNS + 2, 0))]
        indirect = turned_product(self.levers.first(), on_ends[:, self.beams.indirect])
        return [on_ends[:, self.beams.direct], indirect]

    def stiffness(self, stress: Floats) -> list[Floats]:
        """Tangent stiffness with a stress (7, m), symmetric, in the groups of `Beams.unknowns`.

        With `stress` of this state it is the second derivative of the energy along exp(w) R; another stress near it is
        what Newton's method takes, see `lamella.structure.newton`.
        """
        return self._stiffness(self.beams.law.elastic(self._first), stress)

    def geometric_stiffness(self, stress: Floats) -> list[Floats]:
        """The part of `stiffness` that a stress (7, m) and the line loads make, linear in them."""
        return self._stiffness(np.zeros((6, 6, len(self.beams))), stress)

    def _stiffness(self, elastic: Floats, stress: Floats) -> list[Floats]:
        by_motion = turned_product(self._first, stress)
        ends = self.motion.stiffness(elastic + self._turned(stress), by_motion[:3], by_motion[3:])
        self.lines.add_stiffness(ends)
        direct, indirect = self.beams.direct, self.beams.indirect
        if self.levers is None:
            return [ends, np.zeros((END_UNKNOWNS + 2, END_UNKNOWNS + 2, 0))]
        lever = self.levers.first()
        nodes = turned_product(lever, product(ends[..., indirect], lever))
        nodes += self.levers.second(self.on_ends(stress)[:, indirect])
        return [ends[..., direct], nodes]

    def _turned(self, stress: Floats) -> Floats:
        """Second derivative of the strains under a stress, with respect to rho and theta in global axes, (6, 6, m)."""
        local, frame = self.strains.second(stress), self.motion.frame
        for part in (slice(0, 3), slice(3, 6)):
            local[part, part] = np.einsum("iam,jam->ijm", product(frame, local[part, part]), frame)
        return local

    def strain_rate(self, motions: list[Floats]) -> Floats:
        """First derivative of the strains along a motion given in the groups of `Beams.unknowns`, (7, m)."""
        ends = motions[0]
        if self.levers is not None:
            ends = np.empty((END_UNKNOWNS, len(self.beams)))
            ends[:, self.beams.direct] = motions[0]
            ends[:, self.beams.indirect] = product(self.levers.first(), motions[1])
        return product(self._first, np.concatenate(self.motion.strain_motion(ends)))


def make_beams(
    nodes: ArrayLike,
    lengths: ArrayLike,
    sections: CrossSection | Sequence[CrossSection],
    *,
    section: ArrayLike = 0,
    natural: ArrayLike = 0.0,
    turns: ArrayLike | None = None,
    offsets: ArrayLike = 0.0,
    joints: ArrayLike = -1,
) -> Beams:
    """Beam elements.

    Parameters
    ----------
    nodes : (m, 2) int
        Node of each end.
    lengths : (m,) or float
        Natural lengths, m.
    sections : CrossSection or sequence of them
    section : (m,) int
        Which of them each element has.
    natural : (m, 3) or (3,)
        Natural curvature tg0, -kn0, kg0, 1/m: 0 of a straight flat strip, (0, -1/r, 0) of one cut to an arc that bends
        towards n.
    turns : (m, 2, 3, 3), optional
        Frames of the ends in those of their nodes; default: the same.
    offsets : (m, 2, 3)
        From nodes to ends, in the nodes' frames turned by their joints, m.
    joints : (m, 2) int
        Joint whose angle turns each end about its node's third axis; -1: none.

    Raises
    ------
    InputError
        A length that is not above 0; an element from a node to itself; a section that is not there.
    """
    pairs = np.array(nodes, np.int64).reshape(-1, 2)
    m = len(pairs)
    length = np.broadcast_to(np.asarray(lengths, float), m).copy()
    bad = np.flatnonzero(~(np.isfinite(length) & (length > 0)))
    if len(bad):
        raise InputError(
            f"element {bad[0]} has the length {length[bad[0]]!r}", "lengths have to be finite and above 0", "lengths"
        )
    same = np.flatnonzero(pairs[:, 0] == pairs[:, 1])
    if len(same):
        raise InputError(f"element {same[0]} goes from node {pairs[same[0], 0]} to itself", "", "nodes")
    kinds = (sections,) if isinstance(sections, CrossSection) else tuple(sections)
    which = np.broadcast_to(np.asarray(section, np.int64), m).copy()
    attachment = Attachment(
        pairs,
        np.broadcast_to(np.eye(3) if turns is None else np.asarray(turns, float), (m, 2, 3, 3)).copy(),
        np.broadcast_to(np.asarray(offsets, float), (m, 2, 3)).copy(),
        np.broadcast_to(np.asarray(joints, np.int64), (m, 2)).copy(),
    )
    if m and not 0 <= which.min() <= which.max() < len(kinds):
        raise InputError(f"section goes from {which.min()} to {which.max()}", f"there are {len(kinds)}", "section")
    curvature = np.broadcast_to(np.asarray(natural, float), (m, 3)).copy()
    return Beams(attachment, _law(kinds, which, length, curvature), kinds, which)


def _law(kinds: tuple[CrossSection, ...], which: Integers, length: Floats, natural: Floats) -> StrainLaw:
    def of(name: str) -> Floats:
        return np.array([getattr(kind, name) for kind in kinds], float)[which]

    # residual bending flexibility (see strains): shear along u goes with bending about n
    bend = length**2 / 12
    shear_u = 1 / (1 / of("shear_u") + bend / of("bending_n"))
    shear_n = 1 / (1 / of("shear_n") + bend / of("bending_u"))
    columns = (of("axial"), shear_u, shear_n, of("torsion"), of("bending_u"), of("bending_n"), of("helix"))
    stiffness = np.stack(columns) * length
    return StrainLaw(length, natural, stiffness, of("gyration"), of("poisson"), of("plate_rate"))
