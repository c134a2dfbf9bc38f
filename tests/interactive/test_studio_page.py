"""The page of the studio in a browser: what is dragged is what is computed, and it goes back to the byte."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from interactive.designs import CATENOID, RINGS, served, write
from interactive.dragging import drag_example
from lamella.interactive.server import Server
from view.browser import Browser, Page

KNOWN = "window.lamellaStudio?.known"
SETTLED = f"{KNOWN}?.frame?.level === 'exact' && {KNOWN}.frame.revision === {KNOWN}.state.revision"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as browser:
        yield browser


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    with served(write(tmp_path, RINGS)) as server:
        yield server


def opened(browser: Browser, server: Server, **options: Any) -> Page:
    page = browser.page(**options)
    page.open(server.address)
    page.until(SETTLED)
    return page


def place_of(page: Page, handle: str) -> tuple[float, float]:
    """Of a handle on the screen, pixels, when lists and legends have found their places."""
    box = f"document.querySelector('[data-id=\"{handle}\"] .grip').getBoundingClientRect()"
    before = None
    for _ in range(50):
        here = page.value(f"(() => {{ const b = {box}; return [b.x + b.width / 2, b.y + b.height / 2] }})()")
        if here == before:
            return here[0], here[1]
        before = here
        time.sleep(0.3)
    raise TimeoutError(handle)


def drag(page: Page, handle: str, lock: str, by: tuple[float, float]) -> None:
    page.value(f"document.getElementById('lock').value = '{lock}'")
    x, y = place_of(page, handle)
    page.drag((x, y), (x + by[0], y + by[1]), steps=6)


@pytest.mark.slow
def test_what_is_dragged_is_what_is_computed(browser: Browser, server: Server, tmp_path: Path) -> None:
    page = opened(browser, server)
    drag(page, "0.points.0", "z", (0, -30))
    page.until(f"{KNOWN}.state.can_undo && {SETTLED}")
    points = page.value(f"{KNOWN}.state.handles.find(one => one.id === '0.points.0').at")
    assert points[:2] == [3.0, 0.0]
    assert 0.1 < points[2] < 2.0
    assert page.value("document.getElementById('file').classList.contains('unsaved')")
    page.value("document.getElementById('save').click()")
    page.until(f"{KNOWN}.state.saved")
    nodes = np.array(page.value(f"Array.from({KNOWN}.frame.arrays.nodes)")).reshape(-1, 3)
    net = lamella.compute(lamella.read_project(tmp_path / "demo.toml")).network
    assert net is not None
    size = np.linalg.norm(np.ptp(net.node_points, axis=0))
    assert np.abs(nodes - net.node_points).max() < 1e-6 * size
    # the handle is where the corner of what is drawn is
    assert str(points[2]) in (tmp_path / "demo.toml").read_text()
    page.value("document.getElementById('undo').click()")
    page.until(f"!{KNOWN}.state.can_undo && {SETTLED}")
    assert page.value(f"{KNOWN}.state.text") == RINGS
    page.value("document.getElementById('save').click()")
    page.until(f"{KNOWN}.state.saved")
    assert (tmp_path / "demo.toml").read_bytes() == RINGS.encode()
    assert page.complaints() == []
    page.close()


@pytest.mark.slow
def test_an_impossible_boundary_shows_its_reason_and_recovers(browser: Browser, server: Server) -> None:
    page = opened(browser, server)
    page.value("window.lamellaStudio.handles.choose('1.circle.center')")
    page.value(
        "(() => { const z = document.getElementById('at-z'); z.value = 9; z.dispatchEvent(new Event('change')) })()"
    )
    page.until("!document.getElementById('problem').hidden")
    assert "too far apart" in page.value("document.getElementById('problem').textContent")
    assert page.value("document.getElementById('stage').classList.contains('stale')")
    assert page.value(f"{KNOWN}.frame.revision < {KNOWN}.state.revision")
    page.value(
        "(() => { const z = document.getElementById('at-z'); z.value = 2.1; z.dispatchEvent(new Event('change')) })()"
    )
    page.until(f"document.getElementById('problem').hidden && {SETTLED}")
    assert not page.value("document.getElementById('stage').classList.contains('stale')")
    assert page.complaints() == []
    page.close()


@pytest.mark.slow
def test_sliders_lists_text_and_sketches(browser: Browser, server: Server) -> None:
    page = opened(browser, server)
    page.value(
        "(() => { const s = document.querySelector('[data-key=\"network.cells\"]'); s.value = 12;"
        "s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')) })()"
    )
    page.until(f"{KNOWN}.state.text.includes('cells = 12') && {SETTLED}")
    assert page.value(f"{KNOWN}.frame.figures.cells") == 12
    page.value("document.querySelector('#closing-ways button:nth-child(2)').click()")
    page.until(f"""{KNOWN}.state.text.includes('closing = "round"')""")
    page.value("document.getElementById('show-text').click()")
    page.value(
        "(() => { const t = document.getElementById('text'); t.focus();"
        "t.value = t.value.replace('cells = 12', 'cells = x');"
        "t.dispatchEvent(new Event('input')) })()"
    )
    page.until("!document.getElementById('problem').hidden && document.querySelector('#numbers b')")
    line = page.value("document.querySelector('#numbers b').textContent")
    assert RINGS.split("\n")[int(line) - 1].startswith("cells")
    page.value("document.getElementById('undo').click()")
    page.until("document.getElementById('problem').hidden")
    page.value("document.getElementById('show-text').click()")
    page.value("document.getElementById('sketch').click()")
    page.value("document.getElementById('stage').scrollIntoView()")
    box = page.value(
        "(() => { const b = document.getElementById('stage').getBoundingClientRect();"
        "return [b.x, b.y, b.width, b.height] })()"
    )
    for number, (x, y) in enumerate(((0.3, 0.45), (0.6, 0.45), (0.6, 0.75), (0.3, 0.75)), 1):
        page.click(box[0] + x * box[2], box[1] + y * box[3])
        page.until(f"document.getElementById('sketch-count').textContent === 'number {number}'")
    page.value("document.getElementById('sketch-close').click()")
    page.until(f"{KNOWN}.state.handles.filter(one => one.id.startsWith('0.points')).length === 4")
    assert page.value(
        f"{KNOWN}.state.handles.filter(one => one.id.startsWith('0.points')).every(one => Math.abs(one.at[2]) < 1e-9)"
    )
    assert page.complaints() == []
    page.close()


@pytest.mark.slow
@pytest.mark.parametrize(("dark", "phone"), [(False, False), (True, False), (False, True)])
def test_the_page_fits(browser: Browser, tmp_path: Path, dark: bool, phone: bool) -> None:
    """Nothing reaches beyond the page, in whatever colours; a page without handles works as well."""
    with served(write(tmp_path, CATENOID)) as server:
        size = {"width": 390, "height": 844} if phone else {"width": 1300, "height": 900}
        page = opened(browser, server, dark=dark, phone=phone, **size)
        assert page.value("document.documentElement.scrollWidth <= innerWidth")
        assert page.value("document.querySelectorAll('.handles .handle').length") == 0
        background = page.value("getComputedStyle(document.querySelector('.bar')).backgroundColor")
        assert (background == "rgb(255, 255, 255)") is not dark
        assert page.complaints() == []
        page.close()


@pytest.mark.slow
def test_pages_without_the_token_see_nothing(browser: Browser, server: Server) -> None:
    page = browser.page()
    page.open(server.address.partition("?")[0])
    assert "refused" in page.value("document.body.textContent")
    # a page of another origin can neither read an answer nor open the websocket
    port, token = server.access.port, server.access.token
    page.open("data:text/html,<title>other</title>")
    read = f"fetch('http://127.0.0.1:{port}/?token={token}').then(() => 'read', () => 'refused')"
    assert page.value(read) == "refused"
    socket = (
        f"new Promise(done => {{ const s = new WebSocket('ws://127.0.0.1:{port}/t/{token}/socket');"
        "s.onopen = () => done('open'); s.onerror = () => done('refused') })"
    )
    assert page.value(socket) == "refused"
    page.close()


@pytest.mark.slow
def test_random_dragging(browser: Browser) -> None:
    """Some seconds of what `interactive.dragging` does for minutes: it ends where it began, without complaint."""
    dragged = drag_example(browser, "08_two_rings", 10.0, 3)
    assert dragged.drags >= 1
    assert dragged.complaints == []
