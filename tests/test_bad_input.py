"""Bad input: exit 2, a message with what, value, limit and remedy, no traceback, nothing written."""

from __future__ import annotations

import contextlib
import hashlib
import re
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from lamella import InputError, read_project
from lamella.cli import main
from lamella.files.own import write_summary
from lamella.network.density import BYTES_FIXED, BYTES_PER_NODE
from lamella.pipeline import plan

UNDULOID = """name = "x"
[surface]
kind = "unduloid"
neck_radius = 1.6
bulge_radius = 2.8
height = [-2.0, 2.0]
"""
SURFACES = {
    "unduloid": {"neck_radius": "1.6", "bulge_radius": "2.8", "height": "[-2.0, 2.0]"},
    "nodoid": {"neck_radius": "3.0", "bulge_radius": "9.0", "height": "[-1.5, 1.5]"},
    "catenoid": {"neck_radius": "2.0", "height": "[-2.0, 2.5]"},
    "cylinder": {"radius": "2.0", "height": "[0.0, 4.0]"},
    "helicoid": {"pitch": "4.0", "inner_radius": "1.0", "outer_radius": "4.0", "turns": "1.25"},
    "enneper": {"order": "3", "radius": "0.9", "scale": "4.0"},
    "scherk": {"extent": "1.25", "scale": "3.0"},
}
FULL = "density = 7850\nyoungs_modulus = 210e9\nshear_modulus = 81e9\nstrength = 420e6\n"


def surface(kind: str, /, **values: str) -> str:
    table = SURFACES[kind] | values
    return f'[surface]\nkind = "{kind}"\n' + "".join(f"{key} = {value}\n" for key, value in table.items())


def fingerprint(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture
def refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Run a project that has to be refused over an earlier run's folder; returns the message."""
    monkeypatch.chdir(tmp_path)
    earlier = tmp_path / "out" / "p"
    earlier.mkdir(parents=True)
    write_summary(earlier, {"name": "an earlier run"})
    before = fingerprint(tmp_path)

    def refused(project: str | bytes, *words: str, at: str = "", lines: int = 2) -> str:
        content = project if isinstance(project, bytes) else project.encode()
        (tmp_path / "p.toml").write_bytes(content)
        start = time.perf_counter()
        code = main(["run", "p.toml"])
        seconds = time.perf_counter() - start
        told = capsys.readouterr()
        errors = told.err[told.err.index("lamella: ") :]
        assert code == 2, told.err
        assert seconds < 60
        assert re.match(f"lamella: {at or 'p.toml(:[0-9]+)?'}: ", errors), errors
        place = re.match(r"lamella: p.toml:(\d+): ([a-z_.]+): ", errors)
        if place and not at:
            # the line is that of the key, or of its table
            line, leaf = content.splitlines()[int(place[1]) - 1].decode(), place[2].rpartition(".")[2]
            assert leaf in line or f"{leaf} = " not in content.decode(), errors
        assert "Traceback" not in told.err
        assert told.out == ""
        for word in words:
            assert word in errors, f"{word!r} not in {errors}"
        assert errors.count("remedy: ") >= 1, errors
        assert errors.count("\n") <= lines, errors
        assert max(map(len, errors.splitlines())) <= 300, errors
        (tmp_path / "p.toml").unlink()
        assert fingerprint(tmp_path) == before
        assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["p"]
        return errors

    return refused


@pytest.mark.parametrize(
    ("project", "at", "words"),
    [
        ('name = "x"\n[surface\nkind = 3', "p.toml:2", ["not valid TOML", "lamella new"]),
        ("just some words", "p.toml:1", ["not valid TOML"]),
        (b"", "p.toml", ["empty", "lamella new unduloid"]),
        (b"# only a comment\r\n", "p.toml", ["empty"]),
        (bytes(range(256)) * 10, "p.toml", ["not a text file in UTF-8 (byte 128)", "TOML text"]),
        (b"\x00\x00\x01", "p.toml:1", ["not valid TOML"]),
        ('name = "größer"'.encode("latin-1"), "p.toml", ["not a text file in UTF-8 (byte 10)", "saved as UTF-8"]),
        (UNDULOID.encode("utf-16-le"), "p.toml:1", ["not valid TOML"]),
        (UNDULOID + "height = [0, 1]\n", "p.toml:7", ["the same key is there twice", "keep one"]),
        (UNDULOID + "[surface]\nkind = 'nodoid'\n", "p.toml:7", ["the table [surface] is there twice", "keep one"]),
        ("a = " + "[" * 3000 + "]" * 3000, "p.toml", ["nested too deep"]),
        ("a = 1" + "0" * 5000, "p.toml", ["digits"]),
        ("#" + "x" * 5_000_001, "p.toml", ["more than 5 MB"]),
    ],
    ids=lambda value: None if isinstance(value, list) else str(value)[:24],
)
def test_files_that_are_no_project(
    refused: Callable[..., str], project: str | bytes, at: str, words: list[str]
) -> None:
    refused(project, *words, at=at)


def test_missing_file_and_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    for command in ("run", "check"):
        assert main([command, "nothing.toml"]) == 2
        assert "nothing.toml: no such file\n  remedy: check the path" in capsys.readouterr().err
        assert main([command, "folder"]) == 2
        assert "folder is a folder, not a project file\n  remedy: name the .toml file" in capsys.readouterr().err
        assert main([command, "file/p.toml"]) == 2
        assert "file/p.toml cannot be read: Not a directory\n  remedy: " in capsys.readouterr().err
        assert main([command, "x" * 5000]) == 2
        assert "File name too long" in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder"]


@pytest.mark.parametrize("kind", SURFACES)
def test_every_missing_key_is_named(refused: Callable[..., str], kind: str) -> None:
    for key in SURFACES[kind]:
        if key in ("order", "scale"):  # these have defaults
            continue
        text = "\n".join(line for line in surface(kind).splitlines() if not line.startswith(key))
        refused(text, f"surface.{key}: missing: ", f"add {key} = ", at="p.toml:1")


def test_missing_surface_and_kind(refused: Callable[..., str]) -> None:
    refused('name = "x"', "surface: missing: which surface", "add a table [surface]")
    refused("[surface]\nradius = 1\n", "surface.kind: missing", "unduloid, nodoid", at="p.toml:1")
    refused("[surface]\n", "surface.kind: missing", "unduloid, nodoid", at="p.toml:1")


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("'undoloid'", ["unknown kind 'undoloid', did you mean 'unduloid'?"]),
        ("'Catenoid'", ["did you mean 'catenoid'?"]),
        ("'torus'", ["unknown kind 'torus'"]),
        ("''", ["unknown kind ''"]),
        ("'form found'", ["did you mean 'form-found'?"]),
        ("'form_found'", ["did you mean 'form-found'?"]),
        ("'Mesh'", ["did you mean 'mesh'?"]),
        ("'sphere'", ["every point is umbilic", "no net"]),
        ("'plane'", ["every point is umbilic", "no net"]),
        ("3", ["3 is not text in quotes"]),
        ("true", ["true is not text in quotes"]),
        ("[1]", ["[1] is not text in quotes"]),
        ("{a = 1}", ["a table is not text in quotes"]),
        ("'" + "k" * 1000 + "'", ["unknown kind 'kkk", "..."]),
    ],
    ids=lambda value: None if isinstance(value, list) else value[:20],
)
def test_kinds(refused: Callable[..., str], kind: str, words: list[str]) -> None:
    refused(
        UNDULOID.replace('"unduloid"', kind), "surface.kind: ", "choose one of unduloid, nodoid", *words, at="p.toml:3"
    )


