"""Guided projection against its limits: set-up, iterations, memory, growth.

A catenoid in asymptotic layout with noise of 2 % of the edge becomes a net of planar stars with equal diagonals
(`asymptotic`, form "faces"), from 1,000 to 100,000 vertices, one thread; at 10,000 also with right angles between
vertex circles (form "circles"), three times as many unknowns. Printed, in CPU seconds: topology and pattern (limit 1 s
at 10,000 vertices), symbolic analysis, an iteration over its numeric factorisation and solve (limit 1.5), memory
(limit 600 MB at 10,000), `splu` on the same matrix, and the exponent of growth (limit 1.3). Run by `make bench`.
"""

from __future__ import annotations

import os
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import pairwise
from multiprocessing import get_context

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import numpy as np

from lamella import Catenoid
from lamella.base import sparse
from lamella.projection.normal_equations import NormalEquations
from lamella.projection.problems.asymptotic import asymptotic
from lamella.projection.problems.crossing import AngleForm
from lamella.projection.quad_mesh import QuadMesh, quad_mesh

CASES: tuple[tuple[int, AngleForm], ...] = (
    (1_000, "faces"),
    (10_000, "faces"),
    (10_000, "circles"),
    (100_000, "faces"),
)


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


def noisy_catenoid(vertices: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a square patch of lamellas, with noise."""
    n = round(vertices**0.5)
    steps = np.linspace(-1, 1, n)
    p, q = (x.ravel() for x in np.meshgrid(steps, steps, indexing="ij"))
    exact = Catenoid(1.0, (-1.5, 1.5)).at((p + q) / 2 + 1j * (p - q) / 2).position
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


def measured(size: int, form: AngleForm) -> tuple[int, float, float]:
    """Print a line; vertices, seconds of an iteration and of the whole."""
    clock = Clock()
    mesh, seconds = topology(*noisy_catenoid(size))
    clock.setup = seconds
    begin = time.process_time()
    net = asymptotic(mesh, form=form, on_iteration=lambda _: clock.stamps.append(time.process_time()))
    whole = seconds + time.process_time() - begin
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6
    # the first factorisation analyses the pattern too
    numeric = float(np.mean(clock.factor[1:]))
    iteration = float(np.diff(clock.stamps)[:-1].mean())
    count = len(mesh.vertices)
    unknowns = sum(values.size for values in net.solution.values.values())
    print(
        f"{count:8,d} {form:7s} {unknowns:8,d} {clock.setup:9.2f} {clock.factor[0] - numeric:11.2f} {iteration:12.2f} "
        f"{numeric:17.2f} {iteration / numeric:6.2f} {net.solution.last.number:6d} {whole:8.2f} {memory:10.0f}"
        f"  {net.solution.verdict}"
    )
    if size == 10_000 and clock.last:
        pattern, values, right = clock.last
        clock.factor = []
        replace(pattern, backend="splu").factor(values).solve(right)
        print(f"         splu on the same matrix: factor + solve {clock.factor[0]:.2f} s")
    sys.stdout.flush()
    return count, iteration, whole


def main() -> None:
    """Print a table; each line from a process of its own, for its memory."""
    print(
        "vertices form    unknowns  set-up s  symbolic s  iteration s  factor + solve s  ratio  iterations  whole s  "
        "memory MB",
        flush=True,
    )
    rows: list[tuple[int, float, float]] = []
    for size, form in CASES:
        with ProcessPoolExecutor(1, get_context("spawn")) as process:
            row = process.submit(measured, size, form).result()
        if form == "faces":
            rows.append(row)
    print('growth exponents, form "faces":')
    for (n0, i0, w0), (n1, i1, w1) in (*pairwise(rows), (rows[0], rows[-1])):
        span = np.log(n1 / n0)
        exponents = f"iteration {np.log(i1 / i0) / span:.2f}, whole {np.log(w1 / w0) / span:.2f}"
        print(f"  from {n0:,d} to {n1:,d}: {exponents}")


if __name__ == "__main__":
    main()
