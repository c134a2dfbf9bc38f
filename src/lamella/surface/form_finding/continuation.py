"""Along a family of films to the one of a mean curvature, or of a volume."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from lamella.base.progress import Progress
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.family import FAMILY_STEPS_MAX, Member, Stretch, member_of, stretches
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.newton import Along, Equilibrium, FixedH, NoFilmError, Volume, find_equilibrium

# of its first size, of the radius 1 / H or of the volume's edge: a film larger than this many times has left for good
FAMILY_SIZE_MAX = 5.0
# and of its first size, on the way to a film without pressure, which lies in the convex hull of its loops
FAR_CALM = 2.0
# negative eigenvalues more than at the start, with which no stable film is looked for any further on
MORE = 1
# of the first size: way along the family past a fold of the stable films, to where they may be stable again. Two films
# that both keep near their loops are no farther apart than that
BOTH_APART = 1.0


class FoldError(ArithmeticError):
    """The family of stable films turns back before the wanted mean curvature.

    Attributes
    ----------
    mean_curvature : float
        H at the fold, estimated, 1/m.
    steps : int
        Newton steps so far.
    """

    def __init__(self, mean_curvature: float, steps: int) -> None:
        super().__init__(f"the stable films turn back at about H = {mean_curvature:.5g} 1/m")
        self.mean_curvature, self.steps = mean_curvature, steps


class VolumeFoldError(NoFilmError):
    """The volume of the films turns back before the wanted one.

    Attributes
    ----------
    volume : float
        The farthest reached, estimated, m^3.
    """

    def __init__(self, volume: float, last: Film) -> None:
        super().__init__(f"the films' volume turns back at about {volume:.5g} m3", last)
        self.volume = volume


@dataclass(frozen=True)
class Reached:
    """A film reached along a path.

    Attributes
    ----------
    equilibrium : Equilibrium
    steps : int
        Newton steps on the whole path.
    """

    equilibrium: Equilibrium
    steps: int


def to_curvature(start: Equilibrium, target: float, progress: Progress, *, unstable: bool = False) -> Reached:
    """Follow a family to the film of a mean curvature (1/m).

    Where the stable films turn back before it, the unstable ones are followed on: they may become stable again and then
    go farther. So it is with boundaries like Enneper's, which have two stable films and an unstable one between them
    (M. J. Beeson, A. J. Tromba, The cusp catastrophe of Thom in the bifurcation of minimal surfaces, Manuscripta
    Mathematica 46 (1984) 273-308): which of the two a search begins with is left to its elements.

    Parameters
    ----------
    start : Equilibrium
        Where it has the wanted mean curvature already, another film is looked for to both sides of it.
    target : float
    progress : callable
    unstable : bool
        Whether an unstable one is wanted, or a stable one.

    Raises
    ------
    FoldError
        The stable films end before the target, and none was found past their fold.
    NoFilmError
        The path breaks.
    """
    first = member_of(start.film, start.mean_curvature)
    away = target - start.mean_curvature
    size = start.film.size
    largest = FAMILY_SIZE_MAX * max(size, 1 / abs(target)) if target else FAR_CALM * size
    if abs(away) * start.film.size < 1e-9:
        sides = [first, first.backwards()]
    else:
        sides = [first if (away < 0) == (first.rise < 0) else first.backwards()]
    ways = [_Side(side, stretches(side, progress, largest)) for side in sides]
    on = list(ways)
    # both sides in turn: the nearer film comes first
    while on:
        for way in reversed(on.copy()):
            try:
                stretch = next(way.rest)
                way.steps = stretch.steps
                found = _on_stretch(stretch, target, progress, unstable)
                if found:
                    return Reached(found.equilibrium, sum(way.steps for way in ways) + found.steps)
                if not unstable:
                    way.require_hope(stretch)
            except NoFilmError as error:
                way.end = error
                on.remove(way)
    steps = sum(way.steps for way in ways)
    for way in ways:
        if way.fold is not None:
            raise FoldError(way.fold, steps)
    raise NoFilmError("; ".join(dict.fromkeys(str(way.end) for way in ways)), first.film)


@dataclass(eq=False)
class _Side:
    """One of the ways along a family.

    Attributes
    ----------
    start : Member
    rest : iterator of Stretch
    steps : int
        Newton steps so far.
    fold : float or None
        H at which the stable films turn back, 1/m.
    beyond : float
        Way past that, m.
    end : NoFilmError or None
        Why it is followed no further.
    """

    start: Member
    rest: Iterator[Stretch]
    steps: int = 0
    fold: float | None = None
    beyond: float = 0.0
    end: NoFilmError | None = None

    def require_hope(self, last: Stretch) -> None:
        """Note whether the films are past their fold.

        Raises
        ------
        NoFilmError
            After the last stretch there is little hope of a stable film further on.
        """
        if last.second.negative > self.start.negative + MORE:
            raise NoFilmError("along the path films get less and less stable", last.second.film)
        if self.fold is not None:
            self.beyond += last.step
            if self.beyond > BOTH_APART * self.start.film.size:
                raise NoFilmError("past their fold the films stay unstable", last.second.film)
        elif not last.first.negative and last.second.negative:
            self.fold = last.extreme()


def _on_stretch(stretch: Stretch, target: float, progress: Progress, unstable: bool) -> Reached | None:
    """The wanted film, if it lies on a stretch."""
    steps = 0
    for root in stretch.roots("mean_curvature", target):
        with suppress(NoFilmError):
            near = _part(stretch, float(root))
            found = find_equilibrium(
                near.film, target, FixedH(stable=False), most_steps=FAMILY_STEPS_MAX, progress=progress
            )
            steps += near.steps + found.steps
            if (found.negative > 0) == unstable and _between(stretch, found.film):
                return Reached(found, steps)
    return None


def to_volume(start: Equilibrium, volume: float, progress: Progress) -> Reached:
    """Follow a family to the film of an enclosed volume (m^3), stable or not.

    Raises
    ------
    VolumeFoldError
        Their volume turns back before the wanted one.
    NoFilmError
        The path breaks.
    """
    first = member_of(start.film, start.mean_curvature)
    missing = volume - first.volume
    if abs(missing) < 1e-12 * first.film.size**3:
        return Reached(start, 0)
    if (missing < 0) != (first.growth < 0):
        first = first.backwards()
    turned, fold = 0, volume
    for stretch in stretches(first, progress, FAMILY_SIZE_MAX * max(start.film.size, abs(volume) ** (1 / 3))):
        for root in stretch.roots("volume", volume):
            with suppress(NoFilmError):
                near = _part(stretch, float(root))
                left = volume - enclosed_volume(near.film)
                found = find_equilibrium(near.film, near.mean_curvature, Volume(left), progress=progress)
                return Reached(found, stretch.steps + near.steps + found.steps)
        if stretch.second.growth * missing < 0:
            fold = fold if turned else stretch.extreme("volume")
            turned += 1
        if turned > 3:
            raise VolumeFoldError(fold, stretch.second.film)
    raise AssertionError("stretches end with an error")


def _part(stretch: Stretch, step: float) -> Equilibrium:
    """A film on the way from the first to the second."""
    first = stretch.first
    return find_equilibrium(first.film, first.mean_curvature, Along(first.weights, step), most_steps=FAMILY_STEPS_MAX)


def _between(stretch: Stretch, film: Film) -> bool:
    """Whether a film lies on a stretch and not behind its ends: Newton's method at given H may leave it near a fold."""
    way = float((stretch.first.weights * (film.nodes - stretch.first.film.nodes)).sum())
    return -0.2 * stretch.step < way < 1.5 * stretch.step
