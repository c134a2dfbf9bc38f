"""Values of a project that cannot be: exit 2, a message with value, limit and remedy, nothing written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from lamella.command.main import main
from refusals import check_stated, numbers_in

from .projects import FULL, SURFACES, UNDULOID, surface

NUMBERS = [
    (kind, key)
    for kind, table in SURFACES.items()
    for key in table
    if key != "height" and (kind, key) != ("enneper", "order")
]


@pytest.mark.parametrize(("kind", "key"), NUMBERS)
def test_numbers_that_are_none(refused: Callable[..., str], kind: str, key: str) -> None:
    for value, words in (
        ('"1.6"', ["1.6"]),
        ('"100 mm"', ["100 mm"]),
        ("true", ["true"]),
        ("[1.6]", [1.6]),
        ("{a = 1}", []),
        ("1979-05-27", ["1979-05-27"]),
        ("nan", ["nan"]),
        ("inf", ["inf"]),
        ("-inf", ["-inf"]),
        ("1" + "0" * 400, [40]),
    ):
        refused(surface(kind, **{key: value}), f"surface.{key}", *words)


@pytest.mark.parametrize(("kind", "key"), NUMBERS)
def test_numbers_out_of_range(refused: Callable[..., str], kind: str, key: str) -> None:
    values = ["1e308", "1e200", "-1e308"]
    if key != "pitch":
        values += ["-1", "-0.001"]
        if key != "inner_radius":
            values += ["0", "0.0", "1e-300", "5e-324"]
    for value in values:
        told = refused(surface(kind, **{key: value}), f"surface.{key}", float(value))
        # both limits beside the value, and the remedy about this key
        assert len(numbers_in(told.partition("remedy: ")[0])) >= 3
        check_stated(told.partition("remedy: ")[2], names=[key] if "_" in key else [])


@pytest.mark.parametrize("kind", ["unduloid", "nodoid", "catenoid", "cylinder"])
def test_ranges_of_height(refused: Callable[..., str], kind: str) -> None:
    for value, words in (
        ("[2, -2]", [2, -2]),
        ("[1, 1]", [1]),
        ("[1, 2, 3]", [1, 2, 3]),
        ("[1]", [1]),
        ("[]", [0]),
        ("3", [3]),
        ('"0..1"', ["0..1"]),
        ('["a", 1]', ["a"]),
        ("[true, 1]", ["true"]),
        ("[[0, 1], [2, 3]]", [0, 1]),
        ("[nan, 1]", ["nan", 1000000.0]),
        ("[0, inf]", ["inf"]),
        ("[-1e308, 1e308]", [-1e308]),
        ("[0, 1" + "0" * 400 + "]", [40]),
        ("[0, 1e-300]", [1e-300, 1e-06]),
    ):
        refused(surface(kind, height=value), "surface.height", *words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (surface("unduloid", neck_radius="3.0"), ["neck_radius", 3, "bulge_radius", 2.8]),
        (
            surface("unduloid", neck_radius="1e-5"),
            ["surface.neck_radius", 0.0001, 0.00028],
        ),
        (
            surface("nodoid", neck_radius="1e-5"),
            ["surface.neck_radius", 0.0001, 0.0009],
        ),
        (surface("nodoid", neck_radius="9"), ["neck_radius", 9, "bulge_radius"]),
        (surface("nodoid", neck_radius="9.5"), ["neck_radius", 9.5, "bulge_radius", 9]),
        (
            surface("nodoid", height="[-2, 1]"),
            ["surface.height", -2, 1.7811, -1.76, 1.76],
        ),
        (surface("nodoid", height="[0, 1000]"), ["surface.height", 1000, 1.7811]),
        (
            surface("catenoid", height="[0, 1000]"),
            ["surface.height", 1000, 27.6],
        ),
        (surface("helicoid", pitch="0"), ["surface.pitch", 0]),
        (surface("helicoid", pitch="1e-9"), ["surface.pitch", 1e-09, 4e-06]),
        (surface("helicoid", inner_radius="4"), ["surface.inner_radius", 4, "outer_radius"]),
        (surface("helicoid", pitch="1e6", inner_radius="3.99"), ["surface.outer_radius", 10000]),
        (surface("helicoid", pitch="1e-5", turns="0.001", outer_radius="9e5"), ["surface.pitch"]),
        (surface("enneper", order="1"), ["surface.order", 1, 2, 12]),
        (surface("enneper", order="13"), ["surface.order", 13]),
        (surface("enneper", order="2.5"), ["surface.order", 2.5]),
        (surface("enneper", order='"3"'), ["surface.order", "3"]),
        (surface("enneper", radius="6"), ["surface.radius", 6, 5]),
        (surface("enneper", order="12", radius="5"), ["surface.radius", 5, 1.52, 12]),
        (surface("scherk", extent="1.5708"), ["surface.extent", 1.5708, 1.570796327]),
        (surface("scherk", extent="1.6"), ["surface.extent", 1.6]),
    ],
    ids=lambda value: None if isinstance(value, list) else value[11:],
)
def test_surfaces_that_do_not_exist(refused: Callable[..., str], text: str, words: list[str]) -> None:
    refused(text, *words)


@pytest.mark.parametrize(
    ("table", "values", "words"),
    [
        ("network", "cells = 0", ["network.cells", 0, 3]),
        ("network", "cells = -3", ["network.cells", -3]),
        ("network", "cells = 24.5", ["network.cells", 24.5]),
        ("network", "cells = true", ["network.cells", "true"]),
        ("network", "cells = 1" + "0" * 400, ["network.cells", 40]),
        ("network", "spacing = 0", ["network.spacing", 0]),
        ("network", "spacing = -1.0", ["network.spacing", -1]),
        ("network", "spacing = 1e-9", ["network.spacing", 1e-09, 1e-06]),
        ("network", "spacing = 1e9", ["network.spacing", 1000000000]),
        ("network", "spacing = nan", ["network.spacing", "nan"]),
        ("network", "spacing = 3", ["network.spacing", 3, 2.5]),
        ("network", "cells = 24\nspacing = 0.5", [24, 0.5]),
        ("network", "angle = 60", ["network.angle", 60, 90]),
        ("network", "angle = 20", ["network.angle", 20, 30, 150]),
        ("network", 'closing = "closed"', ["network.closing", "closed", "open", "round", "adjust"]),
        ("network", "minimum_length = -1", ["network.minimum_length", -1]),
        ("lamella", "height = 0", ["lamella.height", 0]),
        ("lamella", "height = 100", ["lamella.height", 100, 0.0001, 5]),
        ("lamella", 'height = "100mm"', ["lamella.height", "100mm"]),
        ("lamella", "height = 1e-300", ["lamella.height", 1e-300]),
        ("lamella", "height = 4.4", ["lamella.height", 4.4]),
        ("lamella", "thickness = 0.1", ["lamella.thickness", 0.1]),
        ("lamella", "thickness = 0.2", ["lamella.thickness", 0.2, 0.1]),
        ("lamella", "thickness = 1.5", ["lamella.thickness", 1.5]),
        ("lamella", "layers = 0", ["lamella.layers", 0, 1, 4]),
        ("lamella", "layers = 2.5", ["lamella.layers", 2.5]),
        ("lamella", "offset = 0.001", ["lamella.offset", 0.001]),
        ("lamella", "offset = -1", ["lamella.offset", -1]),
        ("lamella", 'marks = "arc"', ["lamella.marks", "arc", "arc-length", "relaxed"]),
        ("lamella", 'material = "1.4031"', ["lamella.material", "1.4031", "1.4301"]),
        ("lamella", 'material = "cheese"', ["lamella.material", "cheese", "1.4301"]),
        ("lamella", "material = 3", ["lamella.material", 3]),
        ("lamella", 'material = "' + "m" * 9999 + '"', ["lamella.material", 9999, 100]),
        ("fabrication", "end_distance = 0", ["fabrication.end_distance", 0]),
        ("fabrication", "end_distance = 1e-6", ["fabrication.end_distance", "end_distance", 1e-06]),
        (
            "fabrication",
            "slot_width = 0.09\nend_distance = 0.05",
            ["fabrication.end_distance", "end_distance", 0.05],
        ),
        ("fabrication", "slot_width = 0.0001", ["fabrication.slot_width", "slot_width", 0.0001]),
        ("fabrication", "slot_width = -1", ["fabrication.slot_width", -1]),
        ("fabrication", "hub_radius = -1", ["fabrication.hub_radius", -1]),
        ("fabrication", "gap = -1", ["fabrication.gap", -1]),
        (
            "fabrication",
            "gap = 1",
            ["fabrication.sheet", 2, 1],
        ),
        ("fabrication", "sheet = [0, 1]", ["fabrication.sheet", 0]),
        ("fabrication", "sheet = [1]", ["fabrication.sheet", 1]),
        ("fabrication", 'sheet = "A0"', ["fabrication.sheet", "A0"]),
        ("fabrication", "sheet = [12000, 2000]", ["fabrication.sheet", 12000]),
        ("fabrication", "sheet = [1e-9, 1e-9]", ["fabrication.sheet", 1e-09]),
        ("fabrication", "sheet = [nan, 1]", ["fabrication.sheet", "nan"]),
        ("materials", "x = 3", ["materials.x", 3]),
    ],
    ids=lambda value: value[:20],
)
def test_tables(refused: Callable[..., str], table: str, values: str, words: str) -> None:
    refused(f"{UNDULOID}[{table}]\n{values}\n", *words)


@pytest.mark.parametrize("key", ["surface", "network", "lamella", "fabrication", "materials"])
def test_values_in_a_tables_place(refused: Callable[..., str], key: str) -> None:
    rest = "" if key == "surface" else UNDULOID
    for value, shown in (("3", 3), ('"x"', "'x'"), ("[1, 2]", "[1, 2]"), ("true", "true")):
        refused(f"{key} = {value}\n{rest}", f"[{key}]", shown, at="p.toml:1")
    refused(f"{rest}[[{key}]]\na = 1\n", f"[{key}]", at=f"p.toml:{7 if rest else 1}")


@pytest.mark.parametrize("key", ["density", "youngs_modulus", "shear_modulus", "strength"])
def test_materials_of_ones_own(refused: Callable[..., str], key: str) -> None:
    head = UNDULOID + '[lamella]\nmaterial = "mine"\n[materials.mine]\n'
    missing = "".join(line + "\n" for line in FULL.splitlines() if not line.startswith(key))
    refused(head + missing, f"materials.mine.{key}", f"{key} = ", at="p.toml:9")
    for value, words in (
        ("0", [0]),
        ("-1.0", [-1]),
        ("1e300", [1e300]),
        ("nan", ["nan"]),
        ('"stiff"', ["stiff"]),
    ):
        refused(head + f"{key} = {value}\n{missing}", f"materials.mine.{key}", *words, at="p.toml:10")


def test_units_slip(refused: Callable[..., str]) -> None:
    refused(UNDULOID + "[lamella]\nheight = 100\n", "lamella.height", 100, 5, at="p.toml:8")
    refused(
        surface("unduloid", neck_radius="0.0006", bulge_radius="0.0014", height="[0, 0.002]"),
        "lamella.height",
        0.002,
        0.1,
    )


def test_check_refuses_what_run_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = tmp_path / "p.toml"
    for text, key in (
        (UNDULOID + "[fabrication]\nend_distance = 1e-6\n", "fabrication.end_distance"),
        (UNDULOID + "[lamella]\nheight = 4.4\n", "lamella.height"),
        (UNDULOID + "[network]\ncells = 5000\n", "network.cells"),
        (surface("nodoid", height="[-2, 1]"), "surface.height"),
    ):
        project.write_text(text)
        assert main(["check", str(project)]) == 2
        assert f"{key}: " in capsys.readouterr().err


@pytest.mark.parametrize(
    "text",
    [
        b"\xef\xbb\xbf" + UNDULOID.encode(),
        UNDULOID.replace("\n", "\r\n").encode(),
        UNDULOID.replace("1.6", "2.8").encode(),  # a cylinder
        UNDULOID.replace("1.6", "2").replace("2.8", "3").encode(),  # whole numbers
        b'surface = {kind = "cylinder", radius = 2, height = [0, 1]}\n',
        b'surface.kind = "cylinder"\nsurface.radius = 2\nsurface.height = [0, 1]\n',
        surface("scherk", extent="1.5707").encode(),
        surface("helicoid", inner_radius="0", pitch="-4").encode(),
    ],
    ids=["BOM", "CRLF", "equal radii", "whole numbers", "inline", "dotted", "scherk's limit", "helicoid's axis"],
)
def test_unusual_projects_that_are_good(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: bytes) -> None:
    (tmp_path / "p.toml").write_bytes(text)
    assert main(["run", str(tmp_path / "p.toml"), "--out", str(tmp_path / "o"), "--until", "network", "--quiet"]) == 0
    assert (tmp_path / "o" / "network.json").is_file()


def test_a_key_with_an_inline_table_is_located(refused: Callable[..., str]) -> None:
    text = 'surface = {kind = "cylinder", radius = -2, height = [0, 1]}\n'
    refused(text, "surface.radius", -2, at="p.toml:1")
