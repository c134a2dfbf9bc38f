"""Curves of a DXF drawing's model space, and of the blocks put there, exactly."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.units import DXF_METRES
from lamella.base.vectors import diagonal
from lamella.base.wording import cut
from lamella.files.read.dxf_document import dxf_damage, open_dxf
from lamella.files.read.file_curves import MOST_NESTED, CurveFile, FileCurve, Gathering
from lamella.surface.boundary.arcs import bulge_arc, ellipse_arc
from lamella.surface.boundary.pieces import Pieces, lines, stack
from lamella.surface.boundary.splines import bezier, closed_spline, open_spline

_SPLINE_FRAME = 16
"""Flag of a vertex that is a control point, which the polyline does not run through."""


# of a curve's size: points nearer to one another are one
ROUNDING_OF_SIZE = 1e-9
# what a drawing holds that is no curve, as the trade calls it
_OTHERS = {
    "3DFACE": "3DFACE",
    "HATCH": "hatch",
    "3DSOLID": "solid",
    "BODY": "solid",
    "REGION": "region",
    "SURFACE": "surface",
    "EXTRUDEDSURFACE": "surface",
    "LOFTEDSURFACE": "surface",
    "REVOLVEDSURFACE": "surface",
    "SWEPTSURFACE": "surface",
    "PLANESURFACE": "surface",
    "MESH": "mesh",
    "POLYLINE": "polyface mesh",
    "TEXT": "text",
    "MTEXT": "text",
    "DIMENSION": "dimension",
    "POINT": "point",
    "SOLID": "filled area",
    "XLINE": "endless line",
    "RAY": "endless line",
}


def read_dxf(path: Path, where: str) -> CurveFile:
    """What the model space of a drawing holds, block instances included, and metres per unit by $INSUNITS.

    Raises
    ------
    InputError
        No DXF file.
    """
    drawing = open_dxf(path, where)
    reading = _Reading(drawing, path, where)
    with dxf_damage(str(path), where):
        reading.read(drawing.modelspace(), np.eye(4), None, "", 0)
        for layout in drawing.layouts:
            if layout.is_any_paperspace:
                kinds = [entity.dxftype() for entity in layout]
                drawn = sum(kind in _CURVES or kind == "INSERT" for kind in kinds)
                reading.others.update({"paper space curve": drawn} if drawn else {})
        metres = DXF_METRES.get(int(drawing.header.get("$INSUNITS", 0)))
    return CurveFile(tuple(reading.curves), metres, others=reading.others)


class _Reading(Gathering):
    """Curves of a drawing, gathered from its model space and its blocks."""

    def __init__(self, drawing: Any, path: Path, where: str) -> None:
        super().__init__(path, where)
        self._drawing = drawing

    def read(self, entities: Iterable[Any], matrix: Floats, inherited: str | None, ids: str, depth: int) -> None:
        """Add what is drawn in model space or in a block.

        Parameters
        ----------
        entities : iterable
        matrix : (4, 4)
            Where the block is put.
        inherited : str or None
            Layer of the instance, which entities on layer 0 of its block are on; None: model space.
        ids : str
            Handles of the instances, each followed by a slash.
        depth : int
            Number of instances.
        """
        for entity in entities:
            layer = str(entity.dxf.get("layer", "0"))
            layer = inherited if inherited is not None and layer == "0" else layer
            if entity.dxftype() == "INSERT":
                self._instance(entity, matrix, layer, ids, depth)
                continue
            about = f"{self.path}: {entity.dxftype()} {entity.dxf.handle} on layer {cut(plain(layer), 40)!r}"
            with dxf_damage(about, self.where):
                try:
                    pieces = _pieces(entity)
                except InputError as error:
                    raise InputError(f"{about}: {error.message}", error.remedy, self.where) from None
            if pieces is None:
                self.others[_OTHERS.get(entity.dxftype(), entity.dxftype())] += 1
                continue
            pieces = pieces.mapped(matrix) if depth else pieces
            handle = str(entity.dxf.handle)
            names = (ids + handle, handle, *ids.split("/")[:-1]) if depth else (handle,)
            self.put(FileCurve(plain(layer), names, entity.dxftype(), pieces, self._hidden(entity, layer)))

    def _instance(self, instance: Any, matrix: Floats, layer: str, ids: str, depth: int) -> None:
        block = self._drawing.blocks.get(instance.dxf.get("name", ""))
        if block is None or depth >= MOST_NESTED:
            self.others["block instance"] += 1
            return
        if block.block is not None and block.block.is_xref:
            self.others["external reference"] += 1
            return
        before = len(self.curves)
        for number, one in enumerate(instance.multi_insert() if instance.mcount > 1 else [instance]):
            self.count_instance()
            # the library's points are rows
            put = one.matrix44()
            here = matrix @ np.array([put.get_row(row) for row in range(4)], float).T
            place = f"{instance.dxf.handle}{f'.{number + 1}' if instance.mcount > 1 else ''}/"
            self.read(block, here, layer, ids + place, depth + 1)
        if len(self.curves) == before:
            self.others["block instance"] += 1

    def _hidden(self, entity: Any, layer: str) -> str:
        if entity.dxf.get("invisible", 0):
            return "the object is hidden"
        if layer not in self._drawing.layers:
            return ""
        about = self._drawing.layers.get(layer)
        if about.is_frozen():
            return "its layer is frozen"
        return "its layer is off" if about.is_off() else ""


def plain(name: str) -> str:
    """A name as CAD shows it: with its \\U+XXXX and %% escapes decoded."""
    name = re.sub(r"\\U\+([0-9A-Fa-f]{4})", lambda found: chr(int(found[1], 16)), name)
    signs = {"d": "\u00b0", "c": "\u00d8", "p": "\u00b1", "%": "%"}

    def sign(found: re.Match[str]) -> str:
        code = found[1].lower()
        return chr(int(code)) if code.isdigit() else signs[code]

    return unicodedata.normalize("NFC", re.sub(r"%%(\d{3}|[dcpDCP%])", sign, name))


_CURVES = ("LINE", "CIRCLE", "ARC", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE")


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
    size = diagonal(world) if n else 0.0
    parts = []
    for k in range(n if closed else n - 1):
        start, end = world[k], world[(k + 1) % n]
        if np.linalg.norm(end - start) > ROUNDING_OF_SIZE * size:
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
        same = ROUNDING_OF_SIZE * diagonal(points)
        return closed_spline(points[:-1] if np.allclose(points[0], points[-1], rtol=0, atol=same) else points)
    return open_spline(points)
