"""Figures of `lamella optimise`: what was given, every iteration, what was measured before and after."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import orjson

from lamella import __version__
from lamella.projection.mesh_figures import MeshFigures, mesh_figures
from lamella.projection.optimised import Optimised, about_mesh
from lamella.projection.report import Solution

if TYPE_CHECKING:
    from lamella.files.quad_mesh_files import QuadFile

SCHEMA = "lamella/optimise/1"


def optimise_bytes(result: Optimised, figures: MeshFigures, given: QuadFile, *, problem: str, file: str) -> bytes:
    """Return the figures as JSON, see `optimise_schema`.

    Parameters
    ----------
    result : Optimised
    figures : MeshFigures
        Of the mesh of the result.
    given : QuadFile
    problem, file : str
        Name of the problem, and of the file that was given.
    """
    content: dict[str, Any] = {
        "schema": SCHEMA,
        "version": __version__,
        "problem": problem,
        "units": "m, degrees, 1/m; residuals, steps and drift in mean edges or radians; null: not defined there",
        "given": {"file": file, "metres_per_unit": given.metres, **about_mesh(given.mesh)},
        "solved": result.solved,
        "result": result.reported,
        "remarks": result.remarks,
        "solutions": [_solution(solution) for solution in result.solutions],
        "before": mesh_figures(given.mesh).summary(),
        "after": figures.summary(),
        "vertices": {key: values.tolist() for key, values in figures.vertices.items()},
        "faces": {key: values.tolist() for key, values in figures.faces.items()},
    }
    if result.lamellas is not None:
        content["lamellas"] = mesh_figures(result.lamellas).summary()
    return orjson.dumps(content, option=orjson.OPT_INDENT_2) + b"\n"


def optimise_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of the figures."""
    text = files("lamella.files").joinpath("optimise.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def _solution(solution: Solution) -> dict[str, Any]:
    keys = ("number", "residual", "largest", "drift", "objective", "step", "length", "damping", "seconds")
    return {
        "verdict": solution.verdict,
        "unmet": solution.unmet,
        "iterations": [{key: getattr(state, key) for key in keys} for state in solution.iterations],
    }
