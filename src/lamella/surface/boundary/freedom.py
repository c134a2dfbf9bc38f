"""How the boundary of a film may be changed: shifts, sizes and tilts of loops, waves of their points, H."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.limits import MOST_WAVES
from lamella.base.vectors import diagonal
from lamella.base.wording import rounded
from lamella.surface.boundary.adjustable_film import AdjustableFilm
from lamella.surface.boundary.boundary_curve import Adjust, BoundaryCurve
from lamella.surface.boundary.film_changes import Change, curve_waved, placed, sized, tilted, waved, with_curvature
from lamella.surface.boundary.splines import follow_weights
from lamella.surface.boundary.waves import wave_rows

# points of a loop for each full wave along it
POINTS_A_WAVE = 3
# places along a loop where its waves together are limited, and to what share of the limit: the curve goes a little
# further between them
FREEDOM_PLACES, NEAR_LIMIT = 144, 0.98
# places of a changed curve whose distances from the drawn one are measured, and of that one
MEASURED_PLACES, DRAWN_PLACES = 1000, 4000
# of a limit: what is offered instead of one that does not do is larger than what is needed
SPARE = 0.05
# where nothing says what may change: of a loop's size
USUAL_CHANGE = 0.05


@dataclass(frozen=True)
class _Part:
    """Some of the parameters: what they are, how far they go, and how the film follows from their values.

    With values `ranges` x what is limited are the lengths of the vectors `limits` (n, 3, p) x: 1 at most. The limit is
    `key` of the `adjust` of the curve number `loop` (-1: that of H).
    """

    name: str
    key: str
    loop: int
    ranges: Floats
    limits: Floats
    apply: Change


class Freedom:
    """The parameters of a boundary that may change, as shares of their ranges.

    A range is a limit of what moves: of the shift of a loop, of the turn about whatever axis, of the shift of every
    point of a loop by all its waves together.

    Parameters
    ----------
    film : AdjustableFilm
        Curves with their `adjust`. Where no curve has one and H is held, all curves by points and all circles may
        change by a twentieth of their size; drawn curves stay where they are.

    Attributes
    ----------
    film : AdjustableFilm
        As it was given.
    names : tuple of str
        What may change.
    count : int
    limits : (n, 3, count)
        Shares x are allowed where |limits x| <= 1.
    """

    def __init__(self, film: AdjustableFilm) -> None:
        self.film = film
        parts: list[_Part] = []
        given = film.adjust_mean_curvature > 0 or any(curve.adjust is not None for curve in film.curves)
        for index, curve in enumerate(film.curves):
            parts += _of_curve(index, curve, usual=not given)
        if film.adjust_mean_curvature:
            parts.append(_part("mean curvature", "", -1, film.adjust_mean_curvature, 1, with_curvature))
        self._parts = parts
        self._trees: dict[int, cKDTree] = {}
        self.names = tuple(part.name for part in parts)
        self.count = sum(len(part.ranges) for part in parts)
        self.limits = np.zeros((sum(len(part.limits) for part in parts), 3, self.count))
        row = column = 0
        for part in parts:
            n, _, p = part.limits.shape
            self.limits[row : row + n, :, column : column + p] = part.limits
            row, column = row + n, column + p

    def used(self, shares: Floats) -> float:
        """The largest share of a limit that shares (count,) of the ranges take."""
        return float(np.linalg.norm(self.limits @ shares, axis=1).max(initial=0.0))

    def over(self, shares: Floats) -> Floats:
        """How far curves are moved by their waves at shares (count,), over their limits, (rows of `limits`,).

        Limits are linear in the shares; the curve through moved points is not, where these lie close. Parts that are
        limited exactly have 0.
        """
        result, first, row = np.zeros(len(self.limits)), 0, 0
        for part in self._parts:
            values = part.ranges * shares[first : first + len(part.ranges)]
            if part.key == "points" and values.any():
                moved = part.apply(self.film, values).curves[part.loop].loop()
                distance, _ = self._drawn(part.loop).query(moved.at(np.arange(MEASURED_PLACES) / MEASURED_PLACES))
                result[row : row + len(part.limits)] = float(distance.max()) / part.ranges[0]
            first, row = first + len(part.ranges), row + len(part.limits)
        return result

    def _drawn(self, index: int) -> cKDTree:
        """Points of a curve as it is drawn."""
        if index not in self._trees:
            self._trees[index] = cKDTree(self.film.curves[index].loop().at(np.arange(DRAWN_PLACES) / DRAWN_PLACES))
        return self._trees[index]

    def enough(self, shares: Floats) -> str:
        """What has to be written to allow shares (count,) of the ranges and a little more.

        Limits that they keep stay as they are; empty: all do, or one would be more than may be written.
        """
        curves = self.film.curves
        adjust: dict[int, dict[str, float]] = {}
        phrases, wider = [], set()
        first = 0
        for part in self._parts:
            used = float(np.linalg.norm(part.limits @ shares[first : first + len(part.ranges)], axis=1).max())
            first += len(part.ranges)
            most = float(np.degrees(part.ranges[0]) if part.key == "tilt" else part.ranges[0])
            if used > 1 - SPARE:
                most = rounded(most * used * (1 + SPARE), up=True, digits=2)
                wider.add(part.loop)
            if part.loop < 0:
                phrases += [f"adjust_mean_curvature = {most:g}"] if part.loop in wider else []
            else:
                adjust.setdefault(part.loop, {})[part.key] = most
        for number, limits in adjust.items() if wider else ():
            given = curves[number].adjust
            # where no loop has a table all may change by the usual: one that is written turns the others off
            if number not in wider and given is not None:
                continue
            height = given is not None and given.keep_height
            try:
                Adjust(**limits, keep_height=height)
            except InputError:
                return ""
            words = [f"{key} = {value:g}" for key, value in limits.items()] + ["keep_height = true"] * height
            phrases.append(f"adjust = {{{', '.join(words)}}} in the table of {curves[number].name!r}")
        return " and ".join(phrases)

    def changed(self, shares: Floats) -> AdjustableFilm:
        """The film with parameters at shares (count,) of their ranges."""
        film, first = self.film, 0
        for part in self._parts:
            film = part.apply(film, part.ranges * shares[first : first + len(part.ranges)])
            first += len(part.ranges)
        return film

    def curvature_sensitivities(self) -> Floats:
        """Change of H, 1/m, per share of each parameter, (count,)."""
        rates = [part.ranges if part.apply is with_curvature else np.zeros(len(part.ranges)) for part in self._parts]
        return np.concatenate([np.zeros(0), *rates])


def refuse_fixed(freedom: Freedom) -> None:
    """Raise an `InputError` where nothing of the boundary may change."""
    if freedom.count:
        return
    held = [curve.name for curve in freedom.film.curves if not curve.slides]
    raise InputError(
        'closing = "adjust", but nothing of the boundary may change',
        f"write adjust = {{move = 0.3}} in the table of {held[0]!r}, or adjust_mean_curvature = 0.1"
        if held
        else 'write closing = "open", or adjust_mean_curvature = 0.1',
        "curves",
    )


def _of_curve(index: int, curve: BoundaryCurve, usual: bool) -> list[_Part]:
    """Parameters of one curve; waves first, so that shifts, sizes and tilts are those of the waved curve."""
    if curve.slides:
        return []
    size = 0.0
    if curve.points is not None:
        size = diagonal(np.array(curve.points))
    elif curve.circle is not None:
        size = 2 * curve.circle.radius
    move = scale = tilt = points = 0.0
    # x, y and z, or the plan only
    axes = 2 if curve.adjust is not None and curve.adjust.keep_height else 3
    if curve.adjust is not None:
        move, scale, tilt, points = curve.adjust.move, curve.adjust.scale, curve.adjust.tilt, curve.adjust.points
    elif usual and size:
        move, scale, points = (
            USUAL_CHANGE * size,
            USUAL_CHANGE,
            USUAL_CHANGE * size if curve.points is not None else 0.0,
        )
    parts = []
    # an even wave is a shift
    first = 1 if move else 0
    if points:
        apply = curve_waved(index, first)
        most = MOST_WAVES
        t = np.arange(FREEDOM_PLACES) / FREEDOM_PLACES
        if curve.points is not None:
            most = min(MOST_WAVES, len(curve.points) // POINTS_A_WAVE)
            drawn = np.array(curve.points)
            rows = wave_rows(np.arange(len(drawn)) / len(drawn), most)[first:]
            apply = waved(index, rows)
            # between the points what the curve makes of them
            rows = rows @ follow_weights(drawn, t, straight=curve.interpolation == "polyline").T
        else:
            rows = wave_rows(t, most)[first:]
        rows = rows / NEAR_LIMIT
        limits = np.zeros((FREEDOM_PLACES, 3, len(rows), axes))
        for axis in range(axes):
            limits[:, axis, :, axis] = rows.T
        ranges = np.full(axes * len(rows), points)
        by_part = limits.reshape(FREEDOM_PLACES, 3, -1)
        parts.append(_Part(f"points of {curve.name!r}", "points", index, ranges, by_part, apply))
    if move:
        parts.append(_part(f"place of {curve.name!r}", "move", index, move, axes, placed(index)))
    if scale:
        parts.append(_part(f"size of {curve.name!r}", "scale", index, scale, 1, sized(index)))
    if tilt:
        parts.append(_part(f"tilt of {curve.name!r}", "tilt", index, np.radians(tilt), 3, tilted(index)))
    return parts


def _part(name: str, key: str, loop: int, most: float, count: int, apply: Change) -> _Part:
    """Components of one vector, at most so long."""
    return _Part(name, key, loop, np.full(count, most), np.eye(3, count)[None], apply)
