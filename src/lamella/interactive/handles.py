"""What can be dragged in the view: boundary points, circles, shifts of file curves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.units import METRES
from lamella.project.tables import BoundaryTable, FormFoundTable, Project
from lamella.project.text_places import Path
from lamella.stages.surface.boundary_of_tables import points_on

Kind = Literal["point", "center", "radius", "normal", "shift"]
Coordinates = tuple[float, float, float]

# of a circle's radius: how far from the centre the handle of its tilt is
TILT_ARM = 0.6
# decimals of a normal that is dragged
TILT_DECIMALS = 4
# significant digits of a coordinate, of the boundary's size: 0.1 mm at 10 m
SIZE_DIGITS = 5


@dataclass(frozen=True)
class Handle:
    """One of them.

    Attributes
    ----------
    id : str
        Loop and what it is: "0.points.3", "1.circle.radius".
    kind : str
    loop : int
    at : (x, y, z)
        m, in the drawing.
    paths : tuple of paths
        What in the project it changes: the same point may be the end of one part and the start of the next one.
    metres : float
        Metres per unit of these numbers.
    center, normal : (x, y, z) or None
        Of the circle, m.
    index : int
        Of a point among those of its loop, where points can be put in and taken out; else -1.
    """

    id: str
    kind: Kind
    loop: int
    at: Coordinates
    paths: tuple[Path, ...]
    metres: float = 1.0
    center: Coordinates | None = None
    normal: Coordinates | None = None
    index: int = field(default=-1)

    def values(self, to: Sequence[float], decimals: int) -> dict[Path, Any]:
        """What the project's values are to be for the handle to be at a place (x, y, z), m.

        Raises
        ------
        InputError
            A circle would have no radius, or no normal.
        """
        if self.kind == "radius":
            assert self.center is not None
            assert self.normal is not None
            arm, normal = np.array(to) - self.center, np.array(self.normal)
            radius = float(np.linalg.norm(arm - (arm @ normal) * normal))
            value: Any = _rounded(radius / self.metres, decimals, self.metres)
            if not value > 0:
                raise InputError(f"radius = {value:g} m", "drag the handle away from the centre", self.id)
        elif self.kind == "normal":
            assert self.center is not None
            arm = np.array(to) - self.center
            size = float(np.linalg.norm(arm))
            if not size > 0:
                raise InputError("a circle has no normal of length 0", "drag the handle away from the centre", self.id)
            value = [round(x, TILT_DECIMALS) + 0.0 for x in (arm / size).tolist()]
        elif self.kind == "shift":
            assert self.center is not None
            value = [_rounded(a - b, decimals, 1.0) for a, b in zip(to, self.center, strict=True)]
        else:
            value = [_rounded(x / self.metres, decimals, self.metres) for x in to]
        return dict.fromkeys(self.paths, value)

    def record(self) -> dict[str, Any]:
        """For the page."""
        return {
            "id": self.id,
            "kind": self.kind,
            "loop": self.loop,
            "at": self.at,
            "index": self.index,
            "center": self.center,
            "normal": self.normal,
        }


def handles_of(project: Project, values: Mapping[str, Any], folder: Any) -> list[Handle]:
    """The handles of a project; none where its surface has no boundary curves.

    Parameters
    ----------
    project : Project
    values : mapping
        The project's values as they are written: the units of loops are there.
    folder : Path
        Where files it names are.
    """
    table = project.surface
    if not isinstance(table, FormFoundTable):
        return []
    raw = values["surface"]["boundary"]
    return [handle for k, loop in enumerate(table.boundary) for handle in _of_loop(k, loop, raw[k], folder)]


def decimals_of(handles: Sequence[Handle]) -> int:
    """Decimals of coordinates in m that are dragged: by the size of the boundary."""
    places = np.array([handle.at for handle in handles])
    size = float(np.linalg.norm(np.ptp(places, axis=0))) if len(places) else 1.0
    return SIZE_DIGITS - math.floor(math.log10(size)) if size > 0 else SIZE_DIGITS


def _rounded(value: float, decimals: int, metres: float) -> float:
    """A number in some unit, to as many decimals as it has in m."""
    return round(float(value), max(decimals + round(math.log10(metres)), 0)) + 0.0


def _of_loop(k: int, loop: BoundaryTable, raw: Mapping[str, Any], folder: Any) -> Iterator[Handle]:
    base: Path = ("surface", "boundary", k)
    metres = METRES[raw["unit"]] if raw.get("unit") and loop.file is None else 1.0
    if loop.points is not None:
        for i, point in enumerate(loop.points):
            yield Handle(f"{k}.points.{i}", "point", k, point, ((*base, "points", i),), metres, index=i)
    elif loop.circle is not None:
        yield from _of_circle(k, loop, metres)
    elif loop.part is not None:
        yield from _of_parts(k, loop, metres)
    if loop.file is not None:
        shift = np.zeros(3) if loop.place is None else np.array(loop.place.shift)
        middle = _middle(loop, folder, f"surface.boundary[{k}]")
        yield Handle(f"{k}.place.shift", "shift", k, _triple(middle + shift), ((*base, "place", "shift"),), 1.0, middle)


def _middle(loop: BoundaryTable, folder: Any, where: str) -> Coordinates:
    points = points_on(loop, folder, where)
    return _triple((points.min(0) + points.max(0)) / 2)


def _of_circle(k: int, loop: BoundaryTable, metres: float) -> Iterator[Handle]:
    ring = loop.circle
    assert ring is not None
    base: Path = ("surface", "boundary", k, "circle")
    center, normal = np.array(ring.center), np.array(ring.normal)
    normal = normal / np.linalg.norm(normal)
    # away from the axis that the normal is nearest to
    aside = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    first = np.cross(aside / np.linalg.norm(aside), normal)
    about: dict[str, Any] = {"center": _triple(center), "normal": _triple(normal)}
    yield Handle(f"{k}.circle.center", "center", k, _triple(center), ((*base, "center"),), metres, **about)
    rim = _triple(center + ring.radius * first)
    yield Handle(f"{k}.circle.radius", "radius", k, rim, ((*base, "radius"),), metres, **about)
    arm = _triple(center + TILT_ARM * ring.radius * normal)
    yield Handle(f"{k}.circle.normal", "normal", k, arm, ((*base, "normal"),), metres, **about)


def _of_parts(k: int, loop: BoundaryTable, metres: float) -> Iterator[Handle]:
    """Points of parts; where one ends and the next one begins they are one handle."""
    base: Path = ("surface", "boundary", k, "part")
    found: dict[Coordinates, list[Path]] = {}
    for i, part in enumerate(loop.part or ()):
        if part.arc is not None:
            for key in ("start", "middle", "end"):
                found.setdefault(getattr(part.arc, key), []).append((*base, i, "arc", key))
        for j, point in enumerate(part.points or ()):
            found.setdefault(point, []).append((*base, i, "points", j))
    for number, (at, paths) in enumerate(found.items()):
        yield Handle(f"{k}.part.{number}", "point", k, at, tuple(paths), metres)


def _triple(values: Floats) -> Coordinates:
    x, y, z = (float(value) for value in values)
    return x, y, z
