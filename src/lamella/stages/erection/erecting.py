"""The net of a project, or each of its segments, laid flat and erected."""

from __future__ import annotations

from dataclasses import replace

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.erection.braced import spring_backs
from lamella.erection.erection import Erection
from lamella.segments.segments import Segment, Segments
from lamella.stages.erection.output import ErectedSegment, ErectionOutput
from lamella.stages.fabrication.defaults import cable_rules
from lamella.stages.fabrication.making import edge_beams_of
from lamella.stages.fabrication.slot_widths import erected_net, segment_lamellas
from lamella.stages.keys import keys
from lamella.stages.stage import Upstream


def erected(up: Upstream, progress: Progress) -> ErectionOutput:
    """Segments where there are some, each a net of its own; else the whole net.

    Raises
    ------
    InputError
        Nothing could be laid flat.
    """
    divided: Segments = up.outputs["fabrication"].segments
    if len(divided.segments) < 2:
        return ErectionOutput((ErectedSegment("", 0.0, _whole(up, progress)),))
    table = up.project.erection
    assert table is not None
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


def _whole(up: Upstream, progress: Progress) -> Erection:
    lamellas, project = up.outputs["lamellas"].lamellas, up.project
    table = project.erection
    assert table is not None
    made = erected_net(up, lamellas, progress)
    with keys("erection", prestress="cables.prestress"):
        braced = spring_backs(
            lamellas,
            elements=table.elements,
            cables=cable_rules(project),
            edge_beams=edge_beams_of(up, lamellas),
            materials=project.known_materials(),
            progress=progress,
        )
    return replace(made, braced=braced)


def _segment(up: Upstream, segment: Segment, divided: Segments, number: int, progress: Progress) -> ErectedSegment:
    """A segment; what cannot be erected is told, and the others go on."""
    try:
        made = erected_net(up, segment_lamellas(up, divided, number), progress, segment.id)
    except InputError as error:
        return ErectedSegment(segment.id, segment.mass, None, error.message)
    return ErectedSegment(segment.id, segment.mass, made)
