"""Form finding against its limit: the factorisations. See `tables`."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from bench import Limit, Row, Table, clocked, exponent, factorisations, memory_gb, show

from lamella import read_project
from lamella.base.arrays import Floats
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.curve import Loop, make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.chart import make_chart
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.found_film import Found
from lamella.surface.form_finding.meshing import start_film, with_sizes
from lamella.surface.form_finding.newton import find_equilibrium
from lamella.surface.remesh.kernel import kernel

EXAMPLES = Path(__file__).parents[1] / "examples"
# times that each film is found
TIMES = 3
# tolerances at which the annulus takes about 3,600 and 9,300 nodes
TOLERANCES = (2e-2, 2e-3)
KINDS = ("09_thin_neck", "11_cap", "13_oculus", "14_three_columns", "15_vault", "17_gridshell")


def annulus_loops() -> tuple[Loop, Loop]:
    """DESIGN's annulus: a boundary of 12 x 9 m that waves, and an oculus."""
    t = np.arange(36) * 2 * np.pi / 36
    outer = closed_spline(np.column_stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)]))
    ring = circle(np.array([0.0, 0.0, 2.0]), 1.3, np.array([0.0, 0.0, 1.0]))
    return make_loop("outer", outer), make_loop("oculus", ring)


@dataclass(frozen=True)
class Search:
    """A film that is looked for."""

    name: str
    loops: tuple[Loop, ...]
    mean_curvature: float = 0.0
    unstable: bool = False
    tolerance: float = 2e-3

    @classmethod
    def of_example(cls, name: str) -> Search:
        """That of an example."""
        table = read_project(EXAMPLES / f"{name}.toml").surface
        loops = boundary_loops(table, EXAMPLES)
        return cls(name, loops, table.mean_curvature or 0.0, table.branch == "unstable", table.tolerance)

    def found(self) -> Found:
        """The film."""
        branch = "unstable" if self.unstable else "stable"
        return find_film(self.loops, self.mean_curvature, tolerance=self.tolerance, branch=branch)


def found_row(search: Search) -> Row:
    """What it takes to find a film, from its loops on."""
    seconds, shares, count = [], [], 0
    for _ in range(TIMES):
        with factorisations() as inside:
            whole, found = clocked(search.found)
        seconds.append(whole)
        shares.append(inside.total)
        count = len(inside.seconds)
    return {
        "film": search.name,
        "tolerance": search.tolerance,
        "nodes": found.equilibrium.film.connectivity.node_count,
        "deviation": found.deviation,
        "find_film, s": median(seconds),
        "factorisations": count,
        "factorisations, s": median(shares),
        "find_film / factorisations": median(s / f for s, f in zip(seconds, shares, strict=True)),
    }


def harmonic_start(elements: int) -> Film:
    """The harmonic start of the annulus on about that many elements, graded towards the oculus."""
    loops = annulus_loops()
    film = start_film(make_chart(loops), loops, 1, 0, 0.5)

    def graded(points: Floats) -> Floats:
        return np.asarray(0.15 + 0.12 * np.linalg.norm(points - [0, 0, 2], axis=1))

    corners = film.nodes[film.connectivity.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    now = (area / (np.sqrt(3) / 4 * graded(corners.mean(1)) ** 2)).sum()
    share = float(np.sqrt(now / elements))
    return harmonic_over_itself(with_sizes(film, lambda points: share * graded(points), 4))


def newton_rows() -> Iterator[Row]:
    """Newton's method from the harmonic start, with both sparse solvers."""
    last: dict[str, tuple[float, float]] = {}
    for elements in (1_250, 12_500):
        start = harmonic_start(elements)
        for backend in ("rslab", "splu") if elements < 5_000 else ("rslab",):
            os.environ["LAMELLA_SOLVER"] = backend
            # anew, or the pattern of the start would serve, with its solver and for nothing
            film = Film.on_mesh(start.mesh, start.loops, 4).at(start.nodes)
            with factorisations() as inside:
                whole, found = clocked(lambda film=film: find_equilibrium(film, 0.0))
            del os.environ["LAMELLA_SOLVER"]
            here = (float(film.connectivity.node_count), whole)
            yield {
                "solver": backend,
                "nodes": film.connectivity.node_count,
                "steps": found.steps,
                "Newton, s": whole,
                "factorisations, s": inside.total,
                "Newton / factorisations": whole / inside.total,
                "memory, GB": memory_gb(),
                "exponent of growth": exponent(last[backend], here) if backend in last else None,
            }
            last[backend] = here


def tables() -> Iterator[Table]:
    """Finding films whole, and Newton's method alone."""
    searches = [Search("annulus", annulus_loops(), tolerance=tolerance) for tolerance in TOLERANCES]
    rows = [found_row(search) for search in (*searches, *map(Search.of_example, KINDS))]
    yield Table(
        "Finding a film",
        "`find_film` from the boundary loops to the film that keeps its tolerance: chart, first film, new elements, "
        "Newton's method, error, stability. The annulus of 12 x 9 m with an oculus, and examples. Factorisations are "
        "all that the call makes, on the way as on the last elements, with the analysis of their patterns. "
        f"Medians of {TIMES}; the remesher's loops are {'compiled' if kernel() else 'those of numpy'}.",
        tuple(rows),
        tuple(
            Limit(
                f"find_film / factorisations at {row['nodes']:,} nodes", float(row["find_film / factorisations"]), 6.0
            )
            for row in rows[: len(searches)]
        ),
    )
    rows = list(newton_rows())
    yield Table(
        "Newton's method on given elements",
        "From the harmonic start of the annulus, elements of order 4. The limit is the factorisations of its steps.",
        tuple(rows),
        tuple(
            Limit(f"Newton / factorisations at {row['nodes']:,} nodes", float(row["Newton / factorisations"]), 3.0)
            for row in rows
            if row["solver"] == "rslab" and row["nodes"] < 50_000
        ),
    )


if __name__ == "__main__":
    show(tables())
