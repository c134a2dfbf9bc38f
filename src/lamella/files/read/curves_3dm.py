"""Curves of a Rhino file, those of its blocks and the naked edges of its surfaces too, exactly: as NURBS."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.units import RHINO_METRES
from lamella.base.vectors import diagonal
from lamella.files.read.file_curves import MOST_NESTED, CurveFile, FileCurve, Gathering
from lamella.files.read.rhino_model import RhinoCurve, RhinoModel, RhinoObject, read_rhino
from lamella.surface.boundary.arc_length import Course
from lamella.surface.boundary.joining import find_chains
from lamella.surface.boundary.pieces import Pieces
from lamella.surface.boundary.splines import bezier

_OTHERS = {
    "Mesh": "mesh",
    "SubD": "SubD",
    "Surface": "surface",
    "Extrusion": "extrusion",
    "Point": "point",
    "PointSet": "point cloud",
    "TextDot": "text dot",
    "Annotation": "annotation",
    "Hatch": "hatch",
    "Light": "light",
    "InstanceReference": "block instance",
}


def read_3dm(path: Path, where: str) -> CurveFile:
    """What a model holds, block instances included, and its metres per unit.

    Raises
    ------
    InputError
        No .3dm file.
    """
    try:
        model = read_rhino(path.read_bytes(), "curves", where)
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    reading = _Reading(model, path, where)
    for item in model.objects:
        if not item.in_block:
            reading.add(item, np.eye(4), None, 0)
    tolerance = model.tolerance if model.tolerance > 0 else None
    return CurveFile(tuple(reading.curves), RHINO_METRES.get(model.unit), tolerance, reading.others)


class _Instance(NamedTuple):
    """An instance of a block: its ids, the one of the whole chain of instances first, and why it is hidden."""

    ids: tuple[str, ...]
    hidden: str


class _Reading(Gathering):
    """Curves of a model, gathered from its objects and its blocks."""

    def __init__(self, model: RhinoModel, path: Path, where: str) -> None:
        super().__init__(path, where)
        self._tolerance = model.tolerance
        self._layers = {layer.index: layer for layer in model.layers}
        self._by_id = {layer.id: layer for layer in model.layers}
        self._blocks = {block.id: block for block in model.blocks}
        self._objects = {item.id: item for item in model.objects}

    def add(self, item: RhinoObject, matrix: Floats, instance: _Instance | None, depth: int) -> None:
        """Add an object of the model, or of a block that is put by a matrix (4, 4)."""
        ids = tuple(filter(None, (item.name, item.id)))
        if instance is not None:
            ids = (f"{instance.ids[0]}/{ids[0]}", *ids, *instance.ids)
        hidden = self._hidden(item) or (instance.hidden if instance else "")
        about = FileCurve(self._layer(item), ids, item.type, _NOTHING, hidden)
        if item.on_page:
            self.others["layout object"] += 1
        elif item.kind == "InstanceReference":
            self._instance(item, matrix, _Instance(ids, hidden), depth)
        elif item.kind == "Curve":
            for pieces in filter(None, map(_pieces, item.curves)):
                self.put(replace(about, pieces=pieces.mapped(matrix)))
        elif item.kind in ("Brep", "Extrusion"):
            self._edges(item, matrix, about)
        else:
            self.others[_OTHERS.get(item.kind, item.kind or "unknown object")] += 1

    def _instance(self, reference: RhinoObject, matrix: Floats, instance: _Instance, depth: int) -> None:
        self.count_instance()
        block = self._blocks.get(reference.block)
        before = len(self.curves)
        if block is not None and depth < MOST_NESTED:
            inside = instance._replace(ids=(*instance.ids, *filter(None, (block.name,))))
            for ident in block.members:
                if ident in self._objects:
                    self.add(self._objects[ident], matrix @ reference.transform, inside, depth + 1)
        if len(self.curves) == before:
            self.others["block instance"] += 1

    def _edges(self, item: RhinoObject, matrix: Floats, about: FileCurve) -> None:
        """Add the naked edges of a surface, joined to rims, the longest first."""
        kind = "polysurface" if item.faces > 1 else "surface"
        self.others["extrusion" if item.kind == "Extrusion" else kind] += 1
        edges = [edge.mapped(matrix) for edge in filter(None, map(_pieces, item.curves))]
        edges = [edge for edge in edges if edge.sound]
        if not edges:
            return
        size = diagonal(np.concatenate([edge.hull for edge in edges]))
        limit = max(1e-6 * size, min(self._tolerance, 1e-3 * size))
        closed = [edge for edge in edges if _gap(edge) <= limit]
        chains = find_chains([edge for edge in edges if _gap(edge) > limit], limit)
        rims = sorted([*closed, *(chain.pieces for chain in chains)], key=lambda rim: -Course(rim).length)
        for number, rim in enumerate(rims, 1):
            ids = (f"{about.ids[0]}/{number}", *about.ids) if len(rims) > 1 else about.ids
            self.put(replace(about, ids=ids, pieces=rim, kind="naked edge", edge=True))

    def _layer(self, item: RhinoObject) -> str:
        layer = self._layers.get(item.layer)
        return "" if layer is None else layer.full_path

    def _hidden(self, item: RhinoObject) -> str:
        if not item.visible:
            return "the object is hidden"
        layer = self._layers.get(item.layer)
        # a layer is seen if those above it are
        for _ in self._layers:
            if layer is None:
                break
            if not layer.visible:
                return "its layer is off"
            layer = self._by_id.get(layer.parent_id)
        return ""


_NOTHING = Pieces(np.zeros((1, 2, 4)))


def _gap(edge: Pieces) -> float:
    return float(np.linalg.norm(edge.ends[-1] - edge.starts[0]))


def _pieces(curve: RhinoCurve) -> Pieces | None:
    """The curve's pieces; None where its numbers contradict each other."""
    inner = curve.knots
    if len(inner) != len(curve.controls) + curve.degree - 1 or not len(inner):
        return None
    # the format leaves out the first and the last knot, which no point of the curve depends on
    return bezier(np.concatenate([inner[:1], inner, inner[-1:]]), curve.degree, curve.controls)
