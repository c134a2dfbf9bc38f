"""How far apart umbilics are in the isothermic plane, by the shifts of the cut between them.

Around an umbilic of odd order w comes back as -w + c: it is at w = c / 2. Continued along a way to another one both are
on one sheet, and their distance there is a sum of halves of the shifts. Where they are near, the way is straight in the
flat metric |dw|, and whole shifts that make the distance nought would have the two meet.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from lamella.base.arrays import Complexes, Floats
from lamella.network.isothermic.holonomy import around_vertex
from lamella.network.isothermic.isothermic import Isothermic

# cells: nearer to each other than that, whole shifts may ask two umbilics to meet
MEETING_CELLS = 1.0


def between_umbilics(iso: Isothermic) -> Floats:
    """Factors (c, t): times the shifts they are the distances of all pairs of odd umbilics, by the shortest ways."""
    mesh, count = iso.mesh, len(iso.transitions)
    connectivity = mesh.connectivity
    middle = mesh.nodes[connectivity.faces].mean(1)
    element, edge = np.nonzero(connectivity.neighbours >= 0)
    other = connectivity.neighbours[element, edge]
    apart = np.linalg.norm(middle[element] - middle[other], axis=1)
    graph = coo_array((apart, (element, other)), (len(middle), len(middle))).tocsr()
    edge_to = {(int(a), int(b)): int(k) for a, b, k in zip(element, other, edge, strict=True)}
    first = [int(np.nonzero(connectivity.faces == vertex)[0][0]) for vertex in iso.odd.tolist()]
    twice = [around_vertex(mesh, iso.transitions, iso.across, vertex)[1] for vertex in iso.odd.tolist()]
    rows = []
    for p, start in enumerate(first):
        _, before = dijkstra(graph, indices=start, return_predecessors=True)
        for q in range(p):
            direction = [first[q]]
            while direction[-1] != start:
                direction.append(int(before[direction[-1]]))
            direction.reverse()
            # w there is sign w + factors . shifts
            sign, factors = 1, np.zeros(count)
            for here, there in pairwise(direction):
                through = int(iso.across[here, edge_to[here, there]])
                if through:
                    s = iso.transitions[abs(through) - 1].sign
                    factors = s * factors
                    factors[abs(through) - 1] += 1 if through > 0 else -s
                    sign *= s
            rows.append(sign * twice[p] / 2 + factors - twice[q] / 2)
    return np.array(rows).reshape(-1, count)


def keeps_apart(factors: Floats, shifts: Complexes, whole: Complexes) -> bool:
    """Whether whole shifts leave umbilics apart that are near now.

    Parameters
    ----------
    factors : (c, t)
        See `between_umbilics`.
    shifts, whole : (t,) complex
        Those of now and the whole ones, in cells.
    """
    near = np.abs(factors @ shifts) < MEETING_CELLS
    return not bool((np.abs(factors @ whole)[near] < MEETING_CELLS / 2).any())
