"""Measures of fabrication that follow from other values of a project, and what no part can be made with."""

from __future__ import annotations

from typing import Any

import numpy as np

from lamella.base.drawing_origin import drawing_origin
from lamella.base.errors import InputError
from lamella.base.material import find_material
from lamella.base.wording import shown
from lamella.fabrication.contours import CutOptions
from lamella.fabrication.defaults import default_end_distance, default_hub_radius, default_slot_width
from lamella.fabrication.rules import Rules, clear_hub
from lamella.fabrication.stock import DEFAULT_SPLICE_WORTH, SAME, Stock, Supply
from lamella.hardware.edge_rules import EdgeBeamRules
from lamella.hardware.rules import CableRules, JointRules
from lamella.project.surface_tables import MOST_LOOPS
from lamella.project.tables import EdgeBeamTable, FabricationTable, JointTable, Project
from lamella.stages.keys import keys
from lamella.stages.section_of_table import section_of
from lamella.surface.surface import Surface


def fill_in(project: Project, surface: Surface[Any]) -> Project:
    """The project with those defaults filled in that follow from its other values."""
    cut, strip, joint = project.fabrication, project.lamella, project.joint
    slot_width = cut.slot_width if joint is None or joint.slot_width is None else joint.slot_width
    hub_radius = cut.hub_radius
    # how far apart layers on lamella curves are next to a singular node, the net decides
    if hub_radius is None and (strip.layers == 1 or strip.layer_curves != "lamella"):
        rays = max((2 * (order + 2) for order in surface.singular_orders()), default=0)
        hub_radius = default_hub_radius(clear_hub(rays, strip.layers, strip.offset, strip.thickness))
        if joint is not None and joint.hub and rays:
            hub_radius = max(hub_radius, joint_rules(project, joint).least_hub_radius(2 * np.pi / rays))
    filled = cut.model_copy(update={"slot_width": slot_width, "hub_radius": hub_radius})
    update: dict[str, Any] = {"fabrication": filled}
    if joint is not None:
        update["joint"] = joint.model_copy(update={"slot_width": None})
    if project.panels is not None:
        update["panels"] = project.panels.filled(strip.height)
    if any(drawing_origin(surface)):
        update["surface"] = project.surface.model_copy(update={"origin": drawing_origin(surface)})
    made = project.model_copy(update=update)
    return made if slots_by_erection(made) else filled_measures(made, surface, default_slot_width(strip.thickness))


def slots_by_erection(project: Project) -> bool:
    """Whether nothing but the way of its joints says how wide a project's slots are."""
    given = project.fabrication.slot_width or (project.joint and project.joint.slot_width)
    return project.erection is not None and not given and not section_of(project).level


def usual_slot_width(project: Project) -> float:
    """Width of its slots that nothing but the project itself decides, m."""
    return project.fabrication.slot_width or default_slot_width(project.lamella.thickness)


def filled_measures(project: Project, surface: Surface[Any], slot_width: float) -> Project:
    """The project with its slots' width, m, where it has none, and what follows from it."""
    cut = project.fabrication
    width = slot_width if cut.slot_width is None else cut.slot_width
    end_distance = cut.end_distance
    if end_distance is None:
        end_distance = default_end_distance(width, _normal_curvature(project, surface), project.lamella.height)
    filled = cut.model_copy(update={"slot_width": width, "end_distance": float(end_distance)})
    return project.model_copy(update={"fabrication": filled})


def joint_rules(project: Project, joint: JointTable) -> JointRules:
    """The measures of the hardware."""
    material = find_material(joint.material, project.known_materials())
    measures = joint.model_dump(exclude={"kind", "slot_width", "level_gap"})
    try:
        blocks = find_material(joint.block_material or joint.material, project.known_materials())
    except InputError as error:
        raise InputError(error.message, error.remedy, "block_material") from None
    return JointRules(density=material.density, block_density=blocks.density, **measures)


def cable_rules(project: Project) -> CableRules | None:
    """The measures of the cables, where there are some."""
    return None if project.cables is None else CableRules(**project.cables.model_dump())


def stocks_of(project: Project) -> tuple[Stock, ...]:
    """The stock a project has; bars get their width with the strips."""
    found = []
    for table in project.stock or ():
        length, width = table.size or (table.length or 0.0, table.width or 0.0)
        sides = (max(length, width), min(length, width)) if table.kind == "sheet" else (length, width)
        found.append(Stock(table.kind, *sides, table.thickness, table.material, table.price, table.weight))
    return tuple(found)


