"""`lamella new`: a project of every kind runs as it is, without a warning."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from lamella import compute, parse_project, read_project
from lamella.command.main import main
from lamella.project.starter import starter
from lamella.project.surface_tables import SURFACE_TABLES


@pytest.mark.parametrize("kind", SURFACE_TABLES)
def test_every_starter_runs_without_a_warning(kind: str, tmp_path: Path) -> None:
    """`lamella new KIND` writes projects that run as they are."""
    file = tmp_path / f"{kind}.toml"
    assert main(["new", kind, "--out", str(file)]) == 0
    results = compute(read_project(file), folder=tmp_path)
    assert results.summary["warnings"] == []
    assert results.parts is not None
    assert 0 < results.summary["lamellas"]["utilisation_max"] < 1


def test_the_mesh_of_a_starter_is_the_catenoid_it_says(tmp_path: Path) -> None:
    assert main(["new", "mesh", "--out", str(tmp_path / "hall.toml")]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"hall.toml", "hall.obj"}
    results = compute(read_project(tmp_path / "hall.toml"), until="surface", folder=tmp_path)
    figures = results.summary["surface"]
    assert abs(figures["mean_curvature"]) < 1e-4
    # at the neck k1 = -k2 = 1 / 2 m
    assert figures["k1_max"] == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize("there", ["hall.toml", "hall.obj"])
def test_nothing_is_overwritten(there: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / there).write_text("mine")
    assert main(["new", "mesh", "--out", str(tmp_path / "hall.toml")]) == 2
    assert there in capsys.readouterr().err
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {there: "mine"}


def test_examples_of_tables_are_read_and_lines_have_no_gaps() -> None:
    text = starter("catenoid", "hall")
    own = text.replace("# [erection]", "[erection]").replace("# lifting =", "lifting =")
    table = parse_project(tomllib.loads(own)).erection
    assert table is not None
    assert table.lifting is not None
    assert table.lifting.points == (2, 3, 4)
    comments = [line for line in text.splitlines() if re.match(r"# \S", line)]
    assert not [line for line in comments if re.search(r"\S  +\S", line) and "lamella run" not in line]
    assert not [line for line in comments if re.fullmatch(r"# \[[^\]]+\]", line) and line[3:-1] in UNITS]


UNITS = {"m", "mm", "deg", "1/m", "Pa", "N", "N/m", "N m/rad", "kg", "cells", "s"}
