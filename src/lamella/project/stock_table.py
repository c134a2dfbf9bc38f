"""The table [[stock]]: sheets, bars and coils that strips and plates are cut from."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, field_validator, model_validator

from lamella.base.number_lists import Refusal, two_numbers
from lamella.project.values import Name, Range, Table, number

MEASURES = {"sheet": ("size",), "bar": ("length",), "coil": ("width", "length")}
"""Keys that each kind has, and no other."""

MOST_SIDE = 1e4
"""m; coils are long."""


class StockTable(Table):
    """Stock to cut from: with it splices are chosen so that it is used up, and plates are laid on sheets too."""

    kind: Literal["sheet", "bar", "coil"] = Field(
        description='"sheet"; "bar" of the strips\' own section, for straight ones; "coil": unrolled as far as it is '
        "needed, cut like a sheet, or like a bar where it is as wide as straight strips are high.",
    )
    size: Range | None = number(
        "Length and width of a sheet.", "m", default=None, examples=[[3.0, 1.5]], validate_default=False
    )
    length: float | None = number("Of a bar or coil.", "m", gt=0, le=MOST_SIDE, default=None, examples=[6.0])
    width: float | None = number("Of a coil.", "m", gt=0, le=100, default=None, examples=[0.1])
    thickness: float | None = number(
        "Of a sheet or coil; there are such of every thickness when not given.",
        "m",
        ge=1e-6,
        le=0.5,
        default=None,
        examples=[0.0015],
    )
    material: Name | None = Field(
        default=None,
        max_length=100,
        description="There are such of every material when not given.",
        examples=["1.4301"],
    )
    price: float | None = number(
        "Of one piece; what costs least is cut. Given for all stock or for none.",
        "",
        gt=0,
        le=1e9,
        default=None,
        examples=[120.0],
    )
    weight: float | None = number(
        "Of one piece, which counts where no price is given; that of its size when not given.",
        "kg",
        gt=0,
        le=1e9,
        default=None,
        examples=[53.3],
    )

    @field_validator("size", mode="before")
    @classmethod
    def _sides(cls, value: Any) -> Any:
        sides = two_numbers(value, "[length, width]", "a sheet")
        for x in sides:
            if not 0 < x <= MOST_SIDE:
                remedy = "lengths are in metres, not millimetres" if x > 0 else "write both sides in metres"
                raise Refusal(
                    f"a side of {x:g} m is out of range: has to be above 0 and at most {MOST_SIDE:g} m", remedy
                )
        return sides

    @model_validator(mode="after")
    def _complete(self) -> StockTable:
        wanted = MEASURES[self.kind]
        for key in ("size", "length", "width"):
            given = getattr(self, key)
            if key in wanted and given is None:
                raise Refusal(f"a {self.kind} has no {key}", f"write {' and '.join(wanted)} of the {self.kind}", key)
            if key not in wanted and given is not None:
                raise Refusal(f"a {self.kind} has no {key}", f"a {self.kind} has {' and '.join(wanted)}", key)
        if self.kind == "bar" and self.thickness is not None:
            raise Refusal("a bar has the thickness of the strips", "leave thickness out", "thickness")
        return self


def check_stock(stock: tuple[StockTable, ...]) -> None:
    """Require prices for all stock or for none."""
    priced = [one.price is not None for one in stock]
    if any(priced) and not all(priced):
        missing = priced.index(False)
        raise Refusal(
            f"{sum(priced)} of {len(stock)} tables of stock have a price: what costs least cannot be told",
            "write a price for each, or for none",
            f"stock[{missing}].price",
        )
