"""From lamellas to the workshop: flat parts with slots, sheets, drawings and the part list."""

from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.parts import make_parts
from lamella.fabrication.read_back import SlotReadBack, read_slots
from lamella.fabrication.schedule import write_schedule
from lamella.fabrication.sheet import Nesting, nest

__all__ = [
    "Nesting",
    "Part",
    "Parts",
    "SlotReadBack",
    "make_parts",
    "nest",
    "read_slots",
    "write_drawings",
    "write_schedule",
]
