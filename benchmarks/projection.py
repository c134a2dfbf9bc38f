"""Guided projection against its limits: set-up, iterations, memory, growth; scipy's `splu` on the same matrix."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from bench import Limit, Table, alone, clocked, exponent, memory_gb, show

from lamella import Catenoid
from lamella.base import sparse
from lamella.projection.constraints.planar_face import PlanarFace
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.normal_equations import NormalEquations
from lamella.projection.problems.asymptotic import asymptotic
from lamella.projection.problems.crossing import AngleForm
from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block

CASES: tuple[tuple[int, AngleForm], ...] = (
    (1_000, "faces"),
    (10_000, "faces"),
    (10_000, "circles"),
    (100_000, "faces"),
)
SPLU_AT = 10_000
PLANAR_SIZES, PLANAR = (1_000, 10_000), 1e-6
GROWING = ("iteration, s", "whole, s")


class Clock:
    """CPU seconds of set-up, of each factorisation with its solve, and of each iteration."""

    def __init__(self) -> None:
        self.setup = 0.0
        self.factor: list[float] = []
        self.stamps: list[float] = []
        self.last: tuple[sparse.SymmetricPattern, sparse.Floats, sparse.Floats] | None = None
        factor, of = sparse.SymmetricPattern.factor, NormalEquations.of

        def timed(pattern: sparse.SymmetricPattern, values: sparse.Floats) -> sparse.Factor:
            begin = time.process_time()
            found = factor(pattern, values)
            self.factor.append(time.process_time() - begin)
            return _TimedFactor(found, self, pattern, values)

        def set_up(*arguments: object, **options: object) -> NormalEquations:
            begin = time.process_time()
            found = of(*arguments, **options)  # type: ignore[arg-type]
            self.setup += time.process_time() - begin
            self.factor.clear()  # what came before was the filter
            return found

        sparse.SymmetricPattern.factor = timed  # type: ignore[method-assign]
        NormalEquations.of = set_up  # type: ignore[method-assign]


class _TimedFactor:
    def __init__(
        self, factor: sparse.Factor, clock: Clock, pattern: sparse.SymmetricPattern, values: sparse.Floats
    ) -> None:
        self._factor, self._clock, self._system = factor, clock, (pattern, values)
        self.negative = factor.negative

    def solve(self, right: sparse.Floats) -> sparse.Floats:
        begin = time.process_time()
        found = self._factor.solve(right)
        self._clock.factor[-1] += time.process_time() - begin
        self._clock.last = (*self._system, right)
        return found


def noisy_catenoid(vertices: int, principal: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a square patch of lamellas, or of principal lines, with noise."""
    n = round(vertices**0.5)
    steps = np.linspace(-1, 1, n)
    p, q = (x.ravel() for x in np.meshgrid(steps, steps, indexing="ij"))
    where = p + 1j * q if principal else (p + q) / 2 + 1j * (p - q) / 2
    exact = Catenoid(1.0, (-1.5, 1.5)).at(where).position
    k = np.arange(n * n).reshape(n, n)
    faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    edge = quad_mesh(exact, faces).mean_edge
    return exact + 0.02 * edge * np.random.default_rng(0).normal(size=exact.shape), faces


def topology(vertices: np.ndarray, faces: np.ndarray) -> tuple[QuadMesh, float]:
    """The mesh with all that is asked of it, and CPU seconds."""
    begin = time.process_time()
    mesh = quad_mesh(vertices, faces)
    mesh.stars(mesh.inner)
    mesh.runs(4)
    return mesh, time.process_time() - begin


def measured(size: int, form: AngleForm) -> dict[str, Any]:
    """A row."""
    clock = Clock()
    mesh, seconds = topology(*noisy_catenoid(size))
    clock.setup = seconds
    begin = time.process_time()
    net = asymptotic(mesh, form=form, on_iteration=lambda _: clock.stamps.append(time.process_time()))
    whole = seconds + time.process_time() - begin
    memory = memory_gb()
    # the first factorisation analyses the pattern too
    numeric = float(np.mean(clock.factor[1:]))
    iteration = float(np.diff(clock.stamps)[:-1].mean())
    row: dict[str, Any] = {
        "vertices": len(mesh.vertices),
        "form": form,
        "unknowns": sum(values.size for values in net.solution.values.values()),
        "set-up, s": clock.setup,
        "symbolic, s": clock.factor[0] - numeric,
        "iteration, s": iteration,
        "factor + solve, s": numeric,
        "iteration / factor + solve": iteration / numeric,
        "iterations": net.solution.last.number,
        "whole, s": whole,
        "memory, GB": memory,
    }
    if size == SPLU_AT and clock.last:
        pattern, values, right = clock.last
        row["splu, s"] = clocked(lambda: replace(pattern, backend="splu").factor(values).solve(right))[0]
    return row


