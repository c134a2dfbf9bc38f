"""Values of a project that cannot be: exit 2, a message with value, limit and remedy, nothing written."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lamella.command.main import main

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
        ('"1.6"', "'1.6' is not a number"),
        ('"100 mm"', "'100 mm' is not a number"),
        ("true", "true is not a number"),
        ("[1.6]", "[1.6] is not a number"),
        ("{a = 1}", "a table is not a number"),
        ("1979-05-27", "1979-05-27 is not a number"),
        ("nan", "nan is not a finite number"),
        ("inf", "inf is not a finite number"),
        ("-inf", "-inf is not a finite number"),
        ("1" + "0" * 400, "a number of over 40 digits is out of range"),
    ):
        told = refused(surface(kind, **{key: value}), f"surface.{key}: {words}")
        assert re.search(r"remedy: (write a number|lower)", told)


@pytest.mark.parametrize(("kind", "key"), NUMBERS)
def test_numbers_out_of_range(refused: Callable[..., str], kind: str, key: str) -> None:
    values = ["1e308", "1e200", "-1e308"]
    if key != "pitch":
        values += ["-1", "-0.001"]
        if key != "inner_radius":
            values += ["0", "0.0", "1e-300", "5e-324"]
    for value in values:
        told = refused(surface(kind, **{key: value}), f"surface.{key}: ", "is out of range: has to be ")
        assert re.search(r"(above|at least) \S+ and (at most|below) \S+", told)
        assert f"remedy: {'lower' if float(value) > 1 else 'raise'} {key}" in told


@pytest.mark.parametrize("kind", ["unduloid", "nodoid", "catenoid", "cylinder"])
def test_ranges_of_height(refused: Callable[..., str], kind: str) -> None:
    for value, words in (
        ("[2, -2]", "the range [2, -2] is reversed: z0 has to be below z1\n  remedy: write [-2, 2]"),
        ("[1, 1]", "the range [1, 1] is empty"),
        ("[1, 2, 3]", "[1, 2, 3] has 3 values, needs two\n  remedy: write two numbers in m: [z0, z1]"),
        ("[1]", "[1] has 1 number, needs two"),
        ("[]", "[] has 0 values"),
        ("3", "3 is not a range of heights\n  remedy: write two numbers in m: [z0, z1]"),
        ('"0..1"', "'0..1' is not a range of heights"),
        ('["a", 1]', "'a' is not a number"),
        ("[true, 1]", "true is not a number"),
        ("[[0, 1], [2, 3]]", "[0, 1] is not a number"),
        ("[nan, 1]", "nan m is out of range: has to be a finite number up to 1e+06 m"),
        ("[0, inf]", "inf m is out of range"),
        ("[-1e308, 1e308]", "-1e+308 m is out of range"),
        ("[0, 1" + "0" * 400 + "]", "a number of over 40 digits m is out of range"),
        ("[0, 1e-300]", "the range is only 1e-300 m long (limit 1e-06 m)"),
    ):
        refused(surface(kind, height=value), f"surface.height: {words}")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (surface("unduloid", neck_radius="3.0"), ["neck_radius = 3 m is above bulge_radius = 2.8 m", "swap them"]),
        (
            surface("unduloid", neck_radius="1e-5"),
            ["(at least 0.0001 of it): the surface is a row of spheres", "umbilic", "neck_radius = 0.00028 or more"],
        ),
        (
            surface("nodoid", neck_radius="1e-5"),
            ["(at least 0.0001 of it): the surface is a row of spheres", "umbilic", "neck_radius = 0.0009 or more"],
        ),
        (surface("nodoid", neck_radius="9"), ["neck_radius = 9 m is not below bulge_radius = 9 m"]),
        (surface("nodoid", neck_radius="9.5"), ["neck_radius = 9.5 m is not below bulge_radius = 9 m"]),
        (
            surface("nodoid", height="[-2, 1]"),
            ["surface.height: z = -2 m", "fold: |z| < 1.78", "keep height within [-1.76, 1.76]"],
        ),
        (surface("nodoid", height="[0, 1000]"), ["surface.height: z = 1000 m", "fold: |z| < 1.78"]),
        (
            surface("catenoid", height="[0, 1000]"),
            ["surface.height: at z = 1000 m", "limit |z| <= 27.6", "keep height within"],
        ),
        (surface("helicoid", pitch="0"), ["surface.pitch: pitch = 0 m", "flat ring", "umbilic", "choose a pitch"]),
        (surface("helicoid", pitch="1e-9"), ["surface.pitch: pitch = 1e-09 m", "flat ring (limit 4e-06 m"]),
        (surface("helicoid", inner_radius="4"), ["surface.inner_radius: ", "4 m is not below outer_radius = 4 m"]),
        (surface("helicoid", pitch="1e6", inner_radius="3.99"), ["surface.outer_radius: ", "too narrow", "10,000"]),
        (surface("helicoid", pitch="1e-5", turns="0.001", outer_radius="9e5"), ["surface.pitch"]),
        (surface("enneper", order="1"), ["surface.order: 1 is out of range: has to be at least 2 and at most 12"]),
        (surface("enneper", order="13"), ["surface.order: 13 is out of range", "lower order"]),
        (surface("enneper", order="2.5"), ["surface.order: 2.5 is not a whole number", "write a whole number"]),
        (surface("enneper", order='"3"'), ["surface.order: '3' is not a whole number", "without quotes"]),
        (surface("enneper", radius="6"), ["surface.radius: 6 is out of range", "at most 5"]),
        (surface("enneper", order="12", radius="5"), ["surface.radius: radius = 5", "at most 1.52 for order 12"]),
        (surface("scherk", extent="1.5708"), ["surface.extent: 1.5708 is out of range", "below 1.570796327"]),
        (surface("scherk", extent="1.6"), ["surface.extent: 1.6 is out of range", "lower extent"]),
    ],
    ids=lambda value: None if isinstance(value, list) else value[11:],
)
def test_surfaces_that_do_not_exist(refused: Callable[..., str], text: str, words: list[str]) -> None:
    refused(text, *words)


@pytest.mark.parametrize(
    ("table", "values", "words"),
    [
        ("network", "cells = 0", "network.cells: 0 is out of range: has to be at least 3"),
        ("network", "cells = -3", "network.cells: -3 is out of range"),
        ("network", "cells = 24.5", "network.cells: 24.5 is not a whole number"),
        ("network", "cells = true", "network.cells: true is not a whole number"),
        ("network", "cells = 1" + "0" * 400, "network.cells: a number of over 40 digits is out of range"),
        ("network", "spacing = 0", "network.spacing: 0 m is out of range"),
        ("network", "spacing = -1.0", "network.spacing: -1 m is out of range"),
        ("network", "spacing = 1e-9", "network.spacing: 1e-09 m is out of range: has to be at least 1e-06"),
        ("network", "spacing = 1e9", "network.spacing: 1000000000 m is out of range"),
        ("network", "spacing = nan", "network.spacing: nan is not a finite number"),
        ("network", "spacing = 3", "network.spacing: spacing = 3 m leaves 2.5 cells across"),
        ("network", "cells = 24\nspacing = 0.5", "cells = 24 and spacing = 0.5 m are both given\n  remedy: keep one"),
        ("network", "angle = 60", "network.angle: angle = 60 deg: only 90 deg is offered\n  remedy: write angle = 90"),
        ("network", 'closing = "closed"', "network.closing: 'closed' is not one of 'open', 'round' or 'adjust'"),
        ("network", "minimum_length = -1", "network.minimum_length: -1 cells is out of range"),
        ("lamella", "height = 0", "lamella.height: 0 m is out of range"),
        ("lamella", "height = 100", "lamella.height: 100 m is out of range: has to be at least 0.0001 and at most 5 m"),
        ("lamella", 'height = "100mm"', "lamella.height: '100mm' is not a number"),
        ("lamella", "height = 1e-300", "lamella.height: 1e-300 m is out of range"),
        ("lamella", "height = 4.4", "lamella.height: the lamellas' circle has a radius of 4.4 m"),
        ("lamella", "thickness = 0.1", "lamella.thickness: thickness = 0.1 m is not below height = 0.1 m"),
        ("lamella", "thickness = 0.2", "lamella.thickness: thickness = 0.2 m is not below height = 0.1 m"),
        ("lamella", "thickness = 1.5", "lamella.thickness: 1.5 m is out of range"),
        ("lamella", "layers = 0", "lamella.layers: 0 is out of range: has to be at least 1 and at most 4"),
        ("lamella", "layers = 2.5", "lamella.layers: 2.5 is not a whole number"),
        ("lamella", "offset = 0.001", "lamella.offset: offset = 0.001 m leaves no gap between layers"),
        ("lamella", "offset = -1", "lamella.offset: -1 m is out of range"),
        ("lamella", 'marks = "arc"', "lamella.marks: 'arc' is not one of 'arc-length' or 'relaxed'"),
        ("lamella", 'material = "1.4031"', "lamella.material: unknown material '1.4031', did you mean '1.4301'?"),
        ("lamella", 'material = "cheese"', "lamella.material: unknown material 'cheese'\n  remedy: use one of 1.4301"),
        ("lamella", "material = 3", "lamella.material: 3 is not text in quotes"),
        ("lamella", 'material = "' + "m" * 9999 + '"', "lamella.material: 9999 characters are too many (limit 100)"),
        ("fabrication", "end_distance = 0", "fabrication.end_distance: 0 m is out of range"),
        ("fabrication", "end_distance = 1e-6", "fabrication.end_distance: end_distance is 1e-06 m"),
        (
            "fabrication",
            "slot_width = 0.09\nend_distance = 0.05",
            "fabrication.end_distance: end_distance is 0.05 m, which leaves less than one",
        ),
        ("fabrication", "slot_width = 0.0001", "fabrication.slot_width: slot_width = 0.0001 m is less than the thick"),
        ("fabrication", "slot_width = -1", "fabrication.slot_width: -1 m is out of range"),
        ("fabrication", "hub_radius = -1", "fabrication.hub_radius: -1 m is out of range"),
        ("fabrication", "gap = -1", "fabrication.gap: -1 m is out of range"),
        (
            "fabrication",
            "gap = 1",
            "fabrication.sheet: the sheet is 2 m wide, nothing of it is left between gaps of 1 m",
        ),
        ("fabrication", "sheet = [0, 1]", "fabrication.sheet: a side of 0 m is out of range"),
        ("fabrication", "sheet = [1]", "fabrication.sheet: [1] has 1 number, needs two"),
        ("fabrication", 'sheet = "A0"', "fabrication.sheet: 'A0' is not a sheet\n  remedy: write two numbers in m"),
        ("fabrication", "sheet = [12000, 2000]", "fabrication.sheet: a side of 12000 m is out of range"),
        ("fabrication", "sheet = [1e-9, 1e-9]", "fabrication.sheet: the sheet is 1e-09 m wide"),
        ("fabrication", "sheet = [nan, 1]", "fabrication.sheet: nan m is out of range"),
        ("materials", "x = 3", "materials.x: 3 is not a table\n  remedy: write [materials.x]"),
    ],
    ids=lambda value: value[:20],
)
def test_tables(refused: Callable[..., str], table: str, values: str, words: str) -> None:
    refused(f"{UNDULOID}[{table}]\n{values}\n", words)


@pytest.mark.parametrize("key", ["surface", "network", "lamella", "fabrication", "materials"])
def test_values_in_a_tables_place(refused: Callable[..., str], key: str) -> None:
    rest = "" if key == "surface" else UNDULOID
    for value, shown in (("3", "3"), ('"x"', "'x'"), ("[1, 2]", "[1, 2]"), ("true", "true")):
        refused(f"{key} = {value}\n{rest}", f"{key}: {shown} is not a table", f"write [{key}]", at="p.toml:1")
    refused(f"{rest}[[{key}]]\na = 1\n", f"{key}: [a table] is not a table", at=f"p.toml:{7 if rest else 1}")


@pytest.mark.parametrize("key", ["density", "youngs_modulus", "shear_modulus", "strength"])
def test_materials_of_ones_own(refused: Callable[..., str], key: str) -> None:
    head = UNDULOID + '[lamella]\nmaterial = "mine"\n[materials.mine]\n'
    missing = "".join(line + "\n" for line in FULL.splitlines() if not line.startswith(key))
    refused(head + missing, f"materials.mine.{key}: missing", f"add {key} = ", at="p.toml:9")
    for value, words in (
        ("0", "is out of range"),
        ("-1.0", "is out of range"),
        ("1e300", "is out of range"),
        ("nan", "is not a finite number"),
        ('"stiff"', "is not a number"),
    ):
        refused(head + f"{key} = {value}\n{missing}", f"materials.mine.{key}: ", words, at="p.toml:10")


def test_units_slip(refused: Callable[..., str]) -> None:
    refused(UNDULOID + "[lamella]\nheight = 100\n", "lengths are in metres, not millimetres", at="p.toml:8")
    refused(
        surface("unduloid", neck_radius="0.0006", bulge_radius="0.0014", height="[0, 0.002]"),
        "lamella.height: the lamellas' circle has a radius of 0.002 m, too little for a strip 0.1 m high",
    )


def test_check_refuses_what_run_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = tmp_path / "p.toml"
    for text, words in (
        (UNDULOID + "[fabrication]\nend_distance = 1e-6\n", "fabrication.end_distance"),
        (UNDULOID + "[lamella]\nheight = 4.4\n", "lamella.height"),
        (UNDULOID + "[network]\ncells = 5000\n", "network.cells"),
        (surface("nodoid", height="[-2, 1]"), "surface.height"),
    ):
        project.write_text(text)
        assert main(["check", str(project)]) == 2
        assert f"{words}: " in capsys.readouterr().err


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
    refused(text, "surface.radius: -2 m", at="p.toml:1")
