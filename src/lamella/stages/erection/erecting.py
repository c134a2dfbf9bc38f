"""The net of a project, or each of its segments, laid flat and erected."""

from __future__ import annotations

from dataclasses import replace

from lamella.base.arrays import Booleans
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.erection.braced import spring_backs
from lamella.erection.erect import erect
from lamella.erection.erection import Erection
from lamella.network.network_part import network_part
from lamella.segments.segments import Segment, Segments
from lamella.stages.erection.output import ErectedSegment, ErectionOutput
from lamella.stages.fabrication.defaults import cable_rules
from lamella.stages.fabrication.making import edge_beams_of
from lamella.stages.keys import keys
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.stage import Upstream
from lamella.strip.lamellas import Lamellas


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
    found = []
    for number, segment in enumerate(divided.segments):
        progress(Report.step(f"segment {segment.id}", number / len(divided.segments)))
        found.append(_segment(up, segment, divided.of_node == number, progress))
    if not any(one.made for one in found):
        raise InputError(
            f"none of {len(found)} segments can be laid flat: {found[0].id}: {found[0].fault}",
            "choose larger segments, or leave the erection out",
            "segments",
        )
    return ErectionOutput(tuple(found))


def _made(up: Upstream, lamellas: Lamellas, progress: Progress) -> Erection:
    table = up.project.erection
    assert table is not None
    with keys("erection", lamellas="lamella"):
        return erect(lamellas, states=table.states, elements=table.elements, progress=progress)


def _whole(up: Upstream, progress: Progress) -> Erection:
    lamellas, project = up.outputs["lamellas"].lamellas, up.project
    table = project.erection
    assert table is not None
    made = _made(up, lamellas, progress)
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


def _segment(up: Upstream, segment: Segment, inside: Booleans, progress: Progress) -> ErectedSegment:
    """A segment; what cannot be erected is told, and the others go on."""
    network = up.outputs["network"].network
    try:
        part = network_part(network, inside).network
        made = _made(up, strips_of(up.project, up.surface)(part), progress)
    except InputError as error:
        return ErectedSegment(segment.id, segment.mass, None, error.message)
    return ErectedSegment(segment.id, segment.mass, made)
