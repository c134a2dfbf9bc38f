"""Names of users and of files in every output: without control characters, and none turns the direction of writing."""

from __future__ import annotations

import csv
import io
import json
import os
import tomllib
import unicodedata
from collections.abc import Iterator
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import rhino3dm

from lamella import parse_project, quad_mesh, read_project
from lamella.base.errors import InputError
from lamella.base.wording import one_line, readable
from lamella.command.main import main
from lamella.files.quad_mesh_files import QuadFile, quad_mesh_bytes
from lamella.files.write.text import csv_comment
from lamella.projection.mesh_figures import mesh_figures

BAD = "".join(
    ["\x1b[2J", "\x07", "\x00", "\x7f", "\x85", "\x9b", "\u202e", "\u2066", "\u200f", "\u2028", "\ufeff", "\U000e0041"]
)
EVIL = f'hall {BAD} </script><b> ,=HYPERLINK("x");=1+1'
HARMLESS = "Gewölbe 半殻 Ω–1 “x”"


def toml_text(text: str) -> str:
    return '"' + "".join(f"\\U{ord(c):08x}" for c in text) + '"'


def texts(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from (key, *texts(item))
    elif isinstance(value, list):
        for item in value:
            yield from texts(item)
    elif isinstance(value, str):
        yield value


def seen(text: str) -> bool:
    """Whether nothing of a text is hidden, but for line ends and tabs."""
    return all(unicodedata.category(c) not in ("Cc", "Cf", "Zl", "Zp", "Cs") or c in "\n\r\t" for c in text)


def test_words() -> None:
    assert seen(one_line(BAD))
    assert seen(readable(BAD))
    assert one_line(f"a\n{BAD}\tb") == "a [2J b"
    assert readable("a\n    b\x1b") == "a\n    b?"
    assert readable("gr\udcf6\udcdfer") == "gr\udcf6\udcdfer"  # bytes of a file name, which streams write as escapes
    assert one_line(HARMLESS) == readable(HARMLESS) == HARMLESS
    assert csv_comment('a,b;c"d|e\tf') == "a b c d e f"


def test_messages_hide_nothing() -> None:
    error = InputError(f"{BAD} is wrong", f"mend {BAD}", f"p.toml: {BAD}")
    assert seen(str(error))
    assert "is wrong" in error.message


@pytest.fixture
def evil_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.toml").write_text(
        f'name = {toml_text(EVIL)}\n[surface]\nkind = "unduloid"\nneck_radius = 1.6\nbulge_radius = 2.8\n'
        f"height = [-1.0, 1.0]\n[network]\ncells = 8\n[lamella]\nmaterial = {toml_text(EVIL)}\n"
        f"[materials.{toml_text(EVIL)}]\n"
        "density = 7850\nyoungs_modulus = 210e9\nshear_modulus = 81e9\nstrength = 420e6\n"
    )
    assert main(["run", "p.toml"]) == 0
    return tmp_path / "out" / "p"


