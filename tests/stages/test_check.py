"""`lamella check` of surfaces that have to be found: in seconds, and right about what a run refuses and makes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import InputError, compute, parse_project
from lamella.stages.check import COARSE, MOST_TRACED, check_project
from network.adjust.test_adjust import sketch
from network.streamlines.test_kept_lines import hypar, write_grid

TURNS = 2 * np.pi * np.arange(12) / 12
SADDLE = np.stack([5 * np.cos(TURNS), 4 * np.sin(TURNS), 0.8 * np.cos(2 * TURNS)], 1).tolist()


def film(tables: dict[str, Any] | None = None, **surface: Any) -> dict[str, Any]:
    return {
        "surface": {"kind": "form-found", "boundary": [{"name": "rim", "points": SADDLE}], **surface},
        **(tables or {}),
    }


def annulus(**network: Any) -> dict[str, Any]:
    tables = sketch(3)
    return {"surface": tables["surface"] | {"tolerance": 5e-3}, "network": network}


@pytest.mark.parametrize(
    "tables",
    [
        film({"network": {"cells": 16}}),
        film({"network": {"spacing": 0.4, "every": [2, 1]}}),
        film({"network": {"cells": 16, "normal_curvature": 0.01}}),
        film({"network": {"cells": 12, "kind": "principal"}}),
        annulus(cells=24),
    ],
    ids=["cells", "spacing", "lines", "principal", "annulus"],
)
def test_cells_and_nodes_are_those_of_the_run(tables: dict[str, Any]) -> None:
    project, steps = parse_project(tables), []
    checked = check_project(project, progress=lambda report: steps.append(str(report)))
    network = compute(project, until="network").network
    assert network is not None
    assert checked.cells == network.cells
    assert checked.nodes == pytest.approx(len(network.node_points), rel=0.15)
    assert f"{checked.cells} cells, about {checked.nodes:,} nodes" in str(checked)
    tolerance = tables["surface"].get("tolerance", 2e-3)
    assert checked.left == (f"whether 100,000 nodes keep tolerance = {tolerance:g} (checked: 0.02)",)


FOLD = 1.3254868387  # DESIGN section 9: coaxial rings need a distance of at most so many radii


def rings(distance: float) -> list[dict[str, Any]]:
    return [{"name": f"ring {z:g}", "circle": {"center": [0, 0, z], "radius": 3.0}} for z in (0.0, distance)]


@pytest.mark.parametrize(
    ("tables", "words", "key"),
    [
        (film({"network": {"cells": 2000}}), "would make about", "network.cells"),
        (film({"network": {"spacing": 1e-3}}), "would make about", "network.spacing"),
        (film({"network": {"spacing": 5.0}}), "cells across the surface, at least 3", "network.spacing"),
        (film({"network": {"cells": 8, "minimum_length": 100.0}}), "no two lamellas cross", "network.minimum_length"),
        (
            film({"network": {"normal_curvature": 9.0}}),
            "no direction of the surface has it",
            "network.normal_curvature",
        ),
        (annulus(cells=25, every=2), "is no multiple of 2", "network.cells"),
        (film(boundary=rings(1.001 * FOLD * 3.0)), "rings are", "surface.boundary"),
        (film(boundary=rings(3.9), most_nodes=500), "more than tolerance = 0.002", "surface.tolerance"),
        (film(mean_curvature=2.0), "no surface in this boundary bends that much", "surface.mean_curvature"),
    ],
)
def test_what_a_run_refuses(tables: dict[str, Any], words: str, key: str) -> None:
    project = parse_project(tables)
    for look in (check_project, compute):
        with pytest.raises(InputError, match=words) as refused:
            look(project)
        assert refused.value.where == key


def test_what_is_left_to_the_run() -> None:
    project = parse_project(film({"network": {"cells": 90}}, tolerance=COARSE))
    checked = check_project(project)
    assert checked.nodes is not None
    assert checked.nodes > MOST_TRACED
    assert checked.left == ("whether all lamellas can be traced, and their strips (checked up to 5,000 nodes)",)
    assert str(checked).endswith("\n  only a run can tell " + checked.left[0])
    adjusted = annulus(cells=24, closing="adjust")
    assert "whether the boundary can be adjusted" in check_project(parse_project(adjusted)).left[-1]
    low = check_project(parse_project(film(order=2)))
    assert "order = 2 takes about 500,000 nodes" in low.left[0]
    assert check_project(parse_project(film(tolerance=COARSE))).left == ()


@pytest.mark.parametrize("height", [0.0, 1.0, 3.0])
def test_spheres_and_planes_have_no_net(height: float) -> None:
    """DESIGN section 9: a cap of height h has H = 2 h / (h^2 + R^2); a run of it ends with the surface."""
    circle = {"name": "rim", "circle": {"center": [0, 0, 0], "radius": 4.0}}
    project = parse_project(film(boundary=[circle], mean_curvature=-2 * height / (height**2 + 16)))
    checked = check_project(project)
    assert checked.nodes is None
    assert "no net" in str(checked)
    results = compute(project)
    assert results.network is None
    assert checked.warnings == tuple(results.summary["warnings"])
    assert "ends with the surface" in checked.warnings[-1]


UNDULOID = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-1.0, 1.0]}


def words(message: str) -> str:
    """A warning without its figures, lamellas and places."""
    return re.sub(r"\b[AB]?[-\d.,]+", "#", re.sub(r"\(.*?\)", "()", message))


@pytest.mark.parametrize(
    ("tables", "of"),
    [
        ({"surface": UNDULOID, "lamella": {"height": 1.8, "layers": 1}}, ["cell edges", "smallest radius"]),
        ({"surface": UNDULOID, "lamella": {"material": "S235", "thickness": 0.01, "layers": 1}}, ["utilisation"]),
        ({"surface": UNDULOID, "lamella": {"layers": 1}, "fabrication": {"sheet": [1.5, 1.0]}}, ["split"]),
        ({"surface": UNDULOID | {"neck_radius": 1600, "bulge_radius": 2800, "height": [-1e3, 1e3]}}, ["millimetres"]),
        ({"surface": UNDULOID, "network": {"closing": "round"}, "lamella": {"layers": 1}}, ["nothing to do"]),
        (film({"lamella": {"layers": 1}}, boundary=rings(3.5), branch="unstable"), ["unstable"]),
        (film({"network": {"cells": 8}, "lamella": {"height": 2.0, "layers": 1}}), ["cell edges"]),
        (film({"network": {"kind": "principal", "cells": 12}}), ["ends with the network"]),
    ],
    ids=["high", "weak", "sheet", "millimetres", "closing", "unstable", "film", "principal"],
)
def test_what_a_run_warns_of(tables: dict[str, Any], of: list[str]) -> None:
    """All of it, from closed forms to the letter, from coarse elements but for the figures."""
    project = parse_project(tables)
    checked, run = check_project(project), compute(project).summary["warnings"]
    for word in of:
        assert any(word in message for message in checked.warnings)
    assert set(map(words, checked.warnings)) == set(map(words, run))
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
            with pytest.raises(InputError) as refused:
                look(project)
            assert refused.value.where == "surface.boundary"


def test_a_mesh_kept_as_it_is(tmp_path: Path) -> None:
    write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), 24, 24)
    table = {"kind": "mesh", "file": "m.obj", "mean_curvature": "varying"}
    good = parse_project({"surface": table, "network": {"cells": 10, "normal_curvature": 0.0}})
    checked = check_project(good, folder=tmp_path)
    assert checked.cells == 10
    # ten by ten crossings and the ends of twenty lamellas
    assert checked.nodes == pytest.approx(140, rel=0.1)
    with pytest.raises(InputError, match="mean curvature varies"):
        check_project(parse_project({"surface": table}), folder=tmp_path)
