"""Figures of the stock: what is used of it, what is left over, what is cut."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella.fabrication.cut_length import outline_length
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.figure import ABSENT, INTEGER, NUMBER, TEXT, Figure, list_of, nullable, record

Rows = Iterator[tuple[str, str, str]]

STOCK = record(stock=TEXT, material=TEXT, thickness=NUMBER, pieces=INTEGER, use=NUMBER, offcut_mass=NUMBER, cost=NUMBER)


def _on_bars(out: FabricationOutput) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Of the nesting's sheets: which are bars; of its pieces: which lie on them."""
    bars = np.array([one.kind == "bar" for one in out.nesting.stocks], dtype=bool)
    if not len(bars):
        bars = np.zeros(out.nesting.sheet_count, dtype=bool)
    return bars, bars[out.nesting.sheets]


def sheet_use(out: FabricationOutput) -> float | None:
    """Area of strips over that of the sheets and coils they are cut from."""
    bars, on_bars = _on_bars(out)
    areas = np.array([part.area for part in out.parts.parts])[out.nesting.parts]
    if bars.all() and len(bars):
        return None
    return float(areas[~on_bars].sum() / np.prod(out.nesting.sizes[~bars], axis=1).sum())


def _bar_use(out: FabricationOutput) -> Any:
    if out.supply is None:
        return ABSENT
    bars, on_bars = _on_bars(out)
    if not bars.any():
        return None
    lengths = np.array([part.length for part in out.parts.parts])[out.nesting.parts]
    return float(lengths[on_bars].sum() / out.nesting.sizes[bars, 0].sum())


def _plate_use(out: FabricationOutput) -> Any:
    if out.supply is None:
        return ABSENT
    if not out.plates:
        return None
    return float(sum(one.area for one in out.plates) / sum(np.prod(one.sizes, axis=1).sum() for one in out.plates))


def _stock(out: FabricationOutput) -> Any:
    return ABSENT if out.supply is None else stock_records(out)


def stock_records(out: FabricationOutput) -> list[dict[str, Any]]:
    """What is used of each kind of stock, and left over; nothing where a project has none."""
    if out.supply is None:
        return []
    found = []
    nesting, supply = out.nesting, out.supply
    areas = np.array([part.area for part in out.parts.parts])[nesting.parts]
    for stock in dict.fromkeys(nesting.stocks):
        own = np.array([one == stock for one in nesting.stocks])
        used, whole = float(areas[own[nesting.sheets]].sum()), float(np.prod(nesting.sizes[own], axis=1).sum())
        cost = supply.cost(stock) * float(nesting.sizes[own, 0].sum()) / stock.length
        left = supply.density * supply.thickness * (whole - used)
        found.append(_record(stock.label, supply.material, supply.thickness, int(own.sum()), used / whole, left, cost))
    for one in out.plates:
        whole = float(np.prod(one.sizes, axis=1).sum())
        left = one.items[0].density * one.thickness * (whole - one.area)
        found.append(
            _record(one.stock.label, one.material, one.thickness, len(one.sizes), one.area / whole, left, one.cost)
        )
    return found


def _record(
    label: str, material: str, thickness: float, pieces: int, use: float, offcut: float, cost: float
) -> dict[str, Any]:
    return {
        "stock": label,
        "material": material,
        "thickness": thickness,
        "pieces": pieces,
        "use": use,
        "offcut_mass": offcut,
        "cost": cost,
    }


def _stock_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for one in value:
        label = f"{one['stock'].capitalize()}, {1e3 * one['thickness']:g} mm, {one['material']}"
        yield label, f"{one['pieces']:,}", f"pieces, {one['use']:.1%} used, {one['offcut_mass']:.3g} kg left over"


def _cut_length(out: FabricationOutput) -> Any:
    if out.supply is None:
        return ABSENT
    found: dict[tuple[float, str], float] = {}
    for part in out.parts.parts:
        length = sum(outline_length(one) for one in (part.outline, *part.hole_outlines()))
        key = out.supply.thickness, out.supply.material
        found[key] = found.get(key, 0.0) + part.quantity * length
    for item in out.hardware:
        if item.plate:
            length = sum(outline_length(one) for one in (item.cut.outline, *item.cut.holes))
            key = round(item.thickness, 9), item.material
            found[key] = found.get(key, 0.0) + item.quantity * length
    return [{"thickness": t, "material": name, "length": found[t, name]} for t, name in sorted(found)]


def _cut_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for one in value:
        yield f"Cut in {1e3 * one['thickness']:g} mm, {one['material']}", format(one["length"], ",.0f"), "m"


STOCK_FIGURES: tuple[Figure[FabricationOutput], ...] = (
    Figure(
        "bar_use",
        "",
        "where `[[stock]]` is given: length of the parts over that of the bars they are cut from; null without bars",
        _bar_use,
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "plate_use",
        "",
        "where `[[stock]]` is given: area of the hardware's plates over that of their sheets; null without",
        _plate_use,
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "stock",
        "",
        "where it is given, by kind of stock, material and `thickness` (m): `pieces`, `use` (by area), `offcut_mass` "
        "(kg left over) and `cost` (price, or weight in kg)",
        _stock,
        list_of(STOCK),
        always=False,
        rows=_stock_rows,
    ),
    Figure(
        "cut_length",
        "m",
        "where `[[stock]]` is given, by `thickness` (m) and `material`: `length` of all outlines of parts and plates",
        _cut_length,
        list_of(record(thickness=NUMBER, material=TEXT, length=NUMBER)),
        always=False,
        rows=_cut_rows,
    ),
)
