"""Nets of lines from even seeds, against closed forms of the lines and against the nets of the lattice."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from scipy.interpolate import CubicSpline

import lamella
from conftest import run_of_example
from lamella import Enneper, Helicoid, InputError, Scherk, parse_project
from lamella.files.write.network_json import network_bytes
from lamella.network.cell_sizes import large_cells
from lamella.network.charts.element_charts import ElementCharts
from lamella.network.charts.plane_charts import PlaneCharts
from lamella.network.network import BOUNDARY, REGULAR, Network
from lamella.network.pattern import Pattern
from lamella.network.streamlines.direction_field import CROSSING_ANGLE_MIN, LineField
from lamella.network.streamlines.streamline_network import TracedNetwork, traced_network
from lamella.network.streamlines.streamlines import finished, trace
from lamella.stages.computation import compute
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from network.elements.test_element_network import shaken_grid
from surface.element.exact_elements import catenoid_map, on_map
from validation.measure_network import measure


def ruled(network: Network) -> dict[str, Any]:
    """The ruler's figures, against the normal curvature that was asked for."""
    reported = json.loads(network_bytes(network, name="x", version="0"))
    reported["surface"]["mean_curvature"] = reported.get("normal_curvature", reported["surface"]["mean_curvature"])
    return measure(reported)


def lamellas(network: Network, family: str) -> list[np.ndarray]:
    """Centre lines of a family."""
    pieces = np.split(network.sample_points, network.sample_offsets[1:-1])
    return [piece for piece, one in zip(pieces, network.families.tolist(), strict=True) if one == family]


def is_sound(network: Network) -> None:
    """One A and one B at each regular node, ends on nodes, the disc's Euler number, no lamella twice."""
    a, b = network.node_degrees()
    regular = network.node_kinds == REGULAR
    assert (a[regular] == 1).all()
    assert (b[regular] == 1).all()
    ends = network.stop_nodes[np.r_[network.stop_offsets[:-1], network.stop_offsets[1:] - 1]]
    assert (network.node_kinds[ends] == BOUNDARY).all()
    assert network.node_angles.min() >= CROSSING_ANGLE_MIN - 1e-6
    for k in range(len(network.ids)):
        stops = slice(network.stop_offsets[k], network.stop_offsets[k + 1])
        assert (np.diff(network.stop_arclengths[stops]) > 0).all()
        samples = network.stop_samples[stops] + network.sample_offsets[k]
        assert np.allclose(network.sample_points[samples], network.node_points[network.stop_nodes[stops]], atol=1e-8)


@cache
def on_catenoid(count: int, cells: int = 8) -> TracedNetwork:
    surface = on_map(catenoid_map, *shaken_grid((0, 2), (-1, 1), count, count), 4, 0.0)
    return traced_network(
        ElementCharts(surface), Pattern(normal_curvature=0.0), mean_curvature=0.0, cells=cells, minimum_length=0
    )


def test_asymptotic_lines_of_a_catenoid_on_elements() -> None:
    """DESIGN section 9: they are u + v = const and u - v = const; the shape operator's error falls by h^3."""
    errors = []
    for count in (4, 8, 16):
        network = on_catenoid(count).network
        is_sound(network)
        worst = 0.0
        for family, sign in (("A", -1), ("B", 1)):
            spreads = {}
            for way in (-1, 1):
                spreads[way] = max(
                    np.ptp(np.arctan2(p[:, 1], p[:, 0]) + way * p[:, 2]) for p in lamellas(network, family)
                )
            assert min(spreads, key=lambda way: spreads[way]) == sign
            worst = max(worst, spreads[sign])
        errors.append(worst)
    assert errors[0] < 1e-2
    assert np.log(errors[0] / errors[2]) / np.log(4) > 2.8


def test_the_net_of_a_film_is_that_of_its_lattice() -> None:
    """On a minimal surface lines of kn = 0 are its lamellas."""
    results = run_of_example("10_saddle", "network")
    surface, lattice = results.surface, results.network
    assert isinstance(surface, ElementSurface)
    size = float(np.linalg.norm(np.ptp(surface.nodes, axis=0)))
    charts, field = ElementCharts(surface), LineField(0.0, 1.0)
    regular = np.flatnonzero(lattice.node_kinds == REGULAR)[::17]
    seeds, _ = surface.closest(lattice.node_points[regular])
    owner = lattice.stop_owner
    for family in "AB":
        streamlines = finished(
            trace(charts, field, seeds, np.full(len(regular), family == "A"), step=0.1, longest=5 * size)
        )
        mine = np.flatnonzero(lattice.families[owner] == family)
        line_of = dict(zip(lattice.stop_nodes[mine].tolist(), owner[mine].tolist(), strict=True))
        for k, node in enumerate(regular.tolist()):
            line = line_of[node]
            samples = lattice.sample_points[lattice.sample_offsets[line] : lattice.sample_offsets[line + 1]]
            assert abs(streamlines.lengths[k] - lattice.lengths[line]) < 2e-4 * size
            at = np.linspace(0, 1, 2001) * streamlines.lengths[k]
            traced = streamlines.at(np.full(len(at), k), at)[1].position
            apart = np.linalg.norm(samples[:, None] - traced, axis=2).min(1)
            # the nearest of points 5e-4 of the line apart
            assert apart.max() < 3e-4 * size