def supply_of(project: Project, surface: Surface[Any]) -> Supply | None:
    """What a project's strips are cut from; None where it has no stock."""
    strip, cut = project.lamella, project.fabrication
    if not project.stock:
        return None
    worth = DEFAULT_SPLICE_WORTH if cut.splice_worth is None else cut.splice_worth
    return Supply.of(
        stocks_of(project),
        height=strip.height,
        thickness=strip.thickness,
        material=strip.material,
        density=project.material().density,
        gap=cut.gap,
        straight=not _normal_curvature(project, surface),
        splice_worth=worth,
    )


def cut_options(project: Project) -> CutOptions:
    """How contours are cut."""
    cut = project.fabrication
    given = {key: getattr(cut, key) for key in ("kerf", "lead_in", "tabs", "tab_width")}
    return CutOptions(**{key: value for key, value in given.items() if value is not None})


def splice_room(project: Project) -> float:
    """Half a splice and a slot's width, which a splice keeps from a slot, m; 0 where there are no splices."""
    if project.joint is None or not project.joint.splice:
        return 0.0
    from lamella.hardware.splices import splice_length

    slot_width = usual_slot_width(project)
    return splice_length(joint_rules(project, project.joint)) / 2 + slot_width + SAME


def edge_beam_rules(project: Project, surface: Surface[Any]) -> dict[int, EdgeBeamRules]:
    """The measures of the edge beams, by boundary loop; nothing where there are none.

    Raises
    ------
    InputError
        Measures that contradict each other or the strips.
    """
    if project.joint is None:
        return {}
    section, joints = section_of(project), joint_rules(project, project.joint)
    origin = drawing_origin(surface)
    tables = [table.edge_beam for table in getattr(project.surface, "boundary", ())]
    loops = max(len(tables), MOST_LOOPS)
    found = {}
    for loop in range(loops):
        own = tables[loop] if loop < len(tables) else None
        table = project.edge_beam if own is None else own
        if table:
            key = "edge_beam" if own is None else f"surface.boundary[{loop}].edge_beam"
            with keys(key):
                found[loop] = _edge_beam_rules(project, table, origin[2])
                found[loop].check(section, joints)
    return found


def _edge_beam_rules(project: Project, table: EdgeBeamTable, origin_height: float) -> EdgeBeamRules:
    measures = table.model_dump()
    if table.ground is not None:
        measures["ground"] = table.ground - origin_height
    return EdgeBeamRules(density=find_material(table.material, project.known_materials()).density, **measures)


@keys("joint")
def check_joint(project: Project) -> None:
    """Refuse hardware that cannot be made with the project's strips.

    Raises
    ------
    InputError
    """
    if project.joint is not None:
        joint_rules(project, project.joint).check(section_of(project))


def check_drawings(project: Project) -> None:
    """Refuse a language that there are no words in, and files whose library is not there.

    Raises
    ------
    InputError
    """
    if project.files.ifc:
        from lamella.files.write.ifc import require_ifcopenshell

        with keys("files"):
            require_ifcopenshell()
    if project.drawings is None:
        return
    from lamella.drawings.terms import languages

    if project.drawings.language not in languages():
        raise InputError(
            f"there are no drawings in the language {shown(project.drawings.language)}",
            f"choose one of {', '.join(languages())}",
            "drawings.language",
        )


@keys("fabrication", height="lamella.height", stock="stock")
def check_fabrication(project: Project, surface: Surface[Any]) -> None:
    """Refuse measures that no part can be made with, by the key in the project.

    Raises
    ------
    InputError
    """
    filled = filled_measures(fill_in(project, surface), surface, default_slot_width(project.lamella.thickness))
    strip, cut = filled.lamella, filled.fabrication
    supply_of(project, surface)
    rules = Rules(
        layers=strip.layers,
        offset=strip.offset,
        height=strip.height,
        thickness=strip.thickness,
        curvature=float(_normal_curvature(filled, surface)),
        density=filled.material().density,
        **part_measures(cut.model_copy(update={"hub_radius": cut.hub_radius or 0.0})),
    )
    rules.check()


def part_measures(cut: FabricationTable) -> dict[str, Any]:
    """The measures of a table that decide parts."""
    measures = cut.model_dump(exclude={"splice_worth", "kerf", "lead_in", "tabs", "tab_width"})
    return measures | {"transport_length": cut.transport_length or np.inf}


def _normal_curvature(project: Project, surface: Surface[Any]) -> float:
    """Of the lamellas, 1/m."""
    given = project.network.normal_curvature
    return surface.mean_curvature if given is None else given
