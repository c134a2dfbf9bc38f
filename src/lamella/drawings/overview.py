"""The overview: plan and elevations of the net with the numbers of nodes and the names of lamellas."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.built import Built
from lamella.drawings.page import HEAD_EM, NOTE_EM, Page, text_width
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.placing import Places
from lamella.drawings.terms import Terms
from lamella.drawings.view import View

X, Y, Z = np.eye(3)
VIEW_BORDER = 14.0
"""mm: beside a view, for its dimensions and names of lamellas."""
ARROW = 2.6
"""mm: length of the mark at a lamella's start."""
NODE = 0.4
"""mm: half the side of a node's square."""


def overview_pages(built: Built, paper: Paper, words: Terms) -> list[Page]:
    """Plan; two elevations."""
    left, low, right, high = paper.room
    plan = Page(f"{words('overview')}: {words('plan')}")
    draw_net(plan, built, words, np.array([X, Y]), (left, low, right, high), words("plan"))
    elevations = Page(f"{words('overview')}: {words('elevations')}")
    middle = (low + high) / 2
    # seen along +x, y runs to the left
    for axes, room, name in (
        (np.array([X, Z]), (left, middle, right, high), words("elevation_x")),
        (np.array([-Y, Z]), (left, low, right, middle), words("elevation_y")),
    ):
        draw_net(elevations, built, words, axes, room, name)
    return [plan, elevations]


def draw_net(
    page: Page,
    built: Built,
    words: Terms,
    axes: Floats,
    room: tuple[float, float, float, float],
    name: str,
    *,
    starts: bool = False,
) -> View:
    """A view of the net in a rectangle of the sheet, (left, low, right, high) in mm.

    Lamellas have their names at their starts, nodes their numbers as far as there is room; the extents are
    told. Where asked for, a mark at its start shows where each lamella runs.
    """
    network = built.network
    left, low, right, high = room
    flat = network.sample_points @ axes.T
    least, most = flat.min(axis=0), flat.max(axis=0)
    wide = right - left - 2 * VIEW_BORDER, high - low - 2 * VIEW_BORDER - HEAD_EM
    scale = standard_scale(tuple((most - least).tolist()), wide)
    at = ((left + right) / 2, (low + high - HEAD_EM) / 2)
    view = View(np.eye(2), (least + most) / 2, np.array(at), scale)
    page.scale = scale_text(scale) if page.scale in ("", scale_text(scale)) else f"{page.scale}, {scale_text(scale)}"
    page.label(f"{name}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    lines = view.place(flat)
    offsets = network.sample_offsets
    for k, family in enumerate(network.families.tolist()):
        page.line(lines[offsets[k] : offsets[k + 1]], "medium" if family == "A" else "thin")
    corners = np.array([least, [most[0], least[1]], most])
    view.dimension(page, words, corners[[0, 1]], -VIEW_BORDER * 0.75)
    view.dimension(page, words, corners[[1, 2]], -VIEW_BORDER * 0.75)
    places = Places((left, low, right, high - 2 * HEAD_EM))
    (x0, y0), (x1, _) = view.place(corners[[0, 1]])
    places.take(x0, y0 - VIEW_BORDER, x1, y0 - VIEW_BORDER * 0.4)
    places.take(x1 + VIEW_BORDER * 0.4, low, x1 + VIEW_BORDER, high)
    points = view.place(network.node_points @ axes.T)
    for x, y in points.tolist():
        places.take(x - NODE, y - NODE, x + NODE, y + NODE)
        page.rectangle(x - NODE, y - NODE, x + NODE, y + NODE, "thin")
    if starts:
        _starts(page, built, lines, places)
    _names(page, built, words, lines, places, (left, low))
    _numbers(page, words, points, places, (right, low))
    return view


def _starts(page: Page, built: Built, lines: Floats, places: Places) -> None:
    """A triangle at the start of each lamella that points along it."""
    offsets = built.network.sample_offsets
    for start, end in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True):
        points = lines[start:end]
        away = np.linalg.norm(points - points[0], axis=1)
        ahead = points[int(np.argmax(away > ARROW))] - points[0]
        length = float(np.hypot(*ahead))
        if length > 0:
            ahead = ahead * ARROW / length
            side = 0.35 * np.array([-ahead[1], ahead[0]])
            corners = points[0] + np.array([side, ahead, -side])
            page.line(corners, "medium", closed=True)
            places.take(*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())


def _names(page: Page, built: Built, words: Terms, lines: Floats, places: Places, note: tuple[float, float]) -> None:
    """The name of each lamella in a frame at its start."""
    network = built.network
    left_out = 0
    for k, identity in enumerate(network.ids):
        start = int(network.sample_offsets[k])
        width = text_width(identity, NOTE_EM, True) + 0.8
        found = places.beside(lines[start], width, NOTE_EM + 0.4, 1.0)
        if found is None:
            found = places.beside(lines[int(network.sample_offsets[k + 1]) - 1], width, NOTE_EM + 0.4, 1.0)
        if found is None:
            left_out += 1
            continue
        x, y = found
        page.blank(x, y, x + width, y + NOTE_EM + 0.4)
        page.rectangle(x, y, x + width, y + NOTE_EM + 0.4, "fine")
        page.label(identity, x + 0.4, y + 0.75, NOTE_EM, bold=True)
    if left_out:
        page.label(words("lamellas_left_out", count=left_out), *note, NOTE_EM)


def _numbers(page: Page, words: Terms, points: Floats, places: Places, note: tuple[float, float]) -> None:
    """The number of each node beside it."""
    left_out = 0
    for index, point in enumerate(points):
        text = str(index)
        width = text_width(text, NOTE_EM)
        found = places.beside(point, width, 0.8 * NOTE_EM, NODE + 0.3)
        if found is None:
            left_out += 1
            continue
        x, y = found
        page.blank(x, y, x + width, y + 0.8 * NOTE_EM)
        page.label(text, x, y + 0.1, NOTE_EM)
    if left_out:
        page.label(words("labels_left_out", count=left_out), *note, NOTE_EM, anchor="end")
