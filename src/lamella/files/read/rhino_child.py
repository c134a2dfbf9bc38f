"""Reading a Rhino file where it can be ended: the process that `lamella.files.read.rhino_model` starts.

It writes what the file holds as a table with arrays (`numpy.savez`), never as objects. It imports little, because it
starts for every file.
"""

from __future__ import annotations

import io
import json
import os
import sys
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
import rhino3dm

from lamella.files.read.bounded import Limits, limit_this_process


def main(arguments: list[str]) -> None:
    """Read a .3dm from standard input; ``arguments`` are the limits of seconds and bytes, and what is wanted."""
    seconds, memory, wanted = arguments
    # what the library prints must not get between
    result = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    limit_this_process(Limits(int(seconds), int(memory)))
    packed = packed_model(sys.stdin.buffer.read(), wanted)
    with result:
        result.write(packed)
    # taking the library's objects apart may fail where they are damaged
    os._exit(0)


def packed_model(data: bytes, wanted: str) -> bytes:
    """All that is read of a .3dm, packed."""
    model = rhino3dm.File3dm.FromByteArray(data)
    store = _Store()
    about = {"read": False} if model is None else {"read": True, **_about(model, wanted, store)}
    table = np.frombuffer(json.dumps(about).encode(), np.uint8)
    packed = io.BytesIO()
    np.savez(packed, about=table, floats=_joined(store.floats, float), integers=_joined(store.integers, np.int64))
    return packed.getvalue()


def _joined(parts: list[Any], kind: Any) -> Any:
    return np.concatenate(parts) if parts else np.zeros(0, kind)


class _Store:
    """Numbers of all objects one after the other, so that the file has a few arrays however many objects there are."""

    def __init__(self) -> None:
        self.floats: list[Any] = []
        self.integers: list[Any] = []
        self.float_count = self.integer_count = 0

    def curve(self, curve: Any) -> list[int] | None:
        """Degree, start, number of knots and of control points; None for a curve without NURBS form."""
        nurbs = curve.ToNurbsCurve()
        if nurbs is None:
            return None
        controls = np.array([(p.X, p.Y, p.Z, p.W) for p in nurbs.Points], float).reshape(-1, 4)
        knots = np.array(list(nurbs.Knots), float)
        start = self._add_floats(knots)
        self._add_floats(controls.ravel())
        return [int(nurbs.Degree), start, len(knots), len(controls)]

    def mesh(self, mesh: Any) -> list[int]:
        """Start and number of points, start and number of faces."""
        table = mesh.Faces
        faces = np.array([table[i] for i in range(len(table))], np.int64).reshape(-1)
        # points in double precision are handed out by this call alone
        points = np.array([(p.X, p.Y, p.Z) for p in mesh.Vertices.ToPoint3dArray()], float).reshape(-1)
        first = self.integer_count
        self.integers.append(faces)
        self.integer_count += len(faces)
        return [self._add_floats(points), len(points) // 3, first, len(faces) // 4]

    def _add_floats(self, numbers: Any) -> int:
        start = self.float_count
        self.floats.append(numbers)
        self.float_count += len(numbers)
        return start


def _about(model: Any, wanted: str, store: _Store) -> dict[str, Any]:
    return {
        "unit": _last_word(model.Settings.ModelUnitSystem),
        "tolerance": float(model.Settings.ModelAbsoluteTolerance),
        "layers": [
            {
                "index": int(layer.Index),
                "id": str(layer.Id),
                "parent_id": str(layer.ParentLayerId),
                "name": str(layer.Name or ""),
                "full_path": str(layer.FullPath or layer.Name or ""),
                "visible": bool(layer.Visible),
                "locked": bool(layer.Locked),
            }
            for layer in model.Layers
        ],
        "objects": [_object(item, wanted, store) for item in model.Objects if item.Geometry is not None],
        "blocks": [
            {
                "id": str(block.Id),
                "name": str(block.Name or ""),
                "members": [str(member) for member in block.GetObjectIds()],
            }
            for block in model.InstanceDefinitions
        ],
    }


def _object(item: Any, wanted: str, store: _Store) -> dict[str, Any]:
    geometry, about = item.Geometry, item.Attributes
    instance = isinstance(geometry, rhino3dm.InstanceReference)
    curves = [store.curve(curve) for curve in _curves(geometry)] if wanted == "curves" else []
    solid = _brep(geometry) if wanted == "curves" else None
    return {
        "kind": _last_word(geometry.ObjectType),
        "type": type(geometry).__name__,
        "id": str(about.Id),
        "name": str(about.Name or ""),
        "layer": int(about.LayerIndex),
        "visible": bool(about.Visible),
        "locked": _last_word(about.Mode) == "Locked",
        "in_block": bool(about.IsInstanceDefinitionObject),
        "on_page": _last_word(about.ActiveSpace) == "PageSpace",
        "curves": [curve for curve in curves if curve is not None],
        "meshes": [store.mesh(mesh) for mesh in _meshes(geometry)] if wanted == "meshes" else [],
        "faces": 0 if solid is None else len(solid.Faces),
        "block": str(geometry.ParentIdefId) if instance else "",
        "transform": _matrix(geometry.Xform) if instance else np.eye(4).ravel().tolist(),
    }


def _curves(geometry: Any) -> Iterator[Any]:
    if isinstance(geometry, rhino3dm.Curve):
        yield geometry
        return
    solid = _brep(geometry)
    if solid is not None:
        # an edge that faces share has a trim in each, a seam two in one
        uses = Counter(trim.EdgeIndex for face in solid.Faces for loop in face.Loops for trim in loop.Trims)
        yield from (solid.Edges[k] for k in range(len(solid.Edges)) if uses[k] == 1)


def _brep(geometry: Any) -> Any:
    """A surface or an extrusion as faces; None for other things."""
    solid = geometry.ToBrep(False) if isinstance(geometry, rhino3dm.Extrusion) else geometry
    return solid if isinstance(solid, rhino3dm.Brep) else None


def _meshes(geometry: Any) -> Iterator[Any]:
    if isinstance(geometry, rhino3dm.Mesh):
        yield geometry
        return
    if isinstance(geometry, rhino3dm.Brep):
        faces = geometry.Faces
        found = [faces[k].GetMesh(rhino3dm.MeshType.Any) for k in range(len(faces))]
    elif isinstance(geometry, rhino3dm.Extrusion):
        found = [geometry.GetMesh(rhino3dm.MeshType.Any)]
    else:
        return
    yield from (mesh for mesh in found if mesh is not None and len(mesh.Faces))


def _matrix(transform: Any) -> list[float]:
    return [float(getattr(transform, f"M{row}{column}")) for row in range(4) for column in range(4)]


def _last_word(value: Any) -> str:
    """Name of a value of one of the library's enumerations."""
    return str(value).rpartition(".")[2]
