"""Sheets of all plates that are cut: each kind once, with its measures."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.built import Built
from lamella.drawings.page import HEAD_EM, NOTE_EM, TEXT_EM, Page, shortened, text_width
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.terms import Terms
from lamella.drawings.view import View
from lamella.fabrication.flat import outline_points
from lamella.hardware.item import Item

CELL = 66.0
"""mm: least width and height of a plate's place on the sheet."""
AROUND = 20.0
"""mm: beside a plate, for its dimensions."""
HEADLINE = 2 * HEAD_EM
PLATE_ARCS = 24
"""Straight parts of an arc."""
FIRST_ROW, SECOND_ROW = 8.0, 14.5
"""mm: from a plate to its first and to its second row of dimensions."""
CORNERS_TOLD = 7
"""Different places of corners along an axis up to which their distances are told."""
CHAINED = 4
"""Holes up to this number are told by their places, and round ones; more are slots at the angles of a hub's rays."""
MOST_SHARE = 0.4
"""Of a sheet's width and height that one plate's place takes at most."""


def plate_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """Plates in rows, each in the largest scale in which it fits its share of the sheet."""
    plates = [item for item in built.hardware if item.plate]
    left, low, right, high = paper.room
    page, x, y, row = None, left, high, 0.0
    for item in plates:
        scale = _scale(item, (right - left, high - low))
        width, height = _cell(item, scale)
        if page is not None and x + width > right + 1e-6:
            x, y, row = left, y - row, 0.0
        if page is None or y - height < low - 1e-6:
            if page is not None:
                yield page
            page, x, y, row = Page(words("plates")), left, high, 0.0
        _draw(page, words, item, (x, y - height, x + width, y), scale)
        x, row = x + width, max(row, height)
    if page is not None:
        yield page


def _size(item: Item) -> Floats:
    """Width and height of a plate, m, (2,)."""
    return np.asarray(np.ptp(outline_points(item.cut.outline, PLATE_ARCS), axis=0))


def _scale(item: Item, room: tuple[float, float]) -> float:
    """Of a plate; not above 1:1."""
    width, height = _size(item).tolist()
    share = MOST_SHARE * room[0] - 2 * AROUND, MOST_SHARE * room[1] - 2 * AROUND - HEADLINE
    return max(standard_scale((width, height), share), 1.0)


def _cell(item: Item, scale: float) -> tuple[float, float]:
    """Width and height of a plate's place, mm."""
    width, height = (1e3 * _size(item) / scale).tolist()
    return max(width + 2 * AROUND, CELL), max(height + 2 * AROUND + HEADLINE, CELL)


def _draw(page: Page, words: Terms, item: Item, room: tuple[float, float, float, float], scale: float) -> None:
    left, low, right, high = room
    outline = outline_points(item.cut.outline, PLATE_ARCS)
    least, most = outline.min(axis=0), outline.max(axis=0)
    at = ((left + right) / 2, (low + high - HEADLINE) / 2)
    view = View.flat((least + most) / 2, at, scale)
    page.label(shortened(item.id, right - left - 4, HEAD_EM, True), left, high - HEAD_EM, HEAD_EM, bold=True)
    count = words("one_piece") if item.quantity == 1 else words("pieces", count=item.quantity)
    thickness = words("thickness", value=words.mm(item.thickness))
    text = f"{scale_text(scale)}, {thickness}, {item.material}, {count}"
    page.label(shortened(text, right - left - 4, NOTE_EM), left, high - HEAD_EM - 1.4 * NOTE_EM, NOTE_EM)
    page.shape([view.place(outline), *(view.place(outline_points(hole, PLATE_ARCS)) for hole in item.cut.holes)], 0.93)
    page.line(view.place(outline), "medium", closed=True)
    for hole in item.cut.holes:
        page.line(view.place(outline_points(hole, PLATE_ARCS)), "medium", closed=True)
    _folds(page, words, view, item)
    corners = np.array([least, [most[0], least[1]], most])
    away = -FIRST_ROW - (SECOND_ROW - FIRST_ROW) * np.array([_steps(page, words, view, item, axis) for axis in (0, 1)])
    view.dimension(page, words, corners[[0, 1]], float(away[0]))
    view.dimension(page, words, corners[[1, 2]], float(away[1]))
    _holes(page, words, view, item, least, most)


def _folds(page: Page, words: Terms, view: View, item: Item) -> None:
    """Lines of the folds, their sense, angle and inner radius along them."""
    for fold in item.folds:
        begin, end = view.place(fold.line)
        page.line([begin, end], "centre")
        text = words("fold_up", angle=words.number(float(np.degrees(fold.angle)), 2), radius=words.mm(fold.radius))
        x, y = end
        page.line([end, (x, y + 2), (x + 1, y + 2)], "fine")
        page.label(text, x + 1.5, y + 2 - 0.3 * NOTE_EM, NOTE_EM)


