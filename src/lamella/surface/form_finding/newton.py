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

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report, silent
from lamella.base.sparse import Factor, SingularError, SymmetricPattern
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.variation import FirstVariation, Variation

# a step this small, over the film's size, is the last: the next would be its square
LAST_STEP = 1e-7
# directions follow the film once a normal has turned this far from its node's, as a cosine
TURNED = 0.7
# share of the residual that a step leaves, above which its factorisation is used again
MUCH_LEFT = 0.03
MOST_HALVINGS = 12


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
class Way:
    """A way to go along a family of films: the sum of weights . (x - x0) is to be an amount.

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
    *,
    volume: float | None = None,
    way: Way | None = None,
    springs: Floats | None = None,
    stable: bool = True,
    most_steps: int = 30,
    progress: Progress = silent,
) -> Equilibrium:
    """The film of a mean curvature near a given one.

    Parameters
    ----------
    film : Film
        Where to start.
    mean_curvature : float
        H, 1/m; with `volume` where the search for it starts.
    volume : float, optional
        Volume to sweep from the start along its normals, m^3; H follows.
    way : Way, optional
        How far to go along a family; H follows.
    springs : (n,), optional
        Stiffness (no unit: force over the tension 1 of the film, times length over length) with which each node is held
        where it starts.
    stable : bool
        Look for a minimum of area + 2 H volume (shift the second variation while it has negative eigenvalues).
    most_steps : int
    progress : callable
        Is told each step.

    Raises
    ------
    NoFilmError
        No equilibrium was reached.
    """
    unknowns = film.unknowns
    free = unknowns >= 0
    held = None if springs is None else springs[free]
    size = film.size
    moves: list[float] = []
    swept = 0.0
    begin = film.nodes
    shifted = np.zeros(len(free))
    directions = film.directions()
    variation = Variation(film.connectivity, directions)
    first = variation.first(film.nodes)

    def pull(nodes: Floats, there: FirstVariation, curvature: float) -> Floats:
        total = there.area_gradient + 2 * curvature * there.volume_gradient
        if springs is not None:
            total = total + springs * (shifted + ((nodes - film.nodes) * directions).sum(1))
        return np.asarray(total)

    for step in range(most_steps):
        # the normals at the integration points against the directions of their element
        if step and _turned(film, directions, first) < TURNED:
            directions = film.directions()
            variation = Variation(film.connectivity, directions)
            first = variation.first(film.nodes)
        gradient = pull(film.nodes, first, mean_curvature)[free]
        blocks = variation.second(film.nodes, first, mean_curvature)
        if way is not None:
            left = way.amount - float((way.weights * (film.nodes - begin)).sum())
            row = (way.weights * directions).sum(1)[free]
            shift_of, change, negative = _step_along(film, blocks, gradient, first.volume_gradient[free], row, left)
        elif volume is None:
            again, negative = _factored(film, variation, first, _entries(film.pattern, blocks, held), stable)
            shift_of, change = -again.solve(gradient), 0.0
        else:
            border = np.append(first.volume_gradient[free], 0.0)
            pattern = film.bordered_pattern
            try:
                factor = pattern.factor(_entries(pattern, blocks, held, border))
            except SingularError as error:
                raise NoFilmError(str(error), film) from None
            solution = factor.solve(-np.append(gradient, swept - volume))
            shift_of, change, negative = solution[:-1], solution[-1] / 2, factor.negative - 1
        if not np.isfinite(shift_of).all():
            raise NoFilmError("the second variation is singular", film)
        shift = np.zeros(len(free))
        shift[free] = shift_of
        slope = float(gradient @ shift_of)
        free_to_rise = volume is not None or way is not None
        there = partial(pull, curvature=mean_curvature + change)
        film, first, share = _search(film, variation, first, shift, slope, there, not free_to_rise)
        shifted += share * shift
        mean_curvature += share * change
        if volume is not None:
            swept += _swept(film, variation, shift, share)
        if volume is None and way is None and share == 1:
            left_over = there(film.nodes, first)[free]
            if np.abs(left_over).max() > MUCH_LEFT * np.abs(gradient).max():
                more = np.zeros(len(free))
                more[free] = -again.solve(left_over)
                slope = float(left_over @ more[free])
                # without the correction the step is still a step
                with suppress(NoFilmError):
                    film, first, part = _search(film, variation, first, more, slope, there, True)
                    shift += part * more
                    shifted += part * more
        move = float(np.abs(shift).max()) * share
        moves.append(move)
        progress(
            Report.detail(
                f"step {step + 1}: largest shift {move:.2e} m, residual {np.abs(gradient).max() / size:.2e}"
                + (f", {share:.2g} of the step" if share < 1 else "")
                + (f", {negative} negative eigenvalues" if negative else "")
            )
        )
        if share == 1 and move <= LAST_STEP * size and abs(change) * size <= 1e-6:
            return Equilibrium(film, mean_curvature, step + 1, negative, tuple(moves))
    raise NoFilmError(f"no convergence in {most_steps} steps (last shift {moves[-1]:.2g} m)", film)


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


def _turned(film: Film, directions: Floats, first: FirstVariation) -> float:
    """Least cosine between a normal and the directions of its element."""
    middle = directions[film.connectivity.faces].mean(1)
    return float(np.einsum("ceq,ec->eq", first.normals, middle).min())


def _search(
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
    for _ in range(MOST_HALVINGS):
        nodes = film.nodes + share * shift[:, None] * variation.directions
        there = variation.first(nodes)
        folded = ((there.normals * first.normals).sum(0) < 0.3).any() or (there.elements < 0.1 * first.elements).any()
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


__all__ = ["Equilibrium", "NoFilmError", "Way", "find_equilibrium"]
