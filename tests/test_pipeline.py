"""A run from project to folder: the summary's keys, the copy of the project, the library's stages."""

from __future__ import annotations

import json
import math
import os
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

import lamella
from lamella import InputError, compute, parse_project, read_project
from lamella.cli import main
from lamella.files.network_json import network_schema
from lamella.output import report_data
from lamella.pipeline import STAGES
from lamella.project import FabricationTable, FormFoundTable, LamellaTable, MeshTable, Project, Table
from lamella.project_file import moved
from lamella.surface.surface import Surface

# the other surfaces that are found are computed by test_examples.py
FOUND = ("10_saddle", "15_vault", "16_hall")
EXAMPLES = sorted(
    path for path in (Path(__file__).parents[1] / "examples").glob("*.toml") if path.name < "08" or path.stem in FOUND
)
# DESIGN section 7
KEYS = {
    "surface": "mean_curvature mean_curvature_deviation_max area stability",
    "network": "nodes lamellas singular_nodes node_angle_deviation_max_deg node_angle_deviation_mean_deg "
    "normal_curvature_deviation_max cell_edge_min cell_edge_median cell_edge_max periods closed",
    "lamellas": "total_length geodesic_curvature_max geodesic_torsion_max planarity_score development_deviation_max "
    "stress_bending_max stress_torsion_max stress_helix_max stress_restraint_max von_mises_max utilisation_max",
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


@pytest.fixture(scope="module", params=EXAMPLES, ids=lambda path: path.stem)
def example(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """An example and the folder its run wrote."""
    out = tmp_path_factory.mktemp("example") / "o"
    assert main(["run", str(request.param), "--out", str(out), "--quiet"]) == 0
    return request.param, out


def test_summaries_of_examples_have_every_key_with_finite_values(example: tuple[Path, Path]) -> None:
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
    assert set(KEYS) <= set(summary["seconds"])
    for place, value in numbers(summary):
        if place in {".structure", ".lamellas.planarity_score.developable"}:
            assert value is None
        elif place == ".surface.stability":
            assert value == ("stable" if path.stem in FOUND else None)
        elif place != ".lamellas.material.shear_strength":  # metals have none of their own
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


def test_the_copy_of_the_project_runs_to_the_same_result(example: tuple[Path, Path], tmp_path: Path) -> None:
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
    assert set(full["lamella"]) == set(LamellaTable.model_fields)
    assert set(full["fabrication"]) == set(FabricationTable.model_fields)
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
    compute(parse_project(PROJECT), progress=told.append)
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
    for until in ("structure", "bogus", ""):
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

    monkeypatch.setattr("lamella.output.write_report", fail)
    with pytest.raises(RuntimeError):
        run(surface=PROJECT["surface"], network=PROJECT["network"])
    assert list(tmp_path.iterdir()) == []


def test_the_name_is_in_every_project_copy(tmp_path: Path) -> None:
    for name in ("a\nb", "a\x01\x00b", "#", '"""', "'" * 10, "\\n", "[surface]"):
        lamella.write(compute(parse_project(PROJECT | {"name": name}), until="surface"), tmp_path / "o")
        assert read_project(tmp_path / "o" / "project.toml").name == name
        head = (tmp_path / "o" / "project.toml").read_text(encoding="utf-8").split("\n")[0]
        assert head.startswith("# ")
        assert head.endswith(f"lamella {lamella.__version__}")


# --- surfaces that are no closed forms ----------------------------------------------------------------------------


class FoundTable(Table):
    """Stands for the table of a surface that has to be found."""

    kind: str
    order: int = 4
    tolerance: float = 5e-3
    most_nodes: int = 100_000


@pytest.fixture(params=["form-found", "mesh"])
def found(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> tuple[Project, list[Path]]:
    """A project whose surface is found by a stand-in (a catenoid, told apart from closed forms), and what it was given.

    The stand-in answers the questions every surface answers, and no other.
    """
    asked: list[Path] = []

    class Found:
        def __init__(self) -> None:
            self.kind: str = request.param
            self._form = lamella.Catenoid(2.0, (-1.0, 1.0))

        def __getattr__(self, name: str) -> Any:
            if name not in vars(Surface):
                raise AttributeError(f"no surface is asked for {name}")
            return getattr(self._form, name)

        def describe(self) -> dict[str, Any]:
            return {"stability": "stable"}

    def surface_of_table(table: FoundTable, folder: Path, progress: Callable[[str], None]) -> Found:
        assert table.kind == request.param
        asked.append(folder)
        progress("    Newton step 1")
        return Found()

    where = {"form-found": "lamella.surface.found.find", "mesh": "lamella.surface.imported.adopt"}[request.param]
    module = ModuleType(where)
    module.surface_of_table = surface_of_table  # type: ignore[attr-defined]
    for name in (where.rpartition(".")[0], where):
        monkeypatch.setitem(sys.modules, name, module)
    project = parse_project(PROJECT).model_copy(update={"surface": FoundTable(kind=request.param)})
    monkeypatch.setattr("lamella.pipeline.read_project", lambda path: project)
    monkeypatch.setattr("lamella.project_file.read_project", lambda path: project)
    monkeypatch.setattr(Project, "to_toml", lambda self: "")
    return project, asked


def test_without_until_closed_forms_go_all_the_way() -> None:
    results = compute(parse_project(PROJECT))
    assert results.parts
    assert results.summary["warnings"] == compute(parse_project(PROJECT), until="fabrication").summary["warnings"]


def test_the_surface_stage_of_found_surfaces(found: tuple[Project, list[Path]]) -> None:
    project, _ = found
    told: list[str] = []
    results = compute(project, until="surface", progress=told.append)
    assert results.network is None
    assert results.summary["network"] is None
    assert results.summary["surface"]["stability"] == "stable"
    assert results.summary["surface"]["kind"] == project.surface.kind
    assert "    Newton step 1" in told
    assert ("Surface", "Stability", "stable", "") in report_data(results).figures
    # nothing is missing of what was asked for
    assert results.summary["warnings"] == []


def film(*loops: dict[str, Any], **tables: Any) -> Project:
    """A film between circles of 2 m, coarse."""
    surface = {"kind": "form-found", "tolerance": 0.05, "boundary": list(loops)}
    return parse_project({"surface": surface, "network": {"cells": 10}} | tables)


def ring(height: float) -> dict[str, Any]:
    return {"name": f"at {height:g}", "circle": {"center": [0.0, 0.0, height], "radius": 2.0}}


def test_without_until_found_surfaces_go_all_the_way() -> None:
    told: list[str] = []
    results = compute(film(ring(0.0), ring(1.6)), progress=told.append)
    assert [line.split(":")[0] for line in told if not line.startswith(" ")] == list(KEYS)
    assert results.network
    assert results.parts
    assert len(results.network.ids) == 20
    figures = results.summary["network"]
    assert (figures["requested"], figures["cells"], figures["closed"]) == ("cells = 10", 10, True)
    assert [period["around"] for period in figures["periods"]] == ["at 1.6"]
    assert figures["umbilics"] == figures["singular_nodes"] == []
    assert 0 < figures["isothermic_residual"] < 0.01
    (joint,) = figures["joints"]
    assert set(joint) == {"between", "off_cells", "closed"}
    assert joint["between"] == "between the loop 'at 0' and the loop 'at 1.6'"
    assert joint["closed"]
    assert joint["off_cells"] < 1e-3


FLAT = (film(ring(0.0)), "flat: ")
CAP = (
    parse_project(
        {"surface": {"kind": "form-found", "mean_curvature": -0.25, "boundary": [ring(0.0)]}, "network": {"cells": 10}}
    ),
    "a piece of a sphere of radius ",
)


@pytest.mark.parametrize(("project", "what"), [FLAT, CAP], ids=["plane", "sphere"])
def test_without_until_spheres_and_planes_end_with_the_surface_and_say_why(
    project: Project, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    results = compute(project)
    assert results.network is None
    assert [results.summary[stage] for stage in STAGES[1:]] == [None] * 4
    (warning,) = results.summary["warnings"]
    assert warning.startswith(f"the run ends with the surface: it is {what}")
    assert warning.endswith("and has no net of lamellas")
    assert compute(project, until="surface").summary["warnings"] == []
    # who asks for a net is told that there is none
    (tmp_path / "p.toml").write_text(project.to_toml(), encoding="utf-8")
    for until in ("network", "lamellas", "fabrication"):
        with pytest.raises(InputError, match="every point is umbilic") as refused:
            compute(project, until=until)
        assert what in str(refused.value)
        assert refused.value.where == "surface"
        assert refused.value.remedy
    assert main(["run", "p.toml", "--until", "network", "--quiet"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("lamella: p.toml:")
    assert what in told
    assert "\n  remedy: " in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.toml"]
    assert main(["run", "p.toml", "--quiet"]) == 0
    assert f"warning: {warning}" in capsys.readouterr().err
    assert not (tmp_path / "out" / "p" / "network.json").exists()


def test_only_curves_are_adjusted() -> None:
    # the surface alone has nothing to close
    held = film(ring(0.0), ring(1.6), network={"cells": 10, "closing": "adjust"})
    assert compute(held, until="surface").network is None
    mesh = parse_project({"surface": {"kind": "mesh", "file": "m.obj"}, "network": {"closing": "adjust"}})
    with pytest.raises(InputError, match="a mesh has none") as refused:
        compute(mesh)
    assert refused.value.where == "network.closing"


def test_found_surfaces_on_the_command_line(
    found: tuple[Project, list[Path]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    _, asked = found
    monkeypatch.chdir(tmp_path)
    assert main(["run", "films/film.toml", "--until", "surface"]) == 0
    plain = capsys.readouterr().err
    assert "warning" not in plain
    assert "Newton" not in plain
    files = {p.name for p in (tmp_path / "out" / "film").iterdir()}
    assert files == {"summary.json", "project.toml", "surface.obj", "surface.ply", "report.html"}
    assert main(["run", "films/film.toml", "-v", "--until", "surface"]) == 0
    assert "\n    Newton step 1\n" in capsys.readouterr().err
    laid = SimpleNamespace(lattice=SimpleNamespace(cells=10, estimated_nodes=1234))
    monkeypatch.setattr("lamella.weaving.lay", lambda *_: laid)
    monkeypatch.setattr("lamella.weaving.weave", lambda *_: None)
    assert main(["check", "films/film.toml"]) == 0
    told = capsys.readouterr()
    kind = found[0].surface.kind
    assert told.out == f"films/film.toml: a good project. {kind}, H = 0 1/m, 10 cells, about 1,234 nodes\n"
    assert "Newton" not in told.err
    assert main(["check", "films/film.toml", "--verbose"]) == 0
    assert "    Newton step 1\n" in capsys.readouterr().err
    # files a project names are looked for beside it
    assert asked == [Path("films")] * 4


# --- files a project names ------------------------------------------------------------------------------------------


def test_the_copy_of_a_project_names_the_same_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "drawings").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "linked").symlink_to(tmp_path / "drawings" / "deep")
    curves = tmp_path / "drawings" / "curves.json"
    for given in ("curves.json", "./../drawings/curves.json", str(curves)):
        project = parse_project({"surface": {"kind": "form-found", "boundary": [{"file": given}]}})
        for out in ("elsewhere/o", "drawings/o", "drawings/deep/o", "linked/o"):
            copy = moved(project, tmp_path / "drawings", tmp_path / out).surface
            assert isinstance(copy, FormFoundTable)
            (loop,) = copy.boundary
            assert loop.file
            if Path(given).is_absolute():
                assert loop.file == given
            else:
                assert not Path(loop.file).is_absolute()
                there = Path(os.path.realpath(tmp_path / out)) / loop.file
                assert os.path.normpath(there) == os.path.realpath(curves)
    mesh = parse_project({"surface": {"kind": "mesh", "file": "m.obj"}})
    copy = moved(mesh, Path("a"), Path("b/o")).surface
    assert isinstance(copy, MeshTable)
    assert copy.file == "../../a/m.obj"
    plain = parse_project(PROJECT)
    assert moved(plain, Path("a"), Path("b")) is plain
    # no relative name leads to another drive
    monkeypatch.setattr("os.path.relpath", lambda *a: (_ for _ in ()).throw(ValueError("another drive")))
    far = moved(mesh, tmp_path, tmp_path / "o").surface
    assert isinstance(far, MeshTable)
    assert far.file == os.path.realpath(tmp_path / "m.obj")


SLIDING: dict[str, Any] = {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}
ARCH: list[dict[str, Any]] = [
    {"arc": {"start": [0.0, -2.0, 0.0], "middle": [0.0, 0.0, 2.0], "end": [0.0, 2.0, 0.0]}},
    {"points": [[0.0, 2.0, 0.0], [2.4, 2.0, 0.0]], "slide": SLIDING},
    {"arc": {"start": [2.4, 2.0, 0.0], "middle": [2.4, 0.0, 2.0], "end": [2.4, -2.0, 0.0]}},
    {"points": [[2.4, -2.0, 0.0], [0.0, -2.0, 0.0]]},
]


def test_summary_and_report_tell_the_loops_the_volume_and_the_verdict() -> None:
    results = compute(film(ring(0.0), ring(1.6)), until="surface")
    s = results.summary["surface"]
    assert [loop["name"] for loop in s["loops"]] == ["at 0", "at 1.6"]
    assert [loop["length"] for loop in s["loops"]] == pytest.approx([4 * math.pi] * 2, rel=1e-6)
    assert [loop["held"] for loop in s["loops"]] == ["held", "held"]
    told = {(section, label): (value, unit) for section, label, value, unit in report_data(results).figures}
    assert told["Boundary", "at 1.6"] == ("12.57 m, held", "")
    assert told["Surface", "Volume, with lids over the loops"] == (f"{s['volume']:.4g}", "m³")
    assert told["Surface", "Lowest Jacobi eigenvalue"] == (f"{s['jacobi_eigenvalue']:.3g}", "1/m²")
    assert told["Surface", "Stability"] == ("stable", "")
    results = compute(film({"name": "edge", "part": ARCH}), until="surface")
    (edge,) = results.summary["surface"]["loops"]
    assert edge["held"] == "1 of 4 parts slides on a plane, the others are held"
    # the sliding side has drawn in
    assert edge["length"] < 4 * math.pi + 4.8 + 0.5


def test_summary_and_report_of_a_mesh_tell_the_distance(tmp_path: Path) -> None:
    mesh = lamella.Catenoid(2.0, (-1.0, 1.5)).mesh()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.points.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in mesh.faces.tolist()]
    (tmp_path / "a.obj").write_text("\n".join(lines))
    project = parse_project({"surface": {"kind": "mesh", "file": "a.obj", "tolerance": 0.05}})
    results = compute(project, until="surface", folder=tmp_path)
    s = results.summary["surface"]
    assert [loop["name"] for loop in s["loops"]] == ["outer border", "border 2"]
    assert [loop["length"] for loop in s["loops"]] == pytest.approx(
        [4 * math.pi * math.cosh(0.75), 4 * math.pi * math.cosh(0.5)], rel=1e-5
    )
    told = {(section, label): (value, unit) for section, label, value, unit in report_data(results).figures}
    assert told["Surface", "Off the mesh's vertices, largest"] == (f"{1e3 * s['distance_max']:.3g}", "mm")
    assert told["Boundary", "outer border"] == (f"{s['loops'][0]['length']:.4g} m, held", "")
