"""Sheets of the strips: each different one once, drawn flat, with the stations of its slots and holes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from lamella.base.message import Message
from lamella.drawings.built import Built
from lamella.drawings.page import HEAD_EM, NOTE_EM, Page, shortened, text_width
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.placing import spread
from lamella.drawings.terms import Terms
from lamella.drawings.view import View
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.schedule import congruent_parts

STRIP_ARCS = 32
"""Straight parts of an arc."""
FIRST, COLUMN, BAND_ROW = 24.0, 11.5, 3.5
"""mm: the table's first column, its others, its rows."""
BAND_ROWS = 5
"""Of the table: number, node, station, height over the axis, width."""
ABOVE, BELOW, AFTER = 5.0, 10.0, 5.0
"""mm: over a strip for the numbers of its slots, below it for its length, between strips."""
CHORD_OFF = 5e-5
"""m: what a length may differ from its chord, of which it is the dimension then."""
STRIP_LIMIT = 1_000
"""Different strips that are drawn at most: some 300 sheets, 12 MB, and 20 s."""


@dataclass(frozen=True)
class Feature:
    """A slot, hole or mark of a node: what its column in the table says."""

    station: float
    number: str
    cells: tuple[str, ...]


def different_strips(parts: Parts) -> dict[int, list[int]]:
    """Parts that are cut alike by the first of them; indices."""
    found: dict[int, list[int]] = {}
    for index, same in enumerate(congruent_parts(parts)):
        found.setdefault(same, []).append(index)
    return found


def strips_not_drawn(parts: Parts) -> Iterator[Message]:
    """The warning where there are more different strips than are drawn."""
    if len(parts.parts) <= STRIP_LIMIT:
        return
    first = list(different_strips(parts))
    if len(first) > STRIP_LIMIT:
        last = parts.parts[first[STRIP_LIMIT - 1]].id
        yield Message(
            "strips_not_drawn",
            f"drawings.pdf has sheets of the first {STRIP_LIMIT:,} of {len(first):,} different strips, up to {last}: "
            "A.dxf, B.dxf and schedule.csv have all of them",
        )


def strip_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """Strips below each other in one scale, in which the longest fits the sheet."""
    groups = dict(islice(different_strips(built.parts).items(), STRIP_LIMIT))
    parts = built.parts.parts
    left, low, right, high = paper.room
    bounds = np.array([parts[index].bounds for index in groups])
    size = float((bounds[:, 2] - bounds[:, 0]).max(initial=0.0)), float((bounds[:, 3] - bounds[:, 1]).max(initial=0.0))
    scale = standard_scale(size, (right - left, 0.5 * (high - low)))
    across = max(int((right - left - FIRST) / COLUMN), 1)
    page, y = None, low
    for first, same in groups.items():
        part = parts[first]
        features = _features(built, part, words)
        _, bottom, _, top = part.bounds
        drawn = HEAD_EM + NOTE_EM + 3 + ABOVE + 1e3 * (top - bottom) / scale + BELOW
        bands = -(-len(features) // across)
        if page is None or y - drawn - max(bands, 1) * (BAND_ROWS * BAND_ROW + 1.5) < low:
            if page is not None:
                yield page
            page, y = Page(words("strips"), scale_text(scale)), high
        _draw(page, words, part, [parts[k] for k in same], features, (left, y, right), scale)
        y -= drawn
        for band in range(bands):
            if y - BAND_ROWS * BAND_ROW < low:
                yield page
                page, y = Page(words("strips"), scale_text(scale)), high
            _band(page, words, part, features[band * across : (band + 1) * across], left, y)
            y -= BAND_ROWS * BAND_ROW + 1.5
        y -= AFTER
    if page is not None:
        yield page


def _features(built: Built, part: Part, words: Terms) -> list[Feature]:
    """Slots, holes and marks of nodes in the order of their stations."""
    network = built.network
    stops = slice(int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1]))
    row = max(part.layer - 1, 0)
    of_layer = built.lamellas.layers.stop_stations[row] if part.layer else built.lamellas.stop_stations
    nodes, places = network.stop_nodes[stops], of_layer[stops]
    found = []
    for number, slot in enumerate(part.slots.tolist(), 1):
        node = int(nodes[np.argmin(np.round(np.abs(places - slot), 9))])
        name = f"{words('slot_short')}{number}"
        cells = (name, str(node), words.mm(slot - part.start), "", words.mm(part.slot_width))
        found.append(Feature(slot - part.start, name, cells))
    # marks of nodes that no slot is beside: on the rim, and of lamellas that are laid upon each other
    reach = built.lamellas.section.layers * built.lamellas.section.offset
    marks = [s for s in part.nodes.tolist() if part.start <= s <= part.end]
    marks = [s for s in marks if not len(part.slots) or np.abs(part.slots - s).min() > reach]
    for number, station in enumerate(marks, 1):
        node = int(nodes[np.argmin(np.round(np.abs(places - station), 9))])
        name = f"{words('node_short')}{number}"
        found.append(Feature(station - part.start, name, (name, str(node), words.mm(station - part.start), "", "")))
    for number, (station, height, diameter) in enumerate(part.holes.tolist(), 1):
        name = f"{words('hole_short')}{number}"
        cells = (name, "", words.mm(station - part.start), words.mm(height), f"Ø{words.mm(diameter)}")
        found.append(Feature(station - part.start, name, cells))
    return sorted(found, key=lambda one: (round(one.station, 7), one.number[:1], len(one.number), one.number))


