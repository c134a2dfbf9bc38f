"""Newton's method for films of a given mean curvature, of a given volume, or a given way along a family.

With the second variation K of A + 2 H V, its gradient g and that of the volume v, one step solves

    K s = -g                             H given
    K s + 2 v dH = -g,  v . s = dV       volume given: one symmetric bordered system
    K s + 2 v dH = -g,  w . s = ds       way along a family given (Keller, in: Applications of Bifurcation Theory, 1977)

The last one is not symmetric. With the symmetric border w it takes two right-hand sides: the multiplier of w has to
vanish. It is regular at folds of H and of the volume alike.

Springs may hold the nodes back: with stiffness c_i of node i, c_i is added to the diagonal of K and c_i s_i to g, s_i
being its shift since the search began, summed along its directions (`lamella.surface.form_finding.release`).

Near a fold Newton's steps only halve the error. Where H is given and a step leaves much of the residual, the same
factorisation is used once more at its end (Potra and Ptak, Nondiscrete Induction and Iterative Processes (1984),
chapter 4: third order, three eighths at a fold).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report, silent
from lamella.base.sparse import Factor, SingularError, SymmetricPattern
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.variation import FirstVariation, Variation

# a step this small, over the film's size, is the last: the next would be its square
NEWTON_LAST_STEP = 1e-7
# directions follow the film once a normal has turned this far from its node's, as a cosine
TURNED = 0.7
# share of the residual that a step leaves, above which its factorisation is used again
MUCH_LEFT = 0.03
NEWTON_HALVINGS_MAX = 12
# a step folds elements where a normal turns beyond this cosine, or an area element shrinks to less than this part
FOLDED_COSINE, FOLDED_AREA = 0.3, 0.1


@dataclass(frozen=True)
class Equilibrium:
    """A film in equilibrium.

    Attributes
    ----------
    film : Film
    mean_curvature : float
        H, 1/m.
    steps : int
        Newton steps.
    negative : int
        Negative eigenvalues of the second variation: 0 for a stable film.
    moves : tuple of float
        Largest shift of a node in each step, m.
    """

    film: Film
    mean_curvature: float
    steps: int
    negative: int
    moves: tuple[float, ...]


@dataclass(frozen=True)
class FixedH:
    """H is given.

    Attributes
    ----------
    stable : bool
        Look for a minimum of area + 2 H volume (shift the second variation while it has negative eigenvalues).
    """

    stable: bool = True


@dataclass(frozen=True)
class Volume:
    """A volume is swept from the start along its normals, m^3; H follows."""

    amount: float


@dataclass(frozen=True)
class Along:
    """A step along a family of films: the sum of weights . (x - x0) is to be an amount; H follows.

    Attributes
    ----------
    weights : (n, 3)
        Of the nodes' shifts.
    amount : float
    """

    weights: Floats
    amount: float


def find_equilibrium(
    film: Film,
    mean_curvature: float = 0.0,
    condition: FixedH | Volume | Along = FixedH(),
    *,
    springs: Floats | None = None,
    most_steps: int = 30,
    progress: Progress = silent,
) -> Equilibrium:
    """The film of a mean curvature near a given one.

    Parameters
    ----------
    film : Film
        Where to start.
    mean_curvature : float
        H, 1/m; where the condition is none of H, where the search for it starts.
    condition : FixedH or Volume or Along
        What is given besides the boundary.
    springs : (n,), optional
        Stiffness (no unit: force over the tension 1 of the film, times length over length) with which each node is held
        where it starts.
    most_steps : int
    progress : callable
        Reports each step.

    Raises
    ------
    NoFilmError
        No equilibrium was reached.
    """
    search = _Search(film, mean_curvature, condition, springs)
    size = film.size
    moves: list[float] = []
    for number in range(1, most_steps + 1):
        step = search.step()
        moves.append(step.move)
        progress(
            Report.detail(
                f"step {number}: largest shift {step.move:.2e} m, residual {step.residual / size:.2e}"
                + (f", {step.share:.2g} of the step" if step.share < 1 else "")
                + (f", {step.negative} negative eigenvalues" if step.negative else "")
            )
        )
        if step.share == 1 and step.move <= NEWTON_LAST_STEP * size and abs(step.change) * size <= 1e-6:
            return Equilibrium(search.film, search.mean_curvature, number, step.negative, tuple(moves))
    raise NoFilmError(f"no convergence in {most_steps} steps (last shift {moves[-1]:.2g} m)", search.film)


class _Solved(NamedTuple):
    """Shifts of the free nodes, the change of H, 1/m, negative eigenvalues; the factors where H is given."""

    shift: Floats
    change: float
    negative: int
    factor: Factor | None = None


class _Step(NamedTuple):
    """Largest shift of a node, m; the share of the step that was taken; residual, m; change of H, 1/m."""

    move: float
    share: float
    residual: float
    change: float
    negative: int


class _Search:
    """Newton's method on one film."""

    def __init__(
        self, film: Film, mean_curvature: float, condition: FixedH | Volume | Along, springs: Floats | None
    ) -> None:
        self.film, self.mean_curvature, self.condition, self.springs = film, mean_curvature, condition, springs
        self.free = film.unknowns >= 0
        self.begin = film.nodes
        self.swept = 0.0
        # since the search began
        self.shifted = np.zeros(len(self.free))
        self._take_directions()

    def _take_directions(self) -> None:
        """Directions of the shifts from the present normals."""
        self.directions = self.film.directions()
        self.variation = Variation(self.film.connectivity, self.directions)
        self.first = self.variation.first(self.film.nodes)

    def pull(self, nodes: Floats, there: FirstVariation, curvature: float) -> Floats:
        """Gradient of area + 2 H volume at nodes, with the springs' forces, (n,), m."""
        total = there.area_gradient + 2 * curvature * there.volume_gradient
        if self.springs is not None:
            shift = self.shifted + ((nodes - self.film.nodes) * self.directions).sum(1)
            total = total + self.springs * shift
        return np.asarray(total)

    def step(self) -> _Step:
        """One step, as far as no element folds."""
        # the normals at the integration points against the directions of their element
        if least_cosine(self.film, self.directions, self.first) < TURNED:
            self._take_directions()
        gradient = self.pull(self.film.nodes, self.first, self.mean_curvature)[self.free]
        solved = self._solve(gradient)
        if not np.isfinite(solved.shift).all():
            raise NoFilmError("the second variation is singular", self.film)
        shift = self._spread(solved.shift)
        there = partial(self.pull, curvature=self.mean_curvature + solved.change)
        share = self._go(shift, float(gradient @ solved.shift), there)
        self.mean_curvature += share * solved.change
        if isinstance(self.condition, Volume):
            self.swept += _swept(self.film, self.variation, shift, share)
        if solved.factor is not None and share == 1:
            shift = self._corrected(solved.factor, gradient, shift, there)
        move = float(np.abs(shift).max()) * share
        return _Step(move, share, float(np.abs(gradient).max()), solved.change, solved.negative)

    def _solve(self, gradient: Floats) -> _Solved:
        """The linear system of a step."""
        film, first, condition = self.film, self.first, self.condition
        blocks = self.variation.second(film.nodes, first, self.mean_curvature)
        sweep = first.volume_gradient[self.free]
        if isinstance(condition, Along):
            left = condition.amount - float((condition.weights * (film.nodes - self.begin)).sum())
            row = (condition.weights * self.directions).sum(1)[self.free]
            return _Solved(*_step_along(film, blocks, gradient, sweep, row, left))
        held = None if self.springs is None else self.springs[self.free]
        if isinstance(condition, FixedH):
            values = _entries(film.pattern, blocks, held)
            factor, negative = _factored(film, self.variation, first, values, condition.stable)
            return _Solved(-factor.solve(gradient), 0.0, negative, factor)
        pattern = film.bordered_pattern
        try:
            factor = pattern.factor(_entries(pattern, blocks, held, np.append(sweep, 0.0)))
        except SingularError as error:
            raise NoFilmError(str(error), film) from None
        solution = factor.solve(-np.append(gradient, self.swept - condition.amount))
        return _Solved(solution[:-1], solution[-1] / 2, factor.negative - 1)

    def _go(self, shift: Floats, slope: float, there: Callable[[Floats, FirstVariation], Floats]) -> float:
        """Move by a shift (n,), or by the share of it that is returned."""
        downhill = isinstance(self.condition, FixedH)
        self.film, self.first, share = _line_search(
            self.film, self.variation, self.first, shift, slope, there, downhill
        )
        self.shifted += share * shift
        return share

    def _corrected(
        self, factor: Factor, gradient: Floats, shift: Floats, there: Callable[[Floats, FirstVariation], Floats]
    ) -> Floats:
        """The shift (n,) of a step with what the same factors undo of the residual that it left."""
        left = there(self.film.nodes, self.first)[self.free]
        if np.abs(left).max() <= MUCH_LEFT * np.abs(gradient).max():
            return shift
        more = -factor.solve(left)
        # without the correction the step is still a step
        with suppress(NoFilmError):
            spread = self._spread(more)
            return np.asarray(shift + self._go(spread, float(left @ more), there) * spread)
        return shift

    def _spread(self, shift: Floats) -> Floats:
        """Shifts of all nodes, (n,), from those of the free ones."""
        total = np.zeros(len(self.free))
        total[self.free] = shift
        return total


