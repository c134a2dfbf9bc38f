"""The ruler: measure_network.py recomputes every quality figure from the points of network.json alone.

Its own error on exact curves at 16 segments a cell is 4e-5 of the curvature scale and 5e-4 deg at 10 cells around
(nodoid), 3e-6 and 2e-5 deg at 24; so a written network has to measure 1e-5 and 1e-3 deg from 24 cells up.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lamella
from conftest import KINDS, draw_surface, load
from lamella import Catenoid, Enneper, Helicoid, Nodoid, Scherk, Unduloid
from lamella.files.write.network_json import network_bytes
from lamella.network.lattice.density import choose_density
from validation.measure_network import measure


def _measured(surface, cells):
    network = lamella.net(surface, cells=cells)
    return network, measure(json.loads(network_bytes(network, name="ruler", version="0")))


def _check(surface, cells):
    network, f = _measured(surface, cells)
    size = network.lengths.max()
    assert f["node_angle_measured"] == f["regular_nodes"] == (network.node_kinds == 0).sum()
    assert f["family_sign_errors"] == 0
    assert f["node_off_centreline_max"] <= 1e-9
    fine = cells >= 24
    assert f["normal_curvature_error_rel_max"] <= (1e-5 if fine else 1e-3)
    assert f["node_angle_deviation_max_deg"] <= (1e-3 if fine else 2e-2)
    assert f["node_arclength_error_max"] <= (1e-6 if fine else 1e-5) * max(1, size / 10)
    assert f["cell_edge_median"] == pytest.approx(np.median(network.cell_edges), rel=1e-6)
    # trapezia of 16 segments: the ruler's own spread is their error; a low band may have no cell between two
    # regular nodes
    if network.node_kinds[network.face_nodes].tolist().count(0) > 4 * cells:
        assert f["cell_twist_spread_p95"] <= (1e-4 if fine else 1e-3)


# nets of thousands of nodes, which the ruler takes seconds for
LARGE = {(41, "helicoid"), (41, "enneper3"), (41, "enneper"), (24, "helicoid")}


@pytest.mark.parametrize(
    ("cells", "kind"),
    [
        pytest.param(cells, kind, marks=pytest.mark.slow if (cells, kind) in LARGE else ())
        for cells in (10, 24, 41)
        for kind in KINDS
    ],
)
@pytest.mark.few(7)
def test_ruler_agrees(cells, kind):
    """Nets of random closed forms from their written points alone: angles, normal curvature, families, lengths."""
    _check(draw_surface(kind, np.random.default_rng([cells, 71])), cells)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_ruler_agrees_on_many(kind):
    seen = 0
    for seed in range(40):
        rng = np.random.default_rng([seed, 72])
        surface, cells = draw_surface(kind, rng), int(rng.integers(10, 80))
        # neither a band so low that hardly any lamellas cross nor a net the ruler takes minutes for
        if 6 * cells < choose_density(surface, cells=cells).estimated_nodes < 4000:
            _check(surface, cells)
            seen += 1
    assert seen >= 10


@pytest.mark.slow
@pytest.mark.parametrize(
    "surface",
    [
        Unduloid(1.0, 1.7, (-0.2, 0.25)),
        Nodoid(1.0, 3.0, (-0.1, 0.25)),
        Catenoid(1.0, (-0.1, 0.3)),
        Helicoid(20.0, 0.0, 1.0, 0.05),
        Enneper(2, 0.6),
        Scherk(0.8),
    ],
    ids=lambda surface: surface.kind,
)
def test_ruler_agrees_at_200_cells(surface):
    _check(surface, 200 if surface.outline.__class__.__name__ == "Ring" else 100)


def test_ruler_sees_a_wrong_network():
    """The ruler is no rubber stamp: a node moved by a millimetre and a swapped family show."""
    network = lamella.net(draw_surface("catenoid", np.random.default_rng(5)), cells=24)
    content = json.loads(network_bytes(network, name="ruler", version="0"))
    content["lamellas"][0]["family"] = "B"
    content["nodes"][5]["point"][0] += 1e-3
    f = measure(content)
    assert f["family_sign_errors"] == 1
    assert f["node_off_centreline_max"] == pytest.approx(1e-3)


def test_ruler_runs_on_a_written_file(run):
    folder = run("network", surface={"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]})
    ruler = Path(__file__).with_name("measure_network.py")
    done = subprocess.run(
        [sys.executable, ruler, folder / "network.json", "--json"], capture_output=True, text=True, check=True
    )
    assert json.loads(done.stdout)["normal_curvature_error_rel_max"] < 1e-5


@pytest.mark.parametrize(
    "surface",
    [
        {"kind": "unduloid", "neck_radius": 0.9, "bulge_radius": 2.1, "height": [-2.0, 3.3]},
        {"kind": "scherk", "extent": 1.35, "scale": 2.5},
        {"kind": "enneper", "order": 4, "radius": 0.85, "scale": 3.0},
    ],
    ids=lambda s: s["kind"],
)
@pytest.mark.few(2)
def test_summary_agrees_with_the_ruler(run, surface):
    """What a run says of itself, computed from the surface, against what the points say."""
    folder = run("network", surface=surface, network={"cells": 26})
    told, f = load(folder, "summary.json"), measure(load(folder, "network.json"))
    for name in ("cell_edge_min", "cell_edge_median", "cell_edge_max"):
        assert told["network"][name] == pytest.approx(f[name], rel=1e-6, abs=1e-9)
    assert told["network"]["nodes"] == f["nodes"]
    assert told["network"]["lamellas"] == f["lamellas"]
    assert len(told["network"]["singular_nodes"]) == f["singular_nodes"]
    assert told["surface"]["mean_curvature"] == f["mean_curvature"]
    scale = f["curvature_scale"]
    assert abs(told["network"]["normal_curvature_deviation_max"] - f["normal_curvature_error_max"]) < 1e-5 * scale
    assert abs(told["network"]["node_angle_deviation_max_deg"] - f["node_angle_deviation_max_deg"]) < 1e-3
