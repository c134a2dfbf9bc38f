"""What exists where a film does not: the nearest mean curvature, the pressure of a tube, the distance of two loops.

Bounds on films are necessary, not sufficient. So whatever is offered has been found, by the search that a run makes,
on coarse elements.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lamella.base.wording import rounded
from lamella.surface.form_finding.film import Loop
from lamella.surface.form_finding.first_film import FirstFilm
from lamella.surface.form_finding.search_error import SearchError
from lamella.surface.form_finding.tubes import farthest, pressure_of, tube_of

# of the largest H of stable films, the shares that are tried: next to the fold films are found with difficulty, and a
# slightly other boundary has none
SHARES = (0.97, 0.93, 0.87, 0.8, 0.65, 0.5)
# of the H of a hemisphere over a loop, those that are tried
OF_SPHERE = (0.8, 0.6, 0.9)
# of the H at which the stable films of sliding boundaries turn back before H = 0, those that are tried
BEYOND_FOLD = (1.05, 1.2, 1.5)
# of the largest distance of two loops, those that are tried
OF_LIMIT = (0.98, 0.93, 0.85)


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

    def curvature_beyond(self, fold: float | None) -> float | None:
        """A mean curvature of which a film is found, away from 0 past the H at which stable films turn back, 1/m."""
        if not fold:
            return None
        for share in BEYOND_FOLD:
            value = float(np.sign(fold)) * rounded(share * abs(fold), up=True)
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
        """A mean curvature of which there is a film between two loops, 1/m, to three digits."""
        tube = tube_of(self.loops, self.order)
        found = pressure_of(tube) if tube else None
        if found is None:
            return None
        value = float(np.sign(found)) * rounded(abs(found), up=False)
        return value if self.finds(self.loops, value) else None

    def closer(self, mean_curvature: float, limit: float | None = None) -> float | None:
        """A distance between the middles of two loops, moved along it, at which there is a film of an H (1/m), m.

        Parameters
        ----------
        mean_curvature : float
        limit : float, optional
            The largest such distance, where it is known.
        """
        tube = tube_of(self.loops, self.order)
        if tube and limit is None:
            limit = farthest(tube, mean_curvature)
        if tube is None or limit is None:
            return None
        for share in OF_LIMIT:
            value = rounded(share * min(limit, tube.distance), up=False)
            if self.finds(tube.at(value / tube.distance), mean_curvature):
                return value
        return None
