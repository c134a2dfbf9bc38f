"""Boundaries of hundreds of corners are refused before a film is looked for; what is said then makes fewer of them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import InputError, parse_project
from lamella.project import FormFoundTable
from lamella.surface.boundary import boundary_loops
from lamella.surface.boundary.curve import Loop


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
    with pytest.raises(InputError) as refused:
        loops_of(ellipse(count))
    assert refused.value.where == "surface.boundary[0]"
    assert f"{count:,} corners" in refused.value.message
    assert "at most" not in refused.value.remedy
    assert 'interpolation = "spline"' in refused.value.remedy
    (loop,) = loops_of(ellipse(count), "spline")
    assert not (loop.turns > 1e-3).any()


def test_a_zigzag() -> None:
    with pytest.raises(InputError) as refused:
        loops_of(ellipse(300, 0.3), most_nodes=90_000)
    assert "300 corners" in refused.value.message
    assert "for 180" in refused.value.message
    kept = re.search(r"at most (\d+)", refused.value.remedy)
    assert kept
    (loop,) = loops_of(ellipse(int(kept[1]), 0.3), most_nodes=90_000)
    assert len(loop.corners) == int(kept[1]) == 36


def test_what_is_not_refused() -> None:
    """Joints that do not turn, and tolerances of which no number of nodes is known."""
    assert len(loops_of(ellipse(60))[0].corners) == 60
    assert len(loops_of(ellipse(240), tolerance=0.05)[0].corners) == 240
    assert len(loops_of(ellipse(240), most_nodes=200_000)[0].corners) == 240
