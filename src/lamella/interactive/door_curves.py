"""Curves and meshes of Rhino and COMPAS in a project's tables, as values and files that projects have.

A table [[surface.boundary]] may hold `rhino` (what `Encode` of a curve of rhino3dm gives) or `compas` (a Polyline,
Circle or curve of COMPAS in JSON) in place of points, circle, file or part; a surface of kind "mesh" the same in place
of a file.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.errors import InputError
from lamella.base.wording import cut
from lamella.files.compas_json import read_compas

REMEDY_COMPAS = "send a Polyline, a Circle, or points of your own"
# of names of files within the request's own folder
_CURVES, _MESH = "curve{}.3dm", "mesh.obj"


def taken_in(values: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """A project's values with what other programs gave written as files into a folder.

    Parameters
    ----------
    values : mapping
        Tables of a project.
    folder : Path
        An empty one.

    Raises
    ------
    InputError
        A curve or mesh cannot be read; a file is named, of which none is read.
    """
    surface = values.get("surface")
    if not isinstance(surface, dict):
        return dict(values)
    _refuse_file(surface, "surface")
    table = dict(surface)
    if "rhino" in table or "compas" in table:
        table["file"] = _mesh_file(table, folder)
    loops = table.get("boundary")
    if isinstance(loops, list):
        table["boundary"] = [
            _loop(loop, f"surface.boundary[{k}]", folder / _CURVES.format(k)) if isinstance(loop, dict) else loop
            for k, loop in enumerate(loops)
        ]
    return {**values, "surface": table}


def _refuse_file(table: Mapping[str, Any], where: str) -> None:
    if "file" in table:
        raise InputError(
            "files of this machine are not read for a request",
            "send the curve or mesh itself, as points, rhino or compas",
            f"{where}.file",
        )


def _loop(loop: dict[str, Any], where: str, file: Path) -> dict[str, Any]:
    _refuse_file(loop, where)
    own = {key: value for key, value in loop.items() if key not in ("rhino", "compas")}
    if "rhino" in loop:
        _write_curve(loop["rhino"], file, f"{where}.rhino")
        return {"unit": "m", **own, "file": file.name}
    if "compas" in loop:
        return {**own, **_of_compas(loop["compas"], f"{where}.compas")}
    return own


def _decoded(encoded: Any, where: str) -> Any:
    import rhino3dm

    made = None
    # whatever it says of its own arguments says nothing of the request
    with contextlib.suppress(Exception):
        made = rhino3dm.CommonObject.Decode(encoded)
    if made is None:
        raise InputError(
            "it is no object that rhino3dm reads",
            "send the table that Encode() of the curve or mesh gives",
            where,
        )
    return made


def _write_curve(encoded: Any, file: Path, where: str) -> None:
    """A model with that curve alone, in metres."""
    import rhino3dm

    curve = _decoded(encoded, where)
    if not isinstance(curve, rhino3dm.Curve):
        raise InputError(f"a {type(curve).__name__} is no curve", "send a closed curve", where)
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    model.Objects.AddCurve(curve)
    model.Write(str(file), 7)


def _of_compas(given: Any, where: str) -> dict[str, Any]:
    """Points or circle of a curve of COMPAS 2."""
    dtype = str(given.get("dtype", "")).partition("/")[2] if isinstance(given, dict) else ""
    data = given.get("data") if isinstance(given, dict) else None
    if not isinstance(data, dict):
        raise InputError("no JSON of COMPAS", REMEDY_COMPAS, where)
    try:
        if dtype in ("Polyline", "Polygon"):
            points = [_point(point) for point in data["points"]]
            closed = points[:-1] if len(points) > 1 and points[0] == points[-1] else points
            return {"points": closed, "interpolation": "polyline"}
        if dtype == "Circle":
            frame = data["frame"].get("data", data["frame"])
            x, y = (np.array(_point(frame[axis])) for axis in ("xaxis", "yaxis"))
            normal = np.cross(x, y).tolist()
            return {"circle": {"center": _point(frame["point"]), "radius": float(data["radius"]), "normal": normal}}
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"the {dtype} of COMPAS lacks something: {cut(str(error), 80)}", REMEDY_COMPAS, where
        ) from None
    raise InputError(f"{cut(dtype or 'nothing', 40)} of COMPAS is not taken", REMEDY_COMPAS, where)


def _point(given: Any) -> list[float]:
    x, y, z = given["data"] if isinstance(given, dict) else given
    return [float(x), float(y), float(z)]


def _mesh_file(table: dict[str, Any], folder: Path) -> str:
    """A Wavefront file of the mesh, whose tables it takes out of these."""
    if "compas" in table:
        polygons, _, _ = read_compas(orjson.dumps(table.pop("compas")))
        ends = np.cumsum(polygons.sizes)
        faces = [polygons.corners[end - count : end].tolist() for end, count in zip(ends, polygons.sizes, strict=True)]
        points = polygons.points.tolist()
    else:
        mesh = _decoded(table.pop("rhino"), "surface.rhino")
        if not hasattr(mesh, "Vertices") or not hasattr(mesh, "Faces"):
            raise InputError(f"a {type(mesh).__name__} is no mesh", "send a mesh", "surface.rhino")
        points = [[vertex.X, vertex.Y, vertex.Z] for vertex in mesh.Vertices]
        faces = [list(dict.fromkeys(mesh.Faces[k])) for k in range(len(mesh.Faces))]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    (folder / _MESH).write_text("\n".join(lines) + "\n", "ascii")
    table.setdefault("unit", "m")
    return _MESH
