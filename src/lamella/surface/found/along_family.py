"""Along a family of films to the one of a mean curvature, or of a volume."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

from lamella.surface.found.enclosed import enclosed_volume
from lamella.surface.found.family import MANY, Stretch, member_of, stretches
from lamella.surface.found.film import Film
from lamella.surface.found.newton import Detail, Equilibrium, NoFilmError, Way, find_equilibrium

# of its first size, of the radius 1 / H or of the volume's edge: a film larger than this many times has left for good
FAR = 5.0
# and of its first size, on the way to a film without pressure, which lies in the convex hull of its loops
FAR_CALM = 2.0
# negative eigenvalues more than at the start, with which no stable film is looked for any further on
MORE = 1


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


def to_curvature(start: Equilibrium, target: float, detail: Detail, *, unstable: bool = False) -> Reached:
    """Follow a family to the film of a mean curvature (1/m).

    Parameters
    ----------
    start : Equilibrium
        Where it has the wanted mean curvature already, another film is looked for to both sides of it.
    target : float
    detail : callable
    unstable : bool
        Whether an unstable one is wanted, or a stable one.

    Raises
    ------
    FoldError
        The stable films end before the target.
    NoFilmError
        The path breaks.
    """
    first = member_of(start.film, start.mean_curvature)
    away = target - start.mean_curvature
    size = start.film.size
    largest = FAR * max(size, 1 / abs(target)) if target else FAR_CALM * size
    if abs(away) * start.film.size < 1e-9:
        sides = [first, first.backwards()]
    else:
        sides = [first if (away < 0) == (first.rise < 0) else first.backwards()]
    ways = [stretches(side, detail, largest) for side in sides]
    steps = [0] * len(ways)
    ends: list[NoFilmError | FoldError] = []
    # both sides in turn: the nearer film comes first
    while ways:
        for k, way in reversed(list(enumerate(ways))):
            try:
                stretch = next(way)
                steps[k] = stretch.steps
                found = _on_stretch(stretch, target, detail, unstable)
                if not found and not unstable and stretch.second.negative > first.negative + MORE:
                    raise NoFilmError("along the path films get less and less stable", stretch.second.film)
            except (NoFilmError, FoldError) as error:
                ends.append(error)
                del ways[k]
                continue
            if found:
                return Reached(found.equilibrium, sum(steps) + found.steps)
    folds = [end for end in ends if isinstance(end, FoldError)]
    if folds:
        raise folds[0]
    raise NoFilmError("; ".join(dict.fromkeys(map(str, ends))), first.film)


def _on_stretch(stretch: Stretch, target: float, detail: Detail, unstable: bool) -> Reached | None:
    """The wanted film, if it lies on a stretch."""
    steps = 0
    for root in stretch.roots("mean_curvature", target):
        with suppress(NoFilmError):
            near = _part(stretch, float(root))
            found = find_equilibrium(near.film, target, stable=False, most_steps=MANY, detail=detail)
            steps += near.steps + found.steps
            if (found.negative > 0) == unstable and _between(stretch, found.film):
                return Reached(found, steps)
    if not unstable and not stretch.first.negative and stretch.second.negative:
        raise FoldError(stretch.extreme(), stretch.steps + steps)
    return None


def to_volume(start: Equilibrium, volume: float, detail: Detail) -> Reached:
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
    for stretch in stretches(first, detail, FAR * max(start.film.size, abs(volume) ** (1 / 3))):
        for root in stretch.roots("volume", volume):
            with suppress(NoFilmError):
                near = _part(stretch, float(root))
                left = volume - enclosed_volume(near.film)
                found = find_equilibrium(near.film, near.mean_curvature, volume=left, stable=False, detail=detail)
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
    return find_equilibrium(
        first.film, first.mean_curvature, way=Way(first.weights, step), stable=False, most_steps=MANY
    )


def _between(stretch: Stretch, film: Film) -> bool:
    """Whether a film lies on a stretch and not behind its ends: Newton's method at given H may leave it near a fold."""
    way = float((stretch.first.weights * (film.nodes - stretch.first.film.nodes)).sum())
    return -0.2 * stretch.step < way < 1.5 * stretch.step
