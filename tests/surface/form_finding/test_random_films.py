"""Random boundaries: a film that keeps its tolerance wherever it is looked at, or a refusal that says why."""

from __future__ import annotations

import time

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.surface.boundary import check_loops
from lamella.surface.element.places import Places
from lamella.surface.form_finding.adaptivity import away_from_corners
from lamella.surface.form_finding.find import find_film
from surface.form_finding.films import random_places
from surface.form_finding.random_loops import draw_case

TOLERANCE, MOST_NODES = 2e-2, 20_000
LONGEST = 180  # s, of one case on one busy core
# drawn in every run of the suite; all 200 by CI, which takes a quarter of an hour
FEW = [6, 18, 26, 44, 48, 82]
# films that were found, far from the limit of nodes: a search that refuses everything would keep all else
# fmt: off
FOUND = {
    *(6, 14, 17, 20, 36, 38, 41, 44, 48, 53, 54, 59, 61, 63, 66, 70, 74, 81),
    *(82, 83, 88, 90, 94, 95, 96, 99, 100, 102, 103, 104, 112, 113, 114, 118, 122, 129),
    *(130, 132, 133, 135, 136, 137, 146, 147, 149, 155, 163, 165, 167, 171, 173, 185, 188, 194),
}
# fmt: on


def judged(seed: int) -> str:
    """Draw, find, and measure again at places of its own choice; returns what became of it."""
    case = draw_case(seed)
    start = time.perf_counter()
    refusal = None
    try:
        check_loops(case.loops)
        found = find_film(case.loops, case.mean_curvature, tolerance=TOLERANCE, most_nodes=MOST_NODES)
    except InputError as error:
        refusal = error
    else:
        reported = f"deviation {found.deviation:.1e}, {found.equilibrium.film.connectivity.node_count} nodes"
        film, surface = found.equilibrium.film, found.surface("found")
        assert np.isfinite(surface.nodes).all(), seed
        assert found.deviation <= TOLERANCE, (seed, found.deviation)
        assert found.stability.negative == 0, seed
        assert film.connectivity.node_count <= 1.3 * MOST_NODES, seed
        # curvature at places that form finding itself did not look at
        measured = surface.measured(random_places(film, 20_000, seed))
        off = np.abs(measured.mean_curvature - case.mean_curvature)[away_from_corners(film, measured.position)]
        assert off.max() <= TOLERANCE * found.scale, (seed, "silently wrong", off.max() / found.scale)
        # no element is turned over against its neighbours
        mesh = film.connectivity
        middles = np.array([[0.5, 0], [0.5, 0.5], [0, 0.5]])
        element, edge = np.nonzero(mesh.neighbours >= 0)
        one = surface.measured(Places(element, middles[edge])).normal
        other = surface.measured(
            Places(mesh.neighbours[element, edge], middles[mesh.neighbour_edges[element, edge]])
        ).normal
        assert (one * other).sum(1).min() > 0.7, (seed, "folded")
        # the boundary is the loops
        for index, loop in enumerate(case.loops):
            rim = np.unique(mesh.rim_nodes[surface.rim_loop == index])
            fine = loop.at(np.arange(20_000) / 20_000)
            step = loop.length / 20_000
            off_rim = [
                np.linalg.norm(fine - point, axis=1).min() for point in surface.nodes[rim[:: max(len(rim) // 20, 1)]]
            ]
            assert max(off_rim) <= step, (seed, loop.name)
    if refusal is not None:
        assert seed not in FOUND, (seed, "was found before", str(refusal))
        reported = f"refused: {refusal.message}"
        assert refusal.remedy, seed
        assert "nan" not in str(refusal), (seed, reported)
    seconds = time.perf_counter() - start
    assert seconds < LONGEST, (seed, seconds)
    return f"{seed}: {seconds:.1f} s, {case.reported}: {reported}"


def test_draw_is_varied_and_the_same_every_time() -> None:
    cases = [draw_case(seed) for seed in range(40)]
    assert {case.reported.split(",")[0] for case in cases} == {"star", "waving", "free", "winding", "polygon"}
    assert {len(case.loops) for case in cases} == {1, 2, 3, 4}
    assert 0.2 < np.mean([case.mean_curvature == 0 for case in cases]) < 0.7
    again = draw_case(7)
    t = np.linspace(0, 1, 50)
    assert all(np.array_equal(a.at(t), b.at(t)) for a, b in zip(cases[7].loops, again.loops, strict=True))


@pytest.mark.parametrize("seed", FEW)
@pytest.mark.few(2)
def test_film_or_reason(seed) -> None:
    """A random boundary has a film that keeps its H, measured anew, and its loops; or a refusal with a remedy."""
    judged(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", sorted(set(range(200)) - set(FEW)))
def test_film_or_reason_of_more(seed) -> None:
    print(judged(seed))
