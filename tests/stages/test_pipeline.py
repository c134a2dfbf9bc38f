"""A run from project to folder: the summary's keys, the copy of the project, the library's stages."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import lamella
from lamella import InputError, compute, parse_project, read_project
from lamella.command.main import main
from lamella.files.write.network_json import network_schema
from lamella.project.tables import FabricationTable, LamellaTable

# the other surfaces that are found are computed by test_examples.py; of these three the largest takes as long as
# all others together
FOUND, LARGE = ("10_saddle", "15_vault", "16_hall"), "16_hall"
EXAMPLES = [
    pytest.param(path, id=path.stem, marks=pytest.mark.slow if path.stem == LARGE else ())
    for path in sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
    if path.name < "08" or path.stem in FOUND
]
# DESIGN section 7
KEYS = {
    "surface": "mean_curvature mean_curvature_deviation_max area stability",
    "network": "nodes lamellas singular_nodes node_angle_deviation_max_deg node_angle_deviation_mean_deg "
    "normal_curvature_deviation_max cell_edge_min cell_edge_median cell_edge_max periods closed",
    "lamellas": "total_length geodesic_curvature_max geodesic_torsion_max planarity_score development_deviation_max "
    "stress_bending_max stress_torsion_max stress_helix_max stress_restraint_max stress_layer_max von_mises_max "
    "utilisation_max utilisation_net_section_max layer_distances",
    "fabrication": "mass surface_weight parts sheets",
}
# of surfaces of curved elements besides
ELEMENT_KEYS = (
    "jacobi_eigenvalue negative_eigenvalues order surface_nodes elements newton_steps continuation curvature_scale "
    "mean_curvature_deviation volume tolerance"
)
ELEMENT_NETWORK_KEYS = "umbilics isothermic_residual joints"


def numbers(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """All values of nested dictionaries and lists."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numbers(inner, f"{path}.{key}")
    elif isinstance(value, list):
        for inner in value:
            yield from numbers(inner, path)
    else:
        yield path, value


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """An example and the folder its run wrote."""
    out = tmp_path_factory.mktemp("example") / "o"
    assert main(["run", str(request.param), "--out", str(out), "--quiet"]) == 0
    return request.param, out


@pytest.mark.few(4)
def test_summaries_of_examples_have_every_key_with_finite_values(example: tuple[Path, Path]) -> None:
    """summary.json of examples has the keys of the file interface, all numbers finite."""
    path, out = example
    summary = json.loads((out / "summary.json").read_bytes())
    assert summary["schema"] == "lamella/summary/1"
    assert summary["version"] == lamella.__version__
    assert summary["name"] == tomllib.loads(path.read_text(encoding="utf-8"))["name"]
    for stage, keys in KEYS.items():
        assert set(keys.split()) <= set(summary[stage]), stage
    assert (set(summary["surface"]) >= set(ELEMENT_KEYS.split())) == (path.stem in FOUND)
    assert (set(summary["network"]) >= set(ELEMENT_NETWORK_KEYS.split())) == (path.stem in FOUND)
    assert summary["structure"] is None
    assert summary["erection"] is None
    assert summary["panels"] is None
    assert set(KEYS) <= set(summary["seconds"])
    for place, value in numbers(summary):
        if place in {".erection", ".structure", ".panels", ".lamellas.planarity_score.developable"}:
            assert value is None
        elif place == ".surface.stability":
            assert value == ("stable" if path.stem in FOUND else None)
        elif place.startswith(".network.corners") or place == ".lamellas.utilisation_at_corners":
            # null where the net has nothing next to a corner
            assert value is None or math.isfinite(value), place
        # metals have none of their own, and no modification factors
        elif place.removeprefix(".lamellas.material.") not in {"shear_strength", "k_mod", "gamma_m"}:
            assert value is not None, place
            assert not isinstance(value, float) or math.isfinite(value), place
    network = summary["network"]
    assert network["closed"] is True
    assert 0 < network["cell_edge_min"] <= network["cell_edge_median"] <= network["cell_edge_max"]
    for node in network["singular_nodes"]:
        assert node["rays"] == 2 * (node["order"] + 2)
        assert len(node["point"]) == 3
    for period in network["periods"]:
        assert set(period) == {"around", "a_cells", "b_cells"}
    assert set(summary["lamellas"]["planarity_score"]["twisted"]) == {"median", "max"}
    assert summary["fabrication"]["surface_weight"] == pytest.approx(
        summary["fabrication"]["mass"] / summary["surface"]["area"]
    )


def test_summaries_agree_with_the_files_beside_them(example: tuple[Path, Path]) -> None:
    """Counts, singular nodes and lengths of summary.json are those of network.json."""
    path, out = example
    summary = json.loads((out / "summary.json").read_bytes())
    assert (out / "surface.3dm").is_file() == (path.stem in FOUND)
    network = json.loads((out / "network.json").read_bytes())
    assert summary["network"]["nodes"] == len(network["nodes"])
    assert summary["network"]["lamellas"] == len(network["lamellas"])
    singular = [n["point"] for n in network["nodes"] if n["kind"] == "singular"]
    assert [n["point"] for n in summary["network"]["singular_nodes"]] == singular
    assert summary["lamellas"]["total_length"] == pytest.approx(
        sum(lam["node_arclengths"][-1] for lam in network["lamellas"]), rel=1e-12
    )
    assert network["surface"]["mean_curvature"] == summary["surface"]["mean_curvature"]
    assert set(network_schema()["properties"]) >= set(network)


def test_examples_warn_of_nothing_a_designer_must_mend(example: tuple[Path, Path]) -> None:
    _, out = example
    for message in json.loads((out / "summary.json").read_bytes())["warnings"]:
        assert "utilisation" not in message
        assert "millimetres" not in message
        assert "without slots" not in message


