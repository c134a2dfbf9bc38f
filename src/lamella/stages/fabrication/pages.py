"""Further pages of parts.xlsx: cables, plates, edge beams, stock, segments, and the figures of the whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from lamella.base.drawing_origin import Origin
from lamella.fabrication.cut_length import outline_length
from lamella.fabrication.flat import outline_points
from lamella.hardware.item import Item
from lamella.hardware.plate_sheets import sheet_rows
from lamella.hardware.rules import MM
from lamella.hardware.workbook import Page
from lamella.network.network import Network
from lamella.segments.lists import COLUMNS, JOINTS_HEADER, PARTS_HEADER, joint_rows, part_rows, segment_rows
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.fabrication.stock_figures import stock_records

LENGTHS = ("id", "description", "material", "quantity", "length_mm", "total_length_m", "total_mass_kg")
PLATES = (
    "id",
    "kind",
    "material",
    "thickness_mm",
    "quantity",
    "length_mm",
    "width_mm",
    "area_m2",
    "cut_length_mm",
    "total_mass_kg",
)
PLATE_PLAN = (
    "sheet",
    "material",
    "thickness_mm",
    "length_mm",
    "width_mm",
    "plate",
    "copy",
    "x_mm",
    "y_mm",
    "turned_deg",
)
STOCK = ("stock", "material", "thickness_mm", "pieces", "use", "offcut_mass_kg", "cost")


def pages(out: FabricationOutput, figures: dict[str, Any], network: Network, origin: Origin) -> Iterator[Page]:
    """Pages of what a project has; the figures of the whole always.

    Parameters
    ----------
    out : FabricationOutput
    figures : dict
        Of the summary, by key.
    network : Network
        In the drawing's coordinates.
    origin : (3,)
        Point of the drawing that segments are measured from, m.
    """
    for title, kind in (("cables", "cable"), ("edge beams", "edge_beam")):
        items = out.hardware.of(kind)
        if items:
            yield Page(title, LENGTHS, [_by_length(item) for item in items])
    plates = [item for item in out.hardware if item.plate]
    if plates:
        yield Page("plates", PLATES, [_plate(item) for item in plates])
    if out.plates:
        yield Page("plate plan", PLATE_PLAN, list(_plate_plan(out)))
    if out.supply is not None:
        yield Page("stock", STOCK, [_stock(one) for one in stock_records(out)])
    if out.segments.segments:
        # the network is in the drawing's coordinates, what segments hold is not
        yield Page("segments", [column.name for column in COLUMNS], segment_rows(out.segments, origin))
        yield Page("segment joints", JOINTS_HEADER, joint_rows(out.segments, out.parts, network, origin))
        yield Page("segment parts", PARTS_HEADER, list(part_rows(out.segments, out.parts, out.hardware)))
    yield Page("summary", ("figure", "unit", "value"), list(_summary(out, figures)))


def _by_length(item: Item) -> list[object]:
    total = item.quantity * item.length
    mass = f"{item.quantity * item.mass:.6g}"
    return [
        item.id,
        item.description,
        item.material,
        item.quantity,
        f"{MM * item.length:.4f}",
        f"{total:.4f}",
        mass,
    ]


def _plate(item: Item) -> list[object]:
    points = outline_points(item.cut.outline)
    length, width = (MM * np.ptp(points, axis=0)).tolist()
    cut = sum(outline_length(one) for one in (item.cut.outline, *item.cut.holes))
    return [
        item.id,
        item.kind,
        item.material,
        f"{MM * item.thickness:.4f}",
        item.quantity,
        f"{length:.4f}",
        f"{width:.4f}",
        f"{item.cut.area:.6g}",
        f"{MM * cut:.4f}",
        f"{item.quantity * item.mass:.6g}",
    ]


def _plate_plan(out: FabricationOutput) -> Iterator[Sequence[object]]:
    for number, group, sheet in sheet_rows(out.plates):
        length, width = (MM * group.sizes[sheet]).tolist()
        for piece in np.flatnonzero(group.sheets == sheet).tolist():
            x, y = np.round(MM * group.origins[piece], 4).tolist()
            item = group.items[int(group.kinds[piece])]
            where = [item.id, int(group.copies[piece]), x + 0.0, y + 0.0, 90.0 if group.turned[piece] else 0.0]
            yield [number, group.material, f"{MM * group.thickness:.4f}", round(length, 4), round(width, 4), *where]


def _stock(one: dict[str, Any]) -> list[object]:
    thickness = f"{MM * one['thickness']:.4f}"
    numbers = [f"{one[key]:.6g}" for key in ("use", "offcut_mass", "cost")]
    return [one["stock"], one["material"], thickness, one["pieces"], *numbers]


def _summary(out: FabricationOutput, figures: dict[str, Any]) -> Iterator[Sequence[object]]:
    yield "mass", "kg", f"{figures['mass']:.6g}"
    yield "area of the surface", "m2", f"{out.surface_area:.6g}"
    yield "surface weight", "kg/m2", f"{figures['surface_weight']:.6g}"
    yield "lamella layers to cut", "", figures["parts"]
    yield "different lamella layers", "", figures["parts_different"]
    if out.hardware.items:
        yield "pieces of hardware", "", sum(item.quantity for item in out.hardware)
        yield "different pieces of hardware", "", len(out.hardware.items)
    yield "sheets and bars", "", figures["sheets"]
    for key in ("sheet_use", "bar_use", "plate_use"):
        if figures.get(key) is not None:
            yield key, "", f"{figures[key]:.6g}"
    for one in figures.get("cut_length", ()):
        yield f"cut in {MM * one['thickness']:g} mm, {one['material']}", "m", f"{one['length']:.6g}"
