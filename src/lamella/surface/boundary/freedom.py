"""How the boundary of a film may be changed: shifts, sizes and tilts of loops, waves of their points, H."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.project.boundary_tables import MOST_WAVES, AdjustTable, PlaceTable
from lamella.surface.boundary.waves import wave_rows

if TYPE_CHECKING:
    from lamella.project.boundary_tables import BoundaryTable
    from lamella.project.tables import FormFoundTable

# points of a loop for each full wave along it
POINTS_A_WAVE = 3
# places along a loop where its waves together are limited, and to what share of the limit: the curve through shifted
# points goes a little further between them
PLACES, NEAR_LIMIT = 144, 0.98
# of a limit: what is offered instead of one that does not do is larger than what is needed
SPARE = 0.05
# where a project names no freedom: of a loop's size
USUAL = 0.05


@dataclass(frozen=True)
class _Part:
    """Some of the parameters: what they are, how far they go, and how the table follows from their values.

    With values `ranges` x what is limited are the lengths of the vectors `limits` (n, 3, p) x: 1 at most. The limit is
    what the project writes under `key`, of the boundary loop number `loop` (-1: of the surface).
    """

    name: str
    key: str
    loop: int
    ranges: Floats
    limits: Floats
    apply: Callable[[FormFoundTable, Floats], FormFoundTable]


class Freedom:
    """The parameters of a boundary that may change, as shares of their ranges.

    A range is a limit of what moves: of the shift of a loop, of the turn about whatever axis, of the shift of every
    point of a loop by all its waves together.

    Parameters
    ----------
    table : FormFoundTable
        Loops with their `adjust`. Where no loop has one and H is held, all loops given by points and all circles may
        change by a twentieth of their size; curves from files and loops of parts stay where they are.

    Attributes
    ----------
    table : FormFoundTable
        As it was given.
    names : tuple of str
        What may change.
    count : int
    limits : (n, 3, count)
        Shares x are allowed where |limits x| <= 1.
    """

    def __init__(self, table: FormFoundTable) -> None:
        self.table = table
        parts: list[_Part] = []
        given = table.adjust_mean_curvature > 0 or any(loop.adjust is not None for loop in table.boundary)
        for index, loop in enumerate(table.boundary):
            parts += _of_loop(index, loop, usual=not given)
        if table.adjust_mean_curvature:
            parts.append(_part("mean curvature", "", -1, table.adjust_mean_curvature, 1, _with_curvature))
        self._parts = parts
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

    def enough(self, shares: Floats) -> str:
        """What a project writes to allow shares (count,) of the ranges and a little more.

        Limits that they keep stay as they are; empty: all do, or one would be more than a project may write.
        """
        loops = self.table.boundary
        adjust: dict[int, dict[str, float | bool]] = {}
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
            given = loops[number].adjust
            # where no loop has a table all may change by the usual: one that is written turns the others off
            if number not in wider and given is not None:
                continue
            height = {"keep_height": True} if given is not None and given.keep_height else {}
            try:
                AdjustTable.model_validate(limits | height)
            except ValueError:
                return ""
            words = [f"{key} = {value:g}" for key, value in limits.items()] + ["keep_height = true"] * len(height)
            phrases.append(f"adjust = {{{', '.join(words)}}} in the table of {loops[number].name!r}")
        return " and ".join(phrases)

    def changed(self, shares: Floats) -> FormFoundTable:
        """The table with parameters at shares (count,) of their ranges."""
        table, first = self.table, 0
        for part in self._parts:
            table = part.apply(table, part.ranges * shares[first : first + len(part.ranges)])
            first += len(part.ranges)
        return table

    def curvature_rates(self) -> Floats:
        """Change of H, 1/m, per share of each parameter, (count,)."""
        rates = [part.ranges if part.apply is _with_curvature else np.zeros(len(part.ranges)) for part in self._parts]
        return np.concatenate([np.zeros(0), *rates])


def refuse_held(freedom: Freedom) -> None:
    """Raise an `InputError` where nothing of the boundary may change."""
    if freedom.count:
        return
    held = [loop.name for loop in freedom.table.boundary if not slides(loop)]
    raise InputError(
        'closing = "adjust", but nothing of the boundary may change',
        f"write adjust = {{move = 0.3}} in the table of {held[0]!r}, or adjust_mean_curvature = 0.1"
        if held
        else 'write closing = "open", or adjust_mean_curvature = 0.1',
        "surface.boundary",
    )


def slides(loop: BoundaryTable) -> bool:
    """Whether a loop or a part of it slides: such loops are not adjusted."""
    return loop.slide is not None or any(part.slide is not None for part in loop.part or ())


def _of_loop(index: int, loop: BoundaryTable, usual: bool) -> list[_Part]:
    """Parameters of one loop; waves first, so that shifts, sizes and tilts are those of the waved loop."""
    if slides(loop):
        return []
    size = 0.0
    if loop.points is not None:
        size = float(np.linalg.norm(np.ptp(np.array(loop.points), axis=0)))
    elif loop.circle is not None:
        size = 2 * loop.circle.radius
    move = scale = tilt = points = 0.0
    # x, y and z, or the plan only
    axes = 2 if loop.adjust is not None and loop.adjust.keep_height else 3
    if loop.adjust is not None:
        move, scale, tilt, points = loop.adjust.move, loop.adjust.scale, loop.adjust.tilt, loop.adjust.points
    elif usual and size:
        move, scale, points = USUAL * size, USUAL, USUAL * size if loop.points is not None else 0.0
    parts = []
    # an even wave is a shift
    first = 1 if move else 0
    if points:
        apply = _curve_waved(index, first)
        most = MOST_WAVES
        if loop.points is not None:
            most = min(MOST_WAVES, len(loop.points) // POINTS_A_WAVE)
            apply = _waved(index, wave_rows(np.arange(len(loop.points)) / len(loop.points), most)[first:])
        # at some places between the points too
        rows = wave_rows(np.arange(PLACES) / PLACES, most)[first:] / NEAR_LIMIT
        limits = np.zeros((PLACES, 3, len(rows), axes))
        for axis in range(axes):
            limits[:, axis, :, axis] = rows.T
        ranges = np.full(axes * len(rows), points)
        by_part = limits.reshape(PLACES, 3, -1)
        parts.append(_Part(f"points of {loop.name!r}", "points", index, ranges, by_part, apply))
    if move:
        parts.append(_part(f"place of {loop.name!r}", "move", index, move, axes, _placed(index)))
    if scale:
        parts.append(_part(f"size of {loop.name!r}", "scale", index, scale, 1, _sized(index)))
    if tilt:
        parts.append(_part(f"tilt of {loop.name!r}", "tilt", index, np.radians(tilt), 3, _tilted(index)))
    return parts


def _part(
    name: str, key: str, loop: int, most: float, count: int, apply: Callable[[FormFoundTable, Floats], FormFoundTable]
) -> _Part:
    """Components of one vector, at most so long."""
    return _Part(name, key, loop, np.full(count, most), np.eye(3, count)[None], apply)


def _replaced(table: FormFoundTable, index: int, loop: BoundaryTable) -> FormFoundTable:
    loops = list(table.boundary)
    loops[index] = loop
    return table.model_copy(update={"boundary": tuple(loops)})


def _mapped(table: FormFoundTable, index: int, turn: Floats, factor: float, shift: Floats) -> FormFoundTable:
    """One loop turned and scaled about its middle, then shifted."""
    loop = table.boundary[index]
    if loop.points is not None:
        points = np.array(loop.points)
        middle = points.mean(0)
        moved = (points - middle) @ turn.T * factor + middle + shift
        return _replaced(table, index, loop.model_copy(update={"points": _tuples(moved)}))
    if loop.circle is None:
        place = loop.place or PlaceTable()
        there = {
            "shift": tuple((np.array(place.shift) + shift).tolist()),
            "scale": place.scale * factor,
            "turn": _degrees(turn @ Rotation.from_rotvec(np.radians(place.turn)).as_matrix()),
        }
        return _replaced(table, index, loop.model_copy(update={"place": place.model_copy(update=there)}))
    ring = {
        "center": tuple((np.array(loop.circle.center) + shift).tolist()),
        "radius": loop.circle.radius * factor,
        "normal": tuple((turn @ np.array(loop.circle.normal)).tolist()),
    }
    circle = loop.circle.model_copy(update=ring)
    return _replaced(table, index, loop.model_copy(update={"circle": circle}))


def _degrees(turn: Floats) -> tuple[float, ...]:
    """Vector along the axis of a rotation (3, 3), as long as its angle, degrees."""
    return tuple(np.degrees(Rotation.from_matrix(turn).as_rotvec()).tolist())


def _tuples(points: Floats) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(point) for point in points.tolist())


def _in_space(shifts: Floats) -> Floats:
    """Shifts (..., 3) of shifts in plan (..., 2), or those of three already."""
    return np.concatenate([shifts, np.zeros((*shifts.shape[:-1], 3 - shifts.shape[-1]))], axis=-1)


def _placed(index: int) -> Callable[[FormFoundTable, Floats], FormFoundTable]:
    return lambda table, values: _mapped(table, index, np.eye(3), 1.0, _in_space(values))


def _sized(index: int) -> Callable[[FormFoundTable, Floats], FormFoundTable]:
    return lambda table, values: _mapped(table, index, np.eye(3), 1.0 + float(values[0]), np.zeros(3))


def _tilted(index: int) -> Callable[[FormFoundTable, Floats], FormFoundTable]:
    return lambda table, values: _mapped(table, index, Rotation.from_rotvec(values).as_matrix(), 1.0, np.zeros(3))


def _waved(index: int, waves: Floats) -> Callable[[FormFoundTable, Floats], FormFoundTable]:
    def apply(table: FormFoundTable, values: Floats) -> FormFoundTable:
        loop = table.boundary[index]
        points = np.array(loop.points) + waves.T @ _in_space(values.reshape(len(waves), -1))
        return _replaced(table, index, loop.model_copy(update={"points": _tuples(points)}))

    return apply


def _curve_waved(index: int, first: int) -> Callable[[FormFoundTable, Floats], FormFoundTable]:
    """Waves by arc length, added to those the curve is placed with; without the even one where it is moved anyway."""

    def apply(table: FormFoundTable, values: Floats) -> FormFoundTable:
        loop = table.boundary[index]
        place = loop.place or PlaceTable()
        rows = np.zeros((2 * MOST_WAVES + 1, 3))
        rows[: len(place.waves)] = np.array(place.waves).reshape(-1, 3)
        rows[first:] += _in_space(values.reshape(len(rows) - first, -1))
        waves = _tuples(rows) if rows.any() else ()
        return _replaced(table, index, loop.model_copy(update={"place": place.model_copy(update={"waves": waves})}))

    return apply


def _with_curvature(table: FormFoundTable, values: Floats) -> FormFoundTable:
    curvature = (table.mean_curvature or 0.0) + float(values[0])
    return table.model_copy(update={"mean_curvature": curvature})
