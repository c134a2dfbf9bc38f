"""What strips and plates are cut from: sheets, bars and coils."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from lamella.base.errors import InputError

Kind = Literal["sheet", "bar", "coil"]

# m: lengths and thicknesses that are meant to be equal
SAME = 1e-9
# m of strip: what a splice is worth unless a project says otherwise
DEFAULT_SPLICE_WORTH = 0.25


@dataclass(frozen=True)
class Stock:
    """One kind of stock.

    Attributes
    ----------
    kind : str
        "sheet"; "bar": of the strips' own section, for straight ones; "coil": unrolled as far as it is needed, cut
        like a sheet, or, where it is as wide as straight strips are high, like a bar.
    length, width : float
        m, the longer side first; the width of a bar is the strips' height.
    thickness : float or None
        m; None: there are such of every thickness.
    material : str or None
        Name; None: of every material.
    price, weight : float or None
        Of one piece, kg the weight; what costs least is cut. The weight that follows from its size where neither is
        given.
    """

    kind: Kind
    length: float
    width: float
    thickness: float | None = None
    material: str | None = None
    price: float | None = None
    weight: float | None = None

    def serves(self, thickness: float, material: str) -> bool:
        """Whether plates or strips of a thickness (m) and material are cut from it."""
        return (self.thickness is None or abs(self.thickness - thickness) < SAME) and (
            self.material is None or self.material == material
        )

    def cost(self, thickness: float, density: float) -> float:
        """Of one piece: price or weight."""
        if self.price is not None:
            return self.price
        return density * thickness * self.length * self.width if self.weight is None else self.weight

    @property
    def label(self) -> str:
        """In words: "bar 6 m", "sheet 3 x 1.5 m"."""
        return f"{self.kind} {self.length:g}" + (" m" if self.kind == "bar" else f" x {self.width:g} m")


@dataclass(frozen=True)
class Supply:
    """The stock that the strips of a structure are cut from, and what decides how.

    Attributes
    ----------
    stocks : tuple of Stock
        Those that serve; a bar's width is the strips' height.
    thickness : float
        Of the strips, m.
    material : str
        Its name.
    density : float
        kg/m3.
    gap : float
        Between pieces, and to the edges of sheets, m; bars and coils as wide as strips are used from end to end.
    splice_worth : float
        What a splice is worth, in m of strip.
    """

    stocks: tuple[Stock, ...]
    thickness: float
    material: str
    density: float
    gap: float
    splice_worth: float = DEFAULT_SPLICE_WORTH

    @classmethod
    def of(
        cls,
        stocks: tuple[Stock, ...],
        *,
        height: float,
        thickness: float,
        material: str,
        density: float,
        gap: float,
        straight: bool,
        splice_worth: float = DEFAULT_SPLICE_WORTH,
    ) -> Supply:
        """Of all stock that which strips of a section and material are cut from.

        Raises
        ------
        InputError
            There is none.
        """
        fitting = tuple(
            Stock(one.kind, one.length, height, thickness, material, one.price, one.weight)
            if one.kind == "bar"
            else one
            for one in stocks
            if one.serves(thickness, material)
            and (
                straight if one.kind == "bar" else one.width > height + 2 * gap - SAME or abs(one.width - height) < SAME
            )
        )
        if not fitting:
            curved = "" if straight else ", and lamellas that are no straight lines are not cut from bars"
            raise InputError(
                f"no stock is there for strips {1e3 * height:g} x {1e3 * thickness:g} mm of {material}: sheets and "
                f"coils have to be {1e3 * (height + 2 * gap):.4g} mm wide or more (strip and gaps){curved}",
                f"add a sheet at least {height + 2 * gap:.4g} m wide with thickness = {thickness:g} or without one",
                "stock",
            )
        return cls(fitting, thickness, material, density, gap, splice_worth)

    def cost(self, stock: Stock) -> float:
        """Of one piece of a stock."""
        return stock.cost(self.thickness, self.density)

    def splice_cost(self, height: float) -> float:
        """Of a splice of strips of a height (m), in the costs of the stock."""
        cheapest = min(self.cost(one) / (one.length * one.width) for one in self.stocks)
        return cheapest * height * self.splice_worth
