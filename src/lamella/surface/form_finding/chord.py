"""Films near a given one: Newton's method whose factorisation serves many steps.

A step with a factorisation of another place, a chord step, leaves a share of the error that is in proportion to how
far that place is (Ortega and Rheinboldt, Iterative Solution of Nonlinear Equations in Several Variables (1970), section
10.2). It costs the first variation and a solution with the factors alone. Where a step leaves much, the next one has a
factorisation of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.sparse import Factor, SingularError
from lamella.surface.form_finding.carried_rim import NotKeptError
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.newton import are_folded
from lamella.surface.form_finding.reference_film import ReferenceFilm
from lamella.surface.form_finding.variation import FirstVariation

# of the film's size: what is left of the error
CHORD_LEFT = 1e-12
# of a step, left by it: above it the next one has a factorisation of its own
CHORD_MUCH_LEFT = 0.1
CHORD_STEPS_MAX = 25


class Factored(NamedTuple):
    """Factors of a second variation, and how many negative eigenvalues it has."""

    factor: Factor
    negative: int


@dataclass(frozen=True)
class Settled:
    """A film in equilibrium.

    Attributes
    ----------
    film : Film
    mean_curvature : float
        H, 1/m.
    moves : tuple of float
        Largest shift of a node in each step, m.
    factored : Factored
        The last ones.
    factorisations : int
    """

    film: Film
    mean_curvature: float
    moves: tuple[float, ...]
    factored: Factored
    factorisations: int


def settled(
    reference: ReferenceFilm,
    film: Film,
    mean_curvature: float,
    volume: float | None = None,
    factored: Factored | None = None,
) -> Settled:
    """The film in equilibrium along a reference's directions.

    Parameters
    ----------
    reference : ReferenceFilm
        Its elements and directions.
    film : Film
        Where to start, on these elements.
    mean_curvature : float
        H, 1/m; with a volume, where the search for it starts.
    volume : float, optional
        Enclosed, m^3, instead of H.
    factored : Factored, optional
        Of a place near by.

    Raises
    ------
    NotKeptError
        No equilibrium was reached.
    """
    size, moves, count = film.size, list[float](), 0
    here = _At.of(reference, film.nodes)
    rate = 1.0
    for _ in range(CHORD_STEPS_MAX):
        if factored is None:
            factored, count = _factored(reference, here, mean_curvature, volume is not None), count + 1
        shift, change = _step(reference, film.at(here.nodes), here.first, factored.factor, mean_curvature, volume)
        mean_curvature += change
        there = _At.of(reference, here.nodes + shift[:, None] * reference.directions)
        if not np.isfinite(there.first.area) or are_folded(here.first, there.first):
            raise NotKeptError("its elements fold")
        here = there
        moves.append(max(float(np.abs(shift).max()), abs(change) * size**2))
        rate = moves[-1] / moves[-2] if len(moves) > 1 and moves[-2] else 1.0
        if moves[-1] <= CHORD_LEFT * size or (rate < 1 and moves[-1] * rate <= CHORD_LEFT * size):
            return Settled(film.at(here.nodes), mean_curvature, tuple(moves), factored, count)
        if len(moves) > 1 and rate > CHORD_MUCH_LEFT:
            factored = None
    raise NotKeptError(f"no convergence in {CHORD_STEPS_MAX} steps")


class _At(NamedTuple):
    """Nodes and the first variation there."""

    nodes: Floats
    first: FirstVariation

    @classmethod
    def of(cls, reference: ReferenceFilm, nodes: Floats) -> _At:
        return cls(nodes, reference.variation.first(nodes))


def _factored(reference: ReferenceFilm, at: _At, mean_curvature: float, bordered: bool) -> Factored:
    """Factors of the second variation, with a border for a given volume."""
    film, free = reference.film, reference.free
    blocks = reference.variation.second(at.nodes, at.first, mean_curvature)
    pattern = film.bordered_pattern if bordered else film.pattern
    border = np.append(at.first.volume_gradient[free], 0.0)[None] if bordered else None
    try:
        factor = pattern.factor(pattern.assemble(blocks, border))
    except SingularError:
        raise NotKeptError("its second variation is singular") from None
    return Factored(factor, factor.negative - bordered)


def _step(
    reference: ReferenceFilm,
    film: Film,
    first: FirstVariation,
    factor: Factor,
    mean_curvature: float,
    volume: float | None,
) -> tuple[Floats, float]:
    """Shifts of all nodes (n,), m, and the change of H, 1/m."""
    free = reference.free
    gradient = (first.area_gradient + 2 * mean_curvature * first.volume_gradient)[free]
    shift = np.zeros(len(free))
    if volume is None:
        shift[free] = -factor.solve(gradient)
        return shift, 0.0
    solution = factor.solve(-np.append(gradient, enclosed_volume(film) - volume))
    shift[free] = solution[:-1]
    return shift, float(solution[-1]) / 2
