"""States of a net from flat to designed."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.message import Message
from lamella.base.result import Result
from lamella.erection.driver import Driver
from lamella.erection.flat_shape import FlatShape
from lamella.erection.joint_angles import twist_over_depth
from lamella.erection.slot_room import slot_width_needed
from lamella.erection.state import State
from lamella.erection.way import RangeOfMotion, Snap, Way
from lamella.structure.model.model import Model

# deg off square: no slot is wide enough to turn farther
NEARLY_STRAIGHT = 89.0


@dataclass(frozen=True, repr=False, eq=False)
class Erection(Result):
    """States of a net from flat to designed.

    Attributes
    ----------
    model : Model
        With free joints; one node in its middle is held, so that the net is a body free in space.
    driver : Driver or None
        None where a device drives the net, see `way`.
    each_joint : bool
        Whether each joint is turned to its own angle, because the driver alone would not lead the net.
    states : tuple of State
        From flat to designed, at equal shares of the way.
    flat : FlatShape
    held : bool
        Whether the mean of the joints' angles is held in the flat state, because the net would fold up without.
    hold : float
        Moment on each joint that does so, N m.
    locked : State
        All joints at their designed angles, and nothing else holding the net.
    spring_back : float
        Largest distance of a node of that state from where it was designed, after the best rigid motion, m.
    warnings : tuple of Message
    braced : dict
        The same with what braces the net, see `lamella.erection.braced`.
    way : Way or None
        Of the device that drives the net; None where its joints' angles are driven.
    motion : RangeOfMotion or None
        Of a net driven as a mechanism.
    stop : Snap or None
        Where no equilibrium is found between flat and designed: states from there to the flat one are missing.
    """

    model: Model
    driver: Driver | None
    each_joint: bool
    states: tuple[State, ...]
    flat: FlatShape
    held: bool
    hold: float
    locked: State
    spring_back: float
    warnings: tuple[Message, ...]
    braced: dict[str, float | None] = field(default_factory=dict)
    way: Way | None = None
    motion: RangeOfMotion | None = None
    stop: Snap | None = None

    @property
    def slot_width_needed(self) -> float | None:
        """In which the joints turn as far as they do, m; None of stacked lamellas, which have no slots."""
        if self.model.lamellas.section.level:
            return None
        thickness = self.model.lamellas.section.thickness
        farthest = max(float(turned.max()) for turned in self.turned)
        return float(slot_width_needed(np.radians(min(farthest, NEARLY_STRAIGHT)), thickness))

    @cached_property
    def turned(self) -> tuple[Floats, ...]:
        """How far strips stand off square in their slots at most, degrees, (k,) at each joint, of every state.

        The angle between them, and what it changes over the depth of the slots by the strips' twist, which comes with
        the share of the way to the designed shape.
        """
        lamellas = self.model.lamellas
        twist = np.degrees(twist_over_depth(lamellas.network, self.model.joint_nodes, lamellas.section.height / 2))
        return tuple(np.abs(90 - state.angles) + (state.share if self.laid else 1.0) * twist for state in self.states)

    @property
    def laid(self) -> bool:
        """Whether its first state is the flat net."""
        return self.way is None or self.way.start == "flat"

    def _line(self) -> str:
        if not self.laid:
            return f"{len(self.states)} states from the designed shape on, springs back by {self.spring_back:.3g} m"
        lies = "planar" if self.flat.planar else f"on a sphere of {self.flat.radius:.4g} m"
        return f"flat state {lies}, {len(self.states)} states, springs back by {self.spring_back:.3g} m"
