"""Loops from the [[surface.boundary]] tables of a project."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin, origin_of
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.plausible_size import SMALLEST, refuse_doubtful
from lamella.files.read.choose_curve import choose_loop
from lamella.files.read.curves_3dm import read_3dm
from lamella.files.read.curves_dxf import read_dxf
from lamella.files.read.curves_json import read_json
from lamella.project.values import METRES
from lamella.surface.boundary.arcs import arc_through, circle
from lamella.surface.boundary.checks import check_corner_count, check_loops
from lamella.surface.boundary.curve import Loop, Sliding, make_loop
from lamella.surface.boundary.fillets import rounded_loop
from lamella.surface.boundary.joining import join_in_order
from lamella.surface.boundary.pieces import Pieces, lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.smooth_polyline import smooth_curve, vertices
from lamella.surface.boundary.splines import closed_spline, open_spline
from lamella.surface.boundary.units import metres_per_unit, name_of
from lamella.surface.boundary.waves import waved

if TYPE_CHECKING:
    from lamella.project.tables import BoundaryTable, FormFoundTable, PartTable, PlaceTable, SlideTable

# points of a loop for its middle
SAMPLES = 1000
# of a file of curves: some twenty seconds of the DXF library
MOST_BYTES = 64_000_000
_READERS = {".3dm": read_3dm, ".dxf": read_dxf, ".json": read_json}
_HEADERS = {".3dm": "the model's unit system", ".dxf": "$INSUNITS in its header", ".json": 'its key "unit"'}


Drawn = dict["BoundaryTable", Loop]
"""Curves of files before they are placed, by their tables: read once where a boundary is built many times."""


def boundary_loops(table: FormFoundTable, folder: Path, drawn: Drawn | None = None) -> tuple[Loop, ...]:
    """The loops of a form-found surface, built and checked.

    Parameters
    ----------
    table : FormFoundTable
        [surface] of a project.
    folder : Path
        Where relative paths of curve files begin: the project file's folder.
    drawn : dict, optional
        Curves of files that were read before; those that were not are added.

    Returns
    -------
    tuple of Loop
        The outer one first, measured from the table's `origin`.

    Raises
    ------
    InputError
        Whatever is wrong with them, with the key of the table.
    """
    drawn = {} if drawn is None else drawn
    loops = tuple(unchecked_loop(table, k, folder, drawn) for k in range(len(table.boundary)))
    check_loops(loops)
    check_corner_count(loops, table.most_nodes, table.tolerance)
    return loops


def unchecked_loop(table: FormFoundTable, index: int, folder: Path, drawn: Drawn) -> Loop:
    """One loop by its number, built as by `boundary_loops` but not checked."""
    return _loop(table.boundary[index], table.origin or NOWHERE, folder, f"surface.boundary[{index}]", drawn)


def with_origin(table: FormFoundTable, folder: Path) -> FormFoundTable:
    """The table with the point of the drawing that is measured from: its own, or one beside the outer loop."""
    if table.origin is not None:
        return table
    outer, where = table.boundary[0], "surface.boundary[0]"
    shift = np.zeros(3) if outer.place is None else np.array(outer.place.shift)
    origin = origin_of(_points_on(outer, folder, where) + shift)
    return table.model_copy(update={"origin": origin}) if any(origin) else table


def _points_on(table: BoundaryTable, folder: Path, where: str) -> Floats:
    """Points on a curve or beside it, as far apart as it is large, m, (n, 3)."""
    if table.file is not None:
        with np.errstate(all="ignore"):
            pieces, unit, _ = _chosen(table, folder, where)
        return np.asarray(pieces.hull * unit)
    if table.circle is not None:
        return np.array(table.circle.center) + table.circle.radius * np.array([[-1.0], [1.0]])
    if table.points is not None:
        return np.array(table.points)
    arcs = [(part.arc.start, part.arc.middle, part.arc.end) for part in table.part or () if part.arc]
    return np.array(
        [point for points in [*arcs, *(part.points or () for part in table.part or ())] for point in points]
    )


def drawing_unit(table: FormFoundTable, folder: Path) -> str | None:
    """The unit of the first curve file of a form-found surface, as a project names it; None: no curve is of a file.

    A drawing in a unit that a project has no name for counts as one in metres.
    """
    first = next((loop for loop in table.boundary if loop.file is not None), None)
    if first is None:
        return None
    if first.unit is not None:
        return first.unit
    path = folder / str(first.file)
    metres = _READERS[path.suffix.lower()](path, "surface.boundary").metres_per_unit
    return next((name for name, length in METRES.items() if length == metres), "m")


def _loop(table: BoundaryTable, origin: Origin, folder: Path, where: str, drawn: Drawn) -> Loop:
    as_drawn = table.model_copy(update={"place": None, "corner_radius": None})
    loop = drawn.get(as_drawn) or _as_drawn(table.measured_from(origin), origin, folder, where)
    if table.file is not None:
        drawn[as_drawn] = loop
    if table.place is not None:
        loop = _placed(loop, table.place, where)
    if table.corner_radius is not None:
        loop = rounded_loop(loop, table.corner_radius, f"{where}.corner_radius")
    return loop if table.place is None or not table.place.waves else _waved(loop, table.place, where)


def _as_drawn(table: BoundaryTable, origin: Origin, folder: Path, where: str) -> Loop:
    """A loop before it is placed; numbers of the table are measured from the origin already, those of files not yet."""
    if table.part is not None:
        return _composed(table.name, table.part, where)
    remarks: tuple[Message, ...] = ()
    if table.circle is not None:
        ring = table.circle
        pieces = circle(np.array(ring.center), ring.radius, np.array(ring.normal))
    elif table.points is not None:
        points = clean_points(table.points, closed=True, where=f"{where}.points")
        splined = table.interpolation == "spline"
        pieces = closed_spline(points, where=f"{where}.points") if splined else lines(points, closed=True)
    else:
        # numbers of a damaged file may be of any size; what comes out of them is looked at afterwards
        with np.errstate(all="ignore"):
            pieces, remarks = _from_file(table, origin, folder, where)
    sliding = () if table.slide is None else (_sliding(table.slide, 0, pieces.count),)
    return make_loop(table.name, pieces, sliding, remarks=remarks, where=where)


def _placed(loop: Loop, place: PlaceTable, where: str) -> Loop:
    """A held loop turned and scaled about the centroid of its length, and shifted."""
    middle = loop.at(np.arange(SAMPLES) / SAMPLES).mean(0)
    turn = Rotation.from_rotvec(np.radians(place.turn)).as_matrix()
    # the pieces of a course are measured from its origin
    shift = middle + np.array(place.shift) + place.scale * turn @ (loop.course.origin - middle)
    pieces = loop.course.pieces.transformed(place.scale, shift, turn)
    return make_loop(loop.name, pieces, remarks=loop.remarks, where=where)


def _waved(loop: Loop, place: PlaceTable, where: str) -> Loop:
    """A held loop shifted in waves along it."""
    pieces, drawn = waved(loop, np.array(place.waves))
    kept = drawn.copy()
    # where elements end stays so, whatever a wave smooths
    kept[drawn] = np.isin(loop.course.joints / loop.length, loop.corners)
    return make_loop(loop.name, pieces, drawn=drawn, kept=kept, remarks=loop.remarks, where=where)


def _chosen(table: BoundaryTable, folder: Path, table_key: str) -> tuple[Pieces, float, tuple[Message, ...]]:
    """The curve of a file in its own unit, that unit in metres, and remarks on the curve."""
    where = f"{table_key}.file"
    path = folder / str(table.file)
    if not path.is_file():
        raise InputError(f"{path}: no such file", "paths are relative to the project file's folder", where)
    try:
        count = path.stat().st_size
        if count > MOST_BYTES:
            raise InputError(
                f"{path} has {count / 1e6:,.0f} MB; at most {MOST_BYTES / 1e6:g} MB of curves are read",
                "save the boundary curves alone in a file of their own",
                where,
            )
        with path.open("rb") as file:
            file.read(1)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}", "check its permissions", where) from None
    suffix = path.suffix.lower()
    content = _READERS[suffix](path, where)
    try:
        unit = metres_per_unit(table.unit, content.metres_per_unit, _HEADERS[suffix], where)
        chosen = choose_loop(content, table.layer, table.id, where, unit)
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    return chosen.pieces, unit, chosen.remarks


def _from_file(
    table: BoundaryTable, origin: Origin, folder: Path, table_key: str
) -> tuple[Pieces, tuple[Message, ...]]:
    """The curve of a file, measured from the origin, m, and remarks on it."""
    where = f"{table_key}.file"
    path = folder / str(table.file)
    drawn, unit, remarks = _chosen(table, folder, table_key)
    pieces = drawn.transformed(unit, -np.array(origin))
    try:
        size = pieces.extent
        # a hole may be small
        if table.unit is None:
            outer = table_key.endswith("[0]")
            refuse_doubtful("the curve", size if outer else max(size, SMALLEST), unit, name_of(unit), where)
        # curves of a .json say themselves how their points are joined
        corners = None if path.suffix.lower() == ".json" else vertices(pieces, table.interpolation, where)
        if corners is not None:
            pieces, remark = smooth_curve(corners, table.interpolation, where)
            remarks += (remark,) if remark else ()
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    return pieces, remarks


def _composed(name: str, tables: tuple[PartTable, ...], where: str) -> Loop:
    parts = [_part(table, f"{where}.part[{k}]") for k, table in enumerate(tables)]
    names = [f"part[{k}]" for k in range(len(parts))]
    pieces = join_in_order(parts, names, where)
    sliding, first = [], 0
    for table, part in zip(tables, parts, strict=True):
        if table.slide is not None:
            sliding.append(_sliding(table.slide, first, part.count))
        first += part.count
    return make_loop(name, pieces, sliding, where=where)


def _part(table: PartTable, where: str) -> Pieces:
    if table.points is not None:
        points = clean_points(table.points, closed=False, where=f"{where}.points")
        splined = table.interpolation == "spline"
        return open_spline(points, where=f"{where}.points") if splined else lines(points, closed=False)
    assert table.arc is not None
    start, middle, end = (np.array(p) for p in (table.arc.start, table.arc.middle, table.arc.end))
    arc = arc_through(start, middle, end)
    if arc is None:
        raise InputError(
            "start, middle and end of the arc lie on a line, or two of them are one",
            "move the middle off the line, or write points = [start, end] for a straight part",
            f"{where}.arc",
        )
    return arc


def _sliding(table: SlideTable, first: int, count: int) -> Sliding:
    def vector(values: tuple[float, float, float] | None) -> Floats | None:
        return None if values is None else np.array(values)

    return Sliding(first, count, vector(table.point), vector(table.normal), vector(table.direction))
