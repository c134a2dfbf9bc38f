"""A project with the table [joint]: hardware in the figures, lists, drawings and the model, each piece once."""

from __future__ import annotations

import tomllib
from collections import Counter
from pathlib import Path

import ezdxf
import openpyxl
import pytest
import rhino3dm

import lamella
from lamella import InputError, compute, parse_project, write
from stages.csv_rows import rows

PROJECT = {
    "surface": {"kind": "enneper", "order": 3, "radius": 0.8, "scale": 3.0},
    "network": {"cells": 8},
    "lamella": {"layer_curves": "cut"},
    "joint": {},
    "cables": {},
}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[lamella.Results, Path]:
    results = compute(parse_project(PROJECT))
    folder = tmp_path_factory.mktemp("joint") / "run"
    write(results, folder)
    return results, folder


def test_every_piece_is_in_the_lists_and_in_the_model_once(written: tuple[lamella.Results, Path]) -> None:
    """Lists, places and model have the same pieces, each once, and the figures count them."""
    results, folder = written
    kinds = {row["id"]: int(row["quantity"]) for row in rows(folder / "fabrication" / "hardware.csv")}
    places = [(row["id"], row["place"]) for row in rows(folder / "fabrication" / "places.csv")]
    assert len(set(places)) == len(places)
    assert Counter(one for one, _ in places) == kinds
    model = rhino3dm.File3dm.Read(str(folder / "model.3dm"))
    drawn = Counter()
    for one in model.Objects:
        if one.Geometry.ObjectType == rhino3dm.ObjectType.InstanceReference:
            drawn[one.Attributes.GetUserString("id"), one.Attributes.GetUserString("place")] += 1
    assert drawn == Counter(places)
    figures = results.summary["fabrication"]["hardware"]
    network = results.network
    joined = sum(1 for a, b in zip(*network.node_degrees(), strict=True) if a == b == 1)
    assert figures["washer"]["count"] == figures["key"]["count"] == 2 * joined
    assert figures["bolt"]["count"] == joined
    assert (figures["hub"]["count"], figures["hub"]["different"]) == (1, 1)


