"""What exists where a film does not: the nearest mean curvature, the pressure of a tube, the distance of two loops.

Bounds on films are necessary, not sufficient. So whatever is offered has been found, by the search that a run makes,
on coarse elements.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from lamella.surface.found.chart import samples_of
from lamella.surface.found.film import Loop
from lamella.surface.found.first_film import FirstFilm
from lamella.surface.found.loop_path import Moving
from lamella.surface.found.no_film import SearchError
from lamella.surface.points import Floats
from lamella.wording import rounded

# of the largest H of stable films, the shares that are tried: next to the fold films are found with difficulty, and a
# slightly other boundary has none
SHARES = (0.97, 0.93, 0.87, 0.8, 0.65, 0.5)
# of the H of a hemisphere over a loop, and of a cylinder between two, those that are tried
OF_SPHERE = (0.8, 0.6, 0.9)
OF_CYLINDER = (1.0, 0.8, 1.25, 0.6, 1.6)
# of a distance, those that are tried; of the largest one that is known, what is offered
CLOSER, BELOW_LIMIT = 0.85, 0.98
LEAST_SHARE = 0.1
SAMPLES = 400


@dataclass(frozen=True)
class Tries:
    """Tries of other films.

    Attributes
    ----------
    loops : tuple of Loop
    order : int
        Of the elements.
    finds : callable
        Whether a run finds a film in loops, of a mean curvature (1/m): a stable one, or where asked an unstable one.
    """

    loops: tuple[Loop, ...]
    order: int
    finds: Callable[..., bool]

    def nearest_curvature(self, wanted: float, fold: float | None = None) -> float | None:
        """The mean curvature of the sign of a wanted one, and nearly as large as can be, of which a film is found.

        Parameters
        ----------
        wanted : float
            1/m, too large.
        fold : float, optional
            At which stable films turn back, where that is known.

        Returns
        -------
        float or None
            1/m, to three digits; None: none is found.
        """
        if fold is None:
            fold = self._fold(wanted)
        largest = wanted if fold is None or fold * wanted <= 0 or abs(fold) > abs(wanted) else fold
        for share in SHARES:
            value = float(np.sign(wanted)) * rounded(share * abs(largest), up=False)
            if self.finds(self.loops, value):
                return value
        return None

    def curvature_of_bubble(self) -> float | None:
        """A mean curvature of which there is an unstable film in one loop, 1/m: more than half of a sphere, so to say.

        The sphere over a ring of radius R has |H| < 1 / R on either side of its equator.
        """
        radius = self.loops[0].length / (2 * np.pi)
        for share in OF_SPHERE:
            value = rounded(share / radius, up=False)
            if self.finds(self.loops, value, True):
                return value
        return None

    def _fold(self, wanted: float) -> float | None:
        search = FirstFilm(self.loops, self.order, lambda _: None, short=True)
        try:
            search.of_curvature(wanted)
        except SearchError as error:
            return error.fold
        return None

    def curvature_of_tube(self) -> float | None:
        """A mean curvature of which there is a film between two loops, 1/m, to three digits.

        That of the cylinder of their mean radius first. The film lies to the left of the first loop, seen against the
        normal: the normal is the tangent times the way to the other loop.
        """
        if len(self.loops) != 2:
            return None
        first, second = (loop.at(samples_of(loop, SAMPLES)) for loop in self.loops)
        way = second.mean(0) - first.mean(0)
        way = way / np.linalg.norm(way)
        step = np.roll(first, -1, 0) - first
        outwards = np.einsum("nc,nc->", np.cross(step, way), _across(first, way))
        radius = float(np.mean([np.linalg.norm(_across(points, way), axis=1).mean() for points in (first, second)]))
        # above 0 where the normal points to the axis
        cylinder = -np.sign(outwards) / (2 * radius)
        for share in OF_CYLINDER:
            value = float(np.sign(cylinder)) * rounded(share * abs(cylinder), up=False)
            if self.finds(self.loops, value):
                return value
        return None

    def closer(self, limit: float | None = None) -> float | None:
        """A distance between the middles of two loops, moved along it, at which there is a film without pressure, m.

        Parameters
        ----------
        limit : float, optional
            The largest such distance, where it is known.
        """
        if len(self.loops) != 2:
            return None
        middles = [loop.at(np.arange(SAMPLES) / SAMPLES).mean(0) for loop in self.loops]
        apart = middles[1] - middles[0]
        distance = float(np.linalg.norm(apart))
        for share in _shares(1.0 if limit is None else BELOW_LIMIT * limit / distance, limit is not None):
            value = rounded(share * distance, up=False)
            shift = (value / distance - 1) * apart
            if self.finds((self.loops[0], _moved(self.loops[1], shift)), 0.0):
                return value
        return None


def _across(points: Floats, axis: Floats) -> Floats:
    """Vectors (n, 3) from the line along an axis through the points' middle."""
    off = points - points.mean(0)
    return np.asarray(off - np.outer(off @ axis, axis))


def _shares(first: float, included: bool) -> Iterator[float]:
    share = first if included else first * CLOSER
    while share > LEAST_SHARE:
        yield share
        share *= CLOSER


def _moved(loop: Loop, shift: Floats) -> Loop:
    return Moving(loop, lambda t: loop.at(t) + shift, 0.0)
