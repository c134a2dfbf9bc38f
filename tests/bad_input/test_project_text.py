"""Text that is no project, keys and kinds that are missing or unknown: exit 2, a message, nothing written."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lamella import InputError, parse_project
from lamella.command.main import main

from .projects import FULL, SURFACES, UNDULOID, surface


@pytest.mark.parametrize(
    ("project", "at", "words"),
    [
        ('name = "x"\n[surface\nkind = 3', "p.toml:2", []),
        ("just some words", "p.toml:1", []),
        (b"", "p.toml", []),
        (b"# only a comment\r\n", "p.toml", []),
        (bytes(range(256)) * 10, "p.toml", ["UTF-8", 128]),
        (b"\x00\x00\x01", "p.toml:1", []),
        ('name = "größer"'.encode("latin-1"), "p.toml", ["UTF-8", 10]),
        (UNDULOID.encode("utf-16-le"), "p.toml:1", []),
        (UNDULOID + "height = [0, 1]\n", "p.toml:7", []),
        (UNDULOID + "[surface]\nkind = 'nodoid'\n", "p.toml:7", ["[surface]"]),
        ("a = " + "[" * 3000 + "]" * 3000, "p.toml", []),
        ("a = 1" + "0" * 5000, "p.toml", []),
        ("#" + "x" * 5_000_001, "p.toml", [5, "MB"]),
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
        assert "nothing.toml: " in capsys.readouterr().err
        assert main([command, "folder"]) == 2
        assert "folder" in capsys.readouterr().err
        assert main([command, "file/p.toml"]) == 2
        assert f"file/p.toml cannot be read: {os.strerror(errno.ENOTDIR)}\n" in capsys.readouterr().err
        assert main([command, "x" * 5000]) == 2
        assert os.strerror(errno.ENAMETOOLONG) in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder"]


@pytest.mark.parametrize("kind", SURFACES)
def test_every_missing_key_is_named(refused: Callable[..., str], kind: str) -> None:
    for key in SURFACES[kind]:
        if key in ("order", "scale"):  # these have defaults
            continue
        text = "\n".join(line for line in surface(kind).splitlines() if not line.startswith(key))
        refused(text, f"surface.{key}", f"{key} = ", at="p.toml:1")


def test_missing_surface_and_kind(refused: Callable[..., str]) -> None:
    refused('name = "x"', "[surface]")
    refused("[surface]\nradius = 1\n", "surface.kind", "nodoid,", at="p.toml:1")
    refused("[surface]\n", "surface.kind", "nodoid,", at="p.toml:1")


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("'undoloid'", ["undoloid", "unduloid"]),
        ("'Catenoid'", ["catenoid"]),
        ("'torus'", ["torus"]),
        ("''", []),
        ("'form found'", ["form-found"]),
        ("'form_found'", ["form-found"]),
        ("'Mesh'", ["mesh"]),
        ("'sphere'", []),
        ("'plane'", []),
        ("3", [3]),
        ("true", ["true"]),
        ("[1]", [1]),
        ("{a = 1}", []),
        ("'" + "k" * 1000 + "'", []),
    ],
    ids=lambda value: None if isinstance(value, list) else value[:20],
)
def test_kinds(refused: Callable[..., str], kind: str, words: list[str]) -> None:
    refused(UNDULOID.replace('"unduloid"', kind), "surface.kind", *words, at="p.toml:3")


@pytest.mark.parametrize(
    ("text", "at", "words"),
    [
        ('nam = "x"\n' + surface("cylinder"), "p.toml:1", ["nam", "name"]),
        (UNDULOID + "[netwrok]\n", "p.toml:7", ["netwrok", "network"]),
        (UNDULOID + "neck_radios = 3\n", "p.toml:7", ["surface.neck_radios", "neck_radius", "bulge_radius"]),
        (UNDULOID.replace("neck_radius", "neck-radius"), "p.toml:4", ["surface.neck-radius", "neck_radius"]),
        (UNDULOID.replace("neck_radius", "Neck_Radius"), "p.toml:4", ["surface.Neck_Radius", "neck_radius"]),
        (UNDULOID + "[network]\ncell = 3\n", "p.toml:8", ["network.cell", "cells"]),
        (UNDULOID + "[lamella]\nthicknes = 3\n", "p.toml:8", ["lamella.thicknes", "thickness"]),
        (UNDULOID + "[fabrication]\nhubradius = 3\n", "p.toml:8", ["fabrication.hubradius", "hub_radius"]),
        (UNDULOID + f"[materials.x]\n{FULL}densty = 3\n", "p.toml:12", ["materials.x.densty", "density"]),
        (UNDULOID + "zzz = 3\n", "p.toml:7", ["surface.zzz", "neck_radius", "bulge_radius"]),
        (surface("cylinder") + "neck_radius = 1\n", "p.toml:5", ["surface.neck_radius"]),
        (UNDULOID + "cells = 24\n", "p.toml:7", ["surface.cells", "[network]"]),
        ("thickness = 0.001\n" + UNDULOID, "p.toml:1", ["thickness", "[lamella]"]),
        (UNDULOID + "network.cells = 24\n", "p.toml:7", ["surface.network", "[tables]"]),
        (surface("cylinder") + "name = 'x'\n", "p.toml:5", ["surface.name", "[tables]"]),
        ("k" * 9999 + " = 1\n" + UNDULOID, "p.toml:1", []),
        ('"a\\nb\\u001b[31m" = 1\n' + UNDULOID, "p.toml", ["a?b?[31m"]),
    ],
    ids=lambda value: None if isinstance(value, list) else value[:12],
)
def test_unknown_keys_name_the_nearest(refused: Callable[..., str], text: str, at: str, words: list[str]) -> None:
    refused(text, *words, at=at)


def test_several_errors_are_told_at_once_and_not_all_of_a_thousand(refused: Callable[..., str]) -> None:
    reported = refused(UNDULOID.replace("1.6", "-1").replace("2.8", '"2"'), at="p.toml:4", lines=4)
    assert [line.split(": ")[0] for line in reported.splitlines()[::2]] == ["lamella", "p.toml:5"]
    reported = refused(UNDULOID + "".join(f"k{i} = 1\n" for i in range(1000)), 994, at="p.toml:7", lines=13)
    reported = refused(UNDULOID + "".join(f"k{i} = 1\n" for i in range(7)), 1, at="p.toml:7", lines=13)


@pytest.mark.parametrize("values", [UNDULOID, "", b"x", None, 3, ["surface"], Path("p.toml")], ids=repr)
def test_projects_that_are_no_dictionary(values: Any) -> None:
    with pytest.raises(InputError) as error:
        parse_project(values, source="p.toml")
    assert type(values).__name__ in error.value.message
    assert error.value.where == "p.toml"


@pytest.mark.parametrize(
    "values",
    [
        {1: 2},
        {None: {}},
        {"surface": {"kind": "catenoid", 1: 2}},
        {"surface": {"kind": "form-found", "boundary": [{3: 4}]}},
    ],
    ids=repr,
)
def test_keys_that_are_no_text(values: Any) -> None:
    with pytest.raises(InputError) as error:
        parse_project(values)
    assert "remedy: " in str(error.value)
