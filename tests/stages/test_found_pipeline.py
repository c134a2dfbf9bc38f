"""Runs whose surface has to be found: stages, summary and report, and the files a project names."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import pytest

import lamella
from lamella import compute, parse_project
from lamella.base.progress import Progress, Report
from lamella.command.main import main
from lamella.project.read import moved
from lamella.project.tables import FormFoundTable, MeshTable, Project
from lamella.stages.all_stages import STAGES
from lamella.stages.computation import Computation
from lamella.stages.report import report_data
from lamella.stages.stage import Estimate
from lamella.surface.surface import Surface
from refusals import check_stated, refused, warned
from stages.test_pipeline import KEYS, PROJECT


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

    def surface_of_table(
        table: FormFoundTable | MeshTable, folder: Path, progress: Progress, *further: Any, **named: Any
    ) -> Found:
        assert table.kind == request.param
        asked.append(folder)
        progress(Report.detail("Newton step 1"))
        return Found()

    found, kind = {
        "form-found": ("film_of_table", FormFoundTable),
        "mesh": ("surface_of_mesh_table", MeshTable),
    }[request.param]
    monkeypatch.setattr(f"lamella.stages.surface.surface_of_table.{found}", surface_of_table)
    table = kind.model_construct(
        kind=request.param, order=4, tolerance=2e-2, most_nodes=100_000, file="a.obj", boundary=()
    )
    project = parse_project(PROJECT).model_copy(update={"surface": table})
    monkeypatch.setattr("lamella.stages.write.read_project", lambda path: project)
    monkeypatch.setattr("lamella.project.read.read_project", lambda path: project)
    monkeypatch.setattr(Project, "to_toml", lambda self: "")
    return project, asked


def test_without_until_closed_forms_go_all_the_way() -> None:
    results = compute(parse_project(PROJECT))
    assert results.parts
    assert results.summary["warnings"] == compute(parse_project(PROJECT), until="fabrication").summary["warnings"]


def test_the_surface_stage_of_found_surfaces(found: tuple[Project, list[Path]]) -> None:
    project, _ = found
    told: list[str] = []
    results = compute(project, until="surface", progress=lambda report: told.append(str(report)))
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
    results = compute(film(ring(0.0), ring(1.6)), progress=lambda report: told.append(str(report)))
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


FLAT = (film(ring(0.0)), [])
CAP = (
    parse_project(
        {"surface": {"kind": "form-found", "mean_curvature": -0.25, "boundary": [ring(0.0)]}, "network": {"cells": 10}}
    ),
    [4.0],
)


@pytest.mark.parametrize(("project", "numbers"), [FLAT, CAP], ids=["plane", "sphere"])
def test_without_until_spheres_and_planes_end_with_the_surface_and_say_why(
    project: Project,
    numbers: list[float],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    results = compute(project)
    assert results.network is None
    assert all(results.summary[name] is None for name in (stage.name for stage in STAGES[1:]))
    warning = warned(results.summary["warnings"], "ends_with_surface", numbers)
    assert compute(project, until="surface").summary["warnings"] == []
    # a net that is requested is refused
    (tmp_path / "p.toml").write_text(project.to_toml(), encoding="utf-8")
    for until in ("network", "lamellas", "fabrication"):
        with refused("surface", numbers):
            compute(project, until=until)
    assert main(["run", "p.toml", "--until", "network", "--quiet"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("lamella: p.toml:")
    check_stated(told, numbers)
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
    with refused("network.closing"):
        compute(mesh)


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
    estimate = Estimate({"cells": 10, "nodes": 1234})
    monkeypatch.setattr("lamella.stages.network.stage.NetworkStage.estimate", lambda *_: estimate)
    monkeypatch.setattr(Computation, "run_all", lambda *_: None)
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
