"""From a surface to its network, against one factorisation of the Poisson problem it solves.

DESIGN's annulus (12 x 9 m boundary, oculus) found on elements of order 4. A run is everything from the elements on:
curvatures, umbilics, isothermic coordinates, lattice, lamellas, faces; only the analysis of the pattern of their inner
nodes comes with the surface from form finding, as in `lamella run`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from statistics import median
from typing import Any

from bench import Limit, Table, clocked, exponent, show
from film import harmonic_start

from lamella.base import sparse
from lamella.network.elements.element_network import ElementNetwork, element_network
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.newton import find_equilibrium

# elements, cells around the oculus, repetitions
SIZES = ((1_250, 42, 9), (3_750, 72, 5), (12_500, 132, 3))
SOLVERS: tuple[sparse.Backend, ...] = ("rslab", "splu")


def surface(elements: int) -> ElementSurface:
    """The annulus on about that many elements."""
    film = find_equilibrium(harmonic_start(elements), 0.0).film
    rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    return ElementSurface("form-found", 0.0, film.connectivity, film.nodes, rim_loop)


class Poisson:
    """The last matrix that was factored: in a run that of the isothermic coordinates."""

    pattern: sparse.SymmetricPattern
    values: sparse.Floats

    def seconds(self, backend: sparse.Backend) -> tuple[float, float]:
        """Of one factorisation from nothing, and of another one with the same pattern."""
        pattern, values = replace(self.pattern, backend=backend, _symbolic={}), self.values
        first, _ = clocked(lambda: pattern.factor(values))
        again, _ = clocked(lambda: pattern.factor(values))
        return first, again


@contextmanager
def noted() -> Iterator[Poisson]:
    """Keep the last matrix that is factored."""
    poisson, factor = Poisson(), sparse.SymmetricPattern.factor

    def noting(pattern: sparse.SymmetricPattern, values: sparse.Floats) -> sparse.Factor:
        poisson.pattern, poisson.values = pattern, values
        return factor(pattern, values)

    sparse.SymmetricPattern.factor = noting  # type: ignore[method-assign]
    try:
        yield poisson
    finally:
        sparse.SymmetricPattern.factor = factor  # type: ignore[method-assign]


def measured(elements: int, cells: int, times: int) -> dict[str, Any]:
    """A row: medians, the run and the factorisations in turns."""
    start = surface(elements)

    def run() -> ElementNetwork:
        # a copy has nothing computed yet
        return element_network(replace(start), cells=cells)

    run()
    seconds: list[list[float]] = []
    for _ in range(times):
        with noted() as poisson:
            whole, net = clocked(run)
        seconds.append([whole, *(t for name in SOLVERS for t in poisson.seconds(name))])
    whole, first, again, splu, _ = (median(column) for column in zip(*seconds, strict=True))
    return {
        "surface nodes": len(start.nodes),
        "net nodes": len(net.network.node_points),
        "unknowns": poisson.pattern.size,
        "run, s": whole,
        "factorisation (rslab), s": first,
        "the same (splu), s": splu,
        "run / factorisation": whole / first,
        "run / its numbers": whole / again,
    }


def tables() -> Iterator[Table]:
    """A row a size."""
    rows = [measured(*size) for size in SIZES]
    one, other = ((row["surface nodes"], row["run, s"]) for row in (rows[0], rows[-1]))
    ratio = "run / factorisation"
    yield Table(
        "Networks of films",
        "The oculus (boundary 12 x 9 m) on finer and finer elements, the net's cells growing alike. A run is "
        "everything from the elements to faces: curvatures, umbilics, isothermic coordinates, lattice, lamellas. "
        "Beside it one factorisation of the Poisson problem in it: ordering, analysis and numbers, or its numbers "
        "alone.",
        tuple(rows),
        (
            Limit(f"{ratio} at {rows[0]['surface nodes']:,} surface nodes", rows[0][ratio], 10),
            Limit("exponent of growth, run by surface nodes", exponent(one, other), 1.3),
        ),
    )


if __name__ == "__main__":
    show(tables())
