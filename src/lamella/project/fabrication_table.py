"""The table [fabrication]: how strips are cut."""

from __future__ import annotations

from typing import Any

from pydantic import field_validator, model_validator

from lamella.base.number_lists import Refusal, two_numbers
from lamella.project.values import Range, Table, number


class FabricationTable(Table):
    """Cutting the strips."""

    sheet: Range = number("Length and width of a sheet.", "m", default=(12.0, 2.0))
    gap: float = number("Distance between parts on a sheet, and to its edge.", "m", gt=0, le=1, default=0.01)
    end_distance: float | None = number(
        "Least distance from the last slot to the strip's end; the larger of 0.05 m and two slot widths when not "
        "given.",
        "m",
        gt=0,
        le=5,
        default=None,
        examples=[0.05],
    )
    rim_overhang: float = number(
        "Least distance from the rim's node to the strip's end.", "m", ge=0, le=5, default=0.01
    )
    hub_radius: float | None = number(
        "A strip stops this far from a singular node; when not given 0.02 m, or more where the strips of "
        "neighbouring rays would run into each other.",
        "m",
        ge=0,
        le=5,
        default=None,
        examples=[0.05],
    )
    slot_width: float | None = number(
        "Width of the slots; when not given 2 x thickness, and with [erection] at least what the joints need on the "
        "way from flat to designed.",
        "m",
        gt=0,
        le=1,
        default=None,
        examples=[0.003],
    )
    slot_play: float = number(
        "How far the foot of a slot lies beyond the centre line: play for what cuts and strips are off.",
        "m",
        ge=0,
        le=1,
        default=0.0,
    )
    foot_radius: float = number(
        "Of the rounded corners of a slot's foot, where cracks begin; at most half of what the slot is wider than the "
        "strip.",
        "m",
        ge=0,
        le=1,
        default=0.0,
    )

    transport_length: float | None = number(
        "Longest piece that is carried; longer strips are split.", "m", gt=0, le=1e4, default=None, examples=[6.0]
    )
    splice_worth: float | None = number(
        "With [[stock]]: what a splice is worth, in length of strip; pieces are made shorter than they have to be "
        "where that saves more. 0.25 when not given.",
        "m",
        ge=0,
        le=1e4,
        default=None,
        examples=[0.25],
    )

    kerf: float | None = number(
        "Width of the cut: outlines are drawn half of it outside of the parts, holes inside; 0 when not given.",
        "m",
        ge=0,
        le=0.02,
        default=None,
        examples=[0.0002],
    )
    lead_in: float | None = number(
        "Length of a line from waste to each contour, on layer LEAD; none when not given.",
        "m",
        gt=0,
        le=0.1,
        default=None,
        examples=[0.003],
    )
    tabs: int | None = number(
        "Gaps in each outer contour that hold the part in its sheet; none when not given.",
        "",
        ge=1,
        le=100,
        default=None,
        examples=[4],
    )
    tab_width: float | None = number(
        "Of these gaps; 0.0005 when not given.", "m", gt=0, le=0.1, default=None, examples=[0.0005]
    )

    @field_validator("sheet", mode="before")
    @classmethod
    def _positive(cls, value: Any) -> Any:
        sides = two_numbers(value, "[length, width]", "a sheet")
        for x in sides:
            if not 0 < x <= 1000:
                remedy = "lengths are in metres, not millimetres" if x > 0 else "write both sides in metres"
                raise Refusal(f"a side of {x:g} m is out of range: has to be above 0 and at most 1000 m", remedy)
        return sides

    @model_validator(mode="after")
    def _possible(self) -> FabricationTable:
        if min(self.sheet) <= 2 * self.gap:
            raise Refusal(
                f"the sheet is {min(self.sheet):g} m wide, nothing of it is left between gaps of {self.gap:g} m at "
                "either edge",
                "choose a larger sheet or a smaller gap",
                "sheet",
            )
        if self.kerf is not None and self.kerf >= self.gap:
            raise Refusal(
                f"kerf = {self.kerf:g} m leaves nothing of gaps of {self.gap:g} m",
                f"write a kerf below gap = {self.gap:g}",
                "kerf",
            )
        # both contours lie half a kerf in the gap
        if self.lead_in is not None and self.lead_in + (self.kerf or 0.0) >= self.gap:
            raise Refusal(
                f"lead_in = {self.lead_in:g} m would reach the next part, {self.gap:g} m away",
                f"write a lead_in below gap = {self.gap:g} less the kerf, or a larger gap",
                "lead_in",
            )
        return self
