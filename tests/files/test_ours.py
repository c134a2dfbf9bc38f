"""Single files: what is there is replaced only where this program wrote it, and new files take no place."""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np
import pytest
import rhino3dm
from PIL import Image

from lamella import quad_mesh
from lamella.base.errors import InputError
from lamella.command.main import main
from lamella.files.ours import is_ours, signed_png
from lamella.files.quad_mesh_files import QuadFile, quad_mesh_bytes
from lamella.files.whole import write_new_whole
from lamella.projection.mesh_figures import mesh_figures

FOREIGN = {
    ".obj": b"# Blender 4.2\nv 0 0 0\n",
    ".ply": b"ply\nformat ascii 1.0\ncomment made by lamella-like tools\nend_header\n",
    ".json": b'{"dtype": "compas.datastructures/Mesh", "data": {}, "name": "net.obj as planar"}',
    ".3dm": b"3D Geometry File Format        8 and something",
    ".png": b"\x89PNG\r\n\x1a\n and a photo",
}


def a_net(path: Path) -> Path:
    i, j = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(5), np.arange(5), indexing="ij"))
    corner = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    mesh = quad_mesh(np.column_stack([i, j, 0.1 * i * j]), np.stack([corner, corner + 5, corner + 6, corner + 1], 1))
    path.write_bytes(
        quad_mesh_bytes(path.suffix, mesh, mesh_figures(mesh), like=QuadFile(mesh), name="a net", version="0")
    )
    return path


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".json", ".3dm"])
def test_a_result_is_told_from_other_files(tmp_path: Path, suffix: str) -> None:
    assert is_ours(a_net(tmp_path / f"a{suffix}"))
    (tmp_path / f"b{suffix}").write_bytes(FOREIGN[suffix])
    assert not is_ours(tmp_path / f"b{suffix}")
    assert is_ours(tmp_path / f"c{suffix}")
    (tmp_path / f"d{suffix}").touch()
    assert is_ours(tmp_path / f"d{suffix}")
    (tmp_path / f"e{suffix}").symlink_to(tmp_path / f"a{suffix}")
    assert not is_ours(tmp_path / f"e{suffix}")


def test_a_result_saved_by_rhino_is_no_result_any_more(tmp_path: Path) -> None:
    model = rhino3dm.File3dm.Read(str(a_net(tmp_path / "a.3dm")))
    model.ApplicationName, model.ApplicationDetails = "Rhinoceros", "Rhinoceros 8"
    model.Strings.Delete("lamella\\version")
    model.Write(str(tmp_path / "a.3dm"), 8)
    assert not is_ours(tmp_path / "a.3dm")


def test_a_signed_picture_shows_the_same(tmp_path: Path) -> None:
    plain = io.BytesIO()
    picture = Image.fromarray(np.random.default_rng(0).integers(0, 256, (7, 9, 3), np.uint8))
    picture.save(plain, "PNG")
    (tmp_path / "a.png").write_bytes(plain.getvalue())
    assert not is_ours(tmp_path / "a.png")
    (tmp_path / "a.png").write_bytes(signed_png(plain.getvalue()))
    assert is_ours(tmp_path / "a.png")
    shown = Image.open(tmp_path / "a.png")
    assert shown.info == {"Software": "lamella"}
    assert (np.asarray(shown) == np.asarray(picture)).all()


@pytest.mark.parametrize(
    ("option", "name"), [("--out", "o.obj"), ("--out", "o.3dm"), ("--json", "f.json"), ("--picture", "p.png")]
)
def test_optimise_replaces_no_file_of_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], option: str, name: str
) -> None:
    given, mine = a_net(tmp_path / "net.obj"), tmp_path / name
    mine.write_bytes(FOREIGN[mine.suffix])
    command = ["optimise", str(given), "--as", "asymptotic", "--out", str(tmp_path / "new.ply"), option, str(mine)]
    assert main(command) == 2
    assert f"{name} is there already and was not written by lamella" in capsys.readouterr().err
    assert mine.read_bytes() == FOREIGN[mine.suffix]
    assert not (tmp_path / "new.ply").exists()


def test_optimise_keeps_all_it_is_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = a_net(tmp_path / "net-lamellas.obj")
    surface = tmp_path / "surface.json"
    surface.write_text('[surface]\nkind = "catenoid"\nneck_radius = 1.0\nheight = [-1.0, 1.0]\n')
    os.link(given, tmp_path / "second-name.obj")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    # the second file of straighten would be the mesh that is given
    for out, more in (
        ("net.obj", []),
        ("new.ply", ["--json", str(surface), "--surface", str(surface)]),
        ("second-name.obj", []),
    ):
        command = ["optimise", str(given), "--as", "straighten", "--out", str(tmp_path / out), *more]
        assert main(command) == 2
        assert "is in use already" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_results_are_replaced_by_the_next(tmp_path: Path) -> None:
    given = a_net(tmp_path / "net.obj")
    command = ["optimise", str(given), "--as", "asymptotic", "--iterations", "1", "--quiet", "--out"]
    command += [str(tmp_path / "new.ply"), "--json", str(tmp_path / "f.json"), "--picture", str(tmp_path / "p.png")]
    codes = {main(command) for _ in range(2)}
    assert codes <= {0, 1}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["f.json", "net.obj", "new.ply", "p.png"]


def test_new_files_take_no_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "b").symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="b is there already"):
        write_new_whole({tmp_path / "a": b"1", tmp_path / "b": b"2"}, "remedy")
    assert [path.name for path in tmp_path.iterdir()] == ["b"]
    assert (tmp_path / "b").is_symlink()
    link = os.link

    def late(source: Path, target: Path) -> None:
        if target.name == "d":
            target.write_text("mine")
        link(source, target)

    # a file that comes between the question and the writing
    monkeypatch.setattr(os, "link", late)
    with pytest.raises(InputError, match="d is there already"):
        write_new_whole({tmp_path / "c": b"1", tmp_path / "d": b"2"}, "remedy")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b", "d"]
    assert (tmp_path / "d").read_text() == "mine"

    def none(source: Path, target: Path) -> None:
        raise PermissionError("no second names here")

    monkeypatch.setattr(os, "link", none)
    write_new_whole({tmp_path / "e": b"1"}, "remedy")
    assert (tmp_path / "e").read_bytes() == b"1"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b", "d", "e"]


@pytest.mark.parametrize("command", [["new", "unduloid"], ["examples", "--copy", ".", "01_unduloid"]])
def test_a_link_that_leads_nowhere_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], command: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("unduloid.toml", "01_unduloid.toml"):
        (tmp_path / name).symlink_to(tmp_path / "nowhere")
    assert main(command) == 2
    assert "is there already" in capsys.readouterr().err
    assert all(path.is_symlink() for path in tmp_path.iterdir())
