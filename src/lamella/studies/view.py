"""What the page of a study draws of a variant: its lamellas as polylines, in whole thousandths of its size."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import orjson

from lamella.base.arrays import Floats
from lamella.stages.results import Results

VIEW_SAMPLES_A_CELL, VIEW_POINTS_MAX = 2, 12_000
"""Points of a polyline between two nodes; of all of them, or the lines become coarser."""

VIEW_STEPS = 30_000
"""Steps across the largest extent: a line on a screen is wider."""


def view_of(results: Results) -> bytes:
    """The polylines of a variant, or edges of its surface's mesh where it has no net, as JSON.

    Parameters
    ----------
    results : Results
    """
    lines, families = _lines(results)
    points = np.concatenate(lines)
    low, high = points.min(0), points.max(0)
    size = float((high - low).max()) or 1.0
    steps = np.rint((points - (low + high) / 2) * (VIEW_STEPS / size)).astype("<i2")
    content: dict[str, Any] = {
        "size": float(f"{size:.6g}"),
        "scale": VIEW_STEPS,
        "counts": [len(line) for line in lines],
        "families": families,
        "points": base64.b64encode(steps.tobytes()).decode("ascii"),
    }
    return orjson.dumps(content)


def _lines(results: Results) -> tuple[list[Floats], str]:
    """Polylines (n, 3), and the letter of each one's family."""
    network = results.network
    if network is None:
        mesh = results.mesh
        edges = np.unique(np.sort(np.vstack([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]]]), axis=1), axis=0)
        edges = edges[:: max(1, len(edges) * 2 // VIEW_POINTS_MAX)]
        return [mesh.points[edge] for edge in edges], len(edges) * "S"
    total = len(network.sample_points)
    lines = []
    for k in range(len(network.ids)):
        first, last = network.sample_offsets[k : k + 2]
        cells = max(1, int(network.stop_offsets[k + 1] - network.stop_offsets[k]) - 1)
        step = max(1, int(last - first - 1) // (cells * VIEW_SAMPLES_A_CELL), total // VIEW_POINTS_MAX)
        kept = np.unique(np.append(np.arange(first, last, step), last - 1))
        lines.append(network.sample_points[kept])
    return lines, "".join(network.families.tolist())
