"""A stage added later: an object and a line of a list; everything else is made from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jsonschema
import orjson
import pytest

from lamella import InputError, Memory, compute, parse_project, write
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.tables import Project
from lamella.stages import all_stages
from lamella.stages.figure import NUMBER, Figure, line
from lamella.stages.lamellas.stage import LamellasStage
from lamella.stages.stage import Estimate, File, Stage, Upstream

PROJECT = {
    "surface": {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.5, 0.5]},
    "network": {"cells": 6},
    "lamella": {"height": 0.05, "layers": 1},
}


@dataclass(frozen=True)
class Paint:
    litres: float


class PaintStage(Stage[Paint]):
    """How much paint a structure takes: follows the lamellas, as fabrication does, and does not need it."""

    name = "paint"
    needs = ("network", "lamellas")
    writes = (("paint.txt", "how much paint"),)
    figures = (
        Figure(
            "litres", "l", "paint for both sides of all strips", lambda out: out.litres, NUMBER, rows=line("Paint", "l")
        ),
    )
    report = ("Paint", ("litres",))

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("lamella.height",)

    def estimate(self, up: Upstream, progress: Progress) -> Estimate:
        return Estimate({}, ("how much paint it takes",))

    def run(self, up: Upstream, progress: Progress) -> Paint:
        return Paint(2 * float(up.outputs["network"].network.lengths.sum()) * up.project.lamella.height / 10.0)

    def result(self, figures: Mapping[str, Any], out: Paint) -> str:
        return f"{out.litres:.3g} l"

    def warnings(self, out: Paint, up: Upstream, progress: Progress) -> Iterator[Message]:
        yield Message("paint_smell", "open the windows")

    def files(self, out: Paint, up: Upstream) -> Iterator[File]:
        yield File("paint.txt", lambda path: path.write_text(f"{out.litres} l\n"))

    def model(self, out: Paint, up: Upstream) -> Iterator[DrawnLayer]:
        yield DrawnLayer("paint", points=(up.outputs["network"].network.node_points[0],))


@pytest.fixture(autouse=True)
def paint(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line of the list."""
    monkeypatch.setattr(all_stages, "STAGES", (*all_stages.STAGES, PaintStage()))


def test_it_is_run_written_and_reported(tmp_path: Path) -> None:
    results = compute(parse_project(PROJECT))
    assert results.summary["paint"]["litres"] == pytest.approx(
        2 * results.summary["lamellas"]["total_length"] * 0.05 / 10, rel=1e-12
    )
    assert "open the windows" in results.summary["warnings"]
    write(results, tmp_path / "out")
    assert (tmp_path / "out" / "paint.txt").is_file()
    summary = orjson.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert summary["paint"] == results.summary["paint"]
    assert "paint.txt" in summary["files"]
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Paint" in report
    assert b"p\0a\0i\0n\0t\0" in (tmp_path / "out" / "model.3dm").read_bytes()


def test_it_may_be_the_last_one() -> None:
    results = compute(parse_project(PROJECT), until="paint")
    assert list(results.outputs) == ["surface", "network", "lamellas", "paint"]
    assert results.summary["fabrication"] is None


def test_it_ends_where_what_it_needs_does() -> None:
    principal = parse_project(PROJECT | {"network": {"cells": 6, "kind": "principal"}})
    assert list(compute(principal).outputs) == ["surface", "network"]
    with pytest.raises(InputError) as refused:
        compute(principal, until="paint")
    assert refused.value.where == "network.kind"


def test_a_stage_that_cannot_be_leaves_out_those_that_need_it_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    end = Message("ends_here", "no lamellas today")
    monkeypatch.setattr(LamellasStage, "ends", lambda *_: end)
    assert list(compute(parse_project(PROJECT)).outputs) == ["surface", "network"]
    monkeypatch.setattr(PaintStage, "needs", ("network",))
    results = compute(parse_project(PROJECT))
    assert list(results.outputs) == ["surface", "network", "paint"]
    assert results.summary["warnings"].count(end) == 1


def test_it_is_remembered_by_what_it_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    memory, runs = Memory(), []
    original = PaintStage.run
    monkeypatch.setattr(PaintStage, "run", lambda *arguments: runs.append(1) or original(*arguments))
    for sheet in ([12.0, 2.0], [6.0, 2.0]):
        project = parse_project(PROJECT | {"fabrication": {"sheet": sheet}})
        compute(project, memory=memory)
    assert len(runs) == 1


def test_schema_help_and_check_know_it(capsys: pytest.CaptureFixture[str]) -> None:
    from lamella.command.main import main
    from lamella.stages.check import check_project
    from lamella.stages.schema import summary_schema

    schema = summary_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["properties"]["paint"]["anyOf"][0]["properties"]["litres"]["type"] == "number"
    assert "how much paint it takes" in check_project(parse_project(PROJECT)).left
    with pytest.raises(SystemExit):
        main(["run", "--help"])
    assert "paint.txt" in capsys.readouterr().out
