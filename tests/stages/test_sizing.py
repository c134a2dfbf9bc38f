"""A project with [sizing]: figures, and a row a lamella."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from lamella import compute, parse_project, write
from lamella.stages.lamellas.scene import lamellas_scene
from lamella.stages.lamellas.sizing_scene import sizing_quantities
from lamella.stages.network.scene import thinned
from lamella.view.scene.curves import Curves
from lamella.view.scene.layer import StripsLayer


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


def test_the_view_shows_where_the_limit_is_near() -> None:
    """Colours by the share of the limit: 1 where a lamella as thick or as high as its largest measure would be."""
    surface = {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.6, 0.8]}
    results = compute(
        parse_project({"surface": surface, "network": {"cells": 8}, "sizing": {"safety": 1.5}}), until="lamellas"
    )
    out = results.outputs["lamellas"]
    kept = thinned(out.network)
    along, thick, high = sizing_quantities(out.sizing, out.lamellas, kept)
    owner = np.repeat(np.arange(len(out.network.ids)), np.diff(out.network.sample_offsets))[kept.samples]
    assert along.high == thick.high == high.high == 1.0
    np.testing.assert_allclose(along.values, 1.5 * out.lamellas.utilisation[kept.samples], rtol=1e-12)
    # thinner strips than a sixty-fourth were not tried
    thickness = np.maximum(out.sizing.thickness, 0.0015 / 64)
    np.testing.assert_allclose(thick.values, 0.0015 / thickness[owner], rtol=1e-12)
    np.testing.assert_allclose(high.values, 0.1 / np.maximum(out.sizing.height, 0.1 / 64)[owner], rtol=1e-12)
    # a lamella is beyond its largest thickness where, and only where, it is over the limit somewhere
    most = np.maximum.reduceat(along.values, kept.offsets[:-1])
    assert ((thick.values[kept.offsets[:-1]] > 1) == (most > 1)).all()
    shown = list(lamellas_scene(out.lamellas, out.sizing))
    strips = [one for one in shown if isinstance(one, StripsLayer)]
    assert all({"limit", "limit_thickness", "limit_height"} <= {q.key for q in one.quantities} for one in strips)
    (curves,) = (one for one in shown if isinstance(one, Curves))
    assert [fact.label for fact in curves.facts][-3:] == ["Largest thickness", "Largest height", "Largest offset"]
    assert curves.plots[-1].series[0].values.max() == pytest.approx(along.values.max())
