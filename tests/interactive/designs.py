"""Small projects for tests of the studio, and pages that are programs."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from lamella.interactive.server import Server
from lamella.interactive.session import Session

CATENOID = """\
# a comment that stays
name = "demo"

[surface]
kind = "catenoid"
neck_radius = 2.5   # m
height = [-2.0, 3.0]

[network]
cells = 12
"""

RINGS = """\
[surface]
kind = "form-found"
tolerance = 0.03

[[surface.boundary]]
name = "base"
points = [          # m, splined
  [3.0, 0.0, 0.0],
  [2.1213, 2.1213, 0.0],
  [0.0, 3.0, 0.0],
  [-2.1213, 2.1213, 0.0],
  [-3.0, 0.0, 0.0],
  [-2.1213, -2.1213, 0.0],
  [0.0, -3.0, 0.0],
  [2.1213, -2.1213, 0.0],
]

[[surface.boundary]]
name = "ring"
circle = {center = [0.0, 0.0, 2.0], radius = 2.0} # m

[network]
cells = 10

[lamella]
height = 0.05
thickness = 0.001
layers = 1
"""


def write(folder: Path, text: str, name: str = "demo.toml") -> Path:
    """A project file, to the byte."""
    path = folder / name
    path.write_bytes(text.encode())
    return path


@contextmanager
def served(path: Path, **options: Any) -> Iterator[Server]:
    """A server of a project file, whose end is waited for."""
    with Server(Session(path), **options) as server:
        yield server


class Page:
    """A page without a browser."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self.state: dict[str, Any] = {}
        self.status: dict[str, Any] = {}
        self.frames: list[dict[str, Any]] = []
        self.refused: list[dict[str, Any]] = []
        self.acknowledges = True

    def send(self, kind: str, **more: Any) -> None:
        """What a page does."""
        self._connection.send(json.dumps({"type": kind, **more}))

    def edit(self, do: str, *, drag: bool = False, **more: Any) -> None:
        """An edit."""
        self.send("drag" if drag else "edit", edit={"do": do, **more})

    def receive(self, seconds: float) -> dict[str, Any] | None:
        """The next message; None: there was none so long."""
        try:
            raw = self._connection.recv(timeout=seconds)
        except TimeoutError:
            return None
        if isinstance(raw, str):
            message: dict[str, Any] = json.loads(raw)
        else:
            (count,) = struct.unpack("<I", raw[:4])
            message = json.loads(raw[4 : 4 + count]) | {"bytes": raw[4 + count :]}
        kind = message["type"]
        if kind in ("state", "status"):
            setattr(self, kind, message)
        elif kind == "refused":
            self.refused.append(message)
        elif kind in ("frame", "pinned"):
            self.frames.append(message)
            if self.acknowledges and kind == "frame":
                self.send("seen", number=message["number"])
        return message

    def until(self, is_there: Callable[[], Any], seconds: float = 30.0) -> None:
        """Receive until something is there."""
        for _ in range(1000):
            if is_there():
                return
            assert self.receive(seconds) is not None, "nothing came"
        raise AssertionError("it did not come")

    def until_exact(self) -> dict[str, Any]:
        """The exact frame of the present revision."""

        def is_there() -> bool:
            last = self.frames[-1] if self.frames else None
            return bool(last and last["level"] == "exact" and last["revision"] == self.state.get("revision"))

        self.until(is_there)
        return self.frames[-1]


@contextmanager
def page_of(server: Server, **headers: str) -> Iterator[Page]:
    """A page that is connected."""
    address = f"ws://127.0.0.1:{server.access.port}/t/{server.access.token}/socket"
    with connect(address, max_size=None, additional_headers=headers, proxy=None) as connection:
        yield Page(connection)
