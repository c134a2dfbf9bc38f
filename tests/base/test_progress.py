"""Reports: levels, shares, cancelling; how a terminal shows them."""

from __future__ import annotations

import io
import sys

import pytest

from lamella import compute, parse_project
from lamella.base.progress import Cancelled, Level, Report, as_details, cancelled_by, in_stage
from lamella.command.screen import BAR_WIDTH, Screen

PROJECT = {
    "surface": {"kind": "unduloid", "neck_radius": 1.0, "bulge_radius": 3.0, "height": [0.0, 1.0]},
    "network": {"cells": 4},
}


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_levels_indent_and_stages_are_named() -> None:
    reports: list[Report] = []
    receiver = in_stage(as_details(reports.append), "network")
    receiver(Report.step("lines", 0.5))
    assert reports == [Report("lines", Level.DETAIL, "network", 0.5)]
    assert [str(Report("x", level)) for level in Level] == ["x", "  x", "    x"]


def test_every_report_of_a_run_names_its_stage() -> None:
    reports: list[Report] = []
    compute(parse_project(PROJECT), progress=reports.append)
    headings = [report.stage for report in reports if report.level == Level.STAGE]
    assert headings == ["surface", "network", "lamellas", "fabrication"]
    assert all(report.stage for report in reports)


@pytest.mark.parametrize("stage", ["surface", "network", "fabrication"])
def test_a_computation_is_cancelled_where_it_is(stage: str) -> None:
    reports: list[Report] = []
    receiver = cancelled_by(reports.append, lambda: bool(reports) and reports[-1].stage == stage)
    with pytest.raises(Cancelled):
        compute(parse_project(PROJECT), progress=receiver)
    assert reports[-1].stage == stage


def test_the_bar_is_drawn_on_terminals_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    for stream, drawn in ((Terminal(), True), (io.StringIO(), False)):
        monkeypatch.setattr(sys, "stderr", stream)
        screen = Screen(verbose=False)
        screen(Report.detail("hidden", 0.5))
        screen(Report.step("shown"))
        screen(Report.detail("hidden", 2.0))
        screen.clear()
        text = stream.getvalue()
        assert "hidden" not in text
        assert "  shown\n" in text
        assert (BAR_WIDTH // 2 * "#" + BAR_WIDTH // 2 * "." in text) == drawn
        assert ("100%" in text) == drawn
        # nothing of the bar is left over
        assert text.endswith("\r" if drawn else "shown\n")
