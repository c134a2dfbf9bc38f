"""Plates of the hardware on sheets: every piece in its place, by material and thickness."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.cutting.nesting import nested
from lamella.cutting.rectangles import Spread
from lamella.fabrication.flat import outline_points
from lamella.fabrication.stock import Stock
from lamella.hardware.item import Hardware, Item
from lamella.hardware.rules import MM

OUTLINE_ARCS = 64
"""Straight parts of an arc where plates are laid by their outlines: of half a circle they are off by 3e-4 radii."""


@dataclass(frozen=True, eq=False)
class PlateSheets:
    """Plates of one material and thickness on one kind of stock.

    Attributes
    ----------
    items : tuple of Item
        The kinds of plates.
    material : str
    thickness : float
        m.
    stock : Stock
    sizes : (s, 2)
        Length and width of each sheet, m; of a coil what is unrolled of it.
    kinds, copies, sheets : (p,) int
        Of every piece: index of its item, its number among equal ones from 1, and its sheet.
    origins : (p, 2)
        Where the origin of the item's frame lies on the sheet, m.
    turned : (p,) bool
        Whether it is turned by 90 degrees.
    cost : float
        Of the sheets.
    """

    items: tuple[Item, ...]
    material: str
    thickness: float
    stock: Stock
    sizes: Floats
    kinds: Integers
    copies: Integers
    sheets: Integers
    origins: Floats
    turned: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    cost: float

    @property
    def area(self) -> float:
        """Of the plates, m2."""
        return sum(item.quantity * item.cut.area for item in self.items)


def plate_sheets(
    hardware: Hardware, stocks: Sequence[Stock], gap: float
) -> tuple[tuple[PlateSheets, ...], tuple[Message, ...]]:
    """All plates on sheets and coils, on the kind of stock that costs least for each material and thickness.

    Parameters
    ----------
    hardware : Hardware
    stocks : sequence of Stock
    gap : float
        Between plates, and to the sheet's edge, m.

    Returns
    -------
    sheets : tuple of PlateSheets
    notes : tuple of Message
        What no stock is there for.

    Raises
    ------
    InputError
        A plate is larger than the stock.
    """
    groups: dict[tuple[str, float], list[Item]] = {}
    for item in hardware:
        if item.plate:
            groups.setdefault((item.material, round(item.thickness, 9)), []).append(item)
    found, without = [], []
    for (material, thickness), items in sorted(groups.items()):
        serving = [one for one in stocks if one.kind != "bar" and one.serves(thickness, material)]
        if serving:
            found.append(_laid(tuple(items), material, thickness, serving, gap))
        else:
            without.append(f"{MM * thickness:g} mm of {material}")
    notes: tuple[Message, ...] = ()
    if without:
        text = f"plates are on no sheet: no stock is there of {', '.join(without)}; plates.dxf has each kind once"
        notes = (Message("plates_without_stock", text),)
    return tuple(found), notes


def _laid(items: tuple[Item, ...], material: str, thickness: float, stocks: list[Stock], gap: float) -> PlateSheets:
    boxes = np.array([_box(item) for item in items])
    outlines = [outline_points(item.cut.outline, OUTLINE_ARCS) for item in items]
    quantities = np.array([item.quantity for item in items])
    kinds = np.repeat(np.arange(len(items)), quantities)
    copies = np.arange(len(kinds)) - np.repeat(np.cumsum(quantities) - quantities, quantities) + 1
    sizes = boxes[:, 1] - boxes[:, 0]
    best: tuple[float, Stock, Spread, Floats] | None = None
    for stock in stocks:
        for one in nested(outlines, quantities, (stock.length, stock.width), gap):
            whole = np.full(len(one.ends), stock.length)
            length = np.minimum(one.ends, stock.length) if stock.kind == "coil" else whole
            cost = float(stock.cost(thickness, items[0].density) * np.sum(length) / stock.length)
            if best is None or cost < best[0] * (1 - 1e-9):
                best = cost, stock, one, np.column_stack([length, np.full(len(length), stock.width)])
    if best is None:
        largest = items[int(np.argmax(sizes.max(axis=1)))]
        length, width = np.sort(sizes[items.index(largest)])[::-1] + 2 * gap
        raise InputError(
            f"{largest.id} takes {length:.4g} x {width:.4g} m with gaps, more than any of the stock "
            f"({', '.join(stock.label for stock in stocks)})",
            f"add a sheet of {length:.4g} x {width:.4g} m or more",
            "stock",
        )
    cost, stock, one, sheet_sizes = best
    # turned by 90 degrees (x, y) comes to lie at (-y, x): the box's upper edge at the left
    low = np.where(one.turned[:, None], np.column_stack([-boxes[kinds, 1, 1], boxes[kinds, 0, 0]]), boxes[kinds, 0])
    return PlateSheets(
        items,
        material,
        thickness,
        stock,
        sheet_sizes,
        kinds,
        copies,
        one.sheets,
        one.corners - low,
        one.turned,
        cost,
    )


def _box(item: Item) -> Floats:
    """Least and greatest x and y of a plate, (2, 2), m."""
    points = outline_points(item.cut.outline)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def sheet_rows(groups: Sequence[PlateSheets]) -> Iterator[tuple[int, PlateSheets, int]]:
    """All sheets: a number from 1, whose they are, and which of them."""
    number = 0
    for group in groups:
        for sheet in range(len(group.sizes)):
            number += 1
            yield number, group, sheet
