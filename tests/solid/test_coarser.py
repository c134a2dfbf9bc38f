"""Bars for views: chord errors are kept, triangles are fewer."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.fabrication.flat import outline_points
from lamella.hardware.shape import Sweep, circle
from lamella.solid.coarser import coarser_sweep
from lamella.solid.extrusion import sweep_solid


@pytest.mark.parametrize("scale", [1.0, 1000.0])
@pytest.mark.parametrize("turn", [2.0, 2 * np.pi])
def test_a_tube_around_a_rim(turn: float, scale: float) -> None:
    """An arc of radius R in steps s is off by s^2 / 8R, a section of n sides by r (1 - cos(pi / n))."""
    large, small, share = 2.5 * scale, 0.05 * scale, 0.02
    angle = np.linspace(0, turn, 1201)
    points = large * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(1201)])
    if turn > 6:
        points[-1] = points[0]
    up = np.tile([0.0, 0.0, 1.0], (1201, 1))
    tube = Sweep(circle(2 * small), points, up, (circle(1.8 * small),))
    coarse = coarser_sweep(tube, share)
    assert coarse.closed == tube.closed
    steps = np.linalg.norm(np.diff(coarse.points, axis=0), axis=1)
    assert (steps**2 / (8 * large)).max() <= 1.001 * share * small
    # the next longer step that is tried would be too long
    assert (steps.max() * 4 / 3 + 2 * large * turn / 1200) ** 2 / (8 * large) > share * small
    sides = len(outline_points(coarse.outline)) - 1
    assert 1 - np.cos(np.pi / sides) <= share < 1 - np.cos(np.pi / (sides - 2))
    assert len(sweep_solid(coarse).triangles) < len(sweep_solid(tube).triangles) / 4