def off_the_helicoid(wanted: float, cells: int) -> float:
    """Largest error of lines of kn = `wanted` on a helicoid, rad.

    kn = sin(2 theta) / (c cosh^2 U), theta from the ruling, an asymptotic line: dV / dU = tan theta.
    """
    c = 4 / (2 * np.pi)
    network = lamella.net(Helicoid(4.0, 0.5, 3.0, 0.5), cells=cells, normal_curvature=wanted)
    is_sound(network)
    u = np.linspace(np.arcsinh(0.5 / c), np.arcsinh(3 / c), 100_001)
    sine = wanted * c * np.cosh(u) ** 2
    # up to where they are no more
    u, sine = u[np.abs(sine) < 1], sine[np.abs(sine) < 1]
    v = CubicSpline(u, cumulative_simpson(np.tan(np.arcsin(sine) / 2), x=u, initial=0))
    errors = []
    for family in "AB":
        for points in lamellas(network, family):
            at_u, at_v = np.arcsinh(np.hypot(points[:, 0], points[:, 1]) / c), points[:, 2] / c
            # the family that leaves the rulings
            if np.abs(np.diff(at_v)).max() < np.abs(np.diff(at_u)).max():
                way = np.sign((at_v[-1] - at_v[0]) * (at_u[-1] - at_u[0]))
                errors.append(np.ptp(at_v - way * v(at_u)))
    assert len(errors) > 5
    return float(max(errors))


def test_lines_of_a_helicoid() -> None:
    assert off_the_helicoid(0.2, 12) < 1e-6


def test_the_order_of_tracing() -> None:
    """Runge and Kutta's error falls by the fourth power of the step: where a line ends, against one traced finely."""
    charts, field = PlaneCharts(Helicoid(4.0, 0.5, 3.0, 0.5)), LineField(0.05, 1.0)
    seeds = Places(np.zeros(3, np.int64), np.array([[1.2, 0.6], [1.5, 1.2], [1.8, 2.0]]))

    def ends(step: float) -> np.ndarray:
        streamlines = finished(trace(charts, field, seeds, np.array([True, False, True]), step=step, longest=9.0))
        return np.concatenate(
            [streamlines.at(np.arange(3), s)[1].position for s in (0 * streamlines.lengths, streamlines.lengths)]
        )

    exact = ends(0.002)
    errors = [np.linalg.norm(ends(step) - exact, axis=1).max() for step in (0.03, 0.015)]
    assert np.log2(errors[0] / errors[1]) > 3.5


@pytest.mark.parametrize(
    "surface", [Helicoid(4.0, 0.0, 4.0, 1.0), Enneper(2, 0.9, 4.0), Enneper(3, 0.9, 4.0), Scherk(1.25, 3.0)]
)
def test_the_ruler_on_closed_forms(surface: Any) -> None:
    network = lamella.net(surface, cells=12, normal_curvature=0.02)
    is_sound(network)
    figures = ruled(network)
    # next to a flat point lines turn within a few of the ruler's samples
    assert figures["normal_curvature_error_rel_max"] < (1e-2 if surface.hopf_order else 5e-5)
    assert figures["normal_curvature_error_p95"] < 1e-5 * figures["curvature_scale"]
    assert figures["family_sign_errors"] == 0
    assert figures["node_angle_measured"] == (network.node_kinds == REGULAR).sum()
    assert np.abs(network.sample_darboux.kn - 0.02).max() < 1e-12
    assert abs(figures["cell_edge_median"] - np.median(network.cell_edges)) < 1e-6


def test_spacing_is_the_median_cell_edge() -> None:
    """To a tenth, on lines without a lattice."""
    for spacing in (0.6, 0.9):
        network = lamella.net(Scherk(1.25, 3.0), spacing=spacing, normal_curvature=0.02)
        assert np.median(network.cell_edges) == pytest.approx(spacing, rel=0.1)


@pytest.mark.parametrize("density", [{"cells": 7}, {"spacing": 1.1}])
def test_the_median_told_is_that_of_the_summary(density: dict[str, Any]) -> None:
    """Pieces at the rim included, of the lamellas that are kept."""
    table = {"surface": {"kind": "scherk", "extent": 1.25, "scale": 3.0}}
    project = parse_project(table | {"network": {"normal_curvature": 0.02, "minimum_length": 1.5} | density})
    lines: list[str] = []
    reported = compute(project, until="network", progress=lambda report: lines.append(str(report))).summary["network"]
    medians = [line.split("median cell edge ")[1] for line in lines if "median cell edge" in line]
    assert f"{reported['cell_edge_median']:.3g} m" in medians
    assert medians[-1] == f"{reported['cell_edge_median']:.3g} m" or "spacing" in density


