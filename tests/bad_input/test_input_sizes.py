"""Inputs that are small in bytes and large in what they ask for: refused within seconds and little memory."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Sequence
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from lamella.files.quad_mesh_files import read_quad_mesh
from lamella.files.read import file_mesh
from lamella.files.read.file_mesh import TEXT_BLOCK, blocks
from lamella.files.read.mesh import read_mesh
from lamella.files.read.mesh_obj import read_obj
from lamella.files.read.mesh_ply import read_ply
from lamella.files.read.mesh_stl import read_stl
from lamella.project.read import parse_project, read_project
from lamella.stages.surface.boundary_of_tables import boundary_loops
from refusals import refused

UNDULOID = '[surface]\nkind = "unduloid"\nneck_radius = 1.6\nbulge_radius = 2.8\nheight = [-1.0, 1.0]\n'
SECONDS = 15
"""Of computing: each of these took minutes, or for ever; a few seconds are needed on a slow machine."""


def check_refused(
    read: Callable[[], object], where: str | None = None, numbers: Sequence[float] = (), names: Sequence[str] = ()
) -> None:
    """Fail unless something is refused within time, and the error states where, numbers and names."""
    start = time.process_time()
    with refused(where, numbers, names):
        read()
    assert time.process_time() - start < SECONDS


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("a." * 100_000 + "b = 1\n", [32]),
        (UNDULOID + "[" + '"a b".' * 50_000 + "b]\n", [32]),
        (UNDULOID + "".join(f"a{k} = 1\n" for k in range(60_000)), [60_000 - 6]),
        (UNDULOID + "".join(f"[a{k}]\n" for k in range(30_000)), [30_000 - 6]),
        (UNDULOID + "a = " + "[" * 400_000, []),
        (UNDULOID + "a = " + "9" * 1_000_000, []),
    ],
    ids=["dotted", "header", "keys", "tables", "nested", "digits"],
)
def test_projects(tmp_path: Path, text: str, numbers: list[float]) -> None:
    (tmp_path / "p.toml").write_text(text)
    check_refused(lambda: read_project(tmp_path / "p.toml"), numbers=numbers)


def test_keys_of_many_errors_are_counted(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text(UNDULOID + "".join(f"a{k} = 1\n" for k in range(1000)))
    check_refused(lambda: read_project(tmp_path / "p.toml"), numbers=[994], names=["surface.a0"])


@pytest.mark.parametrize("text", ["name = '" + "a." * 100 + "'\n", "# " + "a." * 100 + "\n" + 'name = "x"\n'])
def test_dots_in_texts_are_no_keys(tmp_path: Path, text: str) -> None:
    """Not quite: 32 words with single dots between them are refused wherever they stand; those with spaces are not."""
    (tmp_path / "p.toml").write_text(text.replace("a.", "a. b, ")[:200] + text[-2:] + UNDULOID)
    assert read_project(tmp_path / "p.toml").name


def test_lines_without_end() -> None:
    for data in (b"f " + b"1 " * 2_000_000, b"v 0 0 0\n# " + b"a" * (2 * TEXT_BLOCK)):
        check_refused(lambda data=data: read_obj(data), "path")  # type: ignore[misc]
    text = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n" + b"1" * (2 * TEXT_BLOCK)
    check_refused(lambda: read_ply(text), "path")


def test_blocks_cover_a_text_and_end_where_lines_do() -> None:
    words = [b"%d" % number for number in np.random.default_rng(0).integers(0, 10**9, 300_000)]
    text = b"\n".join(words) + b"\n"
    found = list(blocks(text, b"\n"))
    assert len(found) > 2
    assert b"".join(found) == text
    assert all(block.endswith(b"\n") and len(block) <= TEXT_BLOCK for block in found)
    assert list(blocks(b"", b"\n")) == []


def test_a_mesh_of_several_blocks_is_read_as_one() -> None:
    """Negative numbers count back over the blocks, faces stand between vertices."""
    count = 40_000
    rows = []
    for k in range(count):
        rows.append(f"v {k}.123456 0.5 0\nv {k} 1 0.25\n" + (f"f -1 -2 -4 {max(2 * k - 1, 1)}\n" if k else ""))
    text = "".join(rows).encode()
    assert len(text) > 2 * TEXT_BLOCK
    found = read_obj(text)
    assert found.points.shape == (2 * count, 3)
    assert (found.points[::2, 0] == np.arange(count) + 0.123456).all()
    k = np.arange(1, count)
    assert (found.corners.reshape(-1, 4) == np.stack([2 * k + 1, 2 * k, 2 * k - 2, 2 * k - 2], 1)).all()
    broken = text + b"v 1 x 0\n"
    check_refused(lambda: read_obj(broken), "path", [2 * count + 1], ["v 1 x 0"])


def test_a_text_takes_little_more_than_its_own_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    count, block = 60_000, 20_000
    monkeypatch.setattr(file_mesh, "TEXT_BLOCK", block)
    text = b"".join(b"v %d 0 0\n" % k for k in range(count)) + b"f 1 2 3\n"
    tracemalloc.start()
    read_obj(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # copies of the text, the coordinates twice, the words of one block; all words at once would take 14 MB
    assert peak < 3 * len(text) + 2 * 24 * count + 60 * block


def test_ply_headers_that_claim() -> None:
    head = "ply\nformat binary_little_endian 1.0\n"
    triangle = "property double x\nproperty double y\nproperty double z\n"
    for rows, numbers in (
        (f"element vertex {10**12}\n{triangle}", [10**12]),
        (f"element vertex {10**12}\n", [10**12]),
        (f"element material {10**15}\nelement vertex 3\n{triangle}", [10**15]),
        (f"element face {10**9}\nproperty list uchar int vertex_indices\n", [10**9]),
        (f"element vertex {'9' * 5000}\n{triangle}", []),
    ):
        data = f"{head}{rows}end_header\n".encode() + bytes(100)
        check_refused(lambda data=data: read_ply(data), "path", numbers)  # type: ignore[misc]


def test_an_stl_that_ends_in_spaces() -> None:
    data = b"solid a\nfacet normal 0 0 1\nendfacet\n" + (b"endsolid" + b" " * 300_000 + b"x\n") * 2 + b"facet"
    check_refused(lambda: read_stl(data), "path", [1])


def test_files_beyond_the_limit_are_not_read(tmp_path: Path) -> None:
    for name, size in (("a.obj", 260_000_000), ("a.json", 70_000_000)):
        with (tmp_path / name).open("wb") as file:
            file.truncate(size)  # takes no room on the disk
        check_refused(lambda name=name: read_quad_mesh(tmp_path / name), names=["MB"])  # type: ignore[misc]
    check_refused(lambda: read_mesh(tmp_path / "a.obj"), "path", [260])
    with (tmp_path / "a.dxf").open("wb") as file:
        file.truncate(70_000_000)
    check_refused(lambda: loops(tmp_path / "a.dxf"), "surface.boundary[0].file", [70])


def loops(path: Path) -> object:
    project = parse_project({"surface": {"kind": "form-found", "boundary": [{"file": path.name, "unit": "m"}]}})
    return boundary_loops(project.surface, path.parent)  # type: ignore[arg-type]


def nested_blocks(drawing: ezdxf.document.Drawing) -> None:
    for level in range(12):
        block = drawing.blocks.new(f"b{level}")
        for _ in range(10):
            if level:
                block.add_blockref(f"b{level - 1}", (0, 0))
    drawing.modelspace().add_blockref("b11", (0, 0))


def rows_of_blocks(drawing: ezdxf.document.Drawing) -> None:
    drawing.blocks.new("empty")
    grid = {"row_count": 30_000, "column_count": 30_000, "row_spacing": 1, "column_spacing": 1}
    drawing.modelspace().add_blockref("empty", (0, 0), grid)


@pytest.mark.parametrize("fill", [nested_blocks, rows_of_blocks])
def test_blocks_without_end(tmp_path: Path, fill: Callable[[ezdxf.document.Drawing], None]) -> None:
    drawing = ezdxf.new()
    fill(drawing)
    drawing.saveas(tmp_path / "a.dxf")
    check_refused(lambda: loops(tmp_path / "a.dxf"), "surface.boundary[0].file", [20_000])


@pytest.mark.parametrize(
    "add",
    [
        lambda space: space.add_circle((1e308, 0), 1),
        lambda space: space.add_rational_spline([(0, 0), (1, 1), (2, 0), (0, 0)], [1, 1e-320, 1, 1]),
        lambda space: space.add_line((0, 0), (1e15, 0)),
    ],
)
def test_curves_of_impossible_numbers(tmp_path: Path, add: Callable[[object], object]) -> None:
    drawing = ezdxf.new()
    add(drawing.modelspace())
    drawing.saveas(tmp_path / "a.dxf")
    check_refused(lambda: loops(tmp_path / "a.dxf"), "surface.boundary[0].file", [1])


@pytest.mark.parametrize("attributes", ["7", '"x"', "[1]", "true"])
def test_a_compas_vertex_without_attributes(tmp_path: Path, attributes: str) -> None:
    mesh = '{"data": {"vertex": {"v": ATTRIBUTES}, "face": {"0": ["v", "v", "v", "v"]}}}'
    (tmp_path / "a.json").write_text(mesh.replace("ATTRIBUTES", attributes))
    check_refused(lambda: read_quad_mesh(tmp_path / "a.json"))
