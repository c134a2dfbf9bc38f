"""A surface of constant node angle on elements as small as a tolerance asks for."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.progress import Progress, Report
from lamella.surface.constant_angle.relation import Relation
from lamella.surface.constant_angle.rounds import Rounds, settled_rounds
from lamella.surface.form_finding.adaptivity import Deviation, deviation_of, refined_sizes
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.meshing import renewed, straightened, with_sizes
from lamella.surface.form_finding.redistribution import redistributed
from lamella.surface.form_finding.refinement import GAIN, NEAR_TOLERANCE

REFINED_ROUNDS_MAX = 10
ANGLE_TOLERANCE_USED = 0.9
"""Of the tolerance, kept for what lies between the places that are checked."""
SLOW_GAIN = 0.8
"""Another refinement is worth its time while it lowers the deviation below this part."""


@dataclass(frozen=True)
class Refined:
    """A film of a relation with its elements.

    Attributes
    ----------
    film : Film
    deviation : Deviation
        Of A k1 + B k2 from c.
    rounds : int
        On the last elements.
    all_rounds : int
        On all of them.
    shortfall : str
        Why its tolerance was not reached; empty where it was.
    """

    film: Film
    deviation: Deviation
    rounds: int
    all_rounds: int
    shortfall: str = ""


def refined(
    film: Film, relation: Relation, tolerance: float, most_nodes: int, progress: Progress, *, anew: bool = True
) -> Refined:
    """The surface of a relation near a film, its elements made smaller until it keeps a tolerance.

    Parameters
    ----------
    film : Film
        Near the surface.
    relation : Relation
    tolerance : float
        Largest deviation over the curvature scale.
    most_nodes : int
    progress : callable
    anew : bool
        Whether elements on which rounds fail are made anew once.

    Raises
    ------
    NoFilmError
        The rounds do not settle on the first elements, or on finer ones.
    """
    best: Refined | None = None
    spent, before = 0, 0.0
    for number in range(REFINED_ROUNDS_MAX):
        made = _settled(film, relation, again=anew)
        made, deviation, more = _at_rest(made, relation, tolerance)
        spent += len(made.moves) + more
        progress(
            Report.detail(
                f"{relation.angle:.5g} deg, {made.film.connectivity.node_count:,} nodes: {len(made.moves)} rounds, off "
                f"by up to {deviation.largest:.1e} of the curvature scale {deviation.scale:.3g} 1/m"
            )
        )
        if best is None or deviation.weighted < best.deviation.weighted:
            best = Refined(made.film, deviation, len(made.moves), spent)
        if deviation.weighted <= ANGLE_TOLERANCE_USED * tolerance:
            return Refined(made.film, deviation, len(made.moves), spent)
        size, allowed = refined_sizes(made.film, deviation, tolerance, most_nodes, coarsen=number < 2)
        slow = number > 1 and deviation.weighted > SLOW_GAIN * before
        if not allowed and slow:
            shortfall = f"elements as small as that asks for would need more than most_nodes = {most_nodes:,} nodes"
            return Refined(best.film, best.deviation, best.rounds, spent, shortfall)
        before = deviation.weighted
        film = with_sizes(made.film, size)
    assert best is not None
    shortfall = f"it was not reached in {REFINED_ROUNDS_MAX} refinements"
    return Refined(best.film, best.deviation, best.rounds, spent, shortfall)


def _at_rest(made: Rounds, relation: Relation, tolerance: float) -> tuple[Rounds, Deviation, int]:
    """A film with its nodes where its curvature comes out best, its deviation, and the rounds that took."""
    c, cosine = relation.normal_curvature, relation.cosine
    deviation, spent = deviation_of(made.film, c, cosine), 0
    while True:
        try:
            moved = settled_rounds(redistributed(made.film, c, cosine), relation)
        except NoFilmError:
            return made, deviation, spent
        spent += len(moved.moves)
        before, after = deviation.weighted, deviation_of(moved.film, c, cosine)
        if after.weighted < before:
            made, deviation = moved, after
        if not tolerance < deviation.weighted < min(NEAR_TOLERANCE * tolerance, GAIN * before):
            return made, deviation, spent


def _settled(film: Film, relation: Relation, *, again: bool) -> Rounds:
    """Rounds on elements, or on the same ones made smoother where they fail."""
    try:
        return settled_rounds(film, relation)
    except NoFilmError:
        if not again:
            raise
        return settled_rounds(straightened(renewed(film, 0.7)), relation)
