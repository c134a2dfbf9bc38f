"""Surfaces of constant node angle in boundaries of any shape, their nets, and what is refused of them."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.files.write.network_json import network_bytes
from lamella.surface.constant_angle.angle_surface import AngleSurface
from lamella.surface.constant_angle.find_angle import find_angle
from validation.measure_network import measure

TURN = 2 * np.pi * np.arange(24) / 24
PROJECT: dict[str, Any] = {
    "name": "Saddle",
    "surface": {
        "kind": "form-found",
        "tolerance": 5e-3,
        "boundary": [
            {"name": "low", "circle": {"center": [0.0, 0.0, 0.0], "radius": 2.1}},
            {"name": "high", "circle": {"center": [0.0, 0.0, 1.3], "radius": 1.8}},
        ],
    },
    "network": {"angle": 70.0, "cells": 24},
    "lamella": {"height": 0.05, "thickness": 0.001, "layers": 2},
    "joint": {},
}


def changed(table: str, **values: Any) -> dict[str, Any]:
    """The project with other values in a table."""
    return PROJECT | {table: PROJECT[table] | values}


@pytest.fixture(scope="module")
def results() -> lamella.Results:
    return lamella.compute(lamella.parse_project(PROJECT))


def test_net_crosses_at_the_angle_and_closes(results: lamella.Results) -> None:
    """By the ruler, from the written points alone: 70 degrees everywhere, straight strips, as many A as B around."""
    assert isinstance(results.surface, AngleSurface)
    net = results.network
    assert net is not None
    assert (net.families == "A").sum() == (net.families == "B").sum() == 24
    ruler = measure(json.loads(network_bytes(net, name="x", version="0")))
    assert ruler["normal_curvature_error_p95"] <= 1e-3 * ruler["curvature_scale"]
    figures = results.summary["network"]
    assert figures["node_angle_deviation_max_deg"] < 0.05
    assert figures["node_angle_max_deg"] == pytest.approx(70, abs=0.05)
    assert figures["inner_ends"] == 0
    assert figures["normal_curvature"] == 0
    assert results.summary["surface"]["node_angle"] == 70


def test_hardware_is_made_for_the_angle(results: lamella.Results) -> None:
    """All nodes have one angle, so there is one washer, as at 90 degrees."""
    washers = results.summary["fabrication"]["hardware"]["washer"]
    assert washers["different"] == 1
    assert results.summary["lamellas"]["development_deviation_max"] < 2e-3


def test_angle_buys_less_twist_or_flatter_arches(results: lamella.Results) -> None:
    """On k1 / k2 = -B / A lamellas twist by sqrt(-k1 k2): beside the soap film of the same rings, by sin(2 phi) D."""
    there = results.surface.check_points()
    size = np.abs(there.deviator)
    assert results.network is not None
    twist = np.abs(results.network.sample_darboux.tg)
    assert twist.max() <= np.sin(np.radians(70)) * size.max() * 1.01
    # the ends of the project that were filled in read back
    again = lamella.parse_project(json.loads(json.dumps(results.project.model_dump(mode="json", exclude_none=True))))
    assert again.network.angle == 70
    assert again.network.normal_curvature == again.surface.normal_curvature == 0  # type: ignore[union-attr]


def test_ninety_degrees_take_the_film_of_that_curvature() -> None:
    surface = changed("surface", normal_curvature=0.1)["surface"]
    made = lamella.make_surface(lamella.parse_project({"surface": surface}))
    assert made.mean_curvature == 0.1
    assert not isinstance(made, AngleSurface)


@pytest.mark.parametrize(
    ("values", "where"),
    [
        (changed("network", angle=20.0), "network.angle"),
        (changed("surface", mean_curvature=0.2), "surface.mean_curvature"),
        (changed("surface", volume=3.0), "surface.volume"),
        (changed("surface", branch="unstable"), "surface.branch"),
        (changed("network", normal_curvature=0.3), "network.normal_curvature"),
        (changed("network", closing="round"), "network.angle"),
        (changed("network", closing="adjust", kind="principal"), "network.angle"),
        (changed("network", closing="adjust", limit={"utilisation": 1.0}), "network.angle"),
        (changed("network", limit={"utilisation": 1.0}), "network.angle"),
        (PROJECT | {"surface": {"kind": "catenoid", "neck_radius": 2.0, "height": [0.0, 1.0]}}, "network.angle"),
    ],
)
def test_what_goes_with_no_other_angle(values: dict[str, Any], where: str) -> None:
    with pytest.raises(InputError) as refused:
        lamella.parse_project(values)
    assert refused.value.where == where
    assert refused.value.remedy
    if {"closing", "limit"} & set(values["network"]):
        # what is left out is what was given, and nothing that the file has not
        assert "normal_curvature" not in str(refused.value)
        kept = {key: value for key, value in values["network"].items() if key not in refused.value.remedy}
        lamella.parse_project(values | {"network": {"angle": values["network"]["angle"], **kept}})


def test_boundaries_that_slide_are_refused() -> None:
    project = changed("surface", boundary=[{**PROJECT["surface"]["boundary"][0], "slide": {"direction": [0, 0, 1]}}])
    with pytest.raises(InputError) as refused:
        lamella.make_surface(lamella.parse_project(project))
    assert refused.value.where == "surface.boundary"


def test_flat_points_are_told() -> None:
    rim = np.column_stack([5 * np.cos(TURN), 5 * np.sin(TURN), 0.8 * np.cos(3 * TURN)])
    made = lamella.make_surface(
        lamella.parse_project(
            {
                "surface": {
                    "kind": "form-found",
                    "tolerance": 2e-2,
                    "boundary": [{"name": "rim", "points": rim.tolist()}],
                },
                "network": {"angle": 80.0},
            }
        )
    )
    (note,) = [one for one in made.warnings() if one.key == "angle_umbilics"]
    # by symmetry in the middle of three lobes
    assert "1 umbilic" in note
    assert isinstance(made, AngleSurface)
    assert np.abs(made.umbilics.position[0, :2]).max() < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("number", range(10))
def test_random_boundaries(number: int) -> None:
    """All of these are found; node angles by cos(2 phi) = (c - H) / D, outside of flat points."""
    rng = np.random.default_rng(100 + number)
    a, b = rng.uniform(3, 6, 2)
    waves = ((m, rng.normal(0, 0.5 / m), rng.uniform(0, 7)) for m in (2, 3, 4))
    height = sum((size * np.cos(m * TURN + phase) for m, size, phase in waves), np.zeros(len(TURN)))
    loops = [lamella.spline(np.column_stack([a * np.cos(TURN), b * np.sin(TURN), height]))]
    if number % 2:
        loops.append(lamella.circle((*rng.uniform(-0.5, 0.5, 2), rng.uniform(0.5, 1.5)), rng.uniform(0.6, 1.2)))
    angle, c = float(np.round(rng.uniform(60, 120), 1)), float(rng.choice([0, 0.05, -0.05]))
    found = find_angle(tuple(loops), angle, c, tolerance=4e-3)
    there = found.surface("found").check_points()
    size = np.abs(there.deviator)
    bent = size > 0.05 * found.refined.deviation.scale
    off = np.abs(np.degrees(np.arccos(np.clip((c - there.mean_curvature[bent]) / size[bent], -1, 1))) - angle)
    assert np.percentile(off, 95) < 0.05
    assert off.max() < 0.3
