"""Still pictures: made, not blank, the same each time, and true to what they show."""

from __future__ import annotations

import builtins
from pathlib import Path

import numpy as np
import pytest

import lamella
from lamella.base.errors import InputError

pytest.importorskip("matplotlib")
from PIL import Image

from lamella.view import drawing_picture, figure, picture

SIZE = (320, 240)


@pytest.fixture(scope="module")
def run() -> lamella.Results:
    surface = {"kind": "enneper", "order": 3, "radius": 0.9, "scale": 2.0}
    return lamella.compute(lamella.parse_project({"name": "p", "surface": surface, "network": {"cells": 6}}))


@pytest.fixture(scope="module")
def drawings(run: lamella.Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run") / "out"
    lamella.write(run, folder)
    return folder / "fabrication"


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def near(image: np.ndarray, colour: tuple[int, int, int], within: int = 40) -> int:
    return int((np.abs(image - colour).max(axis=2) < within).sum())


@pytest.mark.parametrize("colour", ["utilisation", "torsion", "curvature", "planarity", "family", "none"])
def test_picture_is_made_and_not_blank(run: lamella.Results, tmp_path: Path, colour: picture.Colour) -> None:
    picture.draw(run, tmp_path / "p.png", colour=colour, size=SIZE)
    image = pixels(tmp_path / "p.png")
    assert image.shape == (240, 320, 3)
    assert (image[0, 0] == 255).all()
    drawn = (image.min(axis=2) < 250).mean()
    assert 0.1 < drawn < 0.9
    # the singular node is marked
    assert near(image, (0xD6, 0x00, 0x9A)) > 5


def test_same_run_same_bytes(run: lamella.Results, drawings: Path, tmp_path: Path) -> None:
    import matplotlib

    for path in ("a", "b"):
        # the user's own settings must not matter
        with matplotlib.rc_context({"lines.linewidth": 1.0 if path == "a" else 9.0, "font.size": 30}):
            picture.draw(run, tmp_path / f"{path}.png", size=SIZE)
            drawing_picture.draw_part(drawings / "A.dxf", tmp_path / f"{path}-part.png", size=(400, 220))
            drawing_picture.draw_sheets(drawings / "sheets.dxf", tmp_path / f"{path}-sheets.png", width=400)
    for kind in ("", "-part", "-sheets"):
        assert (tmp_path / f"a{kind}.png").read_bytes() == (tmp_path / f"b{kind}.png").read_bytes()


def test_both_families_are_shown(run: lamella.Results, tmp_path: Path) -> None:
    picture.draw(run, tmp_path / "p.png", view=(-60, 60), colour="family", size=SIZE)
    image = pixels(tmp_path / "p.png")
    for hexadecimal in figure.FAMILIES.values():
        colour = tuple(int(hexadecimal[i : i + 2], 16) for i in (1, 3, 5))
        assert near(image, colour, 60) > 300


def test_stages_before_the_lamellas(tmp_path: Path) -> None:
    project = lamella.parse_project({"surface": {"kind": "cylinder", "radius": 1.0, "height": [0.0, 2.0]}})
    surface, network = (lamella.compute(project, until=stage) for stage in ("surface", "network"))
    picture.draw(surface, tmp_path / "s.png", colour="none", size=SIZE)
    picture.draw(network, tmp_path / "n.png", colour="torsion", size=SIZE)
    dark = [(pixels(tmp_path / name).min(axis=2) < 150).sum() for name in ("s.png", "n.png")]
    assert dark[0] == 0 < dark[1]
    with pytest.raises(InputError, match="needs the stage lamellas"):
        picture.draw(network, tmp_path / "u.png", size=SIZE)
    assert not (tmp_path / "u.png").exists()


def test_nearer_things_hide_farther_ones() -> None:
    camera = picture.Camera.around(np.array([[-1.0, -1, -1], [1, 1, 1]]), 0.0, 0.0)
    flat, away = camera.project(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]))
    # seen against x: x comes nearer, y lies to the right, z is up
    assert away[1] < away[0] == pytest.approx(away[2])
    np.testing.assert_allclose(flat, [[0, 0], [0, 0], [1, 0], [0, 1]], atol=1e-12)


def test_strips_are_drawn_at_their_true_height(run: lamella.Results) -> None:
    network = run.network
    assert network is not None
    quads, first = picture._strip_quads(network, 0.1)
    np.testing.assert_allclose(np.linalg.norm(quads[:, 3] - quads[:, 0], axis=1), 0.1, rtol=1e-12)
    np.testing.assert_allclose((quads[:, 3] + quads[:, 0]) / 2, network.sample_points[first], atol=1e-12)
    # every piece between nodes is drawn, none twice
    assert len({tuple(q.round(9)) for q in (quads[:, 0] + quads[:, 2])}) == len(quads)
    length = np.linalg.norm((quads[:, 1] + quads[:, 2] - quads[:, 0] - quads[:, 3]) / 2, axis=1).sum()
    assert length == pytest.approx(network.lengths.sum(), rel=0.02)


def test_part_shows_outline_marks_and_id(drawings: Path, tmp_path: Path) -> None:
    drawing_picture.draw_part(drawings / "B.dxf", tmp_path / "p.png", part="B2", size=(600, 320))
    image = pixels(tmp_path / "p.png")
    for hexadecimal in (figure.LAYER_COLOURS[layer] for layer in ("CUT", "MARK", "TEXT")):
        colour = tuple(int(hexadecimal[i : i + 2], 16) for i in (1, 3, 5))
        assert near(image, colour, 60) > 20
    with pytest.raises(InputError, match="no part 'B999'"):
        drawing_picture.draw_part(drawings / "B.dxf", tmp_path / "p.png", part="B999")


def test_sheets_need_a_drawing_with_sheets(drawings: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds no sheets"):
        drawing_picture.draw_sheets(drawings / "A.dxf", tmp_path / "p.png")


def test_missing_matplotlib_names_the_extra(
    run: lamella.Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    original = builtins.__import__

    def without(name: str, *arguments: object, **more: object) -> object:
        if name.partition(".")[0] == "matplotlib":
            raise ImportError(name)
        return original(name, *arguments, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"lamella\[pictures\]"):
        picture.draw(run, tmp_path / "p.png")


def test_unknown_colour(run: lamella.Results, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="choose one of utilisation"):
        picture.draw(run, tmp_path / "p.png", colour="red")  # type: ignore[arg-type]
