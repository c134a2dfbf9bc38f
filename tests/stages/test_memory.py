"""Outputs are computed once: what decides a stage, and what a change costs."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from lamella import Memory, compute, parse_project
from lamella.network.elements import net_coordinates
from lamella.stages.all_stages import STAGES
from lamella.surface.form_finding import find, followed_film

RINGS = [{"circle": {"center": [0.0, 0.0, z], "radius": 2.0, "normal": [0, 0, 1]}} for z in (0.0, 1.2)]
FILM = {
    "surface": {"kind": "form-found", "boundary": RINGS, "tolerance": 0.02},
    "network": {"cells": 12},
    "lamella": {"height": 0.05},
}
UNDULOID = {
    "surface": {"kind": "unduloid", "neck_radius": 1.0, "bulge_radius": 3.0, "height": [0.0, 2.0]},
    "network": {"cells": 8},
}


def changed(project: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    table, _, name = key.partition(".")
    return project | {table: project.get(table, {}) | {name: value}}


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each stage has been run."""
    counted: Counter[str] = Counter()
    for stage in STAGES:
        kind = type(stage)

        def run(self: Any, up: Any, progress: Any, original: Any = kind.run) -> Any:
            counted[self.name] += 1
            return original(self, up, progress)

        monkeypatch.setattr(kind, "run", run)
    return counted


@pytest.mark.parametrize(
    ("key", "value", "again"),
    [
        ("surface.neck_radius", 1.1, {"surface", "network", "lamellas", "fabrication"}),
        ("network.cells", 10, {"network", "lamellas", "fabrication"}),
        ("lamella.height", 0.09, {"lamellas", "fabrication"}),
        ("fabrication.sheet", [6.0, 2.0], {"fabrication"}),
        ("name", "other", set()),
        ("files.unit", "mm", set()),
        ("files.mesh_tolerance", 5e-3, {"surface", "network", "lamellas", "fabrication"}),
    ],
)
def test_a_change_runs_the_stages_it_decides(key: str, value: Any, again: set[str], runs: Counter[str]) -> None:
    memory = Memory()
    compute(parse_project(UNDULOID), memory=memory)
    before = Counter(runs)
    project = UNDULOID | {"name": value} if key == "name" else changed(UNDULOID, key, value)
    remembered = compute(parse_project(project), memory=memory)
    assert set(runs - before) == again
    # the same as from nothing
    anew = compute(parse_project(project)).summary
    for content in (remembered.summary, anew):
        content["seconds"] = None
    assert json.dumps(remembered.summary) == json.dumps(anew)


def test_back_and_forth_costs_nothing(runs: Counter[str]) -> None:
    memory = Memory()
    projects = [parse_project(changed(UNDULOID, "network.cells", cells)) for cells in (8, 10)]
    for project in projects * 2:
        compute(project, memory=memory)
    assert set(runs.values()) == {2} - {1} | {runs["surface"]} - {2}
    assert runs["surface"] == 1


def test_a_film_and_its_coordinates_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another number of cells finds neither the film nor its isothermic coordinates again; a mesh tolerance no film."""
    asked: Counter[str] = Counter()
    for module, name in ((find, "find_film"), (net_coordinates, "net_coordinates")):
        original = getattr(module, name)

        def counting(*arguments: Any, name: str = name, original: Any = original, **more: Any) -> Any:
            asked[name] += 1
            return original(*arguments, **more)

        monkeypatch.setattr(module, name, counting)
    memory = Memory()
    compute(parse_project(FILM), memory=memory)
    first = Counter(asked)
    for key, value in (("network.cells", 14), ("lamella.height", 0.06), ("files.mesh_tolerance", 2e-3)):
        compute(parse_project(changed(FILM, key, value)), memory=memory)
    assert asked == first


def test_the_content_of_a_file_counts(tmp_path: Path, runs: Counter[str]) -> None:
    file, memory = tmp_path / "rings.json", Memory()
    project = parse_project(
        {"surface": {"kind": "form-found", "tolerance": 0.02, "boundary": [{"file": "rings.json"}]}}
    )
    for height in (0.3, 0.3, 0.4):
        points = [[2.0, 0.0, 0.0], [0.0, 2.0, height], [-2.0, 0.0, 0.0], [0.0, -2.0, height]]
        file.write_text(json.dumps({"unit": "m", "curves": {"rim": {"points": points}}}))
        compute(project, until="surface", folder=tmp_path, memory=memory)
    assert runs["surface"] == 2


def test_nothing_is_kept_of_what_failed(runs: Counter[str]) -> None:
    memory = Memory()

    def fail(report: Any) -> None:
        if report.stage == "network":
            raise RuntimeError

    for _ in range(2):
        with pytest.raises(RuntimeError):
            compute(parse_project(UNDULOID), memory=memory, progress=fail)
    assert runs["surface"] == 1
    assert compute(parse_project(UNDULOID), memory=memory).parts


def test_a_memory_that_follows_finds_one_film(monkeypatch: pytest.MonkeyPatch) -> None:
    """Films and nets of changed boundaries are those found from nothing, to the tolerance; runs do not follow."""
    found: list[Any] = []
    original = followed_film.find_film
    monkeypatch.setattr(followed_film, "find_film", lambda *a, **k: found.append(a) or original(*a, **k))
    memory, plain = Memory(follow=True), Memory()
    assert not plain.follow
    for height in (1.2, 1.25, 1.3):
        rings = [RINGS[0], {"circle": RINGS[1]["circle"] | {"center": [0.0, 0.0, height]}}]
        project = parse_project(changed(FILM, "surface.boundary", rings))
        followed = compute(project, until="network", memory=memory)
        wanted = compute(project, until="network", memory=plain)
        assert followed.summary["surface"]["area"] == pytest.approx(wanted.summary["surface"]["area"], rel=1e-5)
        assert followed.summary["surface"]["stability"] == "stable"
        assert followed.network.node_points == pytest.approx(wanted.network.node_points, abs=2e-3)
        assert followed.summary["network"]["closed"]
    assert len(found) == 1
    # another request is another film
    compute(parse_project(changed(FILM, "surface.tolerance", 0.03)), until="surface", memory=memory)
    assert len(found) == 2
