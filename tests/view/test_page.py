"""report.html in headless Chromium: it does what its buttons say, in light, dark and on a phone, without complaint."""

from __future__ import annotations

import base64
import io
import json
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import compute, parse_project
from lamella.base.message import Message
from lamella.stages.report import report_data
from lamella.view.report import write_report
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import StripsLayer
from lamella.view.scene.quantity import magnitude
from lamella.view.scene.scene import Labels, Mark, Scene
from view.browser import Browser, Page

pytestmark = pytest.mark.slow

PROJECT: dict[str, Any] = {
    "name": "Page",
    "surface": {"kind": "catenoid", "neck_radius": 1.5, "height": [-1.0, 1.5]},
    "network": {"cells": 10},
}
VIEWER = "window.lamellaViewer"


@pytest.fixture(scope="module")
def results() -> lamella.Results:
    return compute(parse_project(PROJECT | {"joint": {"block_spacing": 0}}))


@pytest.fixture(scope="module")
def scene(results: lamella.Results) -> Scene:
    """The scene of a run, with a slider, a warning's place and names of nodes."""
    scene = report_data(results).scene
    strips = scene.layer("strips A")
    assert isinstance(strips, StripsLayer)
    lift = np.linspace(0, 1, 5)[:, None, None] * np.array([0.0, 0.0, 1.0])
    height = magnitude("height", "Height", "m", strips.positions[:, 2] + 1)
    own = replace(strips, name="raised", quantities=(height,), quantity="height", palette="", replaces=())
    frames = Frames(
        "raising",
        "Raising",
        np.linspace(0, 1, 5),
        "m",
        tuple(f"state {k}" for k in range(5)),
        (
            Motion("raised", strips.positions + lift, values={"height": strips.positions[:, 2] + 1 + lift[..., 2]}),
            Motion("strips B", displacements=np.broadcast_to(lift, (5, scene.layer("strips B").count, 3)).copy()),
        ),
        (own,),
        ("strips A", "group:Hardware", "solids A", "solids B"),
        "height",
    )
    names = Labels("corners", "Corners", results.network.node_points[:3], ("one", "two", "three"))
    mark = Mark("too_steep", results.network.node_points[7:9], ("B2",))
    return replace(scene, frames=(frames,), labels=(*scene.labels, names), marks=(mark,))