def test_where_directions_stop_being_real() -> None:
    """A helicoid has kn = 0.2 up to c cosh^2 U = 5; the families cross at 20 deg where it is 5 cos 20 deg."""
    c = 4 / (2 * np.pi)
    results = compute(
        parse_project(
            {
                "surface": {"kind": "helicoid", "pitch": 4.0, "inner_radius": 0.0, "outer_radius": 4.0, "turns": 1.0},
                "network": {"normal_curvature": 0.2, "cells": 12},
            }
        ),
        until="network",
    )
    network, reported = results.network, results.summary["network"]
    radius = np.hypot(*network.node_points[:, :2].T)
    last = c * np.sqrt(5 * np.cos(np.radians(CROSSING_ANGLE_MIN)) / c - 1)
    assert radius.max() == pytest.approx(last, rel=1e-4)
    inner = (np.abs(radius - last) < 1e-3 * last) & (network.node_kinds == BOUNDARY)
    assert reported["inner_ends"] == inner.sum()
    # the area between two radii: c^2 (U + sinh U cosh U) pi
    u = np.arcsinh(np.array([4.0, np.sqrt(5 / c - 1) * c, last]) / c)
    whole, real, used = u + np.sinh(u) * np.cosh(u)
    assert reported["unreal_area_share"] == pytest.approx(1 - real / whole, abs=0.01)
    assert reported["flat_area_share"] == pytest.approx((real - used) / whole, abs=0.01)
    (message,) = [m for m in results.summary["warnings"] if "no direction" in m]
    assert f"{reported['unreal_area_share']:.1%} of the surface has no direction of normal curvature 0.2 1/m" in message
    assert reported["node_angle_min_deg"] >= CROSSING_ANGLE_MIN - 1e-6


@pytest.mark.parametrize(("unreal", "flat", "parts"), [(8e-4, 8e-4, 0), (8e-4, 2e-3, 1), (2e-3, 2e-3, 2)])
def test_shares_without_lamellas_are_reported_one_by_one(unreal: float, flat: float, parts: int) -> None:
    """Two shares that are each too small to be reported are none together."""
    traced = on_catenoid(4)
    traced = replace(traced, reach=traced.reach._replace(unreal=unreal, flat=flat))
    about = [message for message in traced.warnings() if "no lamellas there" in message]
    assert len(about) == (parts > 0)
    assert sum(message.count("of the surface") for message in about) == parts


def test_why_cells_are_large() -> None:
    """A helicoid bends one way as much as the other: it is planar nowhere, but its lines of kn = 0.1 are uneven."""
    table = {"surface": {"kind": "helicoid", "pitch": 4.0, "inner_radius": 0.0, "outer_radius": 4.0, "turns": 1.0}}
    results = compute(parse_project(table | {"network": {"normal_curvature": 0.1, "cells": 8}}), until="network")
    count, _ = large_cells(results.network)
    (message,) = [m for m in results.summary["warnings"] if "x the median" in m]
    assert message.startswith(f"{count} cell edges are over 4 x the median")
    assert "lines of one normal curvature draw apart there, or cross at flat angles" in message
    assert "planar" not in message


def test_what_is_refused() -> None:
    surface = Scherk(1.25, 3.0)
    with pytest.raises(InputError, match="no direction of the surface has it") as refused:
        lamella.net(surface, cells=12, normal_curvature=1.0)
    low, high = (float(x) for x in refused.value.remedy.split("from ")[1].split(" 1/m")[0].split(" to "))
    assert len(lamella.net(surface, cells=6, normal_curvature=0.9 * high).ids) > 2
    assert low == pytest.approx(-high)
    with pytest.raises(InputError, match=r"spacing = 9 m leaves \S+ cells across the surface"):
        lamella.net(surface, spacing=9.0, normal_curvature=0.02)
    with pytest.raises(InputError, match="leaves out curves of an isothermic lattice"):
        lamella.net(surface, cells=12, normal_curvature=0.02, every=(2, 1))
    with pytest.raises(InputError, match="nodes and take about"):
        lamella.net(surface, spacing=1e-3, normal_curvature=0.02)
    table = {"surface": {"kind": "scherk", "extent": 1.25, "scale": 3.0}}
    with pytest.raises(InputError, match='closing = "round"') as refused:
        compute(parse_project(table | {"network": {"normal_curvature": 0.02, "closing": "round"}}))
    assert refused.value.where == "network.closing"
