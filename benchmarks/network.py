"""From a surface to its network, against one factorisation of the Poisson problem it solves.

DESIGN's annulus (12 x 9 m boundary, oculus) found on elements of order 4, one thread. A run is everything from the
elements on: curvatures, umbilics, isothermic coordinates, lattice, lamellas, faces; only the analysis of the pattern of
their inner nodes comes with the surface from form finding, as in `lamella run`. Printed for growing surfaces, the net's
nodes growing alike: CPU seconds of the run; of one factorisation, ordering and analysis included, by both sparse
solvers; their ratio (limit 10 at 10,000 surface and 2,000 net nodes with the solver in use); of its numbers alone; and
the exponent of growth. Medians over repetitions, the run and the factorisations in turns. Run by `make bench`.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import numpy as np
from film import annulus

from lamella.base import sparse
from lamella.network.elements.element_network import ElementNetwork, element_network
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.newton import find_equilibrium

# elements, cells around the oculus, repetitions
SIZES = ((1_250, 42, 9), (3_750, 72, 5), (12_500, 132, 3))
SOLVERS: tuple[sparse.Backend, ...] = ("rslab", "splu")


def surface(elements: int) -> ElementSurface:
    """The annulus on about that many elements."""
    film = find_equilibrium(annulus(elements), 0.0).film
    rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    return ElementSurface("form-found", 0.0, film.connectivity, film.nodes, rim_loop)


class Poisson:
    """The last matrix that was factored: in a run that of the isothermic coordinates."""

    def __init__(self) -> None:
        factor = sparse.SymmetricPattern.factor

        def noted(pattern: sparse.SymmetricPattern, values: sparse.Floats) -> sparse.Factor:
            self.pattern, self.values = pattern, values
            return factor(pattern, values)

        sparse.SymmetricPattern.factor = noted  # type: ignore[method-assign]

    def seconds(self, backend: sparse.Backend) -> tuple[float, float]:
        """Of one factorisation from nothing, and of another one with the same pattern."""
        pattern, values = replace(self.pattern, backend=backend, _symbolic={}), self.values
        first, _ = clocked(lambda: pattern.factor(values))
        again, _ = clocked(lambda: pattern.factor(values))
        return first, again


def clocked(work: Callable[[], Any]) -> tuple[float, Any]:
    """CPU seconds, and what came of it."""
    begin = time.process_time()
    result = work()
    return time.process_time() - begin, result


def main() -> None:
    """Print a line a size."""
    poisson = Poisson()
    in_use = sparse.default_backend()
    print(f"solver in use: {in_use}; a factorisation: ordering, analysis and numbers")
    print("surface nodes  net nodes  unknowns   run s  " + "  ".join(f"{name:>7s} s" for name in SOLVERS), end="")
    print(f"  run / {in_use}  {in_use} numbers s  run / numbers")
    first_run: tuple[int, float] | None = None
    last: tuple[int, float] | None = None
    for elements, cells, times in SIZES:
        start = surface(elements)

        def run(start: ElementSurface = start, cells: int = cells) -> ElementNetwork:
            # a copy has nothing computed yet
            return element_network(replace(start), cells=cells)

        if last is None:
            run()
        rows = []
        for _ in range(times):
            whole, net = clocked(run)
            rows.append([whole, *(t for name in SOLVERS for t in poisson.seconds(name))])
        whole, *factors = np.median(rows, 0).tolist()
        of = dict(zip(SOLVERS, zip(factors[::2], factors[1::2], strict=True), strict=True))
        first, again = of[in_use]
        nodes = len(start.nodes)
        print(
            f"{nodes:13,d}  {len(net.network.node_points):9,d}  {poisson.pattern.size:8,d}  {whole:6.2f}  "
            + "  ".join(f"{of[name][0]:9.3f}" for name in SOLVERS)
            + f"  {whole / first:{6 + len(in_use)}.1f}  {again:{10 + len(in_use)}.3f}  {whole / again:13.1f}"
        )
        if last:
            print(f"  growth exponent {growth(last, (nodes, whole)):.2f}")
        last = (nodes, whole)
        first_run = first_run or last
        sys.stdout.flush()
    if first_run and last:
        print(f"growth exponent from {first_run[0]:,} to {last[0]:,} nodes: {growth(first_run, last):.2f} (limit 1.3)")


def growth(small: tuple[int, float], large: tuple[int, float]) -> float:
    """Exponent of the seconds over the nodes."""
    return float(np.log(large[1] / small[1]) / np.log(large[0] / small[0]))


if __name__ == "__main__":
    main()
