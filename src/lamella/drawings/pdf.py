"""Sheets as a PDF file, each with its frame and title block."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

from reportlab.pdfgen.canvas import Canvas

from lamella.base.arrays import Floats
from lamella.base.wording import one_line
from lamella.drawings.page import (
    BOLD,
    FONT,
    HEAD_EM,
    NOTE_EM,
    PENS,
    POINT,
    TITLE_EM,
    Label,
    Line,
    Page,
    Shape,
    printable,
    shortened,
)
from lamella.drawings.paper import Paper
from lamella.drawings.terms import Terms

# mm: dashes of the pen "centre"
DASHES = (4.0, 1.0, 0.6, 1.0)
# widths of the title block's fields, as shares of the frame's; the first is the project
FIELDS = (0.34, 0.30, 0.08, 0.08, 0.12, 0.08)


def pdf_bytes(pages: Sequence[Page], paper: Paper, words: Terms, *, name: str, version: str, material: str) -> bytes:
    """The sheets as a PDF file.

    Parameters
    ----------
    pages : sequence of Page
    paper : Paper
    words : Terms
    name, version : str
        Of the project and of the program.
    material : str
        Of the strips, for the title block.

    Returns
    -------
    bytes
        The same for the same input: without dates, with ids that follow from the content.
    """
    stream = BytesIO()
    size = (paper.width / POINT, paper.height / POINT)
    canvas = Canvas(stream, pagesize=size, invariant=1, pageCompression=1)
    canvas.setTitle(printable(one_line(name)))
    canvas.setAuthor(printable(f"lamella {one_line(version)}"))
    for number, page in enumerate(pages, 1):
        canvas.scale(1 / POINT, 1 / POINT)
        canvas.setLineJoin(1)
        canvas.setLineCap(1)
        values = (
            (words("project"), one_line(name), f"lamella {one_line(version)}"),
            (f"{words('sheet')} {number}", page.title, words("units")),
            (words("scale"), page.scale, ""),
            (words("paper"), paper.name, ""),
            (words("material"), one_line(material), ""),
            (words("sheet"), f"{number}/{len(pages)}", ""),
        )
        _draw(canvas, page)
        _draw(canvas, _title_block(paper, values))
        canvas.showPage()
    canvas.save()
    return stream.getvalue()


def _title_block(paper: Paper, values: Sequence[tuple[str, str, str]]) -> Page:
    """Frame and title block."""
    block = Page("")
    left, low, right, high = paper.margin, paper.margin, paper.width - paper.margin, paper.height - paper.margin
    block.rectangle(left, low, right, high, "thick")
    top = low + paper.title
    block.line([(left, top), (right, top)], "thick")
    x = left
    for share, (name, value, below) in zip(FIELDS, values, strict=True):
        width = share * (right - left)
        if x > left:
            block.line([(x, low), (x, top)], "medium")
        room = width - 4
        block.label(name, x + 2, top - 4.5, NOTE_EM)
        size = TITLE_EM if share > 0.2 else HEAD_EM
        block.label(shortened(value, room, size, True), x + 2, low + 6.8, size, bold=True)
        block.label(shortened(below, room, NOTE_EM), x + 2, low + 2, NOTE_EM)
        x += width
    return block


def _draw(canvas: Canvas, page: Page) -> None:
    for one in page.content:
        if isinstance(one, Line):
            canvas.setLineWidth(PENS[one.pen])
            canvas.setDash(list(DASHES) if one.pen == "centre" else [])
            canvas.drawPath(_path(canvas, one.points, one.closed), stroke=1, fill=0)
        elif isinstance(one, Shape):
            path = canvas.beginPath()
            for ring in one.rings:
                _extend(path, ring, True)
            canvas.setFillGray(one.grey)
            canvas.drawPath(path, stroke=0, fill=1, fillMode=0 if one.even_odd else 1)
            canvas.setFillGray(0.0)
        else:
            _write(canvas, one)


def _path(canvas: Canvas, points: Floats, closed: bool) -> object:
    path = canvas.beginPath()
    _extend(path, points, closed)
    return path


def _extend(path: object, points: Floats, closed: bool) -> None:
    rows = points.tolist()
    path.moveTo(*rows[0])  # type: ignore[attr-defined]
    for row in rows[1:]:
        path.lineTo(*row)  # type: ignore[attr-defined]
    if closed:
        path.close()  # type: ignore[attr-defined]


def _write(canvas: Canvas, label: Label) -> None:
    text = printable(label.text)
    canvas.setFont(BOLD if label.bold else FONT, label.size)
    shift = {"start": 0.0, "middle": -label.width / 2, "end": -label.width}[label.anchor]
    if label.angle == 0:
        canvas.drawString(label.x + shift, label.y, text)
        return
    canvas.saveState()
    canvas.translate(label.x, label.y)
    canvas.rotate(label.angle)
    canvas.drawString(shift, 0.0, text)
    canvas.restoreState()
