"""The table [segments]: what is assembled, carried and lifted in one."""

from __future__ import annotations

from pydantic import model_validator

from lamella.base.number_lists import Refusal
from lamella.project.values import Table, number


class SegmentsTable(Table):
    """Segments that the structure is divided into, cut along lamellas. Without this table it is one."""

    mass: float | None = number(
        "Of a segment at most, strips and hardware; mass or size is given, or both.",
        "kg",
        gt=0,
        le=1e9,
        default=None,
        examples=[400.0],
    )
    size: float | None = number(
        "Greatest distance of two nodes or cut ends of a segment.", "m", gt=0, le=1e6, default=None, examples=[3.0]
    )

    @model_validator(mode="after")
    def _limited(self) -> SegmentsTable:
        if self.mass is None and self.size is None:
            raise Refusal("segments have neither mass nor size", "write mass = 400 (kg) or size = 3.0 (m)", "mass")
        return self