def _steps(page: Page, words: Terms, view: View, item: Item, axis: int) -> bool:
    """Distances of corners and folds along an axis, below or to the right, where there are few and all have room."""
    corners = np.concatenate([item.cut.outline[:, :2], *(fold.line for fold in item.folds)])
    stops = np.unique(np.round(corners[:, axis], 7))
    told = [text_width(words.mm(step), TEXT_EM) + 2 for step in np.diff(stops).tolist()]
    if not 3 <= len(stops) <= CORNERS_TOLD or item.cut.outline[:, 2].any() or (np.diff(stops) * view.mm < told).any():
        return False
    ends = np.full((len(stops), 2), corners[:, 1].min() if axis == 0 else corners[:, 0].max())
    ends[:, axis] = stops
    for first, second in pairwise(ends):
        view.dimension(page, words, np.array([first, second]), -FIRST_ROW)
    return True


def _holes(page: Page, words: Terms, view: View, item: Item, least: Floats, most: Floats) -> None:
    """Sizes of the holes, how many are alike, and where they are; one in the plate's middle has no place."""
    sizes = [_hole_size(hole) for hole in item.cut.holes]
    middles = np.array([_middle(hole) for hole in item.cut.holes]).reshape(-1, 2)
    corner = view.place(np.array([least[0], most[1]]))
    told = list(dict.fromkeys(sizes))
    for size, hole, middle in zip(sizes, item.cut.holes, middles, strict=True):
        x, y = view.place(middle).tolist()
        reach = view.mm * size[0] / 2 + 1.2
        page.line([(x - reach, y), (x + reach, y)], "fine")
        page.line([(x, y - reach), (x, y + reach)], "fine")
        if size not in told:
            continue
        round_hole, same = len(hole) == 2, sizes.count(size)
        text = f"Ø{words.mm(size[0])}" if round_hole else f"{words.mm(size[0])} x {words.mm(size[1])}"
        height = float(corner[1]) + 2 + 1.35 * TEXT_EM * (len(dict.fromkeys(sizes)) - len(told))
        told.remove(size)
        left = float(corner[0])
        page.line([(x, y), (left + 1, height), (left, height)], "fine")
        page.label(text if same == 1 else f"{same}: {text}", left - 0.5, height - 0.3 * TEXT_EM, NOTE_EM, anchor="end")
    round_ones = all(len(hole) == 2 for hole in item.cut.holes)
    if len(middles) and (round_ones or len(middles) <= CHAINED):
        _chain(page, words, view, middles, least, most)


def _chain(page: Page, words: Terms, view: View, middles: Floats, least: Floats, most: Floats) -> None:
    """Distances from the left and the lower edge to the holes and from one to the next, above and to the left.

    Where these are too near to each other for their numbers, the places are listed from the edge.
    """
    listed = []
    for axis, name in enumerate("xy"):
        stops = np.unique(np.round(middles[:, axis], 7))
        if len(stops) == 1 and abs(stops[0] - (least[axis] + most[axis]) / 2) < 1e-7:
            continue
        stops = np.concatenate([least[axis : axis + 1], stops])
        fixed = most[1] if axis == 0 else least[0]
        ends = np.full((len(stops), 2), fixed)
        ends[:, axis] = stops
        told = [text_width(words.mm(step), TEXT_EM) + 2 for step in np.diff(stops).tolist()]
        if (np.diff(stops) * view.mm < told).any():
            places = ", ".join(words.mm(place) for place in (stops[1:] - stops[0]).tolist())
            listed.append(f"{name}: {places}")
            continue
        for first, second in pairwise(ends):
            view.dimension(page, words, np.array([first, second]), FIRST_ROW)
    if listed:
        x, y = view.place(np.array([least[0], least[1]])).tolist()
        page.label(words("holes", places="; ".join(listed)), x, y - AROUND + 1, NOTE_EM)


def _hole_size(hole: Floats) -> tuple[float, float]:
    """Length along its longest straight side and width across, m, to a micrometre; of a round hole its diameter."""
    points = outline_points(hole, PLATE_ARCS)
    sides = np.roll(hole[:, :2], -1, axis=0) - hole[:, :2]
    longest = sides[int(np.argmax(np.round(np.hypot(*sides.T), 9)))]
    along = longest / np.hypot(*longest)
    across = np.array([-along[1], along[0]])
    return round(float(np.ptp(points @ along)), 6), round(float(np.ptp(points @ across)), 6)


def _middle(hole: Floats) -> Floats:
    points = outline_points(hole, PLATE_ARCS)[:-1]
    return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2)
