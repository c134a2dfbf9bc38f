"""Boundary curves from the tables [[surface.boundary]] of a project, and these tables from changed curves."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin, origin_of
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.files.read.curve import chosen_curve, read_curve, unit_of_file
from lamella.project.tables import BoundaryTable, FormFoundTable, PartTable, PlaceTable, SlideTable
from lamella.stages.keys import keys
from lamella.surface.boundary.adjustable_film import AdjustableFilm
from lamella.surface.boundary.arcs import arc_through, circle
from lamella.surface.boundary.boundary_curve import Adjust, BoundaryCurve, Circle, Place
from lamella.surface.boundary.checks import check_corner_count, check_loops
from lamella.surface.boundary.curve import Loop, Sliding, make_loop
from lamella.surface.boundary.joining import join_in_order
from lamella.surface.boundary.pieces import Pieces, lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.splines import closed_spline, open_spline


def boundary_loops(table: FormFoundTable, folder: Path) -> tuple[Loop, ...]:
    """The loops of a form-found surface, built and checked.

    Parameters
    ----------
    table : FormFoundTable
        [surface] of a project.
    folder : Path
        Where relative paths of curve files begin: the project file's folder.

    Returns
    -------
    tuple of Loop
        The outer one first, measured from the table's `origin`.

    Raises
    ------
    InputError
        Whatever is wrong with them, with the key of the table.
    """
    loops = tuple(_curve(table, k, folder).loop(_key(k)) for k in range(len(table.boundary)))
    with keys("surface", loops="surface.boundary"):
        check_loops(loops)
        check_corner_count(loops, table.most_nodes, table.tolerance)
    return loops


def adjustable_film(table: FormFoundTable, folder: Path | None = None) -> AdjustableFilm:
    """What may change of a form-found surface.

    Parameters
    ----------
    table : FormFoundTable
    folder : Path, optional
        As for `boundary_loops`. Without it curves of files are not read, and the film has no loops.

    Raises
    ------
    InputError
    """
    return AdjustableFilm(
        tuple(_curve(table, k, folder) for k in range(len(table.boundary))),
        table.mean_curvature,
        table.adjust_mean_curvature,
        table.volume,
        table.order,
        table.tolerance,
        table.branch,
        table.most_nodes,
    )


def changed_table(table: FormFoundTable, film: AdjustableFilm) -> FormFoundTable:
    """The table of a film that was changed; files it names, and parts, stay and are placed elsewhere."""
    loops = tuple(_changed(loop, curve) for loop, curve in zip(table.boundary, film.curves, strict=True))
    return table.model_copy(update={"boundary": loops, "mean_curvature": film.mean_curvature})


def with_origin(table: FormFoundTable, folder: Path) -> FormFoundTable:
    """The table with the point of the drawing that is measured from: its own, or one beside the outer loop."""
    if table.origin is not None:
        return table
    outer = table.boundary[0]
    shift = np.zeros(3) if outer.place is None else np.array(outer.place.shift)
    origin = origin_of(points_on(outer, folder, _key(0)) + shift)
    return table.model_copy(update={"origin": origin}) if any(origin) else table


def drawing_unit(table: FormFoundTable, folder: Path) -> str | None:
    """The unit of the first curve file of a form-found surface, as a project names it; None: no curve is of a file.

    A drawing in a unit that a project has no name for counts as one in metres.
    """
    first = next((loop for loop in table.boundary if loop.file is not None), None)
    if first is None:
        return None
    return first.unit or unit_of_file(folder / str(first.file), "surface.boundary") or "m"


def _key(index: int) -> str:
    return f"surface.boundary[{index}]"


def _curve(table: FormFoundTable, index: int, folder: Path | None) -> BoundaryCurve:
    """The curve of one table."""
    loop, origin, where = table.boundary[index], table.origin or NOWHERE, _key(index)
    slides = loop.slide is not None or any(part.slide is not None for part in loop.part or ())
    by_points = loop.points is not None and not slides
    by_circle = loop.circle is not None and not slides
    drawn = None
    if not by_points and not by_circle and (folder is not None or loop.file is None):
        drawn = _drawn(loop.measured_from(origin), origin, folder or Path(), where)
    return BoundaryCurve(
        loop.name,
        loop.points if by_points else None,
        loop.interpolation or "spline",
        Circle(**loop.circle.model_dump()) if by_circle and loop.circle else None,
        drawn,
        slides,
        None if loop.place is None else Place(**loop.place.model_dump()),
        loop.corner_radius,
        None if loop.adjust is None else Adjust(**loop.adjust.model_dump()),
        origin,
    )


def _changed(loop: BoundaryTable, curve: BoundaryCurve) -> BoundaryTable:
    """The table of one curve that was changed."""
    changed: dict[str, object] = {}
    if curve.points is not None:
        changed["points"] = curve.points
    if loop.circle is not None and curve.circle is not None:
        changed["circle"] = loop.circle.model_copy(update=vars(curve.circle))
    if curve.place is not None:
        changed["place"] = (loop.place or PlaceTable()).model_copy(update=vars(curve.place))
    return loop.model_copy(update=changed)


def points_on(table: BoundaryTable, folder: Path, where: str) -> Floats:
    """Points on a curve or beside it, as far apart as it is large, m, (n, 3)."""
    if table.file is not None:
        with np.errstate(all="ignore"):
            pieces, unit, _ = chosen_curve(folder / table.file, table.layer, table.id, table.unit, f"{where}.file")
        return np.asarray(pieces.hull * unit)
    if table.circle is not None:
        return np.array(table.circle.center) + table.circle.radius * np.array([[-1.0], [1.0]])
    if table.points is not None:
        return np.array(table.points)
    arcs = [(part.arc.start, part.arc.middle, part.arc.end) for part in table.part or () if part.arc]
    return np.array(
        [point for points in [*arcs, *(part.points or () for part in table.part or ())] for point in points]
    )


def _drawn(table: BoundaryTable, origin: Origin, folder: Path, where: str) -> Loop:
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
            pieces, remarks = read_curve(
                folder / str(table.file),
                layer=table.layer,
                name=table.id,
                unit=table.unit,
                interpolation=table.interpolation,
                origin=origin,
                # a hole may be small
                may_be_small=not where.endswith("[0]"),
                where=f"{where}.file",
            )
    sliding = () if table.slide is None else (_sliding(table.slide, 0, pieces.count),)
    return make_loop(table.name, pieces, sliding, remarks=remarks, where=where)


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
