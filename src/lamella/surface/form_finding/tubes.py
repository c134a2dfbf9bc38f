"""Films between two loops that are too far apart: the pressures that a tube bears, and how near a film needs them.

Far apart, stable tubes of a given mean curvature H are there in a small range of H alone, some percent of it at the
length of half the circumference (of a cylinder of radius R: pi R), and not much beyond. No trial of a few H finds it.
Those of a given volume are stable to the whole circumference (Rayleigh), so one of these is looked for, and from it the
family is followed to both sides: the ends of the range are the folds of H.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import silent
from lamella.surface.form_finding.boundary_homotopy import BreakError, Moving, along_loops, are_apart
from lamella.surface.form_finding.chart import samples_of, vector_area
from lamella.surface.form_finding.family import Member, member_of, stretches
from lamella.surface.form_finding.film import Loop
from lamella.surface.form_finding.first_film import FirstFilm
from lamella.surface.form_finding.newton import NoFilmError
from lamella.surface.form_finding.search_error import SearchError

TUBE_SAMPLES = 400
# of the first size: as far as a family is followed for where it gets stable or unstable
TUBE_SIZE_MAX = 0.5
# of the range of H, from either end, what is left out: next to a fold films are found with difficulty
TUBE_INSIDE = 0.25
# distances, of the loops' mean radius, at which a film is looked for that is then followed to larger ones
TUBE_DISTANCES = (0.6, 1.0, 0.3)
# loops with their middles less than this apart, of their radius, are no ends of a tube
TUBE_DISTANCE_MIN = 0.05


@dataclass(frozen=True)
class Tube:
    """Two loops seen as the ends of a tube.

    Attributes
    ----------
    loops : tuple of Loop
    order : int
        Of the elements.
    apart : (3,)
        From the middle of the first loop to that of the second, m.
    radius : float
        Mean distance from the axis, m.
    volume, mean_curvature : float
        Of a cylinder between them, m^3 and 1/m, with the signs that the first loop gives: the film lies to its left,
        seen against the normal, so that the normal is the loop's tangent times the way to the other loop.
    """

    loops: tuple[Loop, ...]
    order: int
    apart: Floats
    radius: float
    volume: float
    mean_curvature: float

    @property
    def distance(self) -> float:
        """Between the loops' middles, m."""
        return float(np.linalg.norm(self.apart))

    def at(self, share: float) -> tuple[Loop, ...]:
        """The second loop moved to a share of the distance."""
        first, second = self.loops
        shift = (share - 1) * self.apart
        return first, Moving(second, lambda t: second.at(t) + shift, 0.0)


def tube_of(loops: tuple[Loop, ...], order: int) -> Tube | None:
    """Two loops as ends of a tube; None: they are not two, or in each other."""
    if len(loops) != 2:
        return None
    first, second = (loop.at(samples_of(loop, TUBE_SAMPLES)) for loop in loops)
    apart = second.mean(0) - first.mean(0)
    distance = float(np.linalg.norm(apart))
    across = [_across(points, apart / max(distance, 1e-300)) for points in (first, second)]
    radius = float(np.mean([np.linalg.norm(points, axis=1).mean() for points in across]))
    if distance < TUBE_DISTANCE_MIN * radius:
        return None
    way = apart / distance
    step = np.roll(first, -1, 0) - first
    # above 0 where the normal points away from the axis
    sign = float(np.sign(np.einsum("nc,nc->", np.cross(step, way), across[0])))
    area = float(np.mean([abs(vector_area(points) @ way) for points in (first, second)]))
    return Tube(loops, order, apart, radius, sign * area * distance, -sign / (2 * radius))


def pressure_of(tube: Tube) -> float | None:
    """A mean curvature (1/m) of which there is a stable tube: as near to the cylinder's as keeps clear of the folds.

    None: no film of the cylinder's volume is found, or none of its family is stable at a fixed mean curvature.
    """
    try:
        start = FirstFilm(tube.loops, tube.order, silent, short=True).of_volume(tube.volume).equilibrium
        member = member_of(start.film, start.mean_curvature)
    except (SearchError, NoFilmError, InputError):
        return None
    ends: list[float] = []
    for side in (member, member.backwards()):
        ends.extend(_stable(side))
        # from a stable film the range goes to both sides, from an unstable one it lies to one
        if ends and member.negative:
            break
    if not ends:
        return None
    low, high = min(ends), max(ends)
    room = TUBE_INSIDE * (high - low)
    return float(np.clip(tube.mean_curvature, low + room, high - room))


def _stable(side: Member) -> tuple[float, ...]:
    """H where films begin to be stable and where they end to be, 1/m, along a family from a film; empty: nowhere."""
    begin = None if side.negative else side.mean_curvature
    last, way = side.mean_curvature, 0.0
    try:
        for stretch in stretches(side, silent, np.inf):
            last, way = stretch.second.mean_curvature, way + stretch.step
            if begin is None and not stretch.second.negative:
                begin = stretch.extreme()
            elif begin is not None and stretch.second.negative:
                return begin, stretch.extreme()
            if way > TUBE_SIZE_MAX * side.film.size:
                break
    except NoFilmError:
        pass
    return () if begin is None else (begin, last)


def farthest(tube: Tube, mean_curvature: float) -> float | None:
    """The largest distance between the loops' middles (m) to which a stable film of an H (1/m) is followed.

    The loops are moved along the line between their middles, from near each other; None: no film is found there.
    """
    for part in TUBE_DISTANCES:
        share = part * tube.radius / tube.distance
        if share < 1 and are_apart(tube.at(share)):
            reached = _followed(tube.at, share, tube, mean_curvature)
            if reached is not None:
                return reached * tube.distance
    return None


def _followed(
    path: Callable[[float], tuple[Loop, ...]], share: float, tube: Tube, mean_curvature: float
) -> float | None:
    try:
        start = FirstFilm(path(share), tube.order, silent, short=True).of_curvature(mean_curvature).equilibrium
        along_loops(start, path, share, tube.loops, silent)
    except BreakError as error:
        return error.share
    except (SearchError, NoFilmError, InputError):
        return None
    return 1.0


def _across(points: Floats, axis: Floats) -> Floats:
    """Vectors (n, 3) from the line along an axis through the points' middle."""
    off = points - points.mean(0)
    return np.asarray(off - np.outer(off @ axis, axis))
