"""A project with [[stock]]: figures, plates on their sheets as drawn, one message for what cannot be."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

import ezdxf
import numpy as np
import openpyxl
import pytest
from ezdxf.path import make_path

import lamella
from files.write.test_svg import dxf_paths, svg_paths
from lamella import InputError, compute, parse_project
from lamella.fabrication.contours import CutOptions
from lamella.files.write.svg import write_svg
from lamella.hardware.plate_sheets_drawing import drawn_plate_sheets, write_plate_sheets
from lamella.stages.check import check_project
from lamella.stages.fabrication.stage import FabricationStage
from lamella.stages.write import write_styled

PROJECT = {
    "surface": {"kind": "enneper", "order": 3, "radius": 0.8, "scale": 3.0},
    "network": {"cells": 8},
    "lamella": {"layer_curves": "offset"},
    "joint": {"block_bolt": 0.005},
    "segments": {"mass": 120.0},
    "files": {"csv": {"separator": ";", "decimal": ","}},
    "stock": [{"kind": "bar", "length": 3.0}, {"kind": "sheet", "size": [0.5, 1.0]}],
}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[lamella.Results, Path]:
    results = compute(parse_project(PROJECT))
    folder = tmp_path_factory.mktemp("stock")
    (folder / "fabrication").mkdir()
    # lists and drawings for the laser alone: drawings.pdf and the model take their time
    for file in FabricationStage().files(results.outputs["fabrication"], results.upstream):
        if file.name.endswith((".csv", ".xlsx", ".dxf")):
            write_styled(file, folder, (";", ","))
    return results, folder


def closed(path: Path) -> dict[str, list[tuple[str, int, np.ndarray]]]:
    """Closed outlines of a drawing by layer: id, copy, points in mm."""
    found: dict[str, list[tuple[str, int, np.ndarray]]] = {}
    for entity in ezdxf.readfile(path).modelspace().query("LWPOLYLINE"):
        if not entity.closed:
            continue
        points = np.array([(p.x, p.y) for p in make_path(entity).flattening(0.01)])
        tag = entity.get_xdata("LAMELLA") if entity.has_xdata("LAMELLA") else []
        values = dict(tag)
        found.setdefault(entity.dxf.layer, []).append((values.get(1000, ""), values.get(1071, 0), points))
    return found


def test_every_plate_lies_once_on_a_sheet_of_its_own_thickness(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    drawn = closed(folder / "fabrication" / "plate_sheets.dxf")
    hardware = results.outputs["fabrication"].hardware
    plates = {item.id: item for item in hardware if item.plate}
    # outlines and holes
    wanted = Counter()
    for item in plates.values():
        wanted[item.id] = item.quantity * (1 + len(item.cut.holes))
    assert Counter(tag for tag, _, _ in drawn["CUT"]) == wanted
    assert len({(tag, copy) for tag, copy, _ in drawn["CUT"]}) == sum(item.quantity for item in plates.values())
    outer = {}
    for tag, copy, points in drawn["CUT"]:
        box = np.stack([points.min(axis=0), points.max(axis=0)])
        have = outer.get((tag, copy))
        outer[tag, copy] = box if have is None or np.prod(box[1] - box[0]) > np.prod(have[1] - have[0]) else have
    sheets = [np.stack([points.min(axis=0), points.max(axis=0)]) for *_, points in drawn["SHEET"]]
    where = {}
    for key, box in outer.items():
        inside = [k for k, sheet in enumerate(sheets) if (box[0] > sheet[0]).all() and (box[1] < sheet[1]).all()]
        assert len(inside) == 1
        where.setdefault(inside[0], []).append((plates[key[0]].thickness, box))
    for here in where.values():
        assert len({round(thickness, 9) for thickness, _ in here}) == 1
        low, high = np.array([box[0] for _, box in here]), np.array([box[1] for _, box in here])
        apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2) + np.eye(len(here)) * 1e9
        assert apart.min() >= 10 - 0.05


def test_figures_of_stock_fit_together(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    figures = results.summary["fabrication"]
    assert figures["bar_use"] >= 0.9
    assert figures["sheet_use"] is None
    bars, *sheets = figures["stock"]
    assert bars["pieces"] == figures["sheets"]
    # mass of the stock = parts without their holes, and what is left over
    whole = 7900 * 0.0015 * 0.1 * 3.0 * bars["pieces"]
    assert whole == pytest.approx(bars["cost"])
    strips = results.parts
    area = sum(part.quantity * part.area for part in strips.parts)
    assert bars["offcut_mass"] == pytest.approx(whole - 7900 * 0.0015 * area)
    assert {one["thickness"] for one in sheets} == {
        one["thickness"] for one in figures["cut_length"] if one["thickness"] != 0.0015
    }
    # of the drawing, to its own rounding
    drawn = closed(folder / "fabrication" / "sheets.dxf")["CUT"]
    length = sum(float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) for *_, points in drawn)
    told = {one["thickness"]: one["length"] for one in figures["cut_length"]}
    assert told[0.0015] == pytest.approx(length / 1e3, rel=1e-3)


def styled(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        assert file.readline().startswith("# lamella")
        return list(csv.DictReader(file, delimiter=";"))


def number(text: str) -> float:
    assert "." not in text
    return float(text.replace(",", "."))


def test_segments_are_listed_with_all_that_belongs_to_them(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    figures = results.summary["fabrication"]
    rows = styled(folder / "fabrication" / "segments.csv")
    assert [row["id"] for row in rows] == [one["id"] for one in figures["segments"]]
    assert len(rows) > 1
    assert sum(one["nodes"] for one in figures["segments"]) == results.summary["network"]["nodes"]
    assert sum(one["mass"] for one in figures["segments"]) == pytest.approx(figures["mass"])
    parts = styled(folder / "fabrication" / "segment_parts.csv")
    for one, row in zip(figures["segments"], rows, strict=True):
        assert one["mass"] <= 120.0
        own = [number(part["mass_kg"]) for part in parts if part["segment"] == one["id"]]
        assert sum(own) == pytest.approx(one["mass"], rel=1e-4)
        assert number(row["mass_kg"]) == pytest.approx(one["mass"], rel=1e-5)
        assert sum(number(x) for x in row["lifting_kg"].split(";")) == pytest.approx(one["mass"], rel=1e-3)
    # every piece of hardware and strip once
    hardware = {row["id"]: int(row["quantity"]) for row in styled(folder / "fabrication" / "hardware.csv")}
    listed: Counter[str] = Counter()
    for part in parts:
        listed[part["id"]] += int(part["quantity"])
    strips = {row["id"]: int(row["quantity"]) for row in styled(folder / "fabrication" / "schedule.csv")}
    assert listed == Counter(hardware | strips)


def test_the_workbook_has_the_plans_and_the_segments(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    figures = results.summary["fabrication"]
    book = openpyxl.load_workbook(folder / "fabrication" / "parts.xlsx")
    pages = {name: list(book[name].iter_rows(min_row=2, values_only=True)) for name in book.sheetnames}
    assert list(pages) == [
        *("strips", "hardware", "cut plan", "totals", "plates", "plate plan", "stock"),
        *("segments", "segment joints", "segment parts", "summary"),
    ]
    plates = {row[0]: row for row in pages["plates"]}
    assert Counter(row[5] for row in pages["plate plan"]) == {key: row[4] for key, row in plates.items()}
    cut = sum(row[4] * row[8] for row in plates.values()) / 1e3
    assert cut == pytest.approx(sum(one["length"] for one in figures["cut_length"] if one["thickness"] != 0.0015))
    assert [row[0] for row in pages["segments"]] == [one["id"] for one in figures["segments"]]
    assert sum(row[1] for row in pages["segments"]) == pytest.approx(figures["mass"], rel=1e-5)
    summary = {row[0]: row[2] for row in pages["summary"]}
    assert summary["surface weight"] == pytest.approx(figures["surface_weight"], rel=1e-5)
    assert summary["different lamella layers"] == figures["parts_different"]
    assert summary["bar_use"] == pytest.approx(figures["bar_use"], rel=1e-5)


@pytest.mark.parametrize(
    ("tables", "where"),
    [
        ({"segments": {}}, "segments.mass"),
        ({"segments": {"mass": 0}}, "segments.mass"),
        ({"files": {"csv": {"decimal": ","}}}, "files.csv.decimal"),
    ],
)
def test_tables_that_cannot_be_are_refused_with_their_key(tables: dict[str, dict[str, object]], where: str) -> None:
    with pytest.raises(InputError) as refused:
        parse_project(PROJECT | tables)
    assert refused.value.where == where


@pytest.mark.parametrize(
    ("stock", "where"),
    [
        ([{"kind": "bar"}], "stock[0].length"),
        ([{"kind": "sheet", "size": [3.0, 1.5], "length": 2.0}], "stock[0].length"),
        ([{"kind": "bar", "length": 3.0, "thickness": 0.002}], "stock[0].thickness"),
        ([{"kind": "coil", "width": 0.1}], "stock[0].length"),
        ([{"kind": "sheet", "size": [3000, 150000]}], "stock[0].size"),
        ([{"kind": "bar", "length": 6.0, "price": 3.0}, {"kind": "bar", "length": 3.0}], "stock[1].price"),
        ([{"kind": "sheet", "size": [3.0, 1.5], "thickness": 0.002}], "stock"),
        ([{"kind": "sheet", "size": [3.0, 0.11]}], "stock"),
    ],
)
def test_stock_that_cannot_be_is_refused_with_its_key(stock: list[dict[str, object]], where: str) -> None:
    with pytest.raises(InputError) as refused:
        check_project(parse_project(PROJECT | {"stock": stock}))
    assert refused.value.where == where


def test_plates_on_their_sheets_as_svg_with_lead_ins(written: tuple[lamella.Results, Path], tmp_path: Path) -> None:
    """The same contours and lead-ins as in the DXF file, and no lead-in in another plate or beside its sheet."""
    groups = written[0].outputs["fabrication"].plates
    options = CutOptions(kerf=0.0002, lead_in=0.004)
    write_plate_sheets(tmp_path / "x.dxf", groups, options, name="x", version="1")
    placed = drawn_plate_sheets(groups, "", options)
    write_svg(tmp_path / "x.svg", placed, name="x", version="1", further=options.layers)
    drawn = svg_paths(tmp_path / "x.svg")
    cut = dxf_paths(tmp_path / "x.dxf")
    assert {layer: len(paths) for layer, paths in drawn.items()} == {layer: len(paths) for layer, paths in cut.items()}
    assert len(cut["LEAD"]) == len(cut["CUT"])
    sheets = np.array([[points[:, :2].min(axis=0), points[:, :2].max(axis=0)] for *_, points in cut["SHEET"]])
    sheets = sheets[np.ptp(sheets, axis=1).min(axis=1) > 100]
    boxes = np.array([[points[:, :2].min(axis=0), points[:, :2].max(axis=0)] for *_, points in cut["CUT"]])
    owners = np.array([(part, copy) for part, copy, _ in cut["CUT"]])
    for part, copy, points in cut["LEAD"]:
        away = points[0, :2]
        assert ((away > sheets[:, 0]) & (away < sheets[:, 1])).all(axis=1).sum() == 1
        other = (owners != (part, copy)).any(axis=1)
        assert not ((away > boxes[other, 0]) & (away < boxes[other, 1])).all(axis=1).any()
