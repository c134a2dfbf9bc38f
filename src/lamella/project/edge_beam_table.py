"""The table [edge_beam]: the beam along the boundary that lamellas end at."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from lamella.base.number_lists import Refusal
from lamella.project.values import Name, Table, number

_Pair = Annotated[tuple[float, float], Field(strict=False)]


class EdgeBeamTable(Table):
    """A beam along every boundary loop, with an end plate for each lamella. Without this table there is none.

    A boundary may have one of its own, or none: `edge_beam = {...}` or `edge_beam = false` in [[surface.boundary]].
    """

    section: Name | None = Field(
        default=None,
        max_length=100,
        description='Round tube, diameter x wall in mm: "tube 60.3x3.2", which is taken when flat is not given either.',
        examples=["tube 60.3x3.2"],
    )
    flat: _Pair | None = number(
        "A flat bar instead: width along the surface normal, and thickness.",
        "m",
        default=None,
        examples=[[0.1, 0.01]],
    )
    distance: float | None = number(
        "From the rim to the beam's axis, outwards; when not given 0, or where lamellas cross on the rim as much as "
        "their end plates need.",
        "m",
        ge=-1,
        le=5,
        default=None,
        examples=[0.05],
    )
    segment: float = number("Longest piece of the beam.", "m", ge=0.1, le=100, default=6.0)
    end_gap: float = number(
        "Between the end of a lamella's layer and the end plate before it.", "m", ge=0, le=0.1, default=0.003
    )
    end_plate: float = number(
        "Thickness of the end plates: folded, one leg on the beam, one between the layers.",
        "m",
        ge=0.001,
        le=0.1,
        default=0.005,
    )
    end_plate_height: float | None = number(
        "Of an end plate along the surface normal; 0.4 of the strip's height when not given.",
        "m",
        gt=0,
        le=5,
        default=None,
        examples=[0.04],
    )
    end_plate_leg: float = number("Of the leg on the beam.", "m", gt=0, le=1, default=0.04)
    ground: float | None = number(
        "Height z of the ground: base plates stand where the rim lies on it. None when not given.",
        "m",
        ge=-1e6,
        le=1e6,
        default=None,
        examples=[0.0],
    )
    base_plate: float = number("Side of a base plate.", "m", ge=0.02, le=5, default=0.2)
    base_plate_thickness: float = number("Of a base plate.", "m", ge=0.001, le=0.2, default=0.012)
    base_spacing: float = number("Largest distance of base plates along the ground.", "m", ge=0.1, le=100, default=1.0)
    anchor: float = number("Thread of the four anchors of a base plate.", "m", ge=0.004, le=0.1, default=0.012)
    material: Name = Field(
        default="S355", max_length=100, description="Of beam, end plates and base plates: a material as for lamellas."
    )

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: object) -> object:
        if isinstance(values, dict) and "section" not in values and "flat" not in values:
            return values | {"section": "tube 60.3x3.2"}
        return values

    @model_validator(mode="after")
    def _possible(self) -> EdgeBeamTable:
        if self.section is not None and self.flat is not None:
            raise Refusal(
                f'section = "{self.section}" and flat = {list(self.flat)} are both given', "keep one of them", "flat"
            )
        if self.flat is not None and not all(0 < side <= 2 for side in self.flat):
            raise Refusal(
                f"flat = {list(self.flat)}: both sides have to be above 0 and at most 2 m",
                "lengths are in metres, not millimetres",
                "flat",
            )
        return self
