"""The assembly plan: which lamella is laid or threaded after which, which side is up, which layer lies where."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.drawings.built import Built
from lamella.drawings.overview import draw_net
from lamella.drawings.page import HEAD_EM, NOTE_EM, TEXT_EM, Page, text_width
from lamella.drawings.paper import Paper
from lamella.drawings.table import table_pages
from lamella.drawings.terms import Terms
from lamella.strip.layers import SIDES

NOTES = 120.0
"""mm: width of the notes beside the plan."""
WIDTHS = (6.0, 8.0, 26.0, 60.0)
"""Columns of the order, as shares of the sheet."""


def assembly_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """The plan with every lamella's start and sense, notes; the order as a table."""
    left, low, right, high = paper.room
    page = Page(words("assembly"))
    room = (left, low, right - NOTES - 6, high)
    draw_net(page, built, words, np.eye(3)[:2], room, words("plan"), starts=True)
    y = _layers(page, built, words, right - NOTES, high - HEAD_EM)
    kind = built.kind if f"{built.kind}_1" in words.words else "interlocked"
    texts = ["assembly_1", "assembly_2", f"{kind}_1", f"{kind}_2"]
    if built.hardware.items:
        texts += ["assembly_3", "assembly_4"]
    for key in texts:
        for line in wrapped(words(key), NOTES, TEXT_EM):
            page.label(line, right - NOTES, y - TEXT_EM, TEXT_EM)
            y -= 1.5 * TEXT_EM
        y -= TEXT_EM
    yield page
    head = tuple(words(key) for key in ("order", "lamella", "strips_of", "nodes_in_order"))
    yield from table_pages(words("assembly"), paper, head, _order(built, paper), WIDTHS)


def wrapped(text: str, room: float, size: float) -> list[str]:
    """A text in lines that are not longer than the room, mm; a word that is longer has a line of its own."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and text_width(longer, size) <= room:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _order(built: Built, paper: Paper) -> list[tuple[str, ...]]:
    """A row a lamella, more where its nodes need more room; all A lamellas, then all B lamellas."""
    network = built.network
    left, _, right, _ = paper.room
    rooms = [(right - left) * width / sum(WIDTHS) - 3 for width in WIDTHS]
    strips: dict[int, list[str]] = {}
    for part in built.parts.parts:
        strips.setdefault(part.lamella, []).append(part.label)
    rows: list[tuple[str, ...]] = []
    order = [k for family in "AB" for k in np.flatnonzero(network.families == family).tolist()]
    for step, k in enumerate(order, 1):
        stops = network.stop_nodes[int(network.stop_offsets[k]) : int(network.stop_offsets[k + 1])]
        names = wrapped(", ".join(strips.get(k, [])), rooms[2], NOTE_EM)
        nodes = wrapped(" ".join(map(str, stops.tolist())), rooms[3], NOTE_EM)
        for line in range(max(len(names), len(nodes))):
            # a leading space: lists of nodes stand at the left
            cells = [f"{part[line]}" if line < len(part) else "" for part in (names, nodes)]
            rows.append((str(step) if not line else "", network.ids[k] if not line else "", cells[0], " " + cells[1]))
    return rows


def _layers(page: Page, built: Built, words: Terms, left: float, top: float) -> float:
    """A sketch of a lamella cut across, looking along it; the height below it, mm."""
    section = built.lamellas.section
    height, step = 22.0, 14.0
    sides = SIDES[section.layers]
    low = top - height - TEXT_EM
    page.label(f"{words('lamella')}, {words('along')}", left, top - TEXT_EM, TEXT_EM, bold=True)
    middle = left + 50.0
    for k, side in enumerate(sides):
        # the right layer is drawn at the right
        x = middle - (k - (section.layers - 1) / 2) * step
        page.rectangle(x - 0.8, low - 4, x + 0.8, low + height - 6, "medium")
        page.label(side, x, low - 8, TEXT_EM, anchor="middle", bold=True)
    page.line([(middle + 34, low - 4), (middle + 34, low + height - 8)], "medium")
    page.line([(middle + 33, low + height - 11), (middle + 34, low + height - 8), (middle + 35, low + height - 11)])
    page.label(words("up"), middle + 37, low + height / 2 - 6, TEXT_EM)
    return low - 16.0