@pytest.mark.parametrize(
    ("text", "at", "words"),
    [
        ('nam = "x"\n' + surface("cylinder"), "p.toml:1", ["nam: unknown key, did you mean 'name'?", "write name"]),
        (UNDULOID + "[netwrok]\n", "p.toml:7", ["netwrok: unknown key, did you mean 'network'?"]),
        (UNDULOID + "neck_radios = 3\n", "p.toml:7", ["surface.neck_radios", "'neck_radius'?", "bulge_radius, height"]),
        (UNDULOID.replace("neck_radius", "neck-radius"), "p.toml:4", ["surface.neck-radius", "'neck_radius'?"]),
        (UNDULOID.replace("neck_radius", "Neck_Radius"), "p.toml:4", ["surface.Neck_Radius", "'neck_radius'?"]),
        (UNDULOID + "[network]\ncell = 3\n", "p.toml:8", ["network.cell: ", "did you mean 'cells'?"]),
        (UNDULOID + "[lamella]\nthicknes = 3\n", "p.toml:8", ["lamella.thicknes: ", "did you mean 'thickness'?"]),
        (UNDULOID + "[fabrication]\nhubradius = 3\n", "p.toml:8", ["fabrication.hubradius: ", "'hub_radius'?"]),
        (UNDULOID + f"[materials.x]\n{FULL}densty = 3\n", "p.toml:12", ["materials.x.densty", "'density'?"]),
        (UNDULOID + "zzz = 3\n", "p.toml:7", ["surface.zzz: unknown key\n", "kind, neck_radius, bulge_radius, height"]),
        (surface("cylinder") + "neck_radius = 1\n", "p.toml:5", ["surface.neck_radius: unknown key"]),
        (UNDULOID + "cells = 24\n", "p.toml:7", ["surface.cells: ", "belongs in the table [network]"]),
        ("thickness = 0.001\n" + UNDULOID, "p.toml:1", ["thickness: ", "belongs in the table [lamella]"]),
        (UNDULOID + "network.cells = 24\n", "p.toml:7", ["surface.network: ", "above all [tables]"]),
        (surface("cylinder") + "name = 'x'\n", "p.toml:5", ["surface.name: ", "write name above all [tables]"]),
        ("k" * 9999 + " = 1\n" + UNDULOID, "p.toml:1", ["kkk...: unknown key"]),
        ('"a\\nb\\u001b[31m" = 1\n' + UNDULOID, "p.toml", ["a?b?[31m: unknown key"]),
    ],
    ids=lambda value: None if isinstance(value, list) else value[:12],
)
def test_unknown_keys_name_the_nearest(refused: Callable[..., str], text: str, at: str, words: list[str]) -> None:
    refused(text, *words, at=at)


