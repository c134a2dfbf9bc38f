"""Slots in which joints turn as far as they do on the way from flat to designed.

The way of a net hangs on its lamellas, not on their slots; where a project divides its net, on the division, which
hangs on the mass of the parts and by that a little on the slots. So parts are made with the usual slots first, each
segment is erected, and parts are made anew with slots as wide as that takes: never narrower than before, which ends.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.base.wording import rounded
from lamella.erection.erect import erect
from lamella.erection.erection import Erection
from lamella.erection.slot_room import slot_width_needed
from lamella.erection.warnings import FOLDED_ANGLE
from lamella.network.network_part import network_part
from lamella.segments.segments import Segments
from lamella.stages.driven_net import driven_net
from lamella.stages.fabrication.defaults import filled_measures, usual_slot_width
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.keys import keys
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.stage import Upstream
from lamella.strip.lamellas import Lamellas, Section

# elements times states that a check takes its seconds for
MOST_CHECKED_STATES = 10_000
# divisions that are tried: wider slots are lighter, which may move a border
MOST_DIVISIONS = 4

Make = Callable[[Upstream], FabricationOutput]


def with_slots(up: Upstream, make: Make, progress: Progress) -> FabricationOutput:
    """Parts of a project in which nothing says how wide slots are: as wide as the erection needs them.

    Parameters
    ----------
    up : Upstream
    make : callable
        Makes parts of a project that has its slots' width.
    progress : callable
    """
    project = up.project
    usual = usual_slot_width(project)
    lamellas: Lamellas = up.outputs["lamellas"].lamellas
    width, divided = usual, project.segments is not None
    if up.checking and way_takes_long(up):
        return replace(make(_filled(up, width)), slot_width=width)
    if not divided:
        width = max(width, _width(lamellas.section, [erected_net(up, lamellas, progress)]))
    out = make(_filled(up, width))
    for _ in range(MOST_DIVISIONS if divided else 0):
        needed = _width(lamellas.section, _erected_segments(up, out.segments, progress))
        if needed <= width:
            break
        width = needed
        out = make(_filled(up, width))
    return replace(out, slot_width=width, by_erection=True)


def way_takes_long(up: Upstream) -> bool:
    """Whether the way of a net takes longer than a check may."""
    table = up.project.erection
    assert table is not None
    work = len(up.outputs["network"].network.cell_edges) * table.elements * table.states
    return work > MOST_CHECKED_STATES


def erected_net(up: Upstream, lamellas: Lamellas, progress: Progress, segment: str = "") -> Erection:
    """A net or a segment of it on its way from flat to designed: found once, for its slots and for its states."""
    table = up.project.erection
    assert table is not None

    def make() -> Erection:
        if not segment:
            return driven_net(up, lamellas, progress)
        with keys("erection", lamellas="lamella"):
            return erect(lamellas, states=table.states, elements=table.elements, progress=progress)

    nodes = hashlib.sha256(lamellas.network.node_points.tobytes()).hexdigest()
    decided = up.keys["lamellas"], up.content(("erection",)), nodes
    return up.remembered(f"erection of {segment or 'the net'}", decided, make)


def segment_lamellas(up: Upstream, segments: Segments, number: int) -> Lamellas:
    """The lamellas of a segment, as a net of its own.

    Raises
    ------
    InputError
        None of its lamellas goes from node to node.
    """
    part = network_part(up.outputs["network"].network, segments.of_node == number)
    return strips_of(up.project, up.surface)(part.network)


def _erected_segments(up: Upstream, segments: Segments, progress: Progress) -> Iterator[Erection]:
    if len(segments.segments) < 2:
        yield erected_net(up, up.outputs["lamellas"].lamellas, progress)
        return
    for number, segment in enumerate(segments.segments):
        progress(Report.step(f"slots of segment {segment.id}", number / len(segments.segments)))
        try:
            yield erected_net(up, segment_lamellas(up, segments, number), progress, segment.id)
        except InputError:
            # the stage "erection" says so
            continue


def _width(section: Section, made: Iterator[Erection] | list[Erection]) -> float:
    """Of slots that all of them can turn in, m: as far as half the strip between the slots of two layers is left."""
    needed = max((_needed(one) for one in made), default=0.0)
    most = section.height / 4
    if section.layers > 1:
        most = min(most, section.offset / 2)
    return min(rounded(needed, up=True, digits=2), rounded(most, up=False, digits=2)) if needed else 0.0


def _needed(made: Erection) -> float:
    """Of slots that all joints can turn in that do not fold up, m: what folds is held on the floor instead."""
    turned = np.concatenate(made.turned)
    kept = turned[turned <= 90 - FOLDED_ANGLE]
    return float(slot_width_needed(np.radians(kept.max(initial=0.0)), made.model.lamellas.section.thickness))


def _filled(up: Upstream, width: float) -> Upstream:
    return replace(up, project=filled_measures(up.project, up.surface, width))
