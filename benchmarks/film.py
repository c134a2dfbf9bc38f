"""Form finding against its limit: the factorisations.

Newton's method from the harmonic start on DESIGN's annulus (12 x 9 m boundary, oculus), order 4, one thread. Printed
for both sparse solvers: CPU seconds of the whole solve, of its factorisations and their ratio (limit 3 at 10,000
nodes), memory, and the exponent of growth. Run by `make bench`.
"""

from __future__ import annotations

import os
import resource
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import numpy as np

from lamella.base import sparse
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.curve import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.chart import make_chart
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.meshing import start_film, with_sizes
from lamella.surface.form_finding.newton import find_equilibrium


class Clock:
    """CPU seconds spent in factorisations."""

    def __init__(self) -> None:
        self.seconds, self.count = 0.0, 0
        factor = sparse.SymmetricPattern.factor

        def timed(pattern: sparse.SymmetricPattern, values: sparse.Floats) -> sparse.Factor:
            begin = time.process_time()
            result = factor(pattern, values)
            self.seconds += time.process_time() - begin
            self.count += 1
            return result

        sparse.SymmetricPattern.factor = timed  # type: ignore[method-assign]


def annulus(elements: int) -> Film:
    """The harmonic start on about that many elements, graded towards the oculus."""
    t = np.arange(36) * 2 * np.pi / 36
    outer = closed_spline(np.column_stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)]))
    ring = circle(np.array([0.0, 0.0, 2.0]), 1.3, np.array([0.0, 0.0, 1.0]))
    loops = (make_loop("outer", outer), make_loop("oculus", ring))
    film = start_film(make_chart(loops), loops, 1, 0, 0.5)

    def graded(points: sparse.Floats) -> sparse.Floats:
        return np.asarray(0.15 + 0.12 * np.linalg.norm(points - [0, 0, 2], axis=1))

    corners = film.nodes[film.connectivity.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    now = (area / (np.sqrt(3) / 4 * graded(corners.mean(1)) ** 2)).sum()
    share = float(np.sqrt(now / elements))
    return harmonic_over_itself(with_sizes(film, lambda points: share * graded(points), 4))


def main() -> None:
    """Print a table."""
    clock = Clock()
    print("solver   nodes    steps  whole s  factor s  ratio  memory GB")
    last: dict[str, tuple[int, float]] = {}
    for elements in (1_250, 12_500):
        start = annulus(elements)
        for backend in ("rslab", "splu") if elements < 5_000 else ("rslab",):
            os.environ["LAMELLA_SOLVER"] = backend
            # anew, or the pattern of the start would serve, with its solver and for nothing
            film = Film.on_mesh(start.mesh, start.loops, 4).at(start.nodes)
            clock.seconds, clock.count = 0.0, 0
            begin = time.process_time()
            found = find_equilibrium(film, 0.0)
            whole = time.process_time() - begin
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
            nodes = film.connectivity.node_count
            print(
                f"{backend:6s} {nodes:8,d} {found.steps:7d} {whole:8.2f} {clock.seconds:9.2f} "
                f"{whole / clock.seconds:6.2f} {memory:9.2f}"
            )
            if backend in last:
                before, seconds = last[backend]
                print(f"  growth exponent {np.log(whole / seconds) / np.log(nodes / before):.2f}")
            last[backend] = (nodes, whole)
            sys.stdout.flush()


if __name__ == "__main__":
    main()
