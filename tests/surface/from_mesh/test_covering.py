"""Faces that lie on others, and meshes in .off files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lamella import InputError
from lamella.files.read.mesh import read_mesh
from lamella.surface.from_mesh.clean import clean
from lamella.surface.from_mesh.covering import covered_faces, second_diagonals


def grid(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    points = np.stack([x, y, 0.1 * x * y], axis=-1).reshape(-1, 3).astype(float)
    k = np.arange(rows * columns).reshape(rows, columns)
    return points, np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)


def obj(points: np.ndarray, faces: list[list[int]]) -> str:
    text = "".join("v {:.17g} {:.17g} {:.17g}\n".format(*point) for point in points.tolist())
    return text + "".join(f"f {' '.join(str(k + 1) for k in face)}\n" for face in faces)


@pytest.mark.parametrize("apart", [False, True])
def test_quads_saved_with_their_triangles(tmp_path: Path, apart: bool) -> None:
    points, quads = grid(6, 5)
    some = quads[::3]
    triangles = np.concatenate([some[:, [0, 1, 2]], some[:, [0, 2, 3]]])
    if apart:
        # with vertices of their own, as exporters of single objects write them
        triangles += len(points)
        points = np.concatenate([points, points])
    (tmp_path / "m.obj").write_text(obj(points, [*quads.tolist(), *triangles.tolist()]))
    raw = read_mesh(tmp_path / "m.obj", "m")
    assert len(raw.faces) == 2 * len(quads)
    assert any(f"{len(triangles)} faces that lie on others" in note for note in raw.notes)
    assert len(clean(raw).borders) == 1


def test_squares_with_both_diagonals(tmp_path: Path) -> None:
    points, quads = grid(5, 4)
    first = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    second = np.concatenate([quads[::2][:, [0, 1, 3]], quads[::2][:, [1, 2, 3]]])
    (tmp_path / "m.obj").write_text(obj(points, [*first.tolist(), *second.tolist()]))
    raw = read_mesh(tmp_path / "m.obj", "m")
    np.testing.assert_array_equal(raw.faces, first)


def test_whole_meshes_have_no_such_faces() -> None:
    points, quads = grid(5, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    sizes = np.r_[np.full(6, 4), np.full(12, 3)]
    mixed = np.concatenate(
        [quads[:6].ravel(), np.concatenate([quads[6:][:, [0, 1, 2]], quads[6:][:, [0, 2, 3]]]).ravel()]
    )
    assert not covered_faces(points, sizes, mixed).any()
    assert not second_diagonals(triangles).any()
    # a vertex with three faces around it, which all lie on the triangle that is not there
    assert not second_diagonals(np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]])).any()


@pytest.mark.parametrize("head", ["OFF\n{}\n", "OFF {}\n", "COFF\n# a remark\n{}\n", "{}\n"])
def test_off_files(tmp_path: Path, head: str) -> None:
    points, quads = grid(4, 3)
    colour = " 0.5 0.5 0.5 1" if head.startswith("C") else ""
    text = head.format(f"{len(points)} {len(quads)} 0")
    text += "".join("{:.17g} {:.17g} {:.17g}".format(*point) + colour + "\n" for point in points.tolist())
    text += "".join(f"4 {a} {b} {c} {d} 255 0 0\n" for a, b, c, d in quads.tolist())
    (tmp_path / "m.off").write_bytes(text.encode("utf-8-sig"))
    raw = read_mesh(tmp_path / "m.off", "m")
    np.testing.assert_array_equal(raw.points, points)
    assert len(raw.faces) == 2 * len(quads)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "OFF",
        "OFF\n3 1",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
        "OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n",
        "4OFF\n0 0 0\n",
        "OFF BINARY\n\0",
        "ply\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n",
        "OFF\n9999999999 1 0\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-1 0 1 2\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999999999999999 0 1 2\n",
        "OFF\n-3 1 0\n",
        "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    ],
)
def test_damaged_off_files(tmp_path: Path, text: str) -> None:
    (tmp_path / "m.off").write_text(text)
    with pytest.raises(InputError) as error:
        read_mesh(tmp_path / "m.off", "m")
    assert error.value.where == "path"
    assert error.value.remedy
