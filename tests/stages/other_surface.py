"""Results of a run as if its surface were another one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from lamella import Results
from lamella.surface.surface import Surface


def on_surface(results: Results, surface: Surface[Any]) -> Results:
    out = replace(results.outputs["surface"], surface=surface, mesh=surface.mesh())
    outputs = {**results.outputs, "surface": out}
    return replace(results, outputs=outputs, upstream=replace(results.upstream, outputs=outputs))
