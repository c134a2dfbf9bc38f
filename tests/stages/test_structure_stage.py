"""The stage "structure": its file, its figures, what it warns of and refuses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError, compute, parse_project
from lamella.stages.check import check_project
from refusals import warned

SNOW = {"name": "snow", "kind": "area", "value": 100.0, "per": "plan"}
WEIGHT = {"name": "weight", "kind": "self_weight"}
PROJECT: dict[str, Any] = {
    "name": "patch",
    "surface": {"kind": "enneper", "order": 2, "radius": 0.6, "scale": 3.0},
    "network": {"spacing": 0.8},
    "lamella": {"material": "S355"},
    "structure": {"elements": 2, "modes": 2},
    "support": [{"boundary": "rim"}],
    "load": [WEIGHT, SNOW],
}


def project(**tables: Any) -> lamella.Project:
    return parse_project({key: value for key, value in (PROJECT | tables).items() if value is not None})


def test_results_json_and_summary(tmp_path: Path) -> None:
    combination = [{"name": "all", "factors": {"weight": 1.35, "snow": 1.5}}]
    results = compute(project(combination=combination))
    lamella.write(results, tmp_path / "out")
    read = json.loads((tmp_path / "out" / "structure" / "results.json").read_text())
    net = json.loads((tmp_path / "out" / "network.json").read_text())
    assert read["schema"] == "lamella/structure/1"
    assert [case["name"] for case in read["cases"]] == ["residual", "weight", "snow", "all"]
    rest, weight, snow, both = read["cases"]
    for case in read["cases"]:
        assert len(case["nodes"]) == len(net["nodes"])
        assert case["displacement_max"] == pytest.approx(np.linalg.norm(case["nodes"], axis=1).max(), rel=1e-12)
        assert case["converged"]
        total, reaction = np.array(case["load_total"]), np.array(case["reaction_total"])
        assert np.abs(total + reaction).max() < 1e-9 * max(np.abs(total).max(), 1e3)
    assert rest["load_total"] == [0, 0, 0]
    assert both["load_total"][2] == pytest.approx(1.35 * weight["load_total"][2] + 1.5 * snow["load_total"][2])
    # the strips weigh what the fabrication's uncut ones do, but for what the slots take
    mass = 2 * 7850 * 0.1 * 0.0015 * results.summary["lamellas"]["total_length"]
    assert weight["load_total"][2] == pytest.approx(-9.81 * mass, rel=1e-9)
    assert [one["case"] for one in read["buckling"]] == ["weight", "snow", "all"]
    assert all(len(one["factors"]) == 2 for one in read["buckling"])
    assert len(read["frequencies"]) == 2
    figures = results.summary["structure"]
    assert figures["spring_back"] == rest["displacement_max"]
    assert figures["utilisation_max"] == max(case["utilisation_max"] for case in read["cases"])
    assert [case["buckling_factor"] for case in figures["cases"]][1:] == [b["factors"][0] for b in read["buckling"]]
    assert "Structure" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_hardware_weighs() -> None:
    joined = compute(project(joint={}, cables={"prestress": 200.0}, load=[WEIGHT]))
    out = joined.outputs["structure"].analysis
    bare = compute(project(load=[WEIGHT])).outputs["structure"].analysis
    hardware = joined.summary["fabrication"]["hardware"]
    others = sum(one["mass"] for kind, one in hardware.items() if kind != "cable")
    cables = out.model.structure.cables
    more = others + float(cables.mass @ cables.length)
    assert bare.cases[1].load_total[2] - out.cases[1].load_total[2] == pytest.approx(9.81 * more, rel=1e-9)


def test_nothing_is_asked_for() -> None:
    plain = project(structure=None, support=None, load=None)
    results = compute(plain)
    assert results.summary["structure"] is None
    assert not any(message.key.startswith("ends_with") for message in results.summary["warnings"])
    with pytest.raises(InputError) as refused:
        compute(plain, until="structure")
    assert refused.value.where == "structure"


def test_loads_without_supports() -> None:
    with pytest.raises(InputError) as refused:
        check_project(project(support=None))
    assert refused.value.where == "support"


def test_a_check_leaves_large_structures_to_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    small = check_project(project())
    assert not small.left
    monkeypatch.setattr("lamella.stages.structure.stage.MOST_CHECKED", 100)
    (left,) = check_project(project()).left
    assert "3 cases" in left
    assert "GB of memory" in left


def test_a_net_that_is_let_go() -> None:
    results = compute(project(support=None, load=None))
    warned(results.summary["warnings"], "structure_free")
    assert results.summary["structure"]["spring_back"] > 0.1


def test_supports_that_leave_a_mechanism() -> None:
    with pytest.raises(InputError) as refused:
        compute(project(support=[{"near": [0.0, 0.0, 0.0]}]))
    assert refused.value.where == "support"


def test_overload_and_overstress_are_warned_of() -> None:
    thin = {"material": "S355", "height": 0.04, "thickness": 0.0005}
    results = compute(project(load=[SNOW | {"value": 1e5}], lamella=thin))
    told = results.summary["warnings"]
    (case,) = results.summary["structure"]["cases"][1:]
    assert not case["converged"]
    assert case["load_factor"] < 1
    warned(told, "overload", [case["load_factor"]], ["'snow'"])


def test_supports_that_hold_little_or_all_are_warned_of() -> None:
    soft = [{"near": [0.0, 0.0, 0.0], "fixed": ["x", "y", "rx", "ry", "rz"], "spring": {"z": 100.0}}]
    results = compute(project(support=soft, load=[SNOW]))
    (_, case) = results.summary["structure"]["cases"]
    # a spring of 100 N/m under all of the snow
    force = -results.outputs["structure"].analysis.cases[1].load_total[2]
    assert case["deflection_max"] == pytest.approx(force / 100.0, rel=0.05)
    warned(results.summary["warnings"], "structure_moves_far", [case["deflection_max"]])
    everywhere = compute(project(support=[{"ground": 50.0}], load=[SNOW]))
    warned(everywhere.summary["warnings"], "all_nodes_supported")


def test_buckling_and_slack_cables_are_told_with_their_place() -> None:
    thin = {"material": "S355", "thickness": 0.0002}
    limp = compute(project(lamella=thin, load=None))
    ways = limp.outputs["structure"].analysis.cases[0].equilibrium.negative
    warned(limp.summary["warnings"], "structure_unstable", [ways])
    loose = compute(project(joint={}, cables={"prestress": 0.0}, load=[SNOW | {"value": 2000.0}]))
    message = warned(loose.summary["warnings"], "cables_slack")
    attached = loose.outputs["structure"].analysis.model.structure.cables.attachment.nodes
    assert any(f"from node {one} to {other}" in message for one, other in attached.tolist())
    over = compute(
        project(load=[SNOW | {"value": 1e5}], lamella={"material": "S355", "height": 0.04, "thickness": 5e-4})
    )
    case = over.outputs["structure"].analysis.cases[1]
    shifts = np.linalg.norm(case.modes[0][: 6 * len(case.equilibrium.poses.points)].reshape(-1, 6)[:, :3], axis=1)
    point = case.equilibrium.structure.poses.points[np.round(shifts, 9).argmax()]
    warned(over.summary["warnings"], "overload", [case.buckling[0], *point.tolist()])


def test_a_support_near_a_point_far_away() -> None:
    """Millimetres for metres."""
    with pytest.raises(InputError) as refused:
        compute(project(support=[{"near": [1584.0, 0.0, 1080.0]}]))
    assert refused.value.where == "support[0].near"


def test_joints_layers_and_cables_of_the_table() -> None:
    springs = {"stiffness": 100.0, "gap": 2.0}
    table = {"elements": 2, "modes": 0, "joints": springs, "layers": "each", "slots": "whole", "cables": "let go"}
    out = compute(project(structure=table, joint={}, cables={"prestress": 200.0})).outputs["structure"]
    model = out.analysis.model
    assert model.rules.layers == "each"
    assert model.structure.joint_springs.stiffness == pytest.approx(np.full(len(model.joint_nodes), 100.0))
    assert model.structure.joint_springs.gap == pytest.approx(np.full(len(model.joint_nodes), np.radians(2.0)))
    assert len(model.structure.cables)
    with pytest.raises(InputError) as refused:
        project(structure={"joints": {"stiffness": 100.0, "gap": 100.0}})
    assert refused.value.where == "structure.joints"
