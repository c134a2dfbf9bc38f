"""A project with [sizing]: figures, and a row a lamella."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from lamella import compute, parse_project, write


def test_the_figures_are_the_least_of_the_list(tmp_path: Path) -> None:
    surface = {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.6, 0.8]}
    project = {"surface": surface, "network": {"cells": 8}, "sizing": {"safety": 1.5}}
    results = compute(parse_project(project), until="lamellas")
    write(results, tmp_path / "run")
    told = results.summary["lamellas"]["sizing"]
    with (tmp_path / "run" / "sizing.csv").open(encoding="utf-8", newline="") as file:
        file.readline()
        rows = list(csv.DictReader(file))
    assert [row["lamella"] for row in rows] == list(results.network.ids)
    assert told["safety"] == 1.5
    for measure in ("thickness", "height", "offset"):
        column = {row["lamella"]: float(row[f"{measure}_max_mm"]) for row in rows}
        assert min(column.values()) == pytest.approx(1e3 * told[measure]["largest"], rel=1e-4)
        assert column[told[measure]["lamella"]] == min(column.values())
    assert max(float(row["utilisation"]) for row in rows) == pytest.approx(
        results.summary["lamellas"]["utilisation_max"], rel=1e-5
    )
