"""Curves of a Rhino file, exactly: everything it calls a curve has a NURBS form."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.errors import InputError
from lamella.files.rhino_model import RhinoCurve, read_rhino
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
    try:
        model = read_rhino(path.read_bytes(), "curves", where)
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    layers = {layer.index: layer.full_path for layer in model.layers}
    curves = []
    for item in model.objects:
        if item.kind != "Curve" or item.in_block:
            continue
        for curve in item.curves:
            ids = tuple(filter(None, (item.name, item.id)))
            pieces = _pieces(curve)
            if pieces is not None:
                curves.append(FileCurve(layers.get(item.layer, ""), ids, item.type, pieces))
    return curves, _METRES.get(model.unit)


def _pieces(curve: RhinoCurve) -> Pieces | None:
    """The curve's pieces; None where its numbers contradict each other."""
    inner = curve.knots
    if len(inner) != len(curve.controls) + curve.degree - 1 or not len(inner):
        return None
    # the format leaves out the first and the last knot, which no point of the curve depends on
    return bezier(np.concatenate([inner[:1], inner, inner[-1:]]), curve.degree, curve.controls)
