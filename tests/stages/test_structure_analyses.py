"""What the tables below [structure] ask for: files, figures, and what is refused."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError, compute
from lamella.stages.all_stages import STAGES
from lamella.stages.check import check_project
from lamella.stages.report import report_data
from stages.test_structure_stage import SNOW, WEIGHT, project

CONSTRUCTION = ["bent", "joints locked", "cables on", "props away", "loads on"]
DRIVEN = {"case": "snow", "near": [0, 0, 0], "by": 0.005, "steps": 2}
SUMMER = {"name": "summer", "kind": "temperature", "value": 30.0}
TABLE: dict[str, Any] = {"elements": 1, "modes": 1}
(STRUCTURE,) = (stage for stage in STAGES if stage.name == "structure")
WITH = {"joint": {}, "cables": {"prestress": 200.0}}


def written(results: lamella.Results, folder: Path) -> Path:
    """The files of this stage alone."""
    for file in STRUCTURE.files(results.outputs["structure"], results.upstream):
        (folder / file.name).parent.mkdir(exist_ok=True, parents=True)
        file.write(folder / file.name)
    return folder / "structure"


def rows(path: Path) -> list[dict[str, str]]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def test_paths_and_construction(tmp_path: Path) -> None:
    table = TABLE | {"steps": 2, "construction": CONSTRUCTION, "displacement": DRIVEN}
    table |= {"failure": {"cases": ["snow"], "factor_max": 3.0}}
    results = compute(project(structure=table, **WITH))
    folder, figures = written(results, tmp_path), results.summary["structure"]
    stages = rows(folder / "construction.csv")
    assert [row["stage"] for row in stages] == CONSTRUCTION[:-1] == [one["name"] for one in figures["construction"]]
    assert float(stages[0]["displacement_mm"]) == 0
    assert float(stages[-1]["displacement_mm"]) == pytest.approx(1e3 * figures["spring_back"], rel=1e-5)
    assert [float(row["prop_force_max_N"]) > 0 for row in stages] == [True, True, True, False]
    assert float(stages[2]["cable_force_max_N"]) > 300
    (failure,) = rows(folder / "failure.csv")
    (told,) = figures["failure"]
    assert (failure["case"], told["limit_point"], failure["limit_point"]) == ("snow", None, "")
    assert float(failure["followed_to"]) == pytest.approx(told["followed_to"], rel=1e-5)
    path = rows(folder / "paths.csv")
    driven = [row for row in path if row["analysis"].startswith("displacement")]
    assert float(driven[-1]["driven_mm"]) == pytest.approx(5)
    followed = [row for row in path if row["analysis"].startswith("load factor")]
    assert 3 <= float(followed[-1]["load_factor"]) == pytest.approx(float(failure["followed_to"]), rel=1e-5)
    # of a case in two steps the first is kept
    case = results.outputs["structure"].analysis.cases[2]
    assert [state.factor for state in case.before] == [0.5]
    frames = {shown.name: shown for shown in STRUCTURE.scene(results.outputs["structure"], results.upstream)}
    assert {"cases", "steps snow", "steps weight", "buckling", "swinging"} <= set(frames)
    assert frames["steps snow"].values.tolist() == [0, 0.5, 1]
    assert [caption.split(":")[0] for caption in frames["cases"].captions] == ["residual", "weight", "snow"]
    strips = [motion.displacements[2] for motion in frames["cases"].motions[:2]]
    largest = max(np.linalg.norm(shifts, axis=1).max() for shifts in strips)
    assert largest >= results.outputs["structure"].analysis.cases[2].displacement_max * (1 - 1e-9)
    governed = rows(folder / "envelope.csv")
    assert max(float(row["utilisation"]) for row in governed) == pytest.approx(figures["utilisation_max"], abs=1e-6)


def test_variants_and_sensitivity(tmp_path: Path) -> None:
    variants = [
        {"name": "grillage", "without": ["cables"], "feet": "sliding"},
        {"name": "one layer", "layers": 1},
        {"name": "slots too wide", "thickness": 0.5},
        {"name": "the same", "feet": "fixed"},
    ]
    table = TABLE | {"variant": variants, "sensitivity": {"joints": [1e9], "supports": [1e12], "cases": ["snow"]}}
    results = compute(project(structure=table, **WITH))
    folder = written(results, tmp_path)
    found = {(row["variant"], row["case"]): row for row in rows(folder / "variants.csv")}
    designed, grillage = found["as designed", "snow"], found["grillage", "snow"]
    assert designed["deflection_ratio"] == designed["buckling_ratio"] == "1.0000"
    assert float(grillage["deflection_mm"]) > 5 * float(designed["deflection_mm"])
    assert float(grillage["axial_share"]) < float(designed["axial_share"])
    # half the stiffness without loads of its own: twice the deflection, but for cables
    assert 1 < float(found["one layer", "snow"]["deflection_ratio"]) < 2.2
    lighter = float(found["one layer", "weight"]["deflection_ratio"])
    assert lighter < float(found["one layer", "snow"]["deflection_ratio"])
    assert found["slots too wide", "snow"]["remark"]
    assert found["slots too wide", "snow"]["deflection_mm"] == ""
    assert found["the same", "snow"]["deflection_mm"] == designed["deflection_mm"]
    told = {row["variant"]: row for row in rows(folder / "sensitivity.csv")}
    # as stiff as what is rigid
    for name in ("joints 1e+09 N m/rad", "supports 1e+12 N/m"):
        assert float(told[name]["deflection_ratio"]) == pytest.approx(1, abs=2e-3)
        assert float(told[name]["buckling_ratio"]) == pytest.approx(1, abs=2e-3)
    # weak-axis bending and torsion go with the third power of the thickness
    assert 1.07 < float(told["thickness +0.1 mm"]["buckling_ratio"]) < (1.6 / 1.5) ** 3 + 0.02
    assert 0.93 > float(told["thickness -0.1 mm"]["buckling_ratio"]) > (1.4 / 1.5) ** 3 - 0.02
    assert len(results.summary["structure"]["sensitivity"]) == len(told)
    assert ("Variants", "grillage, snow") in [row[:2] for row in report_data(results).figures]


@pytest.mark.parametrize(
    ("table", "others", "where"),
    [
        ({"failure": {"cases": ["storm"]}}, {}, "structure.failure.cases"),
        ({"failure": {}}, {"load": None}, "structure.failure.cases"),
        ({"sensitivity": {"cases": ["storm"]}}, {}, "structure.sensitivity.cases"),
        ({"displacement": DRIVEN | {"case": "storm"}}, {}, "structure.displacement.case"),
        ({"variant": [{"name": "one", "layers": 1}]}, {"load": None}, "structure.variant"),
        ({"construction": CONSTRUCTION}, {}, "structure.construction"),
        ({"construction": [stage for stage in CONSTRUCTION if "cables" not in stage]}, WITH, "structure.construction"),
        ({"construction": CONSTRUCTION, "joints": "hinged"}, WITH, "structure.construction"),
        ({"construction": CONSTRUCTION, "cables": "let go"}, WITH, "structure.cables"),
        ({"construction": ["bent", "props away", "loads on"]}, {}, "structure.construction"),
        ({"construction": ["bent", "loads on"]}, {}, "structure.construction"),
        ({"construction": "bent"}, {}, "structure.construction"),
        ({"construction": ["bent", "roof", "props away", "loads on"]}, {}, "structure.construction"),
        ({"construction": ["bent", "bent", "props away", "loads on"]}, {}, "structure.construction"),
        ({"sensitivity": {"joints": [0.0]}}, {}, "structure.sensitivity.joints"),
        ({"sensitivity": {"joints": [1.0] * 30}}, {}, "structure.sensitivity.joints"),
        ({"failure": {"cases": "snow"}}, {}, "structure.failure.cases"),
        ({"variant": [{"name": "none"}]}, {}, "structure.variant[0]"),
        ({"variant": [{"name": "a", "joints": 1e99}]}, {}, "structure.variant[0].joints"),
        ({"variant": [{"name": "a", "layers": 1}] * 2}, {}, "structure.variant"),
    ],
)
def test_refused_before_a_run(table: dict[str, Any], others: dict[str, Any], where: str) -> None:
    with pytest.raises(InputError) as refused:
        check_project(project(structure=TABLE | table, **others))
    assert refused.value.where == where


@pytest.mark.parametrize(
    ("table", "where"),
    [
        ({"sensitivity": {"thickness": 0.002}}, "structure.sensitivity.thickness"),
        ({"displacement": DRIVEN | {"near": [2.0, 2.0, 0.0]}}, "structure.displacement.near"),
        ({"displacement": DRIVEN | {"near": [2000.0, 0.0, 0.0]}}, "structure.displacement.near"),
        ({"displacement": DRIVEN | {"case": "summer"}}, "structure.displacement.case"),
    ],
)
def test_refused_on_the_net(table: dict[str, Any], where: str) -> None:
    with pytest.raises(InputError) as refused:
        compute(project(structure=TABLE | table, load=[WEIGHT, SNOW, SUMMER]))
    assert refused.value.where == where