def test_every_file_of_a_run(evil_run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = capsys.readouterr()
    assert seen(told.out + told.err)
    checked = set()
    for path in sorted(evil_run.rglob("*")):
        if path.suffix == ".json":
            assert all(seen(text) for text in texts(json.loads(path.read_bytes())))
            assert "hall [2J" in path.read_text("utf-8")
        elif path.suffix in (".obj", ".html", ".csv", ".dxf", ".toml"):
            text = path.read_bytes().decode("utf-8")
            assert seen(text), path
            assert "hall" in text
        elif path.suffix == ".ply":
            assert seen(path.read_bytes().partition(b"end_header")[0].decode("utf-8"))
        elif path.suffix == ".3dm":
            model = rhino3dm.File3dm.Read(str(path))
            assert seen(model.ApplicationDetails)
            strings = [model.Strings[k] for k in range(len(model.Strings))]
            assert any("hall" in str(text) for text in strings)
            assert all(seen(str(text)) for text in strings)
            assert all(seen(str(item.Attributes.Name or "")) for item in model.Objects)
        checked.add(path.suffix)
    assert checked >= {".json", ".obj", ".html", ".csv", ".dxf", ".toml", ".ply", ".3dm"}


def test_a_report_has_no_markup_of_a_name(evil_run: Path) -> None:
    page = (evil_run / "report.html").read_text("utf-8")
    assert "</script><b>" not in page
    assert "<b>" not in page.partition("<script")[0]


@pytest.mark.parametrize("name", ["nodes.csv", "fabrication/schedule.csv"])
def test_tables_have_no_formulas(evil_run: Path, name: str) -> None:
    text = (evil_run / name).read_text("utf-8")
    for separator in ",;\t":
        for row in csv.reader(io.StringIO(text), delimiter=separator):
            cells = [cell.strip() for cell in row]
            # negative numbers begin like formulas, and are none
            assert not any(cell[:1] in ("=", "+", "@", "|") for cell in cells)
    assert len(next(csv.reader(io.StringIO(text)))) == 1


def test_the_copy_of_a_project_names_the_same(evil_run: Path, tmp_path: Path) -> None:
    copy = read_project(evil_run / "project.toml")
    assert copy.name == copy.lamella.material == one_line(EVIL)
    assert list(copy.materials) == [one_line(EVIL)]


def test_layers_and_files_keep_their_names() -> None:
    """They have to be found: what cannot be seen of them is written as an escape."""
    file, layer = f"a{BAD.replace(chr(0), '')}.dxf", f'{BAD}\\ " layer'
    loop = {"name": EVIL[:99], "file": file, "layer": layer, "id": BAD}
    project = parse_project({"surface": {"kind": "form-found", "boundary": [loop]}})
    written = project.to_toml()
    assert seen(written)
    (read,) = tomllib.loads(written)["surface"]["boundary"]
    assert (read["file"], read["layer"], read["id"]) == (file, layer, BAD)
    assert read["name"] == one_line(EVIL[:99])


def test_names_of_a_drawing_in_messages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    drawing = ezdxf.new()
    drawing.modelspace().add_circle((0, 0), 3, {"layer": "a\\U+202E\\U+001B[2J"})
    drawing.modelspace().add_circle((0, 0), 1, {"layer": "b\u202e"})
    drawing.saveas("a.dxf")
    Path("p.toml").write_text('[surface]\nkind = "form-found"\n[[surface.boundary]]\nfile = "a.dxf"\nunit = "m"\n')
    assert main(["run", "p.toml"]) == 2
    told = capsys.readouterr().err
    assert "2 closed curves" in told
    assert seen(told)


@pytest.mark.skipif(os.name == "nt", reason="no such file names there")
def test_names_of_meshes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    i, j = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(5), np.arange(5), indexing="ij"))
    corner = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    mesh = quad_mesh(np.column_stack([i, j, 0.1 * i * j]), np.stack([corner, corner + 5, corner + 6, corner + 1], 1))
    figures = mesh_figures(mesh)
    path = tmp_path / f"net{BAD.replace(chr(0), '')}.obj"
    path.write_bytes(quad_mesh_bytes(".obj", mesh, figures, like=QuadFile(mesh), name=EVIL, version="0"))
    assert seen(path.read_text("utf-8"))
    for suffix in (".obj", ".ply", ".json", ".3dm"):
        command = [
            "optimise",
            str(path),
            "--as",
            "asymptotic",
            "--iterations",
            "1",
            "--out",
            str(tmp_path / f"o{suffix}"),
        ]
        assert main([*command, "--json", str(tmp_path / "f.json")]) in (0, 1)
        told = capsys.readouterr()
        assert seen(told.out + told.err)
        assert all(seen(text) for text in texts(json.loads((tmp_path / "f.json").read_bytes())))
        if suffix == ".json":
            assert all(seen(text) for text in texts(json.loads((tmp_path / "o.json").read_bytes())))
        if suffix == ".3dm":
            model = rhino3dm.File3dm.Read(str(tmp_path / "o.3dm"))
            assert seen(model.ApplicationDetails)
            assert all(seen(str(item.Attributes.Name)) for item in model.Objects)
