"""What a frame of the studio costs while a point is dragged, and that frames do not drift."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from bench import Limit, Row, Table, clocked, factorisations, show

from lamella.base.progress import silent
from lamella.interactive.edits import Design, edited
from lamella.interactive.frame import Frame
from lamella.interactive.warm_frame import WarmFrames

EXAMPLES = Path(__file__).parents[1] / "examples"
DRAGGED = "13_oculus", "14_three_columns", "12_cushion", "17_gridshell"
FRAMES, MOVES = 40, 200
# s of a frame of the oculus, with stresses and what is drawn
FRAME_LIMIT = 0.2
# m
STEP = 0.01


def tables() -> Iterator[Table]:
    """Frames of examples, and the drift after many."""
    yield _frames()
    yield _drift()


class Dragging:
    """An example one of whose points is dragged."""

    def __init__(self, name: str) -> None:
        self.path = EXAMPLES / f"{name}.toml"
        self.design = Design.of(self.path.read_text("utf-8"), self.path)
        self.handles = [one for one in self.design.handles if one.kind in ("point", "center")]
        self.frames = WarmFrames()

    def text(self, number: int, shift: np.ndarray) -> str:
        """The text with one handle moved."""
        handle = self.handles[number % len(self.handles)]
        to = (np.array(handle.at) + shift).tolist()
        return edited(self.design, {"do": "move", "handles": {handle.id: to}})

    def frame(self, text: str) -> tuple[Frame, bytes]:
        """All that the server does from a text to the message for the page."""
        frame = self.frames.frame(Design.of(text, self.path).project, self.path.parent, silent)
        return frame, frame.message("frame", 1, {})


def _frames() -> Table:
    rows: list[Row] = []
    limits: list[Limit] = []
    for name in DRAGGED:
        dragging = Dragging(name)
        dragging.frame(dragging.design.text)
        times, ratios, anew, size = [], [], 0, 0
        for k in range(FRAMES):
            text = dragging.text(3, np.array([0.0, 0.0, STEP * (1 + k % 5)]))
            with factorisations() as inside:
                seconds, (frame, message) = clocked(partial(dragging.frame, text))
            times.append(seconds)
            ratios.append(seconds / inside.total)
            anew += bool(frame.details["made_anew"])
            size = len(message)
        row: dict[str, Any] = {
            "example": name,
            "surface nodes": len(dragging.frames._film.surface.nodes),  # type: ignore[union-attr]
            "frame, s": median(times),
            "frame / factorisations": median(ratios),
            "message, kB": size / 1000,
            "made anew": anew,
        }
        rows.append(row)
        if name == DRAGGED[0]:
            limits.append(Limit("frame of the oculus, s", float(row["frame, s"]), FRAME_LIMIT))
    return Table(
        "A frame of the studio",
        f"From the text to the message for the page, {FRAMES} times with one point moved by centimetres: project read, "
        "film, net lines, stresses along them, misses, and the scene as bytes; medians.",
        tuple(rows),
        tuple(limits),
    )


def _drift() -> Table:
    dragging = Dragging(DRAGGED[0])
    first, _ = dragging.frame(dragging.design.text)
    draws = np.random.default_rng(17)
    anew = 0
    for _ in range(MOVES):
        text = dragging.text(int(draws.integers(len(dragging.handles))), 0.02 * draws.normal(size=3))
        anew += bool(dragging.frame(text)[0].details["made_anew"])
    last, _ = dragging.frame(dragging.design.text)
    drift = {
        name: float(np.abs(last.arrays[name] - first.arrays[name]).max()) / first.size for name in ("vertices", "lines")
    }
    return Table(
        f"{MOVES} moves of the studio and back",
        "The oculus after as many moves of random points: largest distance of what is drawn from the first frame, over "
        "the size.",
        ({"moves": MOVES, "made anew": anew, "surface": drift["vertices"], "lines": drift["lines"]},),
        (Limit("drift of the surface", drift["vertices"], 1e-9), Limit("drift of the lines", drift["lines"], 1e-9)),
    )


if __name__ == "__main__":
    show(tables())
