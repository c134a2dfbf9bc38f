"""The net of a project, or each of its segments, laid flat and erected."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.erection.braced import spring_backs
from lamella.erection.bracings import Bracings
from lamella.erection.cut import Cut, proposed_cut
from lamella.erection.erection import Erection
from lamella.erection.lift_cases import LiftCase, LiftRules, lift_cases
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.network.network_part import network_part
from lamella.segments.segments import Segment, Segments
from lamella.stages.driving_devices import nodes_near
from lamella.stages.erection.output import ErectedSegment, ErectionOutput
from lamella.stages.fabrication.defaults import cable_rules
from lamella.stages.fabrication.making import edge_beams_of
from lamella.stages.fabrication.slot_widths import erected_net, segment_lamellas
from lamella.stages.keys import keys
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.stage import Upstream
from lamella.strip.lamellas import Lamellas
from lamella.structure.actions.hardware_masses import hardware_masses


def erected(up: Upstream, progress: Progress) -> ErectionOutput:
    """Segments where there are some, each a net of its own; else the whole net.

    Raises
    ------
    InputError
        Nothing could be laid flat.
    """
    divided: Segments = up.outputs["fabrication"].segments
    if len(divided.segments) < 2:
        return ErectionOutput((_whole(up, progress),))
    table = up.project.erection
    assert table is not None
    if table.lifting is not None and table.lifting.at is not None:
        raise InputError(
            f"the net is divided into {len(divided.segments)} segments, which are not lifted at the same points",
            "write points = [2, 3, 4] for nodes of each segment's own",
            "erection.lifting.at",
        )
    if table.driver.kind or table.on_ground:
        raise InputError(
            f"the net is divided into {len(divided.segments)} segments, each of which is driven by its joints' angles",
            "leave [segments] out to drive the whole net, or the driver, gravity and props",
            "erection.driver",
        )
    found = []
    for number, segment in enumerate(divided.segments):
        progress(Report.step(f"segment {segment.id}", number / len(divided.segments)))
        found.append(_segment(up, segment, divided, number, progress))
    if not any(one.made for one in found):
        raise InputError(
            f"none of {len(found)} segments can be laid flat: {found[0].id}: {found[0].fault}",
            "choose larger segments, or leave the erection out",
            "segments",
        )
    return ErectionOutput(tuple(found))


def _whole(up: Upstream, progress: Progress) -> ErectedSegment:
    lamellas = up.outputs["lamellas"].lamellas
    bracings = _bracings(up, edge_beams_of(up, lamellas))
    made = _braced(up, erected_net(up, lamellas, progress), bracings, progress)
    lifts = _lifts(up, lamellas, bracings, _masses(up), progress)
    return ErectedSegment("", 0.0, made, lifts=lifts, cut=_cut(up, made, progress))


def _cut(up: Upstream, made: Erection, progress: Progress) -> Cut | None:
    """Proposed where a flat net overlaps."""
    if not len(made.flat.overlaps) or not made.laid:
        return None
    progress(Report.step("overlaps: where to cut the net"))
    return proposed_cut(made, strips_of(up.project, up.surface))


def _bracings(up: Upstream, edge_beams: EdgeBeamAxes | None) -> Bracings:
    project = up.project
    return Bracings(cable_rules(project), edge_beams, project.known_materials())


def _braced(up: Upstream, made: Erection, bracings: Bracings, progress: Progress) -> Erection:
    table = up.project.erection
    assert table is not None
    with keys("erection", prestress="cables.prestress"):
        found = spring_backs(made.model.lamellas, bracings, elements=table.elements, progress=progress)
    return replace(made, braced=found)


def _masses(up: Upstream) -> Floats:
    """Of the hardware at each node of the whole net, kg."""
    network = up.outputs["network"].network
    return hardware_masses(network, up.outputs["fabrication"].hardware, ("cable", "edge_beam"))


def _lifts(
    up: Upstream, lamellas: Lamellas, bracings: Bracings, masses: Floats, progress: Progress
) -> tuple[LiftCase, ...]:
    table = up.project.erection
    assert table is not None
    asked = table.lifting
    if asked is None:
        return ()
    progress(Report.step("lifted under its own weight"))
    nodes = None
    with keys("erection.lifting"):
        if asked.at is not None:
            nodes = np.unique(nodes_near(up, lamellas.network, asked.at, "at"))
            if len(nodes) < 2:
                raise InputError("all these points are nearest to one node", "give points farther apart", "at")
        rules = LiftRules(asked.points, nodes, asked.hook, asked.diameter, asked.limit)
        return lift_cases(lamellas, rules, bracings, elements=table.elements, node_masses=masses, progress=progress)


def _segment(up: Upstream, segment: Segment, divided: Segments, number: int, progress: Progress) -> ErectedSegment:
    """A segment; what cannot be erected is told, and the others go on.

    Edge beams are mounted on the whole net; what braces a segment are its cables.
    """
    bracings = _bracings(up, None)
    try:
        lamellas = segment_lamellas(up, divided, number)
        made = _braced(up, erected_net(up, lamellas, progress, segment.id), bracings, progress)
    except InputError as error:
        return ErectedSegment(segment.id, segment.mass, None, error.message)
    nodes = network_part(up.outputs["network"].network, divided.of_node == number).nodes
    lifts = _lifts(up, lamellas, bracings, _masses(up)[nodes], progress)
    return ErectedSegment(segment.id, segment.mass, made, lifts=lifts, cut=_cut(up, made, progress))
