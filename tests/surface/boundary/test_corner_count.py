"""Boundaries of hundreds of corners are refused before a film is looked for; what is said then makes fewer of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import compute, make_surface, parse_project
from lamella.base.message import Message
from lamella.base.progress import Report
from lamella.project.tables import FormFoundTable
from lamella.stages.check import check_project
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary.curve import Loop
from refusals import check_stated, numbers_in, refused


def loops_of(points: Any, interpolation: str = "polyline", **surface: Any) -> tuple[Loop, ...]:
    boundary = [{"points": points.tolist(), "interpolation": interpolation}]
    table = parse_project({"surface": {"kind": "form-found", "boundary": boundary, **surface}}).surface
    assert isinstance(table, FormFoundTable)
    return boundary_loops(table, Path())


def ellipse(count: int, teeth: float = 0.0) -> Any:
    """Points of an oval; every other one farther out by a length, m."""
    t = 2 * np.pi * np.arange(count) / count
    r = 6 + teeth * (np.arange(count) % 2)
    return np.stack([r * np.cos(t), 0.8 * r * np.sin(t), 0.6 * np.cos(2 * t)], axis=1)


@pytest.mark.parametrize("count", [240, 2000])
def test_steps_of_a_curve(count: int) -> None:
    with refused("surface.boundary[0]", [count], ['interpolation = "spline"']) as error:
        loops_of(ellipse(count))
    # no number of corners is offered where points mean a curve
    assert not numbers_in(error.value.remedy)
    (loop,) = loops_of(ellipse(count), "spline")
    assert not (loop.turns > 1e-3).any()


def test_a_zigzag() -> None:
    with refused("surface.boundary[0]", [300, 180, 36]):
        loops_of(ellipse(300, 0.3), most_nodes=90_000)
    (loop,) = loops_of(ellipse(36, 0.3), most_nodes=90_000)
    assert len(loop.corners) == 36


class Reported(Exception):
    """Ends a search as soon as it has said what is looked for."""


@pytest.mark.parametrize(("count", "teeth"), [(30, 0.0), (60, 0.3), (150, 0.0)])
def test_what_many_corners_cost_is_said_at_once(count: int, teeth: float) -> None:
    """Before a film is looked for, with the nodes, the time and what takes less; by a check and by a run."""
    boundary = [{"points": ellipse(count, teeth).tolist(), "interpolation": "polyline"}]
    project = parse_project({"surface": {"kind": "form-found", "boundary": boundary}})
    for start in (check_project, compute):
        reported: list[str] = []

        def tell(report: Report, reported: list[str] = reported) -> None:
            reported.append(str(report))
            if isinstance(report.text, Message) and report.text.key == "corners_many":
                raise Reported

        with pytest.raises(Reported):
            start(project, progress=tell)
        # no film has been begun
        assert len(reported) <= 3, reported
        check_stated(reported[-1], [count, 1000 * count, 2700 * count, max(round(2.7 * count / 60), 1)])
        assert ("most_nodes" in reported[-1]) == (2700 * count > 100_000)


@pytest.mark.parametrize(
    ("interpolation", "surface"),
    [
        pytest.param("spline", {}, id="spline"),
        pytest.param("polyline", {"tolerance": 0.2}, id="tolerance", marks=pytest.mark.slow),
    ],
)
def test_what_takes_less_is_found_in_seconds(interpolation: str, surface: dict[str, Any]) -> None:
    """Followed, what is said to take less is not said again, and the film takes fewer nodes than were said."""
    boundary = [{"points": ellipse(36).tolist(), "interpolation": interpolation}]
    project = parse_project({"surface": {"kind": "form-found", "boundary": boundary, **surface}})
    reported: list[str] = []
    found = make_surface(project, progress=lambda report: reported.append(str(report)))
    assert not any("corners" in line for line in reported)
    assert len(found.nodes) < 36 * 1000  # type: ignore[attr-defined]


def test_what_is_not_refused() -> None:
    """Joints that do not turn, and tolerances of which no number of nodes is known."""
    assert len(loops_of(ellipse(60))[0].corners) == 60
    assert len(loops_of(ellipse(240), tolerance=0.05)[0].corners) == 240
    assert len(loops_of(ellipse(240), most_nodes=200_000)[0].corners) == 240