@pytest.mark.few(4)
def test_the_copy_of_the_project_runs_to_the_same_result(example: tuple[Path, Path], tmp_path: Path) -> None:
    """project.toml of a run, all defaults filled in, gives the same bytes of every file."""
    _, out = example
    again = tmp_path / "again"  # as deep as the first one, so that relative names of files read alike
    assert main(["run", str(out / "project.toml"), "--out", str(again), "--quiet"]) == 0
    files = {p.relative_to(out) for p in out.rglob("*")}
    assert {p.relative_to(again) for p in again.rglob("*")} == files
    for file in sorted(files):
        if (out / file).is_dir():
            continue
        old, new = (out / file).read_bytes(), (again / file).read_bytes()
        if file.name == "summary.json":
            old, new = ({**json.loads(data), "seconds": None} for data in (old, new))  # type: ignore[assignment]
        assert old == new, file


def test_the_copy_of_the_project_holds_all_defaults(example: tuple[Path, Path]) -> None:
    path, out = example
    given = tomllib.loads(path.read_text(encoding="utf-8"))
    full = tomllib.loads((out / "project.toml").read_text(encoding="utf-8"))
    for table, values in given.items():
        if isinstance(values, dict):
            for key, value in values.items():
                if key == "file":
                    assert (out / full[table][key]).samefile(path.parent / value)
                elif key == "boundary":
                    assert [loop["name"] for loop in full[table][key]] == [loop["name"] for loop in value]
                else:
                    assert full[table][key] == value
    # what says something only where it is given is left out
    for table, filled_in in ((LamellaTable, set()), (FabricationTable, {"end_distance", "hub_radius", "slot_width"})):
        own = {key for key, field in table.model_fields.items() if field.default is not None}
        assert set(full[table.__name__.removesuffix("Table").lower()]) == own | filled_in
    assert {"angle", "closing", "minimum_length"} < set(full["network"])
    assert ("cells" in full["network"]) != ("spacing" in full["network"])


PROJECT: dict[str, Any] = {
    "name": "x",
    "surface": {"kind": "catenoid", "neck_radius": 2.0, "height": [-1.0, 1.0]},
    "network": {"cells": 8},
}


def test_library_stages_stop_where_told() -> None:
    for until, depth in (("surface", 1), ("network", 2), ("lamellas", 3), ("fabrication", 4)):
        results = compute(parse_project(PROJECT), until=until)
        there = [results.mesh, results.network, results.lamellas, results.parts]
        assert [x is not None for x in there] == [k < depth for k in range(4)]
        assert (results.nesting is not None) == (depth == 4)


def test_progress_is_told_line_by_line() -> None:
    told: list[str] = []
    compute(parse_project(PROJECT), progress=lambda report: told.append(str(report)))
    assert [line.split(":")[0] for line in told if not line.startswith(" ")] == list(KEYS)
    assert all("\n" not in line for line in told)


def test_errors_of_the_library_carry_the_key() -> None:
    for tables, key in (
        ({"fabrication": {"end_distance": 1e-6}}, "fabrication.end_distance"),
        ({"network": {"cells": 10**6}}, "network.cells"),
        ({"lamella": {"material": "cheese"}}, "lamella.material"),
        ({"lamella": {"thickness": 0.2}}, "lamella.thickness"),
    ):
        with pytest.raises(InputError) as refused:
            compute(parse_project(PROJECT | tables))
        assert refused.value.where == key
        assert refused.value.remedy
    tall = {
        "surface": {"kind": "cylinder", "radius": 0.5, "height": [0.0, 1.0]},
        "lamella": {"height": 2.0, "layers": 1},
    }
    for until in ("lamellas", "fabrication"):
        with pytest.raises(InputError) as refused:
            compute(parse_project(tall), until=until)
        assert refused.value.where == "lamella.height"
    assert compute(parse_project(tall), until="network").network


def test_a_measure_of_fabrication_does_not_stop_an_earlier_stage() -> None:
    spoilt = parse_project(PROJECT | {"fabrication": {"end_distance": 1e-6}})
    assert compute(spoilt, until="lamellas").parts is None


def test_unknown_stages() -> None:
    for until in ("structures", "bogus", ""):
        with pytest.raises(InputError) as refused:
            compute(parse_project(PROJECT), until=until)
        assert refused.value.where == "--until"


def test_run_returns_its_folder_and_tells_warnings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "big.toml").write_text("[surface]\nkind = 'cylinder'\nradius = 900.0\nheight = [0, 900]\n")
    told: list[str] = []
    folder = lamella.run("big.toml", until="surface", warn=told.append)
    assert folder == Path("out/big")
    assert told == json.loads((folder / "summary.json").read_bytes())["warnings"]
    assert len(told) == 1


def test_a_failing_writer_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Callable[..., Path]
) -> None:
    def fail(*arguments: object, **more: object) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr("lamella.stages.write.write_report", fail)
    with pytest.raises(RuntimeError):
        run(surface=PROJECT["surface"], network=PROJECT["network"])
    assert list(tmp_path.iterdir()) == []


def test_the_name_is_in_every_project_copy(tmp_path: Path) -> None:
    for name in ("a\nb", "a\x01\x00b", "#", '"""', "'" * 10, "\\n", "[surface]"):
        lamella.write(compute(parse_project(PROJECT | {"name": name}), until="surface"), tmp_path / "o")
        # without control characters
        assert read_project(tmp_path / "o" / "project.toml").name == " ".join(re.split(r"[\x00-\x1f]+", name))
        head = (tmp_path / "o" / "project.toml").read_text(encoding="utf-8").split("\n")[0]
        assert head.startswith("# ")
        assert head.endswith(f"lamella {lamella.__version__}")