def planar_faces(vertices: np.ndarray, faces: np.ndarray) -> dict[str, Any]:
    """A row of this program: faces made planar, what constraints leave open by the least change."""
    a, b, c, d = vertices[faces].transpose(1, 0, 2)
    normals = np.cross(c - a, d - b)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    edge = quad_mesh(vertices, faces).mean_edge
    seconds, found = clocked(
        lambda: solve(
            [Block("vertices", vertices, edge), Block("face normals", normals)],
            [
                PlanarFace(name="planar", faces=faces, edge=edge),
                UnitLength(name="unit", block="face normals", index=np.arange(len(faces))),
            ],
        )
    )
    return _planar_row("this program", found.values["vertices"], vertices, faces, found.last.number, seconds)


def planar_faces_of_peer(vertices: np.ndarray, faces: np.ndarray, folder: str) -> dict[str, Any]:
    """A row of geometrylab."""
    script = Path(__file__).parent / "peers" / "geometrylab_planar.py"
    with tempfile.TemporaryDirectory() as place:
        given, result = Path(place) / "given.npz", Path(place) / "result.npz"
        np.savez(given, vertices=vertices, faces=faces, limit=PLANAR)
        python = os.environ.get("GEOMETRYLAB_PYTHON", sys.executable)
        subprocess.run([python, script, given, result, folder], stdout=subprocess.DEVNULL, check=True)
        found = dict(np.load(result))
    return _planar_row("geometrylab", found["vertices"], vertices, faces, int(found["steps"]), float(found["seconds"]))


def _planar_row(
    program: str, found: np.ndarray, given: np.ndarray, faces: np.ndarray, steps: int, seconds: float
) -> dict[str, Any]:
    a, b, c, d = found[faces].transpose(1, 0, 2)
    normal = np.cross(c - a, d - b)
    gap = np.abs(((b - a) * normal).sum(1)) / np.linalg.norm(normal, axis=1)
    edge = float(np.linalg.norm(b - a, axis=1).mean())
    return {
        "program": program,
        "vertices": len(given),
        "iterations": steps,
        "CPU s": seconds,
        "off a plane, edges": float(gap.max()) / edge,
        "moved (rms), edges": float(np.sqrt(((found - given) ** 2).sum(1).mean())) / edge,
    }


def planar_table() -> Table:
    """Beside geometrylab, where a user has it."""
    folder, rows, left_out = os.environ.get("GEOMETRYLAB", ""), [], []
    for size in PLANAR_SIZES:
        mesh = noisy_catenoid(size, principal=True)
        rows.append(planar_faces(*mesh))
        if folder:
            rows.append(planar_faces_of_peer(*mesh, folder))
    if not folder:
        left_out.append(
            "geometrylab, the guided projection of D. Pellis and H. Wang: name the folder that holds it in "
            "GEOMETRYLAB, and the Python that it runs in in GEOMETRYLAB_PYTHON"
        )
    return Table(
        "Planar faces by guided projection",
        "Principal lines of a catenoid with noise of 2 % of the edge: all faces are made planar, to 1e-6 of an edge, "
        "by the least change. The unknowns are the same, vertices and face normals.",
        tuple(rows),
        left_out=tuple(left_out),
    )


def tables() -> Iterator[Table]:
    """A row a case, each measured in a process of its own, for its memory."""
    rows = [alone(measured, size, form) for size, form in CASES]
    faces = [row for row in rows if row["form"] == "faces"]
    middle = faces[1]
    growth = {key: exponent(*((row["vertices"], row[key]) for row in (faces[0], faces[-1]))) for key in GROWING}
    yield Table(
        "Guided projection",
        "A catenoid in asymptotic layout with noise of 2 % of the edge becomes a net of planar stars with equal "
        'diagonals (`asymptotic`, form "faces"); at 10,000 vertices also with right angles between vertex circles '
        '(form "circles"), three times as many unknowns. `lamella optimise` tells the same CPU seconds.',
        tuple(rows),
        (
            Limit("set-up, s, at 10,000 vertices", middle["set-up, s"], 1.0),
            Limit("iteration / factor + solve at 10,000 vertices", middle["iteration / factor + solve"], 1.5),
            Limit("memory, GB, at 10,000 vertices", middle["memory, GB"], 0.6),
            *(Limit(f"exponent of growth from 1,000 to 100,000 vertices: {key}", growth[key], 1.3) for key in GROWING),
        ),
    )
    yield planar_table()


if __name__ == "__main__":
    show(tables())
