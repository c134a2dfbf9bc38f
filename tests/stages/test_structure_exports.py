"""Files of the stage "structure" beside results.json: what is in them for strips, edge beams and cables."""

from __future__ import annotations

import ast
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lamella import compute, parse_project
from lamella.stages.structure.export_remarks import export_remarks
from lamella.stages.structure.stage import StructureStage, _for_programs
from lamella.structure.export.opensees import fine_elements
from lamella.structure.model.model import divided
from stages.csv_rows import rows

PROJECT: dict[str, Any] = {
    "name": "patch",
    "surface": {"kind": "enneper", "order": 2, "radius": 0.6, "scale": 3.0},
    "network": {"spacing": 0.9},
    "lamella": {"material": "S355"},
    "joint": {},
    "cables": {"prestress": 200.0},
    "edge_beam": {"section": "tube 60.3x3.2"},
    "structure": {"elements": 1, "modes": 0},
    "support": [{"boundary": "rim"}],
    "load": [{"name": "snow", "kind": "area", "value": 100.0, "per": "plan"}],
}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Path]:
    results = compute(parse_project(PROJECT))
    folder = tmp_path_factory.mktemp("run")
    (folder / "structure").mkdir()
    out = results.outputs["structure"]
    # those of this stage alone
    up: Any = SimpleNamespace(project=results.project, surface=results.surface)
    for file in StructureStage().files(out, up):
        file.write(folder / file.name)
    return out.analysis, folder / "structure"


def test_strips_and_edge_beams_have_rows_for_every_end(run: tuple[Any, Path]) -> None:
    analysis, folder = run
    found = rows(folder / "elements.csv")
    beams = len(analysis.model.structure.beams)
    strips = 2 * len(analysis.model.lines.length)
    assert 0 < strips < 2 * beams
    assert len(found) == 2 * 2 * beams
    edge = [row for row in found if row["lamella"] == "edge beam"]
    assert len(edge) == 2 * (2 * beams - strips)
    assert all(row["von_mises_MPa"] == "" and float(row["utilisation"]) > 0 for row in edge)
    assert {row["lamella"] for row in found} - {"edge beam"} == set(analysis.model.lamellas.network.ids)
    largest = max(float(row["utilisation"]) for row in found if row["case"] == "snow")
    assert largest == pytest.approx(analysis.cases[1].utilisation_max, abs=1e-6)


def test_reactions_in_the_table_are_the_load(run: tuple[Any, Path]) -> None:
    analysis, folder = run
    snow = [row for row in rows(folder / "supports.csv") if row["case"] == "snow"]
    total = np.array([[float(row[key]) for key in ("Fx_N", "Fy_N", "Fz_N")] for row in snow]).sum(0)
    assert total == pytest.approx(-analysis.cases[1].load_total, abs=0.01)
    points = analysis.model.lamellas.network.node_points
    for row in snow:
        place = [float(row[key]) for key in ("x_m", "y_m", "z_m")]
        assert place == pytest.approx(points[int(row["node"])], abs=1e-6)


def test_cables_and_curvatures(run: tuple[Any, Path]) -> None:
    analysis, folder = run
    snow = [row for row in rows(folder / "cables.csv") if row["case"] == "snow"]
    assert [float(row["force_N"]) for row in snow] == pytest.approx(analysis.cases[1].cable_forces.tolist(), abs=1e-4)
    assert sum(row["slack"] == "slack" for row in snow) == analysis.cases[1].slack
    assert len(rows(folder / "curvatures.csv")) == len(analysis.model.lines.length)


def test_the_script_has_fibres_for_strips_alone(run: tuple[Any, Path]) -> None:
    analysis, folder = run
    parts = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in ast.parse((folder / "opensees.py").read_text("utf-8")).body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    # shorter elements than those of the analysis
    times = fine_elements(analysis.model) // analysis.model.rules.elements
    assert times > 4
    strips = times * len(analysis.model.lines.length)
    assert len(parts["BEAMS"]) == times * len(analysis.model.structure.beams)
    assert len(parts["FIBRES"]) == 2 * strips
    # a slot at each crossing that an element ends at, a hinge at both its ends
    slotted = int(divided(analysis.model, times).lines.crossed.any(1).sum())
    assert slotted == int(analysis.model.lines.crossed.sum()) > 0
    assert len(parts["HINGES"]) == 2 * slotted
    assert len(parts["CABLES"]) == len(analysis.model.structure.cables)
    assert [case[0] for case in parts["CASES"]] == ["residual", "snow"]


def test_a_run_says_what_files_leave_out() -> None:
    warm = {"name": "summer", "kind": "temperature", "value": 30.0}
    project = parse_project(PROJECT | {"load": [*PROJECT["load"], warm]})
    texts = [remark.text for remark in export_remarks(project)]
    assert ["saf.xlsx" in texts[0], "opensees.py" in texts[1], "summer" in texts[1], len(texts)] == [
        True,
        True,
        True,
        2,
    ]
    none = PROJECT | {"structure": {"exports": []}}
    assert list(export_remarks(parse_project(none))) == []


def test_only_files_that_are_asked_for_are_written(run: tuple[Any, Path]) -> None:
    analysis, folder = run
    assert {"opensees.py", "saf.xlsx"} <= {path.name for path in folder.iterdir()}
    project = parse_project(PROJECT | {"structure": {"exports": ["saf"]}})
    names = [file.name for file in _for_programs(analysis, project, {})]
    assert names == ["structure/saf.xlsx"]
