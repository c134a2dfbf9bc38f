r"""Cables: straight bars of two ends that take tension and no compression.

Of the natural length L0 and the distance L of its ends a cable has the tension :math:`N = E A \, (L / L_0 - 1)` where
that is above 0, the energy :math:`\tfrac12 L_0 N^2 / E A`, and with the direction d from end to end the tangent
stiffness

.. math:: \frac{E A}{L_0} d d^T + \frac N L (1 - d d^T)

of its relative shift, and none where it is slack. Under prestress it is cut shorter than the distance it spans.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Lean
from lamella.structure.beam.attachment import END_UNKNOWNS, Attachment, Levers
from lamella.structure.beam.columns import dot, element_last, outer, product, turned_product
from lamella.structure.beam.poses import Poses

# of E A: a compression that is less is what rounding leaves of a cable that spans just its length, which is not slack
TIGHT_FROM = -1e-9


@dataclass(frozen=True)
class Cables(Lean):
    """c cables.

    Attributes
    ----------
    attachment : Attachment
        Of their ends; turns of ends do not matter.
    length : (c,)
        Natural length L0, m.
    axial : (c,)
        E A, N.
    mass : (c,)
        kg/m.
    """

    attachment: Attachment
    length: Floats
    axial: Floats
    mass: Floats

    def __len__(self) -> int:
        return len(self.length)

    def unknowns(self, nodes: int) -> Integers:
        """Unknowns of a structure of so many nodes, (14, c), as `Beams.unknowns` of elements beside their nodes."""
        return self.attachment.unknowns(np.arange(len(self)), nodes)

    def swollen(self, swelling: Floats | float) -> Cables:
        """The same, longer by a strain that needs no force, of all or of each (c,)."""
        return replace(self, length=self.length * (1 + swelling)) if np.any(swelling) else self

    def at(self, poses: Poses) -> CableState:
        """Tension and what follows from it, in a pose."""
        points, _ = self.attachment.ends(poses)
        start, end = element_last(points)
        span = end - start
        distance = np.sqrt(dot(span, span))
        return CableState(self, span / distance, distance, self.attachment.levers(poses, np.arange(len(self))))


@dataclass(frozen=True)
class CableState(Lean):
    """Cables in a pose.

    Attributes
    ----------
    cables : Cables
    direction : (3, c)
        From the first end to the second one.
    distance : (c,)
        Of the ends, m.
    levers : Levers
    """

    cables: Cables
    direction: Floats
    distance: Floats
    levers: Levers

    @cached_property
    def force(self) -> Floats:
        """E A (L / L0 - 1), N, (c,): the tension, and what there would be where it is below 0 and the cable slack."""
        return np.asarray(self.cables.axial * (self.distance / self.cables.length - 1))

    @property
    def tension(self) -> Floats:
        """N, (c,)."""
        return np.maximum(self.force, 0.0)

    def tight(self, force: Floats) -> Booleans:
        """Whether cables with a force (c,) in place of `force` resist a pull, (c,)."""
        return np.asarray(force > TIGHT_FROM * self.cables.axial)

    @property
    def energy(self) -> Floats:
        """J, (c,)."""
        return np.asarray(0.5 * self.tension**2 * self.cables.length / self.cables.axial)

    def forces(self) -> Floats:
        """Derivative of the energy with respect to the unknowns, (14, c)."""
        return turned_product(self.levers.first(), self._on_ends(self.tension))

    def stiffness(self, force: Floats) -> Floats:
        """Tangent stiffness with a force (c,) in place of `force`, symmetric, (14, 14, c)."""
        elastic = np.where(self.tight(force), self.cables.axial / self.cables.length, 0.0)
        return self._stiffness(elastic, np.maximum(force, 0.0))

    def geometric_stiffness(self, tension: Floats) -> Floats:
        """The part of `stiffness` that a tension (c,) makes, linear in it."""
        return self._stiffness(np.zeros_like(tension), tension)

    def force_rate(self, motion: Floats) -> Floats:
        """Derivative of `force` along a motion (14, c) of the unknowns, N, (c,)."""
        ends = product(self.levers.first(), motion)
        away = dot(self.direction, ends[6:9] - ends[:3])
        return np.asarray(self.cables.axial / self.cables.length * away)

    def mass(self) -> Floats:
        """Consistent mass matrix, (14, 14, c), kg."""
        ends = np.zeros((END_UNKNOWNS, END_UNKNOWNS, len(self.cables)))
        whole = self.cables.mass * self.cables.length
        for axis in range(3):
            for one in (0, 6):
                for other in (0, 6):
                    ends[one + axis, other + axis] = whole / (3 if one == other else 6)
        return self._on_nodes(ends)

    def _on_ends(self, tension: Floats) -> Floats:
        pull = tension * self.direction
        on_ends = np.zeros((END_UNKNOWNS, len(self.cables)))
        on_ends[:3], on_ends[6:9] = -pull, pull
        return on_ends

    def _stiffness(self, along: Floats, tension: Floats) -> Floats:
        across = tension / self.distance
        block = outer((along - across) * self.direction, self.direction)
        for axis in range(3):
            block[axis, axis] += across
        ends = np.zeros((END_UNKNOWNS, END_UNKNOWNS, len(self.cables)))
        ends[:3, :3] = ends[6:9, 6:9] = block
        ends[:3, 6:9] = ends[6:9, :3] = -block
        return np.asarray(self._on_nodes(ends) + self.levers.second(self._on_ends(tension)))

    def _on_nodes(self, ends: Floats) -> Floats:
        lever = self.levers.first()
        return turned_product(lever, product(ends, lever))


def make_cables(
    poses: Poses,
    nodes: ArrayLike,
    axial: ArrayLike,
    *,
    prestress: ArrayLike = 0.0,
    mass: ArrayLike = 0.0,
    offsets: ArrayLike = 0.0,
) -> Cables:
    """Cables that have their prestress in a pose.

    Parameters
    ----------
    poses : Poses
    nodes : (c, 2) int
        Node of each end.
    axial : (c,) or float
        E A, N.
    prestress : (c,) or float
        Tension in that pose, N; 0: the cable is as long as it spans.
    mass : (c,) or float
        kg/m.
    offsets : (c, 2, 3)
        From nodes to ends, in the nodes' frames, m.

    Raises
    ------
    InputError
        A stiffness that is not above 0, a prestress or mass below 0; ends at one point.
    """
    pairs = np.array(nodes, np.int64).reshape(-1, 2)
    c = len(pairs)
    of = {name: np.broadcast_to(np.asarray(x, float), c).copy() for name, x in (("axial", axial), ("mass", mass))}
    tension = np.broadcast_to(np.asarray(prestress, float), c)
    for name, values, least in (
        ("axial", of["axial"], np.finfo(float).tiny),
        ("prestress", tension, 0.0),
        ("mass", of["mass"], 0.0),
    ):
        bad = np.flatnonzero(~(np.isfinite(values) & (values >= least)))
        if len(bad):
            above = "above 0" if least else "0 or more"
            raise InputError(
                f"{name} of cable {bad[0]} is {values[bad[0]]!r}", f"it has to be finite and {above}", name
            )
    turns = np.broadcast_to(np.eye(3), (c, 2, 3, 3)).copy()
    beside = np.broadcast_to(np.asarray(offsets, float), (c, 2, 3)).copy()
    attachment = Attachment(pairs, turns, beside, np.full((c, 2), -1))
    points, _ = attachment.ends(poses)
    span = np.linalg.norm(points[:, 1] - points[:, 0], axis=1)
    none = np.flatnonzero(~(span > 0))
    if len(none):
        raise InputError(f"cable {none[0]} spans nothing", "its ends have to be at two points", "nodes")
    return Cables(attachment, span / (1 + tension / of["axial"]), of["axial"], of["mass"])


def no_cables() -> Cables:
    """None at all."""
    none = np.zeros(0)
    attachment = Attachment(
        np.zeros((0, 2), np.int64), np.zeros((0, 2, 3, 3)), np.zeros((0, 2, 3)), np.zeros((0, 2), np.int64)
    )
    return Cables(attachment, none, none, none)
