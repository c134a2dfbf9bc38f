"""`lamella picture`: a PNG of a project or a run; what cannot be is refused before anything is computed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.command import picture
from lamella.command.main import main
from lamella.command.picture import project_file, size_of

TEXT = """
[surface]
kind = "catenoid"
neck_radius = 0.8
height = [-0.3, 0.4]
[network]
cells = 6
"""
SMALL = ("--size", "120x80", "--quiet")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    path = tmp_path / "roof.toml"
    path.write_text(TEXT)
    return path


def test_a_project_and_its_run_give_the_same_bytes(project: Path, tmp_path: Path) -> None:
    from PIL import Image

    files = [tmp_path / f"{k}.png" for k in range(3)]
    assert main(["run", str(project), "--out", str(tmp_path / "run"), "--quiet"]) == 0
    for source, file in zip((project, project, tmp_path / "run"), files, strict=True):
        assert main(["picture", str(source), "--out", str(file), *SMALL]) == 0
    first = files[0].read_bytes()
    assert [file.read_bytes() == first for file in files] == [True] * 3
    pixels = np.asarray(Image.open(files[0]))
    assert pixels.shape == (80, 120, 3)
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 100


@pytest.mark.parametrize("until", ["surface", "network"])
def test_of_any_stage(project: Path, tmp_path: Path, until: str) -> None:
    assert main(["picture", str(project), "--until", until, "--out", str(tmp_path / "x.png"), *SMALL]) == 0
    assert (tmp_path / "x.png").read_bytes()[:4] == b"\x89PNG"


def test_of_a_surface_that_has_no_net(tmp_path: Path) -> None:
    """A sphere: the run ends with it, and so does the picture."""
    path = tmp_path / "ball.toml"
    circle = "circle = {center = [0, 0, 0], radius = 2}"
    path.write_text(f'[surface]\nkind = "form-found"\nmean_curvature = -0.2\n[[surface.boundary]]\n{circle}\n')
    assert main(["picture", str(path), "--out", str(tmp_path / "x.png"), *SMALL]) == 0


@pytest.mark.parametrize(
    ("options", "where"),
    [
        (("--view", "below"), "--view"),
        (("--size", "16x"), "--size"),
        (("--size", "1600"), "--size"),
        (("--size", "9000x100"), "--size"),
        (("--colour", "beauty"), "--colour"),
        (("--until", "harvest"), "harvest"),
        (("--frames", "erection:first"), "--frames"),
        (("--frames", "erection:0"), "[erection]"),
        (("--frames", "dance:0"), "steps"),
        (("--colour", "beauty"), "family"),
    ],
)
def test_what_cannot_be_is_refused(
    project: Path, tmp_path: Path, options: tuple[str, str], where: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["picture", str(project), "--out", str(tmp_path / "x.png"), "--quiet", *options]) == 2
    said = capsys.readouterr().err
    assert where in said
    assert "remedy" in said
    assert not (tmp_path / "x.png").exists()


def test_names_are_refused_before_anything_is_computed(
    project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def computed(*_: object, **__: object) -> None:
        raise AssertionError

    monkeypatch.setattr(picture, "_computed", computed)
    for options in (("--colour", "beauty"), ("--frames", "dance"), ("--frames", "erection"), ("--out", "x.jpg")):
        given = ("--out", str(tmp_path / "x.png")) if options[0] != "--out" else ()
        assert main(["picture", str(project), *given, *options]) == 2


def test_folders_that_are_none(project: Path, tmp_path: Path) -> None:
    assert main(["picture", str(project), "--out", str(tmp_path / "no" / "x.png"), *SMALL]) == 2
    with pytest.raises(InputError, match=r"project\.toml"):
        project_file(tmp_path)
    assert size_of("16X9") == (16, 9)
