"""drawings.pdf, read back by another engine: every part once, measures as those of the model, nothing over another."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pypdfium2
import pypdfium2.raw
import pytest

import lamella
from lamella import compute, parse_project
from lamella.base.arrays import Floats
from lamella.drawings import strip_sheets
from lamella.drawings.built import Built
from lamella.drawings.drawing_set import drawing_pages, drawings_pdf
from lamella.drawings.page import PENS, Label, Page
from lamella.drawings.paper import PAPERS
from lamella.drawings.pdf import pdf_bytes
from lamella.drawings.strip_sheets import different_strips, strips_not_drawn
from lamella.drawings.terms import terms
from lamella.fabrication.flat import outline_points

MM_PER_POINT = 25.4 / 72
EN = terms("en")


@pytest.fixture(scope="module")
def built() -> Built:
    surface = {"kind": "enneper", "order": 3, "radius": 0.6, "scale": 3.0}
    table = {"block_spacing": 0.6}
    results = compute(parse_project({"surface": surface, "network": {"cells": 5}, "joint": table, "cables": {}}))
    made = results.outputs["fabrication"]
    return Built(results.network, results.lamellas, made.parts, made.hardware, "Knot", "1.2.3", "1.4301")


@pytest.fixture(scope="module")
def written(built: Built) -> dict[str, bytes]:
    return {"en": drawings_pdf(built), "de": drawings_pdf(built, language="de", paper="A1")}


@pytest.fixture(scope="module")
def pdf(written: dict[str, bytes]) -> pypdfium2.PdfDocument:
    return pypdfium2.PdfDocument(written["en"])


@pytest.fixture(scope="module")
def pages(built: Built) -> list[Page]:
    return drawing_pages(built)


def texts(page: pypdfium2.PdfPage) -> list[tuple[str, Floats]]:
    """Texts of a page and their bounds, mm: left, low, right, high."""
    reader = page.get_textpage()
    found = []
    for one in page.get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_TEXT], max_depth=1):
        bounds = MM_PER_POINT * np.array(one.get_bounds())
        found.append((reader.get_text_bounded(*(bounds / MM_PER_POINT).tolist()), bounds))
    return found


def sheets(pdf: pypdfium2.PdfDocument) -> Iterator[str]:
    for page in pdf:
        yield page.get_textpage().get_text_range()


def of_title(pages: list[Page], title: str) -> list[int]:
    """Numbers of the sheets whose title begins so."""
    return [k for k, page in enumerate(pages) if page.title.startswith(title)]


def drawn(pdf: pypdfium2.PdfDocument, pages: list[Page], title: str) -> Counter[str]:
    """Texts of these sheets above the title block."""
    low = PAPERS["A3"].margin + PAPERS["A3"].title
    found = (texts(pdf[k]) for k in of_title(pages, title))
    return Counter(text.strip() for sheet in found for text, bounds in sheet if bounds[1] > low)


def test_sheets_have_the_paper_and_the_language_that_are_asked_for(written: dict[str, bytes]) -> None:
    for language, paper in (("en", "A3"), ("de", "A1")):
        document = pypdfium2.PdfDocument(written[language])
        for page in document:
            size = MM_PER_POINT * np.array(page.get_size())
            assert size == pytest.approx([PAPERS[paper].width, PAPERS[paper].height])
        assert terms(language)("parts_list") in list(sheets(document))[-1]


def test_every_sheet_has_its_number(pdf: pypdfium2.PdfDocument) -> None:
    for number, text in enumerate(sheets(pdf), 1):
        assert f"{number}/{len(pdf)}" in text
        assert "Knot" in text
        assert "lamella 1.2.3" in text


def test_sheets_follow_from_the_net(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    titles = Counter(page.title.partition(":")[0] for page in pages)
    singular = int(np.sum(built.network.node_kinds == lamella.network.network.SINGULAR))
    assert sum(count for title, count in titles.items() if title.startswith("Hub")) == singular == 1
    assert (titles["Overview"], titles["Joint"]) == (2, 1)
    assert sum(titles.values()) == len(pdf)


def test_every_strip_and_plate_is_drawn_once(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    strips, plates = drawn(pdf, pages, EN("strips")), drawn(pdf, pages, EN("plates"))
    labels = [built.parts.parts[k].label for k in different_strips(built.parts)]
    assert {label: strips[label] for label in labels} == dict.fromkeys(labels, 1)
    cut = [item.id for item in built.hardware if item.plate]
    assert {one: plates[one] for one in cut} == dict.fromkeys(cut, 1)


def test_parts_list_has_every_part_and_their_mass(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    found = drawn(pdf, pages, EN("parts_list"))
    kinds = [item.id for item in built.hardware]
    assert {one: found[one] for one in kinds} == dict.fromkeys(kinds, 1)
    groups = [", ".join(built.parts.parts[k].label for k in same) for same in different_strips(built.parts).values()]
    assert {one: found[one] for one in groups} == dict.fromkeys(groups, 1)
    assert found[EN.number(built.parts.mass + built.hardware.mass, 1)] == 1


def test_stations_of_slots_are_those_of_the_parts(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    expected: Counter[str] = Counter()
    for k in different_strips(built.parts):
        part = built.parts.parts[k]
        expected.update(EN.mm(value - part.start) for value in [*part.slots, *part.holes[:, 0]])
    assert expected.total() > 50
    assert not expected - drawn(pdf, pages, EN("strips"))


def test_strips_are_drawn_in_the_scale_that_is_told(
    pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built
) -> None:
    straight = [built.parts.parts[k] for k in different_strips(built.parts) if built.parts.parts[k].axis.is_arc]
    assert straight
    widths: list[float] = []
    scale = None
    for k in of_title(pages, EN("strips")):
        page = pdf[k]
        scale = float(re.search(r"1:(\d+)", page.get_textpage().get_text_range())[1])  # type: ignore[index]
        for one in page.get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_PATH], max_depth=1):
            left, _, right, _ = one.get_bounds()
            widths.append((right - left) * MM_PER_POINT)
    for part in straight:
        # bounds are a line's width wider on either side
        assert np.abs(np.array(widths) - 2 * PENS["thin"] - 1e3 * part.length / scale).min() < 1e-3


def test_the_joint_tells_the_measures_of_the_model(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    told = drawn(pdf, pages, EN("node_detail"))
    section = built.lamellas.section
    # between the layers of either family; the slot's depth and width; the height in the section and beside both slots
    assert told[EN.mm(section.offset)] == 2
    assert told[EN.mm(section.height)] == 3
    part = next(part for part in built.parts.parts if len(part.slots))
    assert told[EN.mm(part.slot_width)] == 2
    assert told[EN.mm(part.height / 2 + part.slot_play)] == 2
    washer = next(item for item in built.hardware if item.kind == "washer")
    assert told[EN.mm(float(np.ptp(outline_points(washer.cut.outline)[:, 0])))] == 1
    lengths = {EN.mm(item.length) for item in built.hardware if item.kind == "bolt"}
    assert sum(told[length] for length in lengths) == 1
    named = {text for text in told if re.fullmatch(r"(washer|key|bolt|nut)-\d", text)}
    assert {name.partition("-")[0] for name in named} == {"washer", "key", "bolt", "nut"}


def test_the_hub_tells_the_angles_of_its_rays(pdf: pypdfium2.PdfDocument, pages: list[Page], built: Built) -> None:
    (k,) = of_title(pages, "Hub")
    told = [float(text.strip()[:-1]) for text, _ in texts(pdf[k]) if text.strip().endswith("°")]
    node = int(np.flatnonzero(built.network.node_kinds == lamella.network.network.SINGULAR)[0])
    normal = built.network.node_normals[node]
    fins = [item for item in built.hardware if item.kind == "hub fin"]
    rays = np.concatenate([item.places.axes[:, 0] for item in fins])
    flat = rays - (rays @ normal)[:, None] * normal
    x = flat[0] / np.linalg.norm(flat[0])
    angles = np.sort(np.degrees(np.arctan2(flat @ np.cross(normal, x), flat @ x)) % 360)
    expected = np.diff(np.append(angles, angles[0] + 360))
    assert np.sort(told) == pytest.approx(np.sort(expected), abs=0.051)
    assert sum(told) == pytest.approx(360, abs=0.3)


@pytest.mark.parametrize(("language", "sheet"), [("en", "A3"), ("de", "A1")])
def test_no_text_covers_another_and_all_are_on_the_sheet(written: dict[str, bytes], language: str, sheet: str) -> None:
    document, paper = pypdfium2.PdfDocument(written[language]), PAPERS[sheet]
    for page in document:
        boxes = np.array([bounds for _, bounds in texts(page)])
        low, high = boxes[:, :2], boxes[:, 2:]
        assert np.all(low > paper.margin - 0.2)
        assert np.all(high < np.array([paper.width, paper.height]) - paper.margin)
        overlap = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
        covered = np.triu((overlap > 0.05).all(axis=2), 1)
        assert not covered.any(), [texts(page)[k][0] for k in np.argwhere(covered)[0]]


def test_names_in_other_scripts_are_written_as_far_as_the_font_goes(built: Built) -> None:
    odd = replace(built, name="Überdach 東京 \u202e")
    pages = [Page("one")]
    first = pypdfium2.PdfDocument(pdf_bytes(pages, PAPERS["A3"], EN, name=odd.name, version="1", material="x"))
    assert "Überdach ??" in next(sheets(first))


def test_both_languages_have_the_same_words() -> None:
    assert terms("en").words.keys() == terms("de").words.keys()
    import tomllib
    from importlib.resources import files

    read = tomllib.loads(files("lamella.drawings").joinpath("terms", "de.toml").read_text(encoding="utf-8"))
    assert read.keys() - {"descriptions"} == terms("en").words.keys()
    for key, text in terms("en").words.items():
        fields = re.findall(r"{(\w+)}", text)
        assert sorted(fields) == sorted(re.findall(r"{(\w+)}", terms("de").words[key]))


def test_descriptions_of_hardware_are_translated(built: Built) -> None:
    german = terms("de")
    for item in built.hardware:
        assert german.description(item.description) != item.description
    assert german.description("star washer 51.5 x 4 mm, 90 deg") == "Sternscheibe 51,5 x 4 mm, 90 Grad"


def test_more_strips_than_are_drawn_are_told(built: Built, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first ones in the order of the part list, and how many there are; no word where all are drawn."""
    assert not list(strips_not_drawn(built.parts))
    every = list(different_strips(built.parts))
    assert len(every) > 3
    monkeypatch.setattr(strip_sheets, "STRIP_LIMIT", 3)
    (message,) = strips_not_drawn(built.parts)
    assert message.key == "strips_not_drawn"
    assert f"3 of {len(every)} " in message
    labels = {
        one.text
        for page in strip_sheets.strip_pages(built, PAPERS["A3"], EN)
        for one in page.content
        if isinstance(one, Label)
    }
    heads = [built.parts.parts[k].label for k in every]
    assert [head for head in heads if head in labels] == heads[:3]
