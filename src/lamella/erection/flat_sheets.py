"""erection/flat.pdf: how the net, or each of its segments, is put together on the floor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.assembly import wrapped
from lamella.drawings.overview import VIEW_BORDER
from lamella.drawings.page import HEAD_EM, NOTE_EM, TEXT_EM, Page, text_width
from lamella.drawings.paper import PAPERS, Paper, scale_text, standard_scale
from lamella.drawings.pdf import pdf_bytes
from lamella.drawings.placing import Places
from lamella.drawings.table import table_pages
from lamella.drawings.terms import Terms, terms
from lamella.drawings.view import View
from lamella.erection.erection import Erection
from lamella.erection.flat_plan import FlatPlan

NOTES_WIDTH = 80.0
"""mm: width of the notes beside the plan."""
WIDTHS = (6.0, 8.0, 10.0, 76.0)
"""Columns of the order, as shares of the sheet."""
ANGLE_EM = 0.8 * NOTE_EM


def flat_pdf(
    made: Iterable[tuple[str, Erection]],
    *,
    name: str,
    version: str,
    material: str,
    paper: str = "A3",
    language: str = "en",
) -> bytes:
    """Plans of flat nets, each with the order in which its lamellas are laid, as a PDF file.

    Parameters
    ----------
    made : iterable of (str, Erection)
        Id of the segment, empty for the whole net, and its way, which begins flat.
    name, version, material : str
        Of the project, of the program, of the strips, for the title block.
    paper : str
        "A3" or "A1".
    language : str
        One of `lamella.drawings.terms.languages`.
    """
    words = terms(language)
    pages = [page for segment, one in made for page in flat_pages(segment, one, PAPERS[paper], words)]
    return pdf_bytes(pages, PAPERS[paper], words, name=name, version=version, material=material)


def flat_pages(segment: str, erection: Erection, paper: Paper, words: Terms) -> Iterator[Page]:
    """The plan with ids and angles; the order as a table."""
    plan = FlatPlan.of(erection)
    title = words("laid_flat") + (f", {words('segment', id=segment)}" if segment else "")
    yield _plan(plan, erection, paper, words, title)
    head = tuple(words(key) for key in ("order", "lamella", "length_mm", "nodes_and_angles"))
    yield from table_pages(title, paper, head, _rows(plan, erection, paper, words), WIDTHS)


def _plan(plan: FlatPlan, erection: Erection, paper: Paper, words: Terms, title: str) -> Page:
    left, low, right, high = paper.room
    ids, families = erection.model.lamellas.network.ids, erection.model.lamellas.network.families
    cloud = np.concatenate(plan.lines)
    least, most = cloud.min(0), cloud.max(0)
    width = right - left - NOTES_WIDTH - 6
    # texts stand beyond the ends
    room = width - 2 * VIEW_BORDER, high - low - 2 * VIEW_BORDER - HEAD_EM
    scale = standard_scale((float(most[0] - least[0]), float(most[1] - least[1])), room)
    view = View.flat((least + most) / 2, (left + width / 2, (low + high - HEAD_EM) / 2), scale)
    page = Page(title, scale_text(scale))
    page.label(f"{words('top_view')}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    for line, family in zip(plan.lines, families.tolist(), strict=True):
        page.line(view.place(line), "medium" if family == "A" else "thin")
    corners = np.array([least, [most[0], least[1]], most])
    view.dimension(page, words, corners[[0, 1]], -VIEW_BORDER * 0.75)
    view.dimension(page, words, corners[[1, 2]], -VIEW_BORDER * 0.75)
    places = Places((left, low, left + width, high - 2 * HEAD_EM))
    for lamella, line in zip(ids, plan.lines, strict=True):
        for end in (line[0], line[-1]):
            _text(page, places, view.place(end), lamella, NOTE_EM, bold=True, gap=2.0)
    for place, angle in zip(view.place(plan.joints), erection.states[0].angles.tolist(), strict=True):
        _text(page, places, place, words.number(angle, 1), ANGLE_EM, bold=False, gap=1.0)
    _notes(page, erection, words, right - NOTES_WIDTH, high - HEAD_EM)
    return page


def _text(page: Page, places: Places, at: Floats, text: str, size: float, *, bold: bool, gap: float) -> None:
    """Beside a point, where there is room."""
    width = text_width(text, size, bold) + 0.6
    found = places.beside(at, width, size + 0.2, gap)
    if found is not None:
        x, y = found
        if not bold:
            page.blank(x, y, x + width, y + size + 0.2)
        page.label(text, x + 0.3, y + 0.4, size, bold=bold)


def _notes(page: Page, erection: Erection, words: Terms, left: float, top: float) -> None:
    kind = "stacked" if erection.model.lamellas.section.level else "interlocked"
    y = top
    for key in ("flat_1", f"{kind}_1", f"{kind}_2", "flat_2", "flat_3"):
        for line in wrapped(words(key), NOTES_WIDTH, TEXT_EM):
            page.label(line, left, y - TEXT_EM, TEXT_EM)
            y -= 1.5 * TEXT_EM
        y -= TEXT_EM


def _rows(plan: FlatPlan, erection: Erection, paper: Paper, words: Terms) -> list[tuple[str, ...]]:
    """A row a lamella, more where its nodes need more room."""
    network = erection.model.lamellas.network
    angle = dict(zip(erection.model.joint_nodes.tolist(), erection.states[0].angles.tolist(), strict=True))
    left, _, right, _ = paper.room
    room = (right - left) * WIDTHS[3] / sum(WIDTHS) - 3
    rows: list[tuple[str, ...]] = []
    for step, k in enumerate(plan.order.tolist(), 1):
        stops = network.stop_nodes[int(network.stop_offsets[k]) : int(network.stop_offsets[k + 1])].tolist()
        told = " ".join(f"{node}:{words.number(angle[node], 1)}" if node in angle else str(node) for node in stops)
        for number, line in enumerate(wrapped(told, room, NOTE_EM)):
            # a leading space: lists of nodes stand at the left
            head = ("", "", "") if number else (str(step), network.ids[k], words.mm(float(network.lengths[k])))
            rows.append((*head, " " + line))
    return rows