def _entries(pattern: SymmetricPattern, blocks: Floats, springs: Floats | None, border: Floats | None = None) -> Floats:
    """Entries of the second variation with springs (unknowns,) on its diagonal, and of a border."""
    values = pattern.assemble(blocks, None if border is None else border[None])
    if springs is not None:
        # the lower triangle's columns begin with the diagonal
        values[pattern.columns[: len(springs)]] += springs
    return values


def _factored(
    film: Film, variation: Variation, first: FirstVariation, values: Floats, stable: bool
) -> tuple[Factor, int]:
    """The second variation, for a stable film with the least shift that makes it positive; its negative eigenvalues."""
    pattern = film.pattern
    factor: Factor | None
    try:
        factor = pattern.factor(values)
        negative = factor.negative
    except SingularError:
        factor, negative = None, 1
    if factor is not None and (not negative or not stable):
        return factor, negative
    mass = pattern.assemble(variation.mass(first))
    shift = 1 / film.size**2
    for _ in range(30):
        try:
            factor = pattern.factor(values + shift * mass)
            if not factor.negative:
                return factor, negative
        except SingularError:
            pass
        shift *= 4
    raise NoFilmError("the second variation is singular", film)


def _step_along(
    film: Film, blocks: Floats, gradient: Floats, sweep: Floats, row: Floats, amount: float
) -> tuple[Floats, float, int]:
    """Shift with row . shift = amount, the change of H that goes with it, and negative eigenvalues across the way."""
    pattern = film.bordered_pattern
    right = np.zeros((len(gradient) + 1, 2))
    right[:-1, 0], right[-1, 0], right[:-1, 1] = -gradient, amount, -2 * sweep
    try:
        factor = pattern.factor(pattern.assemble(blocks, np.append(row, 0.0)[None]))
    except SingularError as error:
        raise NoFilmError(str(error), film) from None
    one, other = factor.solve(right).T
    if not other[-1]:
        raise NoFilmError("the family of films has no direction here", film)
    change = -float(one[-1] / other[-1])
    return one[:-1] + change * other[:-1], change, factor.negative - 1


