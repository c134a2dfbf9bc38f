"""Sheets of the segments, each seen along its mean normal: nodes, strips, mass, centre of gravity, lifting points."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.assembly import wrapped
from lamella.drawings.built import Built
from lamella.drawings.overview import VIEW_BORDER
from lamella.drawings.page import HEAD_EM, NOTE_EM, TEXT_EM, Page, text_width
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.placing import Places
from lamella.drawings.terms import Terms
from lamella.drawings.view import View
from lamella.fabrication.part import Part
from lamella.segments.segments import Segment

LISTS = 120.0
"""mm: width of the lists beside a plan."""
UPRIGHT = 1e-6
"""Sine of an angle below which a direction counts as upright."""
MARK = 1.6
"""mm: half the size of the marks of lifting points and centres of gravity."""


def segment_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """A sheet for each segment; none where the structure is not divided."""
    if built.segments is None:
        return
    for segment in built.segments.segments:
        yield _page(built, paper, words, segment)


def part_line(built: Built, part: Part) -> Floats:
    """Points of the centre line beside a part, (k, 3), m."""
    network = built.network
    stops = slice(int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1]))
    span = slice(int(network.sample_offsets[part.lamella]), int(network.sample_offsets[part.lamella + 1]))
    along, points = network.sample_arclengths[span], network.sample_points[span]
    # marks may be lengthened: stations are not arc lengths
    ends = np.interp([part.start, part.end], built.lamellas.stop_stations[stops], network.stop_arclengths[stops])
    inside = (along > ends[0]) & (along < ends[1])
    places = np.concatenate([ends[:1], along[inside], ends[1:]])
    return np.column_stack([np.interp(places, along, points[:, k]) for k in range(3)])


def facing(normals: Floats) -> Floats:
    """Axes of a view against the mean of normals, (2, 3): the first one level, the second upwards where possible."""
    towards = normals.sum(axis=0)
    length = float(np.linalg.norm(towards))
    if length < len(normals) * UPRIGHT:
        return np.eye(3)[:2]
    towards = towards / length
    level = np.array([-towards[1], towards[0], 0.0])
    if np.hypot(*level[:2]) < UPRIGHT:
        level = np.array([1.0, 0.0, 0.0]) - towards[0] * towards
    level /= np.linalg.norm(level)
    return np.stack([level, np.cross(towards, level)])


def _page(built: Built, paper: Paper, words: Terms, segment: Segment) -> Page:
    left, low, right, high = paper.room
    network, parts = built.network, built.parts.parts
    own = [parts[k] for k in segment.parts.tolist()]
    axes = facing(network.node_normals[segment.nodes])
    lines = [part_line(built, part) @ axes.T for part in own]
    nodes = network.node_points[segment.nodes] @ axes.T
    clouds = np.concatenate([*lines, nodes])
    least, most = clouds.min(axis=0), clouds.max(axis=0)
    width = right - left - LISTS - 6
    room = width - 2 * VIEW_BORDER, high - low - 2 * VIEW_BORDER - HEAD_EM
    scale = standard_scale((float(most[0] - least[0]), float(most[1] - least[1])), room)
    view = View.flat((least + most) / 2, (left + width / 2, (low + high - HEAD_EM) / 2), scale)
    page = Page(words("segment", id=segment.id), scale_text(scale))
    page.label(f"{words('top_view')}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    for part, line in zip(own, lines, strict=True):
        page.line(view.place(line), "medium" if part.family == "A" else "thin")
    corners = np.array([least, [most[0], least[1]], most])
    view.dimension(page, words, corners[[0, 1]], -VIEW_BORDER * 0.75)
    view.dimension(page, words, corners[[1, 2]], -VIEW_BORDER * 0.75)
    places = Places((left, low + VIEW_BORDER, left + width - VIEW_BORDER, high - 2 * HEAD_EM))
    lifted = network.node_points[segment.lifting] @ axes.T
    _marks(page, view, lifted, segment.centre @ axes.T, places)
    _names(page, view, own, lines, places)
    _numbers(page, view, segment, nodes, places)
    _lists(page, built, words, segment, (right - LISTS, low, high))
    return page


def _marks(page: Page, view: View, lifted: Floats, centre: Floats, places: Places) -> None:
    """Triangles at the lifting points, a crossed square at the centre of gravity."""
    for point in view.place(lifted):
        page.line(point + MARK * np.array([[-1, -1], [1, -1], [0, 1]]), "thick", closed=True)
        places.take(*(point - MARK).tolist(), *(point + MARK).tolist())
    x, y = view.place(centre).tolist()
    page.rectangle(x - MARK, y - MARK, x + MARK, y + MARK, "medium")
    page.line([(x - MARK, y - MARK), (x + MARK, y + MARK)], "medium")
    page.line([(x - MARK, y + MARK), (x + MARK, y - MARK)], "medium")
    places.take(x - MARK, y - MARK, x + MARK, y + MARK)


def _names(page: Page, view: View, own: list[Part], lines: list[Floats], places: Places) -> None:
    """The id of every part at its middle, once for layers beside each other, as far as there is room."""
    told: set[tuple[int, float]] = set()
    for part, line in zip(own, lines, strict=True):
        key = part.lamella, round(part.start, 1)
        if key in told:
            continue
        told.add(key)
        text = part.id
        width = text_width(text, NOTE_EM, True) + 0.8
        found = places.beside(view.place(line[len(line) // 2]), width, NOTE_EM + 0.4, 1.0)
        if found is not None:
            x, y = found
            page.blank(x, y, x + width, y + NOTE_EM + 0.4)
            page.label(text, x + 0.4, y + 0.75, NOTE_EM, bold=True)


def _numbers(page: Page, view: View, segment: Segment, nodes: Floats, places: Places) -> None:
    """Numbers of the nodes, as far as there is room; all are in the list of the strips' tables."""
    for index, point in zip(segment.nodes.tolist(), view.place(nodes), strict=True):
        found = places.beside(point, text_width(str(index), NOTE_EM), 0.8 * NOTE_EM, 0.7)
        if found is not None:
            x, y = found
            page.blank(x, y, x + text_width(str(index), NOTE_EM), y + 0.8 * NOTE_EM)
            page.label(str(index), x, y + 0.1, NOTE_EM)


