"""Frames when nothing is dragged: what a run of the same text computes, up to the parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lamella.base.progress import Progress
from lamella.interactive.frame import Frame, line_arrays, triangles
from lamella.interactive.warm_scene import closing_labels
from lamella.project.tables import Project
from lamella.stages.clock import Clock
from lamella.stages.computation import Computation
from lamella.stages.memory import Memory
from lamella.stages.results import Results
from lamella.stages.scene import scene_of
from lamella.stages.wanted import wanted_stages

STAGES = ("surface", "network", "lamellas", "fabrication")
"""What is computed while one designs; further stages are a run's."""

# figures beside the view: stage, key of the summary
FIGURES = (
    ("surface", "area"),
    ("surface", "mean_curvature"),
    ("network", "cells"),
    ("network", "nodes"),
    ("network", "lamellas"),
    ("network", "cell_edge_median"),
    ("network", "node_angle_deviation_max_deg"),
    ("lamellas", "total_length"),
    ("lamellas", "utilisation_max"),
    ("fabrication", "mass"),
    ("fabrication", "parts"),
    ("fabrication", "parts_different"),
    ("fabrication", "sheets"),
)


def exact_results(project: Project, folder: Path, memory: Memory, progress: Progress, *, parts: bool = True) -> Results:
    """What a run computes of a project, as far as designing needs it.

    Parameters
    ----------
    project : Project
    folder : Path
        Where files it names are.
    memory : Memory
    progress : callable
        What it raises ends the computation.
    parts : bool
        Whether parts are made.

    Raises
    ------
    InputError
    """
    wanted, messages = wanted_stages(project, None)
    names = STAGES if parts else STAGES[:-1]
    chosen = tuple(stage for stage in wanted if stage.name in names)
    computation = Computation(project, chosen, folder, memory, Clock(progress))
    computation.warnings += messages
    computation.run_all(chosen)
    return computation.results()


def exact_frame(results: Results, closing: Mapping[str, Any] | None = None) -> Frame:
    """The frame of results.

    Parameters
    ----------
    results : Results
    closing : mapping, optional
        Details of the coarse frame of the same project: misses at their places, cells between umbilics.
    """
    mesh, network, summary = results.mesh, results.network, results.summary
    arrays: dict[str, Any] = {"vertices": mesh.points, "faces": triangles(mesh.faces)}
    if results.lamellas is not None:
        values = results.lamellas.utilisation
    else:
        values = np.zeros(0 if network is None else len(network.sample_points))
    if network is not None:
        arrays |= line_arrays(network.sample_points, network.sample_offsets, network.families, values)
        arrays |= {"nodes": network.node_points}
    shown = (
        (key, summary[stage][key]) for stage, key in FIGURES if summary.get(stage) and key in (summary[stage] or {})
    )
    figures = {key: float(value) for key, value in shown if isinstance(value, int | float)}
    scene, details = scene_of(results), _details(results)
    if closing:
        scene = replace(scene, labels=(*scene.labels, *closing_labels(closing)))
        details["apart"] = closing.get("apart", [])
    return Frame("exact", arrays, figures, scene, details, results.origin)


def _details(results: Results) -> dict[str, Any]:
    """Umbilics and misses of the summary; places as they are drawn."""
    summary, origin = results.summary, np.array(results.origin)
    net = summary.get("network") or {}
    umbilics = [
        {"point": (np.array(row["point"]) - origin).tolist(), "rays": row["rays"], "node": row["node"]}
        for row in net.get("umbilics", ())
    ]
    misses = [
        {"between": row["between"], "place": None, "off": row["off_cells"], "closed": row["closed"]}
        for row in net.get("joints", ())
    ]
    warnings = [str(warning) for warning in summary["warnings"]]
    return {"umbilics": umbilics, "misses": misses, "warnings": warnings, "seconds": dict(summary["seconds"])}
