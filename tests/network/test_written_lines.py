"""Figures of written centre lines, from their points alone, and what a run reports of them."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import Catenoid, Enneper, Unduloid, compute, parse_project
from lamella.files.write.network_json import network_bytes
from lamella.network.written_lines import WrittenLines
from validation.measure_network import measure


@pytest.mark.parametrize("surface", [Catenoid(1.0, (-1.0, 1.2)), Unduloid(0.6, 1.2, (-1.6, 2.0))])
def test_smooth_lines_bend_with_the_mean_curvature(surface) -> None:
    """kn = H on every lamella, open and closed ones, which cross at 90 degrees: by the fourth power of the distance."""
    errors = []
    for cells in (6, 12):
        network = lamella.net(surface, cells=cells)
        written = WrittenLines.of(network)
        off = np.abs(90 - written.node_angles(network)).max()
        errors.append((written.bend_off(network, surface.mean_curvature).max(), off))
    assert errors[0][0] > 10 * errors[1][0]
    assert errors[1][0] < 1e-4
    assert errors[0][1] > 10 * errors[1][1]
    assert errors[1][1] < 1e-2


def test_weights_are_the_published_ones() -> None:
    """Savitzky and Golay, Anal. Chem. 36 (1964), table of second derivatives of a quartic over seven points."""
    network = lamella.net(Catenoid(1.0, (-1.0, 1.2)), cells=12)
    before = WrittenLines.of(network)
    first, last = network.sample_offsets[:2]
    middle = (first + last) // 2
    step = network.sample_arclengths[middle + 1] - network.sample_arclengths[middle]
    points = network.sample_points.copy()
    lift = 1e-6 * step
    points[middle] += lift * network.sample_normals[middle]
    after = WrittenLines.of(replace(network, sample_points=points))
    change = (after.bend - before.bend)[middle - 3 : middle + 4] * step**2 / lift
    turned = (network.sample_normals[middle - 3 : middle + 4] * network.sample_normals[middle]).sum(1)
    assert change / turned == pytest.approx(np.array([-13, 67, -19, -70, -19, 67, -13]) / 132, abs=2e-2)


def test_samples_in_one_place_tell_nothing_new() -> None:
    """No division by zero where samples coincide: what the others tell is left."""
    network = lamella.net(Catenoid(1.0, (-1.0, 1.2)), cells=10)
    first, last = network.sample_offsets[:2]
    middle = (first + last) // 2
    points = network.sample_points.copy()
    points[middle : middle + 4] = points[middle]
    written = WrittenLines.of(replace(network, sample_points=points))
    assert np.isfinite(written.bend).all()
    assert np.isfinite(written.tangents).all()


def test_lines_that_turn_sharply_are_traced_as_exactly_as_others() -> None:
    """Next to a flat point lines of a given normal curvature turn within a part of a cell.

    Their samples turn by up to 0.06 from one to the next: chords are shorter than arcs by 0.06^2 / 24 of them.
    """
    network = lamella.net(Enneper(3, 0.8), cells=16, normal_curvature=0.1)
    assert np.abs(network.sample_darboux.kg).max() > 5
    written = WrittenLines.of(network)
    assert written.bend_off(network, 0.1).max() < 2e-4
    inside = np.ones(len(network.sample_points) - 1, bool)
    inside[network.sample_offsets[1:-1] - 1] = False
    chords = np.linalg.norm(np.diff(network.sample_points, axis=0), axis=1)[inside]
    assert (1 - chords / np.diff(network.sample_arclengths)[inside]).max() < 2.5e-4


def _roof() -> dict[str, Any]:
    """A film in five straight sides with rounded corners."""
    turn = 2 * np.pi * np.arange(5) / 5
    corners = 4 * np.column_stack([np.cos(turn), np.sin(turn), [0.3, -0.2, 0.35, -0.1, 0.2]])
    loop = {"points": corners.tolist(), "interpolation": "polyline", "corner_radius": 0.4}
    return {"surface": {"kind": "form-found", "tolerance": 0.005, "boundary": [loop]}, "network": {"cells": 10}}


def _ring(**network: Any) -> dict[str, Any]:
    """A film between a wavy rim and a circle."""
    turn = 2 * np.pi * np.arange(16) / 16
    rim = np.column_stack([3 * np.cos(turn), 2.4 * np.sin(turn), 0.5 * np.cos(2 * turn) + 0.2 * np.sin(turn)])
    loops = [{"points": rim.tolist()}, {"circle": {"center": [0.3, 0.1, 0.2], "radius": 0.6}}]
    return {"surface": {"kind": "form-found", "tolerance": 0.005, "boundary": loops}, "network": network}


@pytest.mark.parametrize(
    "project",
    [
        pytest.param(_roof(), id="roof", marks=pytest.mark.slow),
        pytest.param(_ring(cells=12), id="ring"),
        pytest.param(_ring(spacing=0.6, normal_curvature=0.03), id="given normal curvature"),
    ],
)
@pytest.mark.few(1)
def test_reported_figures_are_no_less_than_those_measured(project) -> None:
    """Deviations in summary.json are no less than those measured on the written points, and at most what they are."""
    results = compute(parse_project(project), until="network")
    network, told = results.network, results.summary["network"]
    content = json.loads(network_bytes(network, name="x", version="0"))
    content["surface"]["mean_curvature"] = network.normal_curvature
    measured = measure(content)
    rounding = 1e-7
    for name in ("normal_curvature_error_max", "normal_curvature_error_p95"):
        key = name.replace("error", "deviation")
        if key in told:
            assert told[key] > measured[name] - rounding * measured["curvature_scale"]
    # next to rounding the ruler's angles, by their cosines, are good to 1e-6 degrees
    for key in ("node_angle_deviation_max_deg", "node_angle_deviation_mean_deg"):
        assert told[key] > measured[key] - 1e-5
    # and no more than what is measured on the surface, where that is more
    on_surface = np.abs(network.sample_darboux.kn - network.normal_curvature).max()
    if "normal_curvature_deviation_p95" not in told:
        most = max(measured["normal_curvature_error_max"], on_surface)
        assert told["normal_curvature_deviation_max"] == pytest.approx(most, rel=1e-3)
