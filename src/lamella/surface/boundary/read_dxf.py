"""Curves of a DXF drawing's model space, exactly."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from lamella.errors import InputError
from lamella.surface.boundary.arcs import bulge_arc, ellipse_arc
from lamella.surface.boundary.dxf_document import dxf_damage, open_dxf
from lamella.surface.boundary.file_curves import FileCurve
from lamella.surface.boundary.pieces import Floats, Pieces, lines, stack
from lamella.surface.boundary.splines import bezier, closed_spline, open_spline
from lamella.wording import cut

# $INSUNITS; inch, foot, mile, mm, cm, m, km, mil, yard, micron, dm, dam, hm, US survey foot
_METRES = {1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1000.0, 9: 2.54e-5, 10: 0.9144}
_METRES |= {13: 1e-6, 14: 0.1, 15: 10.0, 16: 100.0, 21: 1200 / 3937}

_SPLINE_FRAME = 16
"""Flag of a vertex that is a control point, which the polyline does not run through."""


def read_dxf(path: Path, where: str) -> tuple[list[FileCurve], float | None]:
    """Curves of the model space, and metres per unit by $INSUNITS (None: unitless).

    Curves inside blocks are left out.

    Raises
    ------
    InputError
        No DXF file.
    """
    drawing = open_dxf(path, where)
    curves = []
    with dxf_damage(str(path), where):
        for entity in drawing.modelspace():
            layer = str(entity.dxf.get("layer", ""))
            about = f"{path}: {entity.dxftype()} {entity.dxf.handle} on layer {cut(layer, 40)!r}"
            with dxf_damage(about, where):
                try:
                    pieces = _pieces(entity)
                except InputError as error:
                    raise InputError(f"{about}: {error.message}", error.remedy, where) from None
                if pieces is not None and np.isfinite(pieces.controls).all():
                    curves.append(FileCurve(layer, (str(entity.dxf.handle),), entity.dxftype(), pieces))
        return curves, _METRES.get(int(drawing.header.get("$INSUNITS", 0)))


def _pieces(entity: Any) -> Pieces | None:
    """The entity's curve in world coordinates; None for what is no curve."""
    match entity.dxftype():
        case "LINE":
            return lines(np.array([entity.dxf.start, entity.dxf.end], float), closed=False)
        case "CIRCLE" | "ARC":
            return _round(entity)
        case "ELLIPSE":
            return _ellipse(entity)
        case "LWPOLYLINE":
            flat = [(x, y, float(entity.dxf.elevation)) for x, y in entity.get_points("xy")]
            bulges = [float(bulge) for (bulge,) in entity.get_points("b")]
            return _polyline(entity, np.array(flat, float), bulges, closed=bool(entity.closed))
        case "POLYLINE":
            return _old_polyline(entity)
        case "SPLINE":
            return _spline(entity)
    return None


def _round(entity: Any) -> Pieces:
    frame = _frame(entity)
    start, sweep = 0.0, 2 * math.pi
    if entity.dxftype() == "ARC":
        start = math.radians(entity.dxf.start_angle)
        sweep = _sweep(start, math.radians(entity.dxf.end_angle))
    radius = abs(float(entity.dxf.radius))
    center = np.array(entity.dxf.center, float) @ frame
    return ellipse_arc(center, radius * frame[0], radius * frame[1], start, sweep)


def _ellipse(entity: Any) -> Pieces:
    major, axis = np.array(entity.dxf.major_axis, float), np.array(entity.dxf.extrusion, float)
    minor = float(entity.dxf.ratio) * np.cross(axis / np.linalg.norm(axis), major)
    start = float(entity.dxf.start_param)
    sweep = _sweep(start, float(entity.dxf.end_param))
    return ellipse_arc(np.array(entity.dxf.center, float), major, minor, start, sweep)


def _sweep(start: float, end: float) -> float:
    """From start counter-clockwise to end, in (0, 2 pi]."""
    sweep = (end - start) % (2 * math.pi)
    # a full turn is written as 0 to 2 pi or 0 to 360, with the rounding of the file
    return 2 * math.pi if sweep < 1e-9 or sweep > 2 * math.pi - 1e-9 else sweep


def _frame(entity: Any) -> Floats:
    """Axes of the entity's own coordinates as rows: DXF's arbitrary axis algorithm."""
    ocs = entity.ocs()
    return np.array([ocs.to_wcs(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))], float)


def _old_polyline(entity: Any) -> Pieces | None:
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None
    vertices = [v for v in entity.vertices if not int(v.dxf.flags) & _SPLINE_FRAME]
    points = np.array([v.dxf.location for v in vertices], float).reshape(-1, 3)
    if entity.is_3d_polyline:
        return lines(points, closed=bool(entity.is_closed)) if len(points) > 1 else None
    points[:, 2] = float(entity.dxf.elevation.z)
    return _polyline(entity, points, [float(v.dxf.bulge) for v in vertices], closed=bool(entity.is_closed))


def _polyline(entity: Any, points: Floats, bulges: list[float], *, closed: bool) -> Pieces | None:
    """Straight pieces and exact arcs; repeated vertices, which drawings abound in, are left out."""
    frame = _frame(entity)
    world = points @ frame
    n = len(points)
    size = float(np.linalg.norm(np.ptp(world, axis=0))) if n else 0.0
    parts = []
    for k in range(n if closed else n - 1):
        start, end = world[k], world[(k + 1) % n]
        if np.linalg.norm(end - start) > 1e-9 * size:
            parts.append(bulge_arc(start, end, bulges[k], frame[2]))
    return stack(parts) if parts else None


def _spline(entity: Any) -> Pieces | None:
    controls = np.array(entity.control_points, float).reshape(-1, 3)
    if len(controls):
        weights = np.array(entity.weights, float)
        if len(weights) != len(controls):
            weights = np.ones(len(controls))
        knots, degree = np.array(entity.knots, float), int(entity.dxf.degree)
        if len(knots) != len(controls) + degree + 1:
            return None
        homogeneous = np.hstack([controls * weights[:, None], weights[:, None]])
        return bezier(knots, degree, homogeneous)
    # given by the points it passes through alone, a spline is whatever the reader makes of it
    points = np.array(entity.fit_points, float).reshape(-1, 3)
    if len(points) < 2:
        return None
    if entity.closed and len(points) > 2:
        return closed_spline(points[:-1] if np.allclose(points[0], points[-1], rtol=0, atol=1e-9) else points)
    return open_spline(points)
