"""Surfaces of meshes given as arrays: no file, and the surface that a file of the same mesh gives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lamella import InputError, make_surface, parse_project
from lamella.surface.from_mesh.fit_cmc import fit_cmc
from lamella.surface.from_mesh.raw_mesh import mesh_of_arrays
from surface.from_mesh.meshes import grid, obj_text, triangles

POINTS, QUADS = grid()


def test_arrays_give_the_surface_of_their_file(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text(obj_text(POINTS, QUADS))
    table = {"kind": "mesh", "file": "m.obj", "unit": "m", "tolerance": 0.1, "order": 2}
    read = make_surface(parse_project({"surface": table}), tmp_path)
    fitted = fit_cmc(POINTS, QUADS, tolerance=0.1, order=2)
    assert np.array_equal(fitted.nodes, read.nodes)  # type: ignore[attr-defined]
    assert fitted.mean_curvature == read.mean_curvature


def test_quads_are_split_as_those_of_files() -> None:
    assert len(mesh_of_arrays(POINTS, QUADS).faces) == 2 * len(QUADS)
    own = triangles(QUADS)
    assert np.array_equal(np.sort(mesh_of_arrays(POINTS, own).faces, 1), np.sort(own, 1))


@pytest.mark.parametrize(
    ("points", "faces", "where", "number"),
    [
        (POINTS[:, :2], QUADS, "points", "2"),
        (np.full((4, 3), np.nan), [[0, 1, 2]], "points", "points[0]"),
        (np.eye(3) * 1e308, [[0, 1, 2]], "points", "points[0]"),
        (np.eye(3) * 1e7, [[0, 1, 2]], "points", "1e+07 m"),
        (np.zeros((3, 3)), [[0, 1, 2]], "points", "one place"),
        (POINTS, [[0, 1]], "faces", "(1, 2)"),
        (POINTS, QUADS * 1.0, "faces", "float64"),
        (POINTS[:4], [[0, 1, 4]], "faces", "4"),
    ],
)
def test_what_is_no_mesh_is_refused_by_the_parameter(points: object, faces: object, where: str, number: str) -> None:
    with pytest.raises(InputError) as refused:
        mesh_of_arrays(points, faces)  # type: ignore[arg-type]
    assert refused.value.where == where
    assert number in refused.value.message
