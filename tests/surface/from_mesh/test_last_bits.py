"""Surfaces from meshes, and nets on them, do not hang on the last bits of the vertices, however even the mesh is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import EXAMPLES
from lamella import Results, compute, parse_project
from lamella.files.read.mesh import read_mesh
from surface.from_mesh.meshes import grid

NOISE = 1e-14
"""Of the size: a few units in the last place."""


def computed(points: np.ndarray, faces: np.ndarray, folder: Path, until: str, **tables: Any) -> Results:
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    rows += ["f " + " ".join(str(k + 1) for k in face) for face in faces.tolist()]
    (folder / "m.obj").write_text("\n".join(rows) + "\n")
    project = parse_project(
        {"surface": {"kind": "mesh", "file": "m.obj", "unit": "m"} | tables.pop("surface")} | tables
    )
    return compute(project, until=until, folder=folder)


def noisy(points: np.ndarray) -> np.ndarray:
    size = np.linalg.norm(np.ptp(points, axis=0))
    return points + NOISE * size * np.random.default_rng(3).uniform(-1, 1, points.shape)


@pytest.mark.slow
def test_elements_of_a_fitted_surface(tmp_path: Path) -> None:
    mesh = read_mesh(EXAMPLES / "16_hall.obj", "m")
    table = {"surface": {"mean_curvature": "fit"}}
    one, other = (
        computed(points, mesh.faces, tmp_path, "surface", **table).summary["surface"]
        for points in (mesh.points, noisy(mesh.points))
    )
    assert one["elements"] == other["elements"]
    assert one["mean_curvature_deviation"] == pytest.approx(other["mean_curvature_deviation"], rel=1e-6)


@pytest.mark.parametrize(("curvature", "columns"), [(0.0, 15), (0.02, 14)])
@pytest.mark.few(1)
def test_lines_on_a_symmetric_mesh(tmp_path: Path, curvature: float, columns: int) -> None:
    """z = x^2 / 9 - y^2 / 11: seeds, gaps and the elements at a vertex come in mirrored pairs."""
    points, faces = grid(columns, columns, lambda x, y: (x - 3) ** 2 / 9 - (y - 3) ** 2 / 11, 6.0)
    tables = {
        "surface": {"mean_curvature": "varying"},
        "network": {"normal_curvature": curvature, "spacing": 0.9},
        "lamella": {"layers": 1},
    }
    one, other = (computed(each, faces, tmp_path, "lamellas", **tables) for each in (points, noisy(points)))
    assert one.network is not None
    assert other.network is not None
    assert one.network.ids == other.network.ids
    np.testing.assert_allclose(one.network.node_points, other.network.node_points, atol=1e-9)
    first, second = (each.summary["surface"]["curvature_error"] for each in (one, other))
    assert first == pytest.approx(second, rel=1e-6)
    assert one.summary["warnings"] == other.summary["warnings"]