def _lists(page: Page, built: Built, words: Terms, segment: Segment, room: tuple[float, float, float]) -> None:
    """Mass, centre, lifting points with their shares, strips, joints with other segments."""
    assert built.segments is not None
    left, low, y = room
    parts = built.parts.parts
    centre = ", ".join(words.number(float(value), 3) for value in segment.centre)
    lifts = [
        f"{words('node')} {node}: {words.number(share * segment.mass, 1)} kg"
        for node, share in zip(segment.lifting.tolist(), segment.shares.tolist(), strict=True)
    ]
    number = built.segments.segments.index(segment)
    joints = [
        f"{parts[one.parts[0]].label} - {parts[one.parts[1]].label} "
        f"({built.segments.segments[sum(one.segments) - number].id})"
        for one in built.segments.joints
        if number in one.segments
    ]
    blocks = (
        (words("mass", value=words.number(segment.mass, 1)), ""),
        (words("gravity"), f"{centre} m"),
        (words("lifting"), "; ".join(lifts) or "-"),
        (words("strips_of"), ", ".join(parts[k].label for k in segment.parts.tolist())),
        (words("segment_joints"), "; ".join(joints) or "-"),
    )
    for heading, text in blocks:
        page.label(heading, left, y - TEXT_EM, TEXT_EM, bold=True)
        y -= 1.6 * TEXT_EM
        for line in wrapped(text, LISTS, NOTE_EM):
            if y - NOTE_EM < low:
                # the lists of segments have all of it
                return
            page.label(line, left, y - NOTE_EM, NOTE_EM)
            y -= 1.5 * NOTE_EM
        y -= TEXT_EM
