"""The family of films in given loops, followed through its folds.

Films of all mean curvatures in the same loops form a curve. Neither H nor the volume tells where on it a film is: a
bubble on a ring has its largest H as a hemisphere, a nodoid between near rings its least volume before its neck gets
thin. So the steps are steps along the curve itself (`lamella.surface.form_finding.newton.Along`), whose direction is
dx/dH from K dx = -2 v dH, made as long as its largest shift; H and the volume are what comes out. Between two films
both are taken as cubics with the right slopes at either end: where a wanted value or a fold lies follows from them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report
from lamella.base.sparse import SingularError
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.meshing import is_worn, renewed
from lamella.surface.form_finding.newton import Along, NoFilmError, find_equilibrium
from lamella.surface.form_finding.variation import Variation

# largest shift of a first step and of any, over the film's size; a path that needs smaller ones than the last ends
FIRST_STEP, LARGEST_STEP, LEAST_STEP = 0.05, 0.2, 1e-4
FAMILY_FILMS_MAX, FAMILY_NEWTON_MAX = 80, 500
# eigenvalues that may change their sign between neighbouring films, unless the step is this short over the film's size
CHANGED, SHORT_STEP = 1, 0.02
# Newton steps at which the next step along the family may be longer, and that a film may take
FAMILY_FEW_STEPS, FAMILY_STEPS_MAX = 5, 10


@dataclass(frozen=True)
class Member:
    """A film of the family and its direction there.

    Attributes
    ----------
    film : Film
    mean_curvature, volume : float
        1/m, m^3.
    negative : int
        Negative eigenvalues of the second variation.
    weights : (n, 3)
        Way to go: of unit sum with a shift of the film along the family whose largest part is 1 m.
    rise, growth : float
        Change of H and of the volume with that shift, 1/m^2 and m^2.
    """

    film: Film
    mean_curvature: float
    volume: float
    negative: int
    weights: Floats
    rise: float
    growth: float

    def backwards(self) -> Member:
        """The same film, the family run through the other way."""
        return replace(self, weights=-self.weights, rise=-self.rise, growth=-self.growth)


def member_of(film: Film, mean_curvature: float) -> Member:
    """A film in equilibrium with the direction of its family, to either side.

    Raises
    ------
    NoFilmError
    """
    directions = film.directions()
    variation = Variation(film.connectivity, directions)
    first = variation.first(film.nodes)
    free, pattern = film.unknowns >= 0, film.pattern
    stiffness = pattern.assemble(variation.second(film.nodes, first, mean_curvature))
    entries = pattern.assemble(variation.mass(first))
    try:
        factor = pattern.factor(stiffness)
    except SingularError:
        # exactly at a fold the direction is the null mode, which a tiny shift leaves as it is
        try:
            factor = pattern.factor(stiffness + 1e-9 / film.size**2 * entries)
        except SingularError as error:
            raise NoFilmError(str(error), film) from None
    sweep = first.volume_gradient[free]
    shift = factor.solve(-2 * sweep)
    largest = float(np.abs(shift).max())
    if not np.isfinite(largest) or not largest:
        raise NoFilmError("the family of films has no direction here", film)
    shift = shift / largest
    heavy = pattern.matrix(entries) @ shift
    weights = np.zeros_like(film.nodes)
    weights[free] = (heavy / float(heavy @ shift))[:, None] * directions[free]
    return Member(
        film,
        mean_curvature,
        enclosed_volume(film),
        factor.negative,
        weights,
        1 / largest,
        float(sweep @ shift),
    )


@dataclass(frozen=True)
class Stretch:
    """Two neighbouring films of a family, the second one a shift of `step` (m) from the first, and Newton's steps."""

    first: Member
    second: Member
    step: float
    steps: int

    def roots(self, quantity: str, value: float) -> Floats:
        """Shifts, in order, at which H ("mean_curvature") or the "volume" is a value."""
        cubic = self._cubic(quantity) - value
        found = cubic.roots()
        real = found.real[np.abs(found.imag) < 1e-6]
        return np.sort(real[(real > 1e-9) & (real <= 1 + 1e-9)]) * self.step

    def extreme(self, quantity: str = "mean_curvature") -> float:
        """H, 1/m, or the "volume", m^3, where it turns between the two."""
        cubic = self._cubic(quantity)
        turns = cubic.deriv().roots()
        inside = turns.real[(np.abs(turns.imag) < 1e-6) & (turns.real >= 0) & (turns.real <= 1)]
        return float(cubic(inside[0])) if len(inside) else float(getattr(self.second, quantity))

    def _cubic(self, quantity: str) -> np.polynomial.Polynomial:
        slope = {"mean_curvature": "rise", "volume": "growth"}[quantity]
        (a, da), (b, db) = ((getattr(m, quantity), getattr(m, slope) * self.step) for m in (self.first, self.second))
        return np.polynomial.Polynomial([a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db])


def stretches(start: Member, progress: Progress, largest: float) -> Iterator[Stretch]:
    """Follow a family from a film in its direction, as far as it goes, or until a film is larger than a size (m).

    Raises
    ------
    NoFilmError
        The path breaks, or leads too far.
    """
    here, begin, steps = start, start.film.size, 0
    step = FIRST_STEP * begin
    for _ in range(FAMILY_FILMS_MAX):
        step = min(step, LARGEST_STEP * here.film.size)
        try:
            found = find_equilibrium(
                here.film, here.mean_curvature, Along(here.weights, step), most_steps=FAMILY_STEPS_MAX
            )
            there = member_of(found.film, found.mean_curvature)
            if abs(there.negative - here.negative) > CHANGED and step > SHORT_STEP * here.film.size:
                # worn elements have solutions of their own, which no film is near to
                raise NoFilmError("the step leads to another family", here.film)
        except NoFilmError as error:
            steps, step = steps + FAMILY_STEPS_MAX, step / 2
            if step < LEAST_STEP * begin or steps > FAMILY_NEWTON_MAX:
                raise NoFilmError(
                    f"the path of films breaks at H = {here.mean_curvature:.5g} 1/m ({error})", here.film
                ) from None
            continue
        steps += found.steps
        if float((there.weights * (found.film.nodes - here.film.nodes)).sum()) < 0:
            there = there.backwards()
        progress(
            Report.detail(
                f"films followed: volume {there.volume:.5g} m3, H = {there.mean_curvature:.6g} 1/m ({found.steps} "
                f"steps, {there.negative} negative eigenvalues)"
            )
        )
        yield Stretch(here, there, step, steps)
        if there.film.size > largest:
            raise NoFilmError(f"the films followed grow beyond {there.film.size:.3g} m", there.film)
        if is_worn(there.film):
            # what cannot be made anew may still go on as it is
            with suppress(NoFilmError):
                there = _renewed(there)
        if found.steps <= FAMILY_FEW_STEPS:
            step *= 1.5
        here = there
    raise NoFilmError(f"not within {FAMILY_FILMS_MAX} films (last H = {here.mean_curvature:.5g} 1/m)", here.film)


def _renewed(member: Member) -> Member:
    """The same film on new elements."""
    film = renewed(member.film)
    new = member_of(film, member.mean_curvature)
    film = find_equilibrium(film, member.mean_curvature, Along(new.weights, 0.0), most_steps=FAMILY_STEPS_MAX).film
    new = member_of(film, member.mean_curvature)
    # H and volume run on as they did
    same = new.rise * member.rise * film.size**4 + new.growth * member.growth
    return new if same >= 0 else new.backwards()
