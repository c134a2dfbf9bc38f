"""The tables [joint] and [cables]: what joins lamellas at their nodes, holds their layers together and braces them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from lamella.base.number_lists import Refusal
from lamella.project.values import Name, Table, number


class JointTable(Table):
    """What is bolted: washers, hubs, shear blocks. Without this table strips have slots and nothing else."""

    kind: Literal["interlocked", "stacked"] = Field(
        default="interlocked",
        description='"interlocked": both families are slotted into each other at one level. "stacked": A stands below '
        "the surface and B above it, without slots, bolted through both at the nodes.",
    )
    level_gap: float | None = number(
        "Between the two levels of stacked lamellas, along the normal; 1 mm more than washer_thickness when not given.",
        "m",
        gt=0,
        le=1,
        default=None,
        examples=[0.005],
    )
    slot_width: float | None = number(
        "Width of the slots, here or in [fabrication]; when not given 2 x thickness, and with [erection] at least what "
        "the joints need on the way from flat to designed.",
        "m",
        gt=0,
        le=1,
        default=None,
        examples=[0.003],
    )
    washer: bool = Field(
        default=True,
        description="Star washers above and below each node, keys that fix its angle, a carriage bolt on its axis. "
        "They need an even number of layers.",
    )
    washer_length: float | None = number(
        "Of a star washer from tip to tip; half a layer distance beyond the outer layers on each side when not given.",
        "m",
        gt=0,
        le=5,
        default=None,
        examples=[0.06],
    )
    washer_thickness: float = number("Of star washers and keys.", "m", ge=0.0005, le=0.1, default=0.004)
    bolt: float = number(
        "Thread of the bolt on a node's axis: 0.005, 0.006, 0.008, 0.01, 0.012 or 0.016.",
        "m",
        gt=0,
        le=1,
        default=0.008,
    )
    play: float = number("Least play between a flat part and the strips beside it.", "m", ge=0, le=0.01, default=0.0002)
    block_spacing: float = number(
        "Largest distance of the shear blocks that couple the layers of a lamella; 0: none.",
        "m",
        ge=0,
        le=100,
        default=0.3,
    )
    block_length: float = number("Of a shear block along its lamella.", "m", gt=0, le=1, default=0.03)
    block_bolt: float = number("Thread of the screws through shear blocks and hubs.", "m", gt=0, le=1, default=0.006)
    hub: bool = Field(
        default=True,
        description="Hubs of fins and star plates at singular nodes, which the layers of every ray are bolted to.",
    )
    hub_thickness: float = number("Of the plates of a hub.", "m", ge=0.001, le=0.1, default=0.005)
    splice: bool = Field(
        default=True, description="Splice plates on every layer where a lamella is made of several pieces."
    )
    splice_thickness: float | None = number(
        "Of a splice plate; twice that of a strip when not given.", "m", gt=0, le=0.1, default=None, examples=[0.003]
    )
    material: Name = Field(
        default="1.4301",
        max_length=100,
        description="Of plates, blocks and bolts: a material as for the lamellas.",
    )
    block_material: Name | None = Field(
        default=None,
        max_length=100,
        description="Of shear blocks and packers, where it is another one.",
        examples=["C24"],
    )

    @model_validator(mode="after")
    def _possible(self) -> JointTable:
        if self.kind == "stacked" and self.slot_width is not None:
            raise Refusal(
                f"slot_width = {self.slot_width:g} m: stacked lamellas have no slots",
                'leave slot_width out, or write kind = "interlocked"',
                "slot_width",
            )
        if self.kind != "stacked" and self.level_gap is not None:
            raise Refusal(
                f"level_gap = {self.level_gap:g} m: interlocked lamellas are on one level",
                'leave level_gap out, or write kind = "stacked"',
                "level_gap",
            )
        if self.level_gap is not None and self.level_gap <= self.washer_thickness:
            raise Refusal(
                f"level_gap = {self.level_gap:g} m leaves no room for a plate {self.washer_thickness:g} m thick",
                f"write level_gap = {self.washer_thickness + 0.001:g} or more",
                "level_gap",
            )
        return self


class CablesTable(Table):
    """Cables along the diagonals of the cells, clamped by the joints' bolts. Without this table there are none."""

    every: int = number("Every n-th line of diagonals has a pair of cables.", "", ge=1, le=100, default=2)
    diameter: float = number("Of a cable, a spiral strand.", "m", ge=0.001, le=0.1, default=0.006)
    prestress: float = number("Force in each cable, which it is cut shorter for.", "N", ge=0, le=1e7, default=0.0)
    turnbuckle: float = number("Length of the turnbuckle in each cable; 0: none.", "m", ge=0, le=5, default=0.2)
