"""Rounds of films of prescribed mean curvature: H = c - cos(2 phi) D, with D of the round before.

With H(x) given at the integration points the first variation of a film is that of the area and 2 H times the volume
that is swept. One Newton step with D held is a round. A disturbance of D turns into cos(2 phi) times itself in H, so
that rounds contract by abs(cos 2 phi), whatever the elements; Anderson's acceleration (J. ACM 12 (1965), 547-560,
doi:10.1145/321296.321305; Walker and Ni, SIAM J. Numer. Anal. 49 (2011), 1715-1735, doi:10.1137/10078356X) makes a
dozen of them enough. The second variation, with D held, is factored once.

D is that of the continuous shape operator, minus the derivative of L2-projected normals: D itself has kinks at
umbilics, the operator has none.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.sparse import Factor, SingularError
from lamella.surface.constant_angle.relation import Relation
from lamella.surface.element.varying import VaryingSurface
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.newton import are_folded
from lamella.surface.form_finding.variation import FirstVariation, Variation

ANDERSON_DEPTH = 5
ROUNDS_MAX = 60
ROUND_LAST_STEP = 1e-8
"""Of the film's size: a round that moves no node by more is the last."""
ROUND_STEP_MAX = 0.3
"""Of the film's size: rounds that move a node by more have gone astray."""
IDLE_ROUNDS = 12
"""Rounds in which the moves have to fall below half of what they were."""
ANDERSON_CUT = 1e-10


@dataclass(frozen=True)
class Rounds:
    """What rounds have come to.

    Attributes
    ----------
    film : Film
    moves : tuple of float
        Largest shift of a node in each round, m.
    """

    film: Film
    moves: tuple[float, ...]


def varying_of(film: Film) -> VaryingSurface:
    """The surface of a film whose mean curvature varies."""
    rim = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    return VaryingSurface("film", 0.0, film.connectivity, film.nodes, rim)


def settled_rounds(film: Film, relation: Relation, *, most: int = ROUNDS_MAX) -> Rounds:
    """The film of a relation, near one that is given, on its elements.

    Raises
    ------
    NoFilmError
        The rounds do not end, or elements fold.
    """
    search = _Search(film, relation)
    for _ in range(most):
        move = search.round()
        if move <= ROUND_LAST_STEP * film.size:
            return Rounds(search.film, tuple(search.moves))
        if search.idle:
            break
    raise NoFilmError(f"rounds do not settle (last shift {search.moves[-1]:.2g} m)", search.film)


@dataclass
class _Search:
    """Rounds along one field of directions."""

    film: Film
    relation: Relation
    moves: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.begin = self.film
        self.free = self.film.unknowns >= 0
        self.directions = self.film.directions()
        self.variation = Variation(self.film.connectivity, self.directions)
        self.first: FirstVariation = self.variation.first(self.film.nodes)
        self.factor: Factor | None = None
        # shifts along the directions, and what a round would add to them
        self.shift = np.zeros(int(self.free.sum()))
        self.shifts: list[Floats] = []
        self.steps: list[Floats] = []

    @property
    def idle(self) -> bool:
        """Whether the rounds lead nowhere."""
        moves = self.moves
        return len(moves) > IDLE_ROUNDS and min(moves[-IDLE_ROUNDS // 2 :]) > 0.5 * moves[-IDLE_ROUNDS]

    def round(self) -> float:
        """One round; the largest shift of a node that it would bring by itself, m."""
        wanted = self.relation.mean_curvature(self._deviator())
        sweep = self.variation.weighted_sweep(self.film.nodes, wanted)
        gradient = (self.first.area_gradient + 2 * sweep)[self.free]
        if self.factor is None:
            self.factor = self._factored(wanted)
        step = -self.factor.solve(gradient)
        move = float(np.abs(step).max())
        self.moves.append(move)
        if not move <= ROUND_STEP_MAX * self.begin.size:
            raise NoFilmError(f"a round moves a node by {move:.2g} m", self.film)
        self._take(self._accelerated(step))
        return move

    def _deviator(self) -> Floats:
        """D at the integration points of the swept volume, (m, q), 1/m."""
        local = self.variation.volume_points
        surface = varying_of(self.film)
        return np.abs(surface.shape_everywhere(local)[1]).reshape(len(self.film.connectivity.elements), -1)

    def _factored(self, wanted: Floats) -> Factor:
        """The second variation with the mean curvature held, factored."""
        film = self.film
        blocks = self.variation.second(film.nodes, self.first, wanted)
        try:
            return film.pattern.factor(film.pattern.assemble(blocks))
        except SingularError as error:
            raise NoFilmError(str(error), film) from None

    def _accelerated(self, step: Floats) -> Floats:
        """The next shifts: of combinations of the last rounds the one with the least step, and that step."""
        self.shifts.append(self.shift)
        self.steps.append(step)
        del self.shifts[: -ANDERSON_DEPTH - 1], self.steps[: -ANDERSON_DEPTH - 1]
        if len(self.steps) == 1:
            return np.asarray(self.shift + step)
        more = np.diff(np.stack(self.steps, 1), axis=1)
        moved = np.diff(np.stack(self.shifts, 1), axis=1)
        weights = np.linalg.lstsq(more, step, rcond=ANDERSON_CUT)[0]
        return np.asarray(self.shift + step - (moved + more) @ weights)

    def _take(self, shift: Floats) -> None:
        """Move to these shifts.

        Raises
        ------
        NoFilmError
            Elements fold.
        """
        nodes = self.begin.nodes.copy()
        nodes[self.free] += shift[:, None] * self.directions[self.free]
        there = self.variation.first(nodes)
        if are_folded(self.first, there):
            raise NoFilmError("elements fold", self.film)
        self.shift, self.first, self.film = shift, there, self.film.at(nodes)
