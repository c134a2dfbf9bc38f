"""Curves of a Rhino file, exactly: everything it calls a curve has a NURBS form."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from lamella.errors import InputError
from lamella.surface.boundary.file_curves import FileCurve
from lamella.surface.boundary.pieces import Pieces
from lamella.surface.boundary.splines import bezier

_METRES = {
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Decimeters": 0.1,
    "Meters": 1.0,
    "Kilometers": 1000.0,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Yards": 0.9144,
    "Miles": 1609.344,
    "Microns": 1e-6,
}


def read_3dm(path: Path, where: str) -> tuple[list[FileCurve], float | None]:
    """Curves of the model, and its metres per unit (None: it has none).

    Curves inside block definitions are left out: they stand where an instance puts them.

    Raises
    ------
    InputError
        No .3dm file.
    """
    import rhino3dm

    model = rhino3dm.File3dm.Read(str(path))
    if model is None:
        raise InputError(f"{path} is not a .3dm file", "save it from Rhino again", where)
    layers = {layer.Index: str(layer.FullPath or layer.Name) for layer in model.Layers}
    curves = []
    for item in model.Objects:
        geometry, about = item.Geometry, item.Attributes
        if not isinstance(geometry, rhino3dm.Curve) or about.IsInstanceDefinitionObject:
            continue
        pieces = _pieces(geometry)
        if pieces is not None:
            kind = type(geometry).__name__
            ids = (str(about.Name or ""), str(about.Id))
            curves.append(FileCurve(layers.get(about.LayerIndex, ""), tuple(filter(None, ids)), kind, pieces))
    unit = str(model.Settings.ModelUnitSystem).rpartition(".")[2]
    return curves, _METRES.get(unit)


def _pieces(curve: Any) -> Pieces | None:
    nurbs = curve.ToNurbsCurve()
    if nurbs is None:
        return None
    # homogeneous: (w x, w y, w z, w)
    controls = np.array([(p.X, p.Y, p.Z, p.W) for p in nurbs.Points], float)
    inner = np.array(list(nurbs.Knots), float)
    # the format leaves out the first and the last knot, which no point of the curve depends on
    knots = np.concatenate([inner[:1], inner, inner[-1:]])
    return bezier(knots, int(nurbs.Degree), controls)