def _draw(
    page: Page,
    words: Terms,
    part: Part,
    same: list[Part],
    features: list[Feature],
    room: tuple[float, float, float],
    scale: float,
) -> None:
    left, top, right = room
    page.label(part.label, left, top - HEAD_EM, HEAD_EM, bold=True)
    others = ", ".join(one.label for one in same[1:])
    shape = words("radius", value=words.mm(1 / abs(part.curvature))) if part.curvature else words("straight")
    count = sum(one.quantity for one in same)
    facts = [
        words("one_piece") if count == 1 else words("pieces", count=count),
        words("length", value=words.mm(part.length)),
        words("thickness", value=words.mm(part.thickness)),
        shape,
        words("mass", value=words.number(part.mass, 2)),
    ]
    if others:
        facts.append(words("same_as", ids=others))
    start = left + text_width(part.label, HEAD_EM, True) + 4
    page.label(shortened(", ".join(facts), right - start, NOTE_EM), start, top - HEAD_EM, NOTE_EM)
    least_x, least_y, _, most_y = part.bounds
    at = (left, top - HEAD_EM - NOTE_EM - 3 - ABOVE)
    view = View.flat(np.array([least_x, most_y]), at, scale)
    for outline in (part.outline, *part.hole_outlines()):
        page.line(view.place(outline_points(outline, STRIP_ARCS)), "thin", closed=True)
    _numbers(page, view, part, features, right)
    # the chord of an arc is shorter than its length
    ends = part.place(np.array([part.start, part.end]), np.zeros(2))
    if abs(float(np.ptp(ends[:, 0])) - part.length) < CHORD_OFF:
        view.dimension(page, words, np.column_stack([ends[:, 0], [least_y, least_y]]), -BELOW * 0.55)


def _numbers(page: Page, view: View, part: Part, features: list[Feature], right: float) -> None:
    """Numbers of the slots and of nodes without one over the strip, as far as they fit side by side."""
    slots = [one for one in features if one.cells[1]]
    if not slots:
        return
    stations = np.array([one.station for one in slots]) + part.start
    points = view.place(part.place(stations, np.full(len(stations), part.height / 2)))
    width = max(text_width(one.number, NOTE_EM) for one in slots) + 0.8
    left = float(view.place(np.array(part.bounds[:2]))[0])
    if width * len(slots) > right - left:
        return
    # an arc may run backwards at its ends
    order = np.argsort(points[:, 0], kind="stable")
    across = spread(points[order, 0], width, left, right - width)
    level = float(points[:, 1].max()) + 2.2
    for x, k in zip(across.tolist(), order.tolist(), strict=True):
        page.line([points[k], (x, level)], "fine")
        page.label(slots[k].number, x, level + 0.4, NOTE_EM, anchor="middle")


def _band(page: Page, words: Terms, part: Part, features: list[Feature], left: float, top: float) -> None:
    """Some columns of the table of slots and holes."""
    names = ("number", "node", "station", "above_axis", "width_or_diameter")
    right = left + FIRST + COLUMN * len(features)
    for row, name in enumerate(names):
        low = top - BAND_ROW * (row + 1)
        page.label(shortened(words(name), FIRST - 1, NOTE_EM), left, low + 0.8, NOTE_EM, bold=True)
        for column, one in enumerate(features):
            x = left + FIRST + COLUMN * (column + 1) - 1
            page.label(
                shortened(one.cells[row], COLUMN - 1, NOTE_EM), x, low + 0.8, NOTE_EM, anchor="end", bold=not row
            )
        page.line([(left, low), (right, low)], "fine")
