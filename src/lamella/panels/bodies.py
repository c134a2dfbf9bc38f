"""Plates as sheets in space for models and views."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.files.write.drawn_layer import Body, DrawnLayer
from lamella.panels.panels import LAID, MADE, Panels

COLOURS = {"flat": (186, 205, 214), "single-curved": (222, 196, 140), "cold-bent": (214, 140, 120)}
"""Of the layers."""


def panel_layers(panels: Panels) -> Iterator[DrawnLayer]:
    """A layer for each way that plates are made, without thickness."""
    at = panels.plates.offsets.tolist()
    for code, made in enumerate(MADE):
        some = np.flatnonzero(panels.made == code)
        if not len(some):
            continue
        bodies = tuple(_body(panels, k, at[k], at[k + 1]) for k in some.tolist())
        yield DrawnLayer(f"panels {made}", colour=COLOURS[made], bodies=bodies)


def _body(panels: Panels, k: int, begin: int, end: int) -> Body:
    vertices, triangles = sheet(panels.corners[begin:end], run=panels.ids[k].startswith("S"))
    owner = int(panels.owners[k])
    text = {
        "kind": f"T{panels.kinds[k] + 1}",
        "lies": LAID[panels.laid[owner]],
        "area_m2": f"{panels.areas[k]:.6g}",
        "out_of_plane_mm": f"{1000 * panels.planes.out_of_plane[owner]:.3f}",
    }
    return Body(panels.ids[k], vertices, triangles, text)


def sheet(corner: Floats, *, run: bool = False) -> tuple[Floats, Integers]:
    """Vertices and triangles of a plate with corners (n, 3): from side to side of a run, else around its middle."""
    n = len(corner)
    if not run and n == 3:
        return corner, np.array([[0, 1, 2]])
    if not run:
        around = np.arange(n)
        return np.vstack([corner, corner.mean(axis=0)]), np.column_stack([around, (around + 1) % n, np.full(n, n)])
    right = np.arange(1, n // 2 + 1)
    left = (n - np.arange(n // 2)) % n
    quads = np.column_stack([left[:-1], right[:-1], right[1:], left[1:]])
    return corner, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