def least_cosine(film: Film, directions: Floats, first: FirstVariation) -> float:
    """Least cosine between a normal and the directions of its element."""
    middle = directions[film.connectivity.faces].mean(1)
    return float(np.einsum("ceq,ec->eq", first.normals, middle).min())


def are_folded(before: FirstVariation, after: FirstVariation) -> bool:
    """Whether a step turns an element over, or squeezes it, anywhere."""
    turned = (after.normals * before.normals).sum(0) < FOLDED_COSINE
    return bool(turned.any() or (after.elements < FOLDED_AREA * before.elements).any())


def _line_search(
    film: Film,
    variation: Variation,
    first: FirstVariation,
    shift: Floats,
    slope: float,
    pull: Callable[[Floats, FirstVariation], Floats],
    downhill: bool,
) -> tuple[Film, FirstVariation, float]:
    """The longest of the halved steps in which no element folds and the slope along the step does not grow."""
    share = 1.0
    for _ in range(NEWTON_HALVINGS_MAX):
        nodes = film.nodes + share * shift[:, None] * variation.directions
        there = variation.first(nodes)
        folded = are_folded(first, there)
        new_slope = float(pull(nodes, there) @ shift)
        calm = not downhill or new_slope <= max(0.9 * abs(slope), 1e-10 * there.area)
        if not folded and calm:
            return film.at(nodes), there, share
        share /= 2
    raise NoFilmError("elements fold: the film breaks", film)


def _swept(film: Film, variation: Variation, shift: Floats, share: float) -> float:
    """Volume swept by the last step: Simpson's rule is exact, the swept volume being cubic in the shift."""
    total = 0.0
    for back, weight in ((1.0, 1 / 6), (0.5, 4 / 6), (0.0, 1 / 6)):
        nodes = film.nodes - (back * share) * shift[:, None] * variation.directions
        total += weight * float(variation.first(nodes).volume_gradient @ shift) * share
    return total


__all__ = [
    "Along",
    "Equilibrium",
    "FixedH",
    "NoFilmError",
    "Volume",
    "are_folded",
    "find_equilibrium",
    "least_cosine",
]
