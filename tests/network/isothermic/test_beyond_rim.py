"""Nets of surfaces whose deviator has a zero just beyond the rim, or next to it within."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import compute, parse_project
from lamella.files.write.network_json import network_bytes
from lamella.network.adjust.shift_gradients import depth_gradients
from lamella.network.elements.element_network import element_network
from lamella.network.isothermic.beyond_rim import zeros_beyond_rim
from lamella.network.isothermic.umbilic_depth import UmbilicDepths, depth_errors
from lamella.network.network import SINGULAR
from lamella.stages.figure import evaluate
from lamella.stages.network.output import NetworkOutput
from lamella.stages.network.stage import NetworkStage
from surface.element.weierstrass import weierstrass
from validation.measure_network import measure


@pytest.mark.parametrize("distance", [1.01, 1.04, 1.1])
def test_zero_beyond_the_rim_is_estimated(distance) -> None:
    zero = distance * np.exp(0.4j)
    surface = weierstrass([zero], rings=12)
    found = zeros_beyond_rim(surface, 0.01)
    # next to the zero the surface is nearly flat, half as large as the disc of its parameter
    nearest = surface.closest(found[:1])[1]
    assert np.linalg.norm(found[0] - nearest[0]) == pytest.approx((distance - 1) / 2, rel=0.5)
    assert np.linalg.norm(found[0]) > np.linalg.norm(nearest[0])


@pytest.mark.parametrize("distance", [1.02, *(pytest.param(d, marks=pytest.mark.slow) for d in (1.005, 1.05))])
def test_angles_next_to_a_zero_beyond_the_rim(distance) -> None:
    """The net's own angles are right and are those that the ruler finds."""
    net = lamella.net(weierstrass([distance * np.exp(0.4j)], rings=10), cells=20)
    ruler = measure(json.loads(network_bytes(net, name="x", version="0")))
    figures = evaluate(NetworkStage.figures, NetworkOutput(net, "", None, {}))
    assert ruler["node_angle_deviation_max_deg"] < 0.1
    assert figures["node_angle_deviation_max_deg"] == pytest.approx(ruler["node_angle_deviation_max_deg"], abs=0.05)


@pytest.mark.parametrize("inside", [0.02, pytest.param(0.01, marks=pytest.mark.slow)])
def test_a_singular_node_next_to_the_rim_has_all_its_rays(inside) -> None:
    """Cells are large next to an umbilic: some of its rays reach the rim within a small part of one."""
    net = lamella.net(weierstrass([(1 - inside) * np.exp(0.4j)], rings=10), cells=20, minimum_length=0.0)
    (node,) = np.flatnonzero(net.node_kinds == SINGULAR)
    a, b = net.node_degrees()
    assert (a[node], b[node]) == (3, 3)


@pytest.mark.parametrize("direction", [1.0, 1.0j])
def test_how_an_umbilic_moves_from_the_rim(direction) -> None:
    """To first order, against the zero of a surface that differs a little: towards the middle, and along the rim."""
    zero, off = 0.9 * np.exp(0.4j), 2e-3
    surface, moved = (weierstrass([zero - move * direction * np.exp(0.4j)], rings=10) for move in (0.0, off))
    depths = UmbilicDepths.of(surface)
    rim = surface.nodes[np.unique(surface.connectivity.rim_nodes)]
    position = surface.frames(moved.umbilics.places).position
    nearest = np.linalg.norm(surface.frames(surface.umbilics.places).position - rim, axis=1).argmin()
    away = np.linalg.norm(position[0] - rim[nearest]) - depths.depth[0]
    # half as large as the disc of the parameter, about
    d = moved.at(depths.places).deviator - surface.at(depths.places).deviator
    assert depths.by_deviator[0] @ [d.real[0], d.imag[0]] == pytest.approx(away, abs=0.03 * off / 2)
    # by the nodes, the same with what the umbilic's place in its element moves
    change = (depth_gradients(surface, depths)[0] * (moved.nodes - surface.nodes)).sum()
    position = moved.frames(moved.umbilics.places).position
    away = np.linalg.norm(position[0] - rim[nearest]) - depths.depth[0]
    assert change == pytest.approx(away, abs=0.03 * off / 2)


def test_no_zero_is_beyond_the_rim_of_a_bent_surface_where_it_only_leaves_its_tangent_planes() -> None:
    """Next to a ring in a saddle tangents that lead inwards end above the surface, off it but not beyond its rim."""
    t = np.arange(24) * 2 * np.pi / 24
    outer = np.column_stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)])
    surface = lamella.film([outer, lamella.circle((0, 0, 2), 1.3)], tolerance=0.2)
    found = zeros_beyond_rim(surface, 0.01)
    _, nearest = surface.closest(found)
    ring = 1.3 * np.exp(2j * np.pi * np.arange(5000) / 5000)
    to_ring = cKDTree(np.column_stack([ring.real, ring.imag, np.full(5000, 2.0)])).query(found)[0]
    assert to_ring == pytest.approx(np.linalg.norm(found - nearest, axis=1), rel=0.01)


def test_umbilics_on_the_rim_are_not_listed() -> None:
    """Whether a zero on the rim is found within or beyond is an error of the surface; farther within it is one."""
    listed = []
    for inside in (0.05, 1e-4, -1e-4):
        surface = weierstrass([(1 - inside) * np.exp(0.4j)], rings=10)
        net = element_network(surface, cells=12)
        listed.append(len(net.describe()["umbilics"]))
        # on exact elements as sure as the elements' order allows
        assert depth_errors(surface).max(initial=0.0) < 1e-3
    assert listed == [1, 0, 0]


@pytest.mark.slow
def test_umbilics_on_straight_beams_are_listed_alike() -> None:
    """On a straight beam D is the geodesic torsion alone: its zeros lie on the beam, within the surface's error."""
    corners = np.array([[0, 0, 0], [4, 0, 0.8], [4, 2, -0.5], [2, 2, 0.6], [2, 4, -0.4], [0, 4, 0.7]])
    turn = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
    listed = []
    for moved, tolerance in ((np.eye(3), 0.01), (turn, 0.01), (np.diag([1, 1, -1]), 0.01), (np.eye(3), 0.006)):
        loop = {"points": (corners @ moved.T).tolist(), "interpolation": "polyline"}
        project = {"surface": {"kind": "form-found", "tolerance": tolerance, "boundary": [loop]}}
        figures = compute(parse_project(project | {"network": {"cells": 8}}), until="network").summary["network"]
        listed.append(np.array([one["point"] for one in figures["umbilics"]]).reshape(-1, 3) @ moved)
    for one in listed[1:]:
        assert one == pytest.approx(listed[0], abs=2e-3 * 6)
