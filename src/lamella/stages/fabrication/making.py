"""Parts, what joins them, and where all of it is cut from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.arrays import Integers
from lamella.fabrication.contours import check_contours
from lamella.fabrication.part import Parts
from lamella.fabrication.parts import make_parts
from lamella.fabrication.sheet import nest
from lamella.fabrication.stock_nesting import nest_on_stock
from lamella.hardware.item import Hardware
from lamella.hardware.plate_sheets import plate_sheets
from lamella.stages.fabrication.defaults import (
    cable_rules,
    cut_options,
    edge_beam_rules,
    joint_rules,
    part_measures,
    splice_room,
    stocks_of,
    supply_of,
)
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.keys import keys
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.network.stage import other_cells
from lamella.stages.stage import Upstream
from lamella.strip.lamellas import Lamellas

if TYPE_CHECKING:
    from lamella.hardware.axis_ends import EdgeBeamAxes


def made_parts(up: Upstream, borders: Sequence[Integers] | None = None) -> tuple[Parts, Hardware]:
    """Parts and hardware of a project, lamellas cut in some cells too (see `lamella.fabrication.splits.split`)."""
    project, cut = up.project, up.project.fabrication
    net, strips = up.outputs["network"], strips_of(project, up.surface)
    lamellas = up.outputs["lamellas"].lamellas
    others = other_cells(net, up)
    beams = edge_beams_of(up, lamellas)
    with keys("fabrication", height="lamella.height", stock="stock"):
        parts = make_parts(
            net.network,
            lamellas,
            density=project.material().density,
            others=lambda fault: others.without(lambda net: fault(net, strips(net))),
            supply=supply_of(project, up.surface),
            borders=borders,
            splice_room=splice_room(project),
            trims=None if beams is None else beams.trims,
            **part_measures(cut),
        )
    if project.joint is None:
        return parts, Hardware()
    from lamella.hardware.make_hardware import make_hardware

    measures = joint_rules(project, project.joint), cable_rules(project)
    with keys(
        "joint", prestress="cables.prestress", turnbuckle="cables.turnbuckle", end_plate_leg="edge_beam.end_plate_leg"
    ):
        joined = make_hardware(lamellas, parts, *measures, beams)
    return joined.parts, joined.hardware


def edge_beams_of(up: Upstream, lamellas: Lamellas) -> EdgeBeamAxes | None:
    """Axes of the edge beams, where there are some."""
    project = up.project
    rules = edge_beam_rules(project, up.surface)
    if not rules or project.joint is None:
        return None
    from lamella.hardware.beam_axes import edge_beam_axes
    from lamella.hardware.make_hardware import half_joint_of

    joints = joint_rules(project, project.joint)
    with keys("edge_beam"):
        return edge_beam_axes(lamellas, rules, joints, half_joint_of(lamellas, joints))


def made(up: Upstream) -> FabricationOutput:
    """All parts of a project, in segments where it asks for them."""
    out = _made(up)
    options = cut_options(up.project)
    with keys("fabrication"):
        for part in out.parts.parts:
            check_contours(part.outline, part.hole_outlines(), options, tag=part.id)
        for item in out.hardware:
            if item.plate:
                check_contours(item.cut.outline, item.cut.holes, options, tag=item.id)
    return out


def _made(up: Upstream) -> FabricationOutput:
    table = up.project.segments
    if table is None:
        return laid(up, *made_parts(up))
    from lamella.segments.make_segments import make_segments
    from lamella.segments.partition import Limits

    limits = Limits(table.mass or np.inf, table.size or np.inf)
    lamellas = up.outputs["lamellas"].lamellas
    with keys("segments"):
        divided = make_segments(lamellas, limits, lambda borders: made_parts(up, borders), splice_room(up.project))
    return replace(laid(up, divided.parts, divided.hardware), segments=divided.segments)


def laid(up: Upstream, parts: Parts, hardware: Hardware) -> FabricationOutput:
    """Parts, and plates where there is stock, on what they are cut from."""
    project, area = up.project, up.figures["surface"]["area"]
    cut = project.fabrication
    with keys("fabrication", stock="stock"):
        supply = supply_of(project, up.surface)
        if supply is None:
            return FabricationOutput(parts, nest(parts, sheet=cut.sheet, gap=cut.gap), area, hardware)
        plates, notes = plate_sheets(hardware, stocks_of(project), cut.gap)
        return FabricationOutput(parts, nest_on_stock(parts, supply), area, hardware, supply, plates, notes)
