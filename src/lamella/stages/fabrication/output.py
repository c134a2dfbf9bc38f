"""What the stage "fabrication" computes."""

from __future__ import annotations

from dataclasses import dataclass, field

from lamella.base.message import Message
from lamella.fabrication.part import Parts
from lamella.fabrication.sheet import Nesting
from lamella.fabrication.stock import Supply
from lamella.hardware.item import Hardware
from lamella.hardware.plate_sheets import PlateSheets
from lamella.segments.segments import Segments


@dataclass(frozen=True)
class FabricationOutput:
    """Parts and where they lie on sheets.

    Attributes
    ----------
    parts : Parts
    nesting : Nesting
    surface_area : float
        m2.
    hardware : Hardware
        What joins the parts; nothing where the project has no table [joint].
    supply : Supply or None
        What the strips are cut from, where the project has stock.
    plates : tuple of PlateSheets
        Plates of the hardware on such stock.
    notes : tuple of Message
        What the user should know about them.
    segments : Segments
        None where the project has no table [segments].
    slot_width : float
        Of its slots, m.
    by_erection : bool
        Whether that follows from the way of its joints.
    """

    parts: Parts
    nesting: Nesting
    surface_area: float
    hardware: Hardware = field(default_factory=Hardware)
    supply: Supply | None = None
    plates: tuple[PlateSheets, ...] = ()
    notes: tuple[Message, ...] = ()
    segments: Segments = field(default_factory=Segments)
    slot_width: float = 0.0
    by_erection: bool = False
