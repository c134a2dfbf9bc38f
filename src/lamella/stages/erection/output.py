"""What the stage "erection" computes."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.message import Message
from lamella.erection.cut import Cut
from lamella.erection.erection import Erection
from lamella.erection.lift_cases import LiftCase


@dataclass(frozen=True, eq=False)
class ErectedSegment:
    """What is laid flat and erected in one.

    Attributes
    ----------
    id : str
        "S1"; empty for the whole net.
    mass : float
        With its hardware, kg; 0 for the whole net.
    made : Erection or None
    fault : str
        Why there is none.
    lifts : tuple of LiftCase
        Where it is asked for.
    cut : Cut or None
        Where lamellas overlap in the flat state, and a cut is proposed.
    """

    id: str
    mass: float
    made: Erection | None
    fault: str = ""
    lifts: tuple[LiftCase, ...] = ()
    cut: Cut | None = None


@dataclass(frozen=True, eq=False)
class ErectionOutput:
    """The whole net, or its segments where it is divided.

    Attributes
    ----------
    segments : tuple of ErectedSegment
    warnings : tuple of Message
    """

    segments: tuple[ErectedSegment, ...]
    warnings: tuple[Message, ...] = ()

    @property
    def made(self) -> tuple[Erection, ...]:
        """Of those that were found."""
        return tuple(one.made for one in self.segments if one.made is not None)

    @property
    def divided(self) -> bool:
        """Whether the net is divided into segments."""
        return bool(self.segments[0].id)