@pytest.fixture(scope="module")
def file(results: lamella.Results, scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    data = report_data(results)
    write_report(path, replace(data, scene=scene, warnings=(Message("too_steep", "It is too steep."), *data.warnings)))
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as browser:
        yield browser


@pytest.fixture
def page(browser: Browser, file: Path) -> Iterator[Page]:
    page = browser.page()
    page.open(file)
    page.until(VIEWER)
    yield page
    assert page.complaints() == []
    page.close()


def on_screen(page: Page, point: Any, scene: Scene) -> tuple[float, float]:
    """Where a point is seen on the page, pixels."""
    low, high = scene.box
    at = (np.asarray(point) - (low + high) / 2).tolist()
    x, y, left, top = page.value(
        f"(() => {{ const b = {VIEWER}.canvas.getBoundingClientRect();"
        f"return [...{VIEWER}.onScreen()({at}, 0).slice(0, 2), b.left, b.top]; }})()"
    )
    return left + x, top + y


def nearest(page: Page, points: Any, scene: Scene) -> int:
    """Which of some points is nearest to the eye: nothing is before it."""
    low, high = scene.box
    eye = np.array(page.value(f"{VIEWER}.camera.position.toArray()")) + (low + high) / 2
    return int(np.linalg.norm(points - eye, axis=1).argmin())


def test_a_lamella_that_is_clicked_is_chosen(page: Page, results: lamella.Results, scene: Scene) -> None:
    network = results.network
    sample = nearest(page, network.sample_points, scene)
    wanted = network.ids[int(np.searchsorted(network.sample_offsets, sample, "right")) - 1]
    page.value("document.getElementById('lamella-choice').value = ''")
    page.click(*on_screen(page, network.sample_points[sample], scene))
    page.until(f"document.getElementById('lamella-choice').selectedOptions[0].textContent === '{wanted}'")
    assert page.value("location.hash").startswith(f"#{wanted}")
    assert page.value(f"{VIEWER}.selected") == wanted
    assert page.value("document.querySelectorAll('#plots path').length") == 10


def test_plots_are_of_the_chosen_lamella_and_their_cursor_is_in_the_view(page: Page, results: lamella.Results) -> None:
    page.value("location.hash = '#A3'")
    page.until("document.getElementById('lamella-choice').selectedOptions[0].textContent === 'A3'")
    network = results.network
    lamella_number = network.ids.index("A3")
    own = slice(*network.sample_offsets[lamella_number : lamella_number + 2])
    peak = np.abs(network.sample_darboux.tg[own]).max()
    text = page.value("document.querySelectorAll('#plots .plot')[0].querySelectorAll('.readout b')[2].textContent")
    assert abs(float(text.replace("−", "-"))) == pytest.approx(peak, rel=1e-3)
    page.value(
        "(() => { const s = document.querySelector('#plots svg[role=img]'); s.focus();"
        "s.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true})); })()"
    )
    assert page.value(f"{VIEWER}.marker.object.visible")
    low, high = scene_box(page)
    marked = np.array(page.value(f"Array.from({VIEWER}.marker.points)")) + (low + high) / 2
    start = results.lamellas.network.sample_points[own][0]
    assert np.linalg.norm(marked - start) < 1e-4


def scene_box(page: Page) -> tuple[Any, Any]:
    centre = np.array(page.value(f"{VIEWER}.scene.centre"))
    return centre, centre


def test_the_slider_moves_what_it_says(page: Page, scene: Scene) -> None:
    frames = scene.frames[0]
    page.value("(() => { const f = document.getElementById('frames'); f.value = 'raising'; f.onchange(); })()")
    assert page.value("document.getElementById('caption').textContent") == "0 m · state 0"
    visible = f"[...{VIEWER}.drawn.values()].filter((one) => one.object.visible).map((one) => one.layer.name)"
    shown = page.value(visible)
    assert "raised" in shown
    assert "strips B" in shown
    assert not {"strips A", "solids A", "solids B"} & set(shown)
    # between two states
    page.value("(() => { const s = document.getElementById('frame'); s.value = 2.5; s.oninput(); })()")
    centre, _ = scene_box(page)
    points = np.array(page.value(f"Array.from({VIEWER}.drawn.get('raised').points)")).reshape(-1, 3) + centre
    wanted = frames.motions[0].positions[2:4].mean(0)
    assert np.abs(points - wanted).max() < 2e-4
    page.value("(() => { const s = document.getElementById('exaggeration'); s.value = 3; s.oninput(); })()")
    points = np.array(page.value(f"Array.from({VIEWER}.drawn.get('strips B').points)")).reshape(-1, 3) + centre
    assert np.abs(points - scene.layer("strips B").points - [0, 0, 3 * 0.625]).max() < 2e-4
    assert "Height" in page.value("document.getElementById('legends').textContent")
    # back: everything where it was
    page.value("(() => { const f = document.getElementById('frames'); f.value = ''; f.onchange(); })()")
    points = np.array(page.value(f"Array.from({VIEWER}.drawn.get('strips B').points)")).reshape(-1, 3) + centre
    assert np.abs(points - scene.layer("strips B").points).max() < 1e-5
    assert "raised" not in page.value(visible)


def test_what_is_cut_away_is_neither_seen_nor_picked(page: Page, results: lamella.Results, scene: Scene) -> None:
    network = results.network
    sample = nearest(page, network.sample_points, scene)
    x, y = on_screen(page, network.sample_points[sample], scene)
    box = page.value(f"(() => {{ const b = {VIEWER}.canvas.getBoundingClientRect(); return [b.left, b.top]; }})()")
    place = f"{x - box[0]}, {y - box[1]}"
    before, whole = page.value(f"{VIEWER}.pick({place})"), page.picture()
    assert before is not None
    # the eye is at y < 0: all that is before the middle goes
    page.value(
        "(() => { const a = document.getElementById('section-axis'); a.value = 'y';"
        "document.getElementById('section-flip').checked = true; a.dispatchEvent(new Event('input')); })()"
    )
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    after = page.value(f"{VIEWER}.pick({place})")
    assert after is None or after["point"][1] > before["point"][1] + 0.5
    assert page.picture() != whole


def test_two_nodes_are_measured(page: Page, results: lamella.Results, scene: Scene) -> None:
    nodes = results.network.node_points
    first = nearest(page, nodes, scene)
    away = np.linalg.norm(nodes - nodes[first], axis=1)
    second = int(np.argsort(away)[3])
    page.value("document.getElementById('measure').click()")
    for node in (first, second):
        page.click(*on_screen(page, nodes[node], scene))
    page.until("document.getElementById('measured').textContent.includes(' m (')")
    text = page.value("document.getElementById('measured').textContent")
    assert float(text.split(" m")[0]) == pytest.approx(away[second], rel=1e-3)
    page.until("document.querySelector('.overlay .measured')")
    assert page.value("document.querySelector('.overlay .measured').textContent") == text


def test_names_are_shown(page: Page) -> None:
    page.value("document.getElementById('label-corners').click()")
    page.until("[...document.querySelectorAll('.overlay .label')].some((one) => one.textContent === 'two')")


def test_a_warning_leads_to_its_place(page: Page, scene: Scene) -> None:
    page.value("document.querySelector('.warnings .place').click()")
    centre, _ = scene_box(page)
    target = np.array(page.value(f"{VIEWER}.controls.target.toArray()")) + centre
    assert np.abs(target - scene.marks[0].positions[0]).max() < 1e-5
    assert page.value(f"{VIEWER}.selected") == "B2"
    page.value("document.querySelector('.warnings .place').click()")
    target = np.array(page.value(f"{VIEWER}.controls.target.toArray()")) + centre
    assert np.abs(target - scene.marks[0].positions[1]).max() < 1e-5


def test_a_picture_has_its_size_and_something_on_it(page: Page) -> None:
    from PIL import Image

    text = page.value(
        f"{VIEWER}.picture({{ width: 640, height: 400 }}).then((blob) => new Promise((done) => {{"
        "const r = new FileReader(); r.onload = () => done(r.result.split(',')[1]); r.readAsDataURL(blob); }))"
    )
    picture = Image.open(io.BytesIO(base64.b64decode(text)))
    assert picture.size == (640, 400)
    pixels = np.asarray(picture.convert("RGBA"))
    covered = (pixels[..., 3] > 0).mean()
    assert 0.2 < covered < 1
    assert len(np.unique(pixels.reshape(-1, 4), axis=0)) > 200


def test_the_model_is_what_is_shown(page: Page, scene: Scene) -> None:
    import trimesh

    page.value("document.getElementById('show-as-built').click()")
    text = page.value(
        f"{VIEWER}.exportGlb().then((data) => {{ let s = ''; for (const b of new Uint8Array(data))"
        "s += String.fromCharCode(b); return btoa(s); })"
    )
    data = base64.b64decode(text)
    assert struct.unpack("<4sII", data[:12]) == (b"glTF", 2, len(data))
    length = struct.unpack("<I", data[12:16])[0]
    nodes = {node.get("name") for node in json.loads(data[20 : 20 + length])["nodes"]}
    assert {"surface", "strips A", "strips B"} <= nodes
    assert not {"solids A", "ground", "person"} & nodes
    bounds = trimesh.load(io.BytesIO(data), file_type="glb").bounds
    low, high = scene.box
    size = high - low
    # y is up: heights are those of the scene, a strip's half height more
    assert np.ptp(bounds, axis=0)[1] == pytest.approx(size[2], abs=0.15)
    assert np.ptp(bounds, axis=0)[0] == pytest.approx(size[0], abs=0.15)


@pytest.mark.parametrize(("width", "dark", "phone"), [(1300, True, False), (390, False, True), (390, True, True)])
def test_dark_and_on_a_phone(browser: Browser, file: Path, width: int, dark: bool, phone: bool) -> None:
    page = browser.page(width, 844, dark=dark, phone=phone)
    page.open(file)
    page.until(VIEWER)
    assert page.value(f"{VIEWER}.dark") == dark
    assert page.value("document.documentElement.scrollWidth") <= width
    background = page.value("getComputedStyle(document.body).backgroundColor")
    assert (sum(map(int, background[4:-1].split(","))) < 3 * 128) == dark
    assert page.complaints() == []
    page.close()


@pytest.mark.parametrize("until", ["surface", "network", "lamellas"])
def test_every_stage_has_a_page(browser: Browser, tmp_path: Path, until: str) -> None:
    data = report_data(compute(parse_project(PROJECT), until=until))
    write_report(tmp_path / "report.html", data)
    page = browser.page(900, 700)
    page.open(tmp_path / "report.html")
    page.until(VIEWER)
    assert page.value(f"{VIEWER}.drawn.size") == len(data.scene.layers)
    assert page.value("document.getElementById('lamella-panel').hidden") == (until == "surface")
    assert page.complaints() == []
    page.close()


def test_a_scene_is_updated_and_what_was_chosen_stays(page: Page, scene: Scene) -> None:
    page.value(f"{VIEWER}.show('Surface', false); {VIEWER}.lookFrom('top')")
    before = page.value(f"{VIEWER}.camera.position.toArray()")
    page.value(
        f"(() => {{ const v = {VIEWER}; const old = v.scene.layers.find((one) => one.name === 'strips A');"
        "const layer = {...old, positions: Float32Array.from(old.positions, (x) => x + 0.25)};"
        "v.updateScene({...v.scene, layers: [layer], labels: []}); })()"
    )
    assert page.value(f"{VIEWER}.camera.position.toArray()") == before
    assert page.value(f"{VIEWER}.drawn.get('surface').object.visible") is False
    centre, _ = scene_box(page)
    points = np.array(page.value(f"Array.from({VIEWER}.drawn.get('strips A').points)")).reshape(-1, 3)
    assert np.abs(points + centre - scene.layer("strips A").points - 0.25).max() < 1e-5
    assert page.value(f"{VIEWER}.scene.layers.length") == len(scene.layers)
