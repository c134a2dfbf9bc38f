"""`net` takes every surface, and what it makes goes on to strips and parts."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError
from network.streamlines.test_kept_lines import hypar, write_grid

TURNS = 2 * np.pi * np.arange(12) / 12
WAVED = np.stack([3 * np.cos(TURNS), 2.5 * np.sin(TURNS), 0.5 * np.cos(2 * TURNS)], 1).tolist()


def film(boundary: list[dict[str, Any]]) -> Any:
    surface = {"kind": "form-found", "tolerance": 1e-2, "boundary": boundary}
    return lamella.make_surface(lamella.parse_project({"surface": surface}))


def test_a_film_goes_all_the_way_to_parts() -> None:
    steps: list[str] = []
    network = lamella.net(film([{"points": WAVED}]), cells=10, progress=lambda report: steps.append(str(report)))
    assert network.cells == 10
    assert any("umbilics" in step for step in steps)
    parts = network.strips((0.08, 0.001), "S355").parts()
    assert parts.pieces == 2 * len(network.ids)
    # the mass of two layers as long as the net's lamellas, slots and ends aside
    assert parts.mass == pytest.approx(2 * 0.08 * 0.001 * 7850 * network.lengths.sum(), rel=0.05)


def test_it_is_the_network_of_a_run() -> None:
    project = lamella.parse_project(
        {
            "surface": {"kind": "form-found", "tolerance": 1e-2, "boundary": [{"points": WAVED}]},
            "network": {"spacing": 0.6, "every": [2, 1], "minimum_length": 0.7},
        }
    )
    run = lamella.compute(project, until="network").network
    own = lamella.net(lamella.make_surface(project), spacing=0.6, every=(2, 1), minimum_length=0.7)
    assert run is not None
    assert own.ids == run.ids
    np.testing.assert_array_equal(own.node_points, run.node_points)


def test_meshes_kept_as_they_are(tmp_path: Path) -> None:
    """The asymptotic lines of z = x y / c are its straight lines: exactly as many as cells, two families."""
    write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), 16, 16)
    table = {"surface": {"kind": "mesh", "file": "m.obj", "mean_curvature": "varying"}}
    surface = lamella.make_surface(lamella.parse_project(table | {"network": {"normal_curvature": 0.0}}), tmp_path)
    steps: list[str] = []
    network = lamella.net(surface, cells=8, normal_curvature=0.0, progress=lambda report: steps.append(str(report)))
    assert any("8 cells" in step or "lines" in step for step in steps)
    assert network.normal_curvature == 0
    assert np.abs(network.sample_darboux.kn).max() < 1e-6
    with pytest.raises(InputError) as refused:
        lamella.net(surface, cells=8)
    assert refused.value.where == "normal_curvature"
    with pytest.raises(InputError) as refused:
        lamella.net(surface, cells=8, normal_curvature=0.0, closing="round")
    assert refused.value.where == "closing"


def test_what_is_no_surface_or_has_no_net() -> None:
    circle = [{"circle": {"center": [0, 0, 0], "radius": 2.0}}]
    with pytest.raises(InputError) as refused:
        lamella.net(film(circle))
    assert refused.value.where == "surface"
    with pytest.raises(InputError, match="list"):
        lamella.net([1, 2])  # type: ignore[arg-type]
    with pytest.raises(InputError) as refused:
        lamella.net(film([{"points": WAVED}]), cells=8, spacing=0.3)
    assert refused.value.where == "spacing"


def test_every_surface_gives_one_type() -> None:
    """Closed forms, films and lines from seeds: a network with its surface, further figures and warnings."""
    disc = film([{"points": WAVED}])
    asked: list[tuple[Any, dict[str, Any]]] = [
        (lamella.Catenoid(2.0, (-1.0, 1.5)), {}),
        (lamella.Catenoid(2.0, (-1.0, 1.5)), {"kind": "principal"}),
        (lamella.Unduloid(1.0, 2.0, (-2.0, 3.0)), {"normal_curvature": 0.3}),
        (lamella.Enneper(3, 0.9, 2.0), {"normal_curvature": 0.05}),
        (disc, {}),
        (disc, {"closing": "round"}),
        (disc, {"normal_curvature": 0.05}),
    ]
    for surface, options in asked:
        net = lamella.net(surface, cells=8, **options)
        assert type(net) is lamella.Network
        assert net.surface is surface
        assert isinstance(net.describe(), dict)
        assert all(isinstance(note, str) for note in net.warnings())
        assert net.allclose(pickle.loads(pickle.dumps(net)), 0.0)
    figures = lamella.net(disc, cells=8).describe()
    assert {"umbilics", "joints", "closed", "node_angle_deviation_max_deg"} <= set(figures)
