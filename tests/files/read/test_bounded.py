"""Work in a process of its own: results come back, and limits end it."""

from __future__ import annotations

import base64
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import rhino3dm

from lamella.base.errors import InputError
from lamella.files.read import bounded, rhino_model
from lamella.files.read.bounded import BrokeDown, Limits, TookTooLong, limits_for, run_bounded
from lamella.files.read.rhino_model import read_rhino

ROOM = 2**29


def work(folder: Path, monkeypatch: pytest.MonkeyPatch, body: str) -> str:
    """A module with this main function, where only the calling process finds it."""
    (folder / "own_work.py").write_text(
        "import os, sys, time\nfrom lamella.files.read.bounded import Limits, limit_this_process\n"
        f"def main(arguments):\n    limit_this_process(Limits(int(arguments[0]), int(arguments[1])))\n    {body}\n"
    )
    monkeypatch.syspath_prepend(str(folder))
    return "own_work"


def test_a_result_comes_back_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    body = "sys.stdout.buffer.write(arguments[2].encode() + sys.stdin.buffer.read()[::-1])"
    data = np.random.default_rng(0).bytes(3_000_000)
    found = run_bounded(work(tmp_path, monkeypatch, body), ["ä"], data, Limits(20, ROOM))
    assert found == "ä".encode() + data[::-1]


@pytest.mark.skipif(sys.platform == "win32", reason="computing is counted by POSIX systems")
def test_computing_without_end_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    start = time.monotonic()
    with pytest.raises(TookTooLong):
        run_bounded(work(tmp_path, monkeypatch, "while True: pass"), [], b"", Limits(1, ROOM))
    assert time.monotonic() - start < 30


def test_waiting_without_end_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "WALL_PER_CPU", 1)
    with pytest.raises(TookTooLong):
        run_bounded(work(tmp_path, monkeypatch, "time.sleep(600)"), [], b"", Limits(1, ROOM))


@pytest.mark.parametrize("body", ["raise ValueError", "os.abort()", "sys.exit(3)"])
def test_a_breakdown_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: str) -> None:
    with pytest.raises(BrokeDown):
        run_bounded(work(tmp_path, monkeypatch, body), [], b"", Limits(20, ROOM))


@pytest.mark.skipif(sys.platform != "linux", reason="address space is limited by Linux")
def test_memory_without_end_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(BrokeDown):
        run_bounded(work(tmp_path, monkeypatch, "bytearray(2**30)"), [], b"", Limits(20, ROOM))


def test_limits_grow_with_the_data() -> None:
    assert limits_for(0, 10, 2, 100, 3) == Limits(10, 100)
    assert limits_for(2_000_000, 10, 2, 100, 3) == Limits(14, 6_000_100)


@pytest.fixture
def rhino_file() -> bytes:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Feet
    circle = rhino3dm.Circle(rhino3dm.Point3d(1, 2, 3), 4).ToNurbsCurve()
    about = rhino3dm.ObjectAttributes()
    about.Name, about.Visible = "rim", False
    model.Objects.AddCurve(circle, about)
    mesh = rhino3dm.Mesh()
    mesh.Vertices.UseDoublePrecisionVertices = True
    for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (0.1, 2)):
        mesh.Vertices.AddPoint3d(x, y, x * y)
    mesh.Faces.AddFace(0, 1, 2, 3)
    mesh.Faces.AddFace(3, 2, 4)
    model.Objects.AddMesh(mesh)
    model.Objects.AddBrep(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1).ToBrep())
    model.InstanceDefinitions.Add("block", "", "", "", rhino3dm.Point3d(0, 0, 0), (circle,), (about,))
    ident = model.InstanceDefinitions.FindIndex(0).Id
    model.Objects.AddInstanceObject(rhino3dm.InstanceReference(ident, rhino3dm.Transform.Translation(1, 2, 3)))
    return base64.b64decode(model.Encode())


def test_a_rhino_file_as_plain_data(rhino_file: bytes) -> None:
    model = read_rhino(rhino_file, "curves", "key")
    assert model.unit == "Feet"
    assert [block.name for block in model.blocks] == ["block"]
    rim = next(item for item in model.objects if item.kind == "Curve" and not item.in_block)
    assert (rim.name, rim.visible, rim.type) == ("rim", False, "NurbsCurve")
    controls = rim.curves[0].controls
    radii = np.linalg.norm(controls[::2, :3] / controls[::2, 3:] - [1, 2, 3], axis=1)
    assert radii == pytest.approx(4, rel=1e-14)
    assert len(rim.curves[0].knots) == len(controls) + rim.curves[0].degree - 1
    instance = next(item for item in model.objects if item.kind == "InstanceReference")
    assert instance.block == model.blocks[0].id
    assert instance.transform[:3, 3].tolist() == [1, 2, 3]
    (member,) = (item for item in model.objects if item.in_block)
    assert model.blocks[0].members == (member.id,)
    sphere = next(item for item in model.objects if item.kind == "Brep")
    # no edge of a closed surface is naked
    assert not sphere.curves
    assert sphere.faces == 1
    assert all(not item.meshes for item in model.objects)


def test_a_mesh_of_a_rhino_file(rhino_file: bytes) -> None:
    model = read_rhino(rhino_file, "meshes", "key")
    mesh = next(item for item in model.objects if item.kind == "Mesh").meshes[0]
    assert mesh.points.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0], [0.1, 2, 0.2]]
    assert mesh.faces.tolist() == [[0, 1, 2, 3], [3, 2, 4, 4]]
    assert all(not item.curves for item in model.objects)


def test_the_same_where_no_process_can_be_started(rhino_file: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "")
    assert read_rhino(rhino_file, "meshes", "key").unit == "Feet"


def test_a_file_of_several_loops_is_read_once(rhino_file: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def counted(module: str, arguments: list[str], data: bytes, limits: Limits) -> bytes:
        calls.append(arguments)
        return run_bounded(module, arguments, data, limits)

    monkeypatch.setattr(rhino_model, "run_bounded", counted)
    assert len({read_rhino(rhino_file, "curves", f"boundary[{k}]").unit for k in range(3)}) == 1
    assert calls == [["curves"]]
    assert read_rhino(rhino_file, "meshes", "key").unit == "Feet"
    assert calls == [["curves"], ["meshes"]]


@pytest.mark.parametrize(("error", "words"), [(TookTooLong, "longer than 10 s"), (BrokeDown, "breaks down")])
def test_a_limit_reached_is_a_message(
    rhino_file: bytes, monkeypatch: pytest.MonkeyPatch, error: type[Exception], words: str
) -> None:
    def ended(*arguments: object) -> bytes:
        raise error

    monkeypatch.setattr(rhino_model, "run_bounded", ended)
    with pytest.raises(InputError, match=words) as refusal:
        read_rhino(rhino_file, "curves", "surface.file")
    assert refusal.value.where == "surface.file"
    assert "save it again" in refusal.value.remedy


def test_a_script_without_a_guarded_main_part_reads_a_rhino_file(rhino_file: bytes, tmp_path: Path) -> None:
    (tmp_path / "model.3dm").write_bytes(rhino_file)
    # a module of the folder must not take the place of one the process needs
    (tmp_path / "json.py").write_text("raise SystemExit('the wrong json')\n")
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "script.py").write_text(
        "from pathlib import Path\nfrom lamella.files.read.rhino_model import read_rhino\n"
        "print(read_rhino(Path('model.3dm').read_bytes(), 'curves', 'key').unit)\n"
    )
    done = subprocess.run(
        [sys.executable, "code/script.py"], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.stdout, done.stderr) == ("Feet\n", "")
