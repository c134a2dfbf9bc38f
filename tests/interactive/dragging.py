"""Random dragging of examples in a browser, for some minutes: no exception anywhere, and memory stays level.

Run with ``python -m interactive.dragging --minutes 20 --seed 1 13_oculus 08_two_rings 17_gridshell`` from the folder of
the tests; the slow tests drag for some seconds.
"""

from __future__ import annotations

import argparse
import random
import shutil
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from interactive.designs import served
from lamella.interactive.server import Server
from view.browser import Browser, Page

EXAMPLES = Path(__file__).parents[2] / "examples"
KNOWN = "window.lamellaStudio.known"
LOCKS = ("ground", "z", "x", "y", "screen")
# of a drag, pixels
REACH = 40
# MB: of the server, of the page
Memory = tuple[float, float]


@dataclass(frozen=True)
class Dragged:
    """What came of it."""

    drags: int
    undone: int
    complaints: list[str]
    memory: list[Memory]

    def growth(self) -> Memory:
        """Memory in the last quarter over that in the second one, of server and page."""
        quarter = max(len(self.memory) // 4, 1)

        def of(part: list[Memory], k: int) -> float:
            return sum(one[k] for one in part) / len(part)

        middle, last = self.memory[quarter : 2 * quarter] or self.memory, self.memory[-quarter:]
        server, page = (of(last, k) / of(middle, k) for k in (0, 1))
        return server, page


def drag_at_random(page: Page, server: Server, seconds: float, seed: int) -> Dragged:
    """Drag handles of a page at random and undo now and then, so that the design stays near what it was."""
    draws, end = random.Random(seed), time.monotonic() + seconds
    drags = undone = 0
    memory = []
    while time.monotonic() < end:
        ids = page.value(f"{KNOWN}.state.handles.map(one => one.id)")
        page.value(f"document.getElementById('lock').value = '{draws.choice(LOCKS)}'")
        box = f"document.querySelector('[data-id=\"{draws.choice(ids)}\"] .grip').getBoundingClientRect()"
        x, y = page.value(f"(() => {{ const b = {box}; return [b.x + b.width / 2, b.y + b.height / 2] }})()")
        page.drag((x, y), (x + draws.uniform(-REACH, REACH), y + draws.uniform(-REACH, REACH)), steps=10)
        drags += 1
        if draws.random() < 0.5:
            time.sleep(draws.uniform(0, 1.0))
        if page.value(f"{KNOWN}.state.can_undo") and draws.random() < 0.6:
            page.value("document.getElementById('undo').click()")
            undone += 1
        memory.append(memory_of(page))
        assert server._worker._thread.is_alive()
    # back to the file, and to what can be computed
    page.until(f"!{KNOWN}.state.can_undo || (document.getElementById('undo').click(), false)")
    page.until(f"{KNOWN}.frame.level === 'exact' && {KNOWN}.frame.revision === {KNOWN}.state.revision")
    return Dragged(drags, undone, page.complaints(), memory)


def memory_of(page: Page) -> Memory:
    """Of this process, which is the server, and of the page's objects, MB."""
    status = Path("/proc/self/status").read_text("utf-8") if Path("/proc/self/status").exists() else "VmRSS: 1 kB"
    own = next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS"))
    return own / 1e3, page.value("performance.memory ? performance.memory.usedJSHeapSize : 1e6") / 1e6


def drag_example(browser: Browser, name: str, seconds: float, seed: int) -> Dragged:
    """Drag an example, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(shutil.copy(EXAMPLES / f"{name}.toml", folder))
        text = path.read_text("utf-8")
        with served(path) as server:
            page = browser.page(1200, 850)
            page.open(server.address)
            page.until(f"window.lamellaStudio && {KNOWN}.frame && {KNOWN}.frame.level === 'exact'")
            dragged = drag_at_random(page, server, seconds, seed)
            assert page.value(f"{KNOWN}.state.text") == text
            page.close()
            return dragged


def main() -> None:
    """Drag examples one after the other and tell what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=["08_two_rings", "13_oculus", "17_gridshell"])
    parser.add_argument("--minutes", type=float, default=20.0, help="altogether")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for name in options.names:
        with Browser() as browser:
            dragged = drag_example(browser, name, 60 * options.minutes / len(options.names), options.seed)
        server, page = dragged.growth()
        print(
            f"{name}: {dragged.drags} drags, {dragged.undone} undone, memory x {server:.2f} and x {page:.2f}",
            flush=True,
        )
        for complaint in dragged.complaints:
            print(f"  {complaint}", flush=True)


if __name__ == "__main__":
    main()
