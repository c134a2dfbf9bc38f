"""The stage "panels": its files read back, its figures, its defaults, and what is refused."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import rhino3dm

import lamella
from lamella import InputError
from lamella.panels.panels import FLAT, Panels
from lamella.stages.scene import scene_of
from lamella.view.scene.encode import encode_scene
from stages.csv_rows import rows

PROJECT: dict[str, Any] = {
    "name": "Facade",
    "surface": {"kind": "enneper", "order": 3, "radius": 0.8, "scale": 3.0},
    "network": {"cells": 12},
    "lamella": {"height": 0.06, "layers": 1},
    "panels": {"limit_mm": 0.1},
}


def made(**panels: Any) -> lamella.Results:
    return lamella.compute(lamella.parse_project(PROJECT | {"panels": panels}), until="panels")


@pytest.fixture(scope="module")
def results() -> lamella.Results:
    return lamella.compute(lamella.parse_project(PROJECT))


@pytest.fixture(scope="module")
def run(results: lamella.Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("panels") / "out"
    lamella.write(results, folder)
    return folder


def outlines(file: Path) -> dict[str, np.ndarray]:
    """Closed outlines of the drawing, mm, by the kind they are tagged with."""
    found = {}
    for entity in ezdxf.readfile(file).modelspace().query('LWPOLYLINE[layer=="CUT"]'):
        (tag,) = [value for code, value in entity.get_xdata("LAMELLA") if code == 1000]
        assert entity.closed
        assert tag not in found
        found[tag] = np.array([point[:2] for point in entity.get_points()])
    return found


def test_drawing_has_the_plates_as_they_stand_in_space(run: Path, results: lamella.Results) -> None:
    """Sides and diagonals of each outline within 0.01 mm of those between the corners in space, less the gap."""
    panels: Panels = results.outputs["panels"]
    drawn = outlines(run / "panels" / "panels.dxf")
    assert sorted(drawn) == sorted(f"T{k + 1}" for k in range(panels.different))
    at = panels.plates.offsets
    for kind, first in enumerate(panels.first_of_kind.tolist()):
        flat, corner = drawn[f"T{kind + 1}"], 1000 * panels.corners[at[first] : at[first + 1]]
        assert panels.made[first] == FLAT
        for step in (1, 2):
            read, meant = (np.linalg.norm(np.roll(x, -step, axis=0) - x, axis=1) for x in (flat, corner))
            assert read == pytest.approx(meant, abs=0.01)


def test_list_has_every_plate(run: Path, results: lamella.Results) -> None:
    panels: Panels = results.outputs["panels"]
    table = rows(run / "panels.csv")
    assert [row["id"] for row in table] == list(panels.ids)
    assert [int(row["kind"][1:]) - 1 for row in table] == panels.kinds.tolist()
    figures = results.summary["panels"]
    assert figures["count"] == len(table)
    assert figures["different"] == len({row["kind"] for row in table})
    assert sum(float(row["area_m2"]) for row in table) == pytest.approx(figures["area"], rel=1e-5)
    assert max(float(row["out_of_plane_mm"]) for row in table) == pytest.approx(
        figures["out_of_plane_max_mm"], abs=1e-3
    )
    over = {row["id"].partition(".")[0] for row in table if float(row["out_of_plane_mm"]) > 0.1}
    assert len(over) == figures["over_limit"] > 0
    network = json.loads((run / "network.json").read_text())
    for row in table:
        nodes = [network["nodes"][int(node)] for node in row["nodes"].split(";")]
        middle = np.mean([np.array(node["point"]) + 0.06 * np.array(node["normal"]) for node in nodes], axis=0)
        assert [float(row[f"{axis}_m"]) for axis in "xyz"] == pytest.approx(middle.tolist(), abs=1e-4)
        angles = [float(angle) for angle in row["angles_deg"].split(";")]
        assert len(angles) == len(nodes) == len(row["sides_mm"].split(";")) == len(row["kinks_deg"].split(";"))
        # of a planar polygon; those near the limit miss it by the square of their angle to the plane
        assert sum(angles) == pytest.approx(180 * (len(angles) - 2), abs=0.1)


def test_model_has_a_layer_of_panels(run: Path, results: lamella.Results) -> None:
    model = rhino3dm.File3dm.Read(str(run / "model.3dm"))
    layer = next(layer for layer in model.Layers if layer.Name == "panels flat")
    there = [item.Attributes.Name for item in model.Objects if item.Attributes.LayerIndex == layer.Index]
    assert sorted(there) == sorted(results.outputs["panels"].ids)


def test_view_shows_every_plate(results: lamella.Results) -> None:
    scene = scene_of(results)
    layer, panels = scene.layer("panels"), results.outputs["panels"]
    assert layer.ids == panels.ids
    values = {one.key: one.values for one in layer.quantities}
    assert values["out_of_plane"].max() == pytest.approx(results.summary["panels"]["out_of_plane_max_mm"], rel=1e-12)
    (mark,) = [one for one in scene.marks if one.key == "panels_over_limit"]
    assert len(mark.ids) == results.summary["panels"]["over_limit"]
    assert len(encode_scene(scene)) > 12 * len(layer.positions)


def test_measures_follow_the_strip(results: lamella.Results) -> None:
    assert results.project.panels is not None
    assert results.project.panels.offset == 0.06
    assert made(offset=-0.2).outputs["panels"].rules.offset == -0.2
    assert made(on="cells").outputs["panels"].rules.above_limit == "cold-bent"


def test_principal_nets_have_their_cells_as_panels() -> None:
    project = PROJECT | {"network": {"cells": 12, "kind": "principal"}}
    out = lamella.compute(lamella.parse_project(project))
    assert "fabrication" not in out.outputs
    panels: Panels = out.outputs["panels"]
    assert len(panels.planned) == len(out.network.face_offsets) - 1


def test_no_table_no_panels() -> None:
    project = lamella.parse_project({key: value for key, value in PROJECT.items() if key != "panels"})
    with pytest.raises(InputError) as refused:
        lamella.compute(project, until="panels")
    assert refused.value.where == "panels"


@pytest.mark.parametrize(
    ("values", "where"),
    [({"offset": 5.0}, "panels.offset"), ({"gap": 1.0}, "panels.gap")],
)
def test_what_is_refused(values: dict[str, Any], where: str) -> None:
    with pytest.raises(InputError) as refused:
        made(**values)
    assert refused.value.where == where
    assert refused.value.remedy


@pytest.mark.parametrize("values", [{"gap": -1.0}, {"limit_mm": -1.0}, {"kind": "round"}, {"along": 3}, {"gaps": 1}])
def test_values_out_of_range(values: dict[str, Any]) -> None:
    with pytest.raises(InputError) as refused:
        lamella.parse_project(PROJECT | {"panels": values})
    assert refused.value.where.startswith("panels.")


def test_same_bytes_twice(run: Path, results: lamella.Results, tmp_path: Path) -> None:
    lamella.write(lamella.compute(lamella.parse_project(PROJECT)), tmp_path / "again")
    for name in ("panels.csv", "panels/panels.dxf", "model.3dm"):
        assert (tmp_path / "again" / name).read_bytes() == (run / name).read_bytes()
    with (run / "panels.csv").open() as file:
        assert next(csv.reader(file))[0].startswith("# lamella")
