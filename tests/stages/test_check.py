"""`lamella check` of surfaces that have to be found: in seconds, and right about what a run refuses and makes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import Memory, compute, parse_project
from lamella.stages.check import COARSE, MOST_TRACED, check_project
from network.adjust.test_adjust import sketch
from network.streamlines.test_kept_lines import hypar, write_grid
from refusals import check_stated, keys, refused

TURNS = 2 * np.pi * np.arange(12) / 12
SADDLE = np.stack([5 * np.cos(TURNS), 4 * np.sin(TURNS), 0.8 * np.cos(2 * TURNS)], 1).tolist()
# of runs: a quarter of that of checks
TOLERANCE = 5e-3
MEMORY = Memory()
"""Of surfaces that several cases have: found once."""


def film(tables: dict[str, Any] | None = None, **surface: Any) -> dict[str, Any]:
    return {
        "surface": {"kind": "form-found", "tolerance": TOLERANCE, "boundary": [{"name": "rim", "points": SADDLE}]}
        | surface,
        **(tables or {}),
    }


# strips for which no other number of cells is searched: low, and with ends too short to meet beyond the rim
SMALL = {"lamella": {"height": 1e-3, "thickness": 1e-4}, "fabrication": {"end_distance": 1e-3, "rim_overhang": 0.0}}


def annulus(**network: Any) -> dict[str, Any]:
    tables = sketch(3)
    return {"surface": tables["surface"] | {"tolerance": TOLERANCE}, "network": network} | SMALL


@pytest.mark.parametrize(
    "tables",
    [
        film({"network": {"cells": 16}}),
        film({"network": {"spacing": 0.4, "every": [2, 1]}}),
        film({"network": {"cells": 16, "normal_curvature": 0.01}}),
        film({"network": {"cells": 12, "kind": "principal"}}),
        # closed, so that no strips end within
        annulus(cells=24, closing="round"),
    ],
    ids=["cells", "spacing", "lines", "principal", "annulus"],
)
@pytest.mark.few(3)
def test_cells_and_nodes_are_those_of_the_run(tables: dict[str, Any]) -> None:
    """On coarse elements a check counts the cells of a run, and its nodes to 15 %."""
    project, steps = parse_project(tables), []
    checked = check_project(project, progress=lambda report: steps.append(str(report)), memory=MEMORY)
    network = compute(project, until="network", memory=MEMORY).network
    assert network is not None
    assert checked.cells == network.cells
    assert checked.nodes == pytest.approx(len(network.node_points), rel=0.15)
    assert f"{checked.cells} cells, about {checked.nodes:,} nodes" in str(checked)
    assert checked.left == (f"whether 100,000 nodes keep tolerance = {TOLERANCE:g} (checked: 0.02)",)


FOLD = 1.3254868387  # DESIGN section 9: coaxial rings need a distance of at most so many radii


def rings(distance: float) -> list[dict[str, Any]]:
    return [{"name": f"ring {z:g}", "circle": {"center": [0, 0, z], "radius": 3.0}} for z in (0.0, distance)]


@pytest.mark.parametrize(
    ("tables", "key", "numbers"),
    [
        (film({"network": {"cells": 2000}}), "network.cells", [2000, 500_000]),
        (film({"network": {"spacing": 1e-3}}), "network.spacing", [1e-3, 500_000]),
        (film({"network": {"spacing": 5.0}}), "network.spacing", [5, 3]),
        (film({"network": {"cells": 8, "minimum_length": 100.0}}), "network.minimum_length", [100]),
        (film({"network": {"normal_curvature": 9.0}}), "network.normal_curvature", [9]),
        (annulus(cells=25, every=2), "network.cells", [25, 2]),
        (film(boundary=rings(1.001 * FOLD * 3.0)), "surface.boundary", [1.001 * FOLD * 3.0]),
        (film(boundary=rings(3.9), most_nodes=500, tolerance=2e-3), "surface.tolerance", [0.002, 500]),
        (film(mean_curvature=2.0), "surface.mean_curvature", [2]),
    ],
)
@pytest.mark.few(5)
def test_what_a_run_refuses(tables: dict[str, Any], key: str, numbers: list[float]) -> None:
    """A check refuses what a run refuses, by the same key and with the same numbers."""
    project = parse_project(tables)
    for compute_or_check in (check_project, compute):
        with refused(key, numbers):
            compute_or_check(project, memory=MEMORY)


def test_what_is_left_to_the_run() -> None:
    """What a check did not look at is said, each thing on its own."""
    project = parse_project(film({"network": {"cells": 90}}, tolerance=COARSE))
    checked = check_project(project, memory=MEMORY)
    assert checked.nodes is not None
    assert checked.nodes > MOST_TRACED
    (left,) = checked.left
    check_stated(left, [MOST_TRACED])
    assert str(checked).endswith(left)
    # of a net that is adjusted it is one thing more
    rim = {"name": "rim", "points": SADDLE, "adjust": {"points": 0.1}}
    adjusted = film({"network": {"cells": 10, "closing": "adjust"}}, boundary=[rim])
    assert len(check_project(parse_project(adjusted), memory=MEMORY).left) == 2
    low = check_project(parse_project(film(SMALL, boundary=rings(1.0), order=2, tolerance=2e-3)), memory=MEMORY)
    check_stated(low.left[0], [2, 500_000], ["order"])
    assert check_project(parse_project(film(SMALL, tolerance=COARSE)), memory=MEMORY).left == ()


@pytest.mark.parametrize("height", [0.0, 1.0, 3.0])
def test_spheres_and_planes_have_no_net(height: float) -> None:
    """DESIGN section 9: a cap of height h has H = 2 h / (h^2 + R^2); a run of it ends with the surface."""
    circle = {"name": "rim", "circle": {"center": [0, 0, 0], "radius": 4.0}}
    project = parse_project(film(boundary=[circle], mean_curvature=-2 * height / (height**2 + 16)))
    checked = check_project(project)
    assert checked.nodes is None
    results = compute(project)
    assert results.network is None
    assert checked.warnings == tuple(results.summary["warnings"])
    assert keys(checked.warnings)[-1] == "ends_with_surface"


UNDULOID = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-1.0, 1.0]}


@pytest.mark.parametrize(
    ("tables", "of"),
    [
        ({"surface": UNDULOID, "lamella": {"height": 1.8, "layers": 1}}, ["cells_narrow", "strip_high"]),
        ({"surface": UNDULOID, "lamella": {"material": "S235", "thickness": 0.01, "layers": 1}}, ["overstressed"]),
        ({"surface": UNDULOID, "lamella": {"layers": 1}, "fabrication": {"sheet": [1.5, 1.0]}}, ["lamellas_split"]),
        ({"surface": UNDULOID | {"neck_radius": 1600, "bulge_radius": 2800, "height": [-1e3, 1e3]}}, ["unit_large"]),
        ({"surface": UNDULOID, "network": {"closing": "round"}, "lamella": {"layers": 1}}, ["closing_idle"]),
        (film({"lamella": {"layers": 1}}, boundary=rings(3.5), branch="unstable"), ["film_unstable"]),
        (film({"network": {"cells": 8}, "lamella": {"height": 2.0, "layers": 1}}), ["cells_narrow"]),
        (film({"network": {"kind": "principal", "cells": 12}}), ["ends_with_network"]),
    ],
    ids=["high", "weak", "sheet", "millimetres", "closing", "unstable", "film", "principal"],
)
@pytest.mark.few(4)
def test_what_a_run_warns_of(tables: dict[str, Any], of: list[str]) -> None:
    """All of it: from closed forms to the letter, from coarse elements the same but for the figures."""
    project = parse_project(tables)
    checked = check_project(project, memory=MEMORY)
    run = compute(project, memory=MEMORY).summary["warnings"]
    assert set(of) <= set(keys(checked.warnings))
    assert keys(checked.warnings) == keys(run)
    if not checked.coarse:
        assert list(checked.warnings) == run
    assert f"{len(run)} warning" in str(checked)


def test_adjusting_what_may_not_change() -> None:
    """Before any film is looked for: sliding loops are not adjusted, nor those whose limits are all 0."""
    sliding = [{"points": SADDLE, "slide": {"direction": [0, 0, 1]}}, {"circle": {"center": [0, 0, 1], "radius": 1}}]
    held = sliding[1] | {"adjust": {"move": 0.0}}
    for boundary in ([sliding[0], held], [held]):
        project = parse_project(film({"network": {"closing": "adjust"}}, boundary=boundary))
        for look in (check_project, compute):
            with refused("surface.boundary"):
                look(project)


def test_a_mesh_kept_as_it_is(tmp_path: Path) -> None:
    """Cells and nodes of lines on a mesh that is no surface of constant mean curvature, and what is refused there."""
    write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), 24, 24)
    table = {"kind": "mesh", "file": "m.obj", "mean_curvature": "varying"}
    good = parse_project({"surface": table, "network": {"cells": 10, "normal_curvature": 0.0}})
    checked = check_project(good, folder=tmp_path)
    assert checked.cells == 10
    # ten by ten crossings and the ends of twenty lamellas
    assert checked.nodes == pytest.approx(140, rel=0.1)
    with refused("network.normal_curvature"):
        check_project(parse_project({"surface": table}), folder=tmp_path)