def test_several_errors_are_told_at_once_and_not_all_of_a_thousand(refused: Callable[..., str]) -> None:
    told = refused(UNDULOID.replace("1.6", "-1").replace("2.8", '"2"'), at="p.toml:4", lines=4)
    assert [line.split(": ")[0] for line in told.splitlines()[::2]] == ["lamella", "p.toml:5"]
    told = refused(
        UNDULOID + "".join(f"k{i} = 1\n" for i in range(1000)), "and 994 more errors", at="p.toml:7", lines=13
    )
    told = refused(UNDULOID + "".join(f"k{i} = 1\n" for i in range(7)), "and 1 more error\n", at="p.toml:7", lines=13)


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


@pytest.mark.parametrize("cells", [1_000, 100_000, 10**9, 10**12])
def test_absurd_counts_are_refused_before_any_work(refused: Callable[..., str], cells: int) -> None:
    tracemalloc.start()
    told = refused(
        f"{UNDULOID}[network]\ncells = {cells}\n",
        f"cells = {cells} would make about ",
        "(limit 500,000 nodes)",
        at="p.toml:8",
    )
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6
    nodes, memory = re.search(r"about ([\d,.e+]+) nodes and take about ([\d,.e+]+) GB", told).groups()  # type: ignore[union-attr]
    assert float(nodes.replace(",", "")) == pytest.approx(0.7589 * cells**2, rel=0.05)
    assert float(memory.replace(",", "")) == pytest.approx(
        (BYTES_FIXED + BYTES_PER_NODE * float(nodes.replace(",", ""))) / 1e9, rel=0.01, abs=0.51
    )
    most = int(re.search(r"remedy: at most (\d+) cells fit", told)[1])  # type: ignore[index]
    assert most == pytest.approx(811, rel=0.02)


def test_the_limit_named_is_the_limit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = tmp_path / "p.toml"
    for key, value in (("cells", "5000"), ("spacing", "0.001")):
        capsys.readouterr()
        project.write_text(f"{UNDULOID}[network]\n{key} = {value}\n")
        assert main(["check", str(project)]) == 2
        named = float(re.search(r"remedy: .*?at (?:most|least) ([\d.]+)", capsys.readouterr().err)[1])  # type: ignore[index]
        for given, code in (
            (named * (0.99 if key == "cells" else 1.01), 0),
            (named * (1.03 if key == "cells" else 0.97), 2),
        ):
            project.write_text(f"{UNDULOID}[network]\n{key} = {int(given) if key == 'cells' else given}\n")
            assert main(["check", str(project)]) == code, (key, given, capsys.readouterr().err)


@pytest.mark.parametrize("kind", ["unduloid", "cylinder"])
def test_very_long_ranges_are_refused_with_an_estimate(refused: Callable[..., str], kind: str) -> None:
    refused(surface(kind, height="[0, 1e6]"), "network.cells: ", "nodes and take about", "(limit 500,000 nodes)")


def test_units_slip(refused: Callable[..., str]) -> None:
    refused(UNDULOID + "[lamella]\nheight = 100\n", "lengths are in metres, not millimetres", at="p.toml:8")
    refused(
        surface("unduloid", neck_radius="0.0006", bulge_radius="0.0014", height="[0, 0.002]"),
        "lamella.height: the lamellas' circle has a radius of 0.002 m, too little for a strip 0.1 m high",
    )


def test_a_surface_that_runs_to_infinity(refused: Callable[..., str]) -> None:
    """Arc lengths that cannot be measured are refused, not told wrong."""
    refused(surface("scherk", extent="1.57079632"), "stretch too much for their length to be measured", "raise network")


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


@pytest.mark.parametrize(
    "text",
    [
        surface("unduloid", height="[0, 500]") + "[network]\nspacing = 2.0\n",
        surface("catenoid", neck_radius="3.0", height="[0, 0.125]") + "[network]\nspacing = 1.0\n",
    ],
    ids=["long", "narrow"],
)
def test_spacing_on_long_and_narrow_surfaces(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str) -> None:
    (tmp_path / "p.toml").write_text(text)
    assert main(["check", str(tmp_path / "p.toml")]) in (0, 2)
    project = read_project(tmp_path / "p.toml")
    tracemalloc.start()
    # the density alone
    with contextlib.suppress(InputError):
        plan(project)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6