def test_masses_add_up(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    figures = results.summary["fabrication"]
    hardware = sum(float(row["total_mass_kg"]) for row in rows(folder / "fabrication" / "hardware.csv"))
    strips = sum(float(row["mass_kg"]) * int(row["quantity"]) for row in rows(folder / "fabrication" / "schedule.csv"))
    assert figures["mass"] == pytest.approx(hardware + strips, rel=1e-5)
    assert sum(kind["mass"] for kind in figures["hardware"].values()) == pytest.approx(hardware, rel=1e-5)


def test_plates_are_drawn_once_with_their_holes(written: tuple[lamella.Results, Path]) -> None:
    _, folder = written
    document = ezdxf.readfile(folder / "fabrication" / "plates.dxf")
    assert document.audit().errors == []
    outlines = Counter(
        entity.get_xdata("LAMELLA")[0].value for entity in document.modelspace().query('LWPOLYLINE[layer=="CUT"]')
    )
    assert all(entity.closed for entity in document.modelspace().query('LWPOLYLINE[layer=="CUT"]'))
    plates = [row["id"] for row in rows(folder / "fabrication" / "hardware.csv") if row["drawing"] == "plates.dxf"]
    assert sorted(outlines) == sorted(plates)
    # outline and holes: the bolt's neck, six slots, two screws
    assert {outlines[one] for one in plates if one.startswith(("washer", "key"))} == {2}
    assert outlines["hub-1-plate"] == 7
    assert {outlines[one] for one in plates if "fin" in one} == {3}


def test_holes_of_the_strips_are_cut(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    parts = results.parts.parts
    drawn = Counter()
    for family in "AB":
        document = ezdxf.readfile(folder / "fabrication" / f"{family}.dxf")
        for entity in document.modelspace().query('LWPOLYLINE[layer=="CUT"]'):
            if len(entity) == 2:
                drawn[entity.get_xdata("LAMELLA")[0].value] += 1
                (x0, _, _, _, bulge), (x1, _, _, _, _) = entity.get_points()
                assert bulge == 1.0
                assert x1 - x0 == pytest.approx(6.6, abs=1e-6)
    assert drawn == Counter({part.id: len(part.holes) for part in parts if len(part.holes)})
    assert sum(drawn.values()) > 0


def test_the_same_bytes_twice(written: tuple[lamella.Results, Path], tmp_path: Path) -> None:
    """Lists, drawings and models of hardware are the same to the byte in a second run."""
    _, folder = written
    write(compute(parse_project(PROJECT)), tmp_path / "again")
    for name in (
        "parts.xlsx",
        "hardware.csv",
        "places.csv",
        "plates.dxf",
        "A.dxf",
        "drawings.pdf",
        "plates.svg",
        "B.svg",
    ):
        assert (tmp_path / "again" / "fabrication" / name).read_bytes() == (folder / "fabrication" / name).read_bytes()
    for name in ("model.3dm", "model.glb"):
        assert (tmp_path / "again" / name).read_bytes() == (folder / name).read_bytes()


def test_the_workbook_has_what_the_lists_have(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    book = openpyxl.load_workbook(folder / "fabrication" / "parts.xlsx")
    assert book.sheetnames == ["strips", "hardware", "cut plan", "totals", "cables", "plates", "summary"]
    for page, file in (("strips", "schedule.csv"), ("hardware", "hardware.csv")):
        table = [[cell.value for cell in row] for row in book[page].iter_rows()]
        listed = rows(folder / "fabrication" / file)
        assert table[0] == list(listed[0])
        assert len(table) - 1 == len(listed)
        for cells, row in zip(table[1:], listed, strict=True):
            for cell, text in zip(cells, row.values(), strict=True):
                assert cell == (float(text) if isinstance(cell, int | float) else text or None)
    plan = list(book["cut plan"].iter_rows(min_row=2, values_only=True))
    assert len(plan) == len(results.nesting.parts) == results.summary["fabrication"]["parts"]
    total = {row[0]: row[1:] for row in book["totals"].iter_rows(min_row=2, values_only=True)}
    assert total["all"][2] == pytest.approx(results.summary["fabrication"]["mass"], rel=1e-12)
    assert total["strips"][1] == results.summary["fabrication"]["parts_different"]


def test_without_the_table_nothing_is_added() -> None:
    surface = {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.5, 0.5]}
    results = compute(parse_project({"surface": surface, "network": {"cells": 6}}))
    assert results.summary["fabrication"]["hardware"] == {}
    assert all(len(part.holes) == 0 for part in results.parts.parts)


@pytest.mark.parametrize(
    ("table", "more", "key"),
    [
        ({"bolt": 0.007}, {}, "joint.bolt"),
        ({"washer_length": 2.0}, {}, "joint.washer_length"),
        ({}, {"lamella": {"layers": 1}}, "joint"),
        ({"slot_width": 0.003}, {"fabrication": {"slot_width": 0.004}}, "joint.slot_width"),
        ({"material": "balsa"}, {}, "joint.material"),
        ({"wosher": True}, {}, "joint.wosher"),
        ({}, {"drawings": {"language": "tlh"}}, "drawings.language"),
        ({}, {"drawings": {"paper": "A4"}}, "drawings.paper"),
        ({"washer": False}, {}, "cables"),
        ({}, {"cables": {"prestress": 1e6}}, "cables.prestress"),
    ],
)
def test_what_cannot_be_joined_is_refused_by_its_key(table: dict, more: dict, key: str) -> None:
    with pytest.raises(InputError) as refused:
        compute(parse_project(PROJECT | more | {"joint": table}))
    assert refused.value.where == key
    assert refused.value.remedy


def test_slots_take_their_width_from_the_joint() -> None:
    results = compute(parse_project(PROJECT | {"joint": {"slot_width": 0.0035, "block_spacing": 0}}))
    assert {part.slot_width for part in results.parts.parts if len(part.slots)} == {0.0035}
    again = parse_project(tomllib.loads(results.project.to_toml()))
    assert again.fabrication.slot_width == 0.0035
