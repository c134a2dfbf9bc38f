"""Meshes of COMPAS, the framework of computational architecture: as JSON, and in memory. COMPAS itself is not needed.

Read are the files of COMPAS 2 (`{"dtype": "compas.datastructures/Mesh", "data": {...}}`) and of COMPAS 1, which puts
the same tables below "value" or "data". Written is the form of COMPAS 2: `compas.json_load` gives a `Mesh`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
import orjson

from lamella import __version__
from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.wording import cut, shown
from lamella.files.read.file_mesh import Polygons
from lamella.projection.quad_mesh import QuadMesh, quad_mesh

DTYPE = "compas.datastructures/Mesh"
WRITE = "write it with mesh.to_json(...) of COMPAS"


def read_compas(data: bytes) -> tuple[Polygons, tuple[str, ...], tuple[str, ...]]:
    """Vertices and faces in the order of the file, and the keys of both.

    Raises
    ------
    InputError
        No JSON, no mesh of COMPAS, or one that contradicts itself.
    """
    try:
        table = _table(orjson.loads(data))
    except orjson.JSONDecodeError as reason:
        raise InputError(
            f"the file is no JSON: {cut(str(reason), 120)}", "write it with mesh.to_json(...) of COMPAS"
        ) from None
    own = table.get("default_vertex_attributes", table.get("dva"))
    default = {"x": 0.0, "y": 0.0, "z": 0.0, **(own if isinstance(own, dict) else {})}
    points = []
    for key, attributes in table["vertex"].items():
        if not isinstance(attributes, dict | None):
            raise InputError(
                f"vertex {cut(key, 40)} has no table of attributes", "write it with mesh.to_json(...) of COMPAS"
            )
        place = [{**default, **(attributes or {})}[axis] for axis in "xyz"]
        if not all(isinstance(x, int | float) and not isinstance(x, bool) for x in place):
            raise InputError(f"vertex {cut(key, 40)} is at {shown(place)}", "three numbers x, y and z are expected")
        points.append(place)
    number = {key: k for k, key in enumerate(table["vertex"])}
    faces = list(table["face"].values())
    if not all(isinstance(face, list) for face in faces):
        raise InputError("a face is no list of vertices", WRITE)
    try:
        corners = [number[str(key)] for key in chain.from_iterable(faces)]
    except KeyError as missing:
        raise InputError(
            f"a face names vertex {cut(str(missing), 40)}, which is not there", "write the file anew"
        ) from None
    polygons = Polygons(
        np.array(points, np.float64).reshape(-1, 3),
        np.array([len(face) for face in faces], np.int64),
        np.array(corners, np.int64),
    )
    return polygons, tuple(table["vertex"]), tuple(table["face"])


def _table(content: Any) -> dict[str, Any]:
    """The tables "vertex" and "face", however deep the version of COMPAS puts them."""
    found = content
    while isinstance(found, dict):
        if isinstance(found.get("vertex"), dict) and isinstance(found.get("face"), dict):
            return found
        found = found.get("data", found.get("value"))
    kind = f" but {cut(str(content['dtype']), 40)}" if isinstance(content, dict) and "dtype" in content else ""
    raise InputError(f"the file holds no mesh of COMPAS{kind}", WRITE)


def compas_bytes(
    points: Floats,
    mesh: QuadMesh,
    *,
    vertex_figures: dict[str, Floats],
    face_figures: dict[str, Floats],
    vertex_keys: Sequence[str] = (),
    face_keys: Sequence[str] = (),
    name: str,
) -> bytes:
    """A mesh as COMPAS 2 reads it, with figures as attributes of vertices and faces; a figure not known is null."""
    units = "coordinates in the unit of the given file; figures in m, degrees, 1/m"
    data = mesh_data(
        points,
        mesh.faces.tolist(),
        vertex_figures=vertex_figures,
        face_figures=face_figures,
        vertex_keys=vertex_keys,
        face_keys=face_keys,
        attributes={"name": name, "units": units},
    )
    return orjson.dumps({"lamella": __version__, "dtype": DTYPE, "data": data, "name": name})


def mesh_data(
    points: Floats,
    faces: list[list[int]],
    *,
    vertex_figures: dict[str, Floats],
    face_figures: dict[str, Floats],
    vertex_keys: Sequence[str] = (),
    face_keys: Sequence[str] = (),
    attributes: dict[str, str],
) -> dict[str, Any]:
    """The tables of a `Mesh` in the JSON of COMPAS 2."""
    vertices = list(vertex_keys) or [str(k) for k in range(len(points))]
    keys = list(face_keys) or [str(k) for k in range(len(faces))]
    columns = {"x": points[:, 0], "y": points[:, 1], "z": points[:, 2], **vertex_figures}
    number = [int(key) if key.lstrip("-").isdigit() else key for key in vertices]
    return {
        "attributes": attributes,
        "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "default_face_attributes": {},
        "vertex": _rows(vertices, columns),
        "face": {key: [number[k] for k in face] for key, face in zip(keys, faces, strict=True)},
        "facedata": _rows(keys, face_figures),
        "edgedata": {},
        "max_vertex": max((key for key in number if isinstance(key, int)), default=-1),
        "max_face": max((int(key) for key in keys if key.isdigit()), default=-1),
    }


def _rows(keys: Sequence[str], columns: dict[str, Floats]) -> dict[str, dict[str, float]]:
    lists = [values.tolist() for values in columns.values()]
    rows = zip(*lists, strict=True) if lists else [()] * len(keys)
    return {key: dict(zip(columns, row, strict=True)) for key, row in zip(keys, rows, strict=True)}


def quad_mesh_of_compas(mesh: Any) -> QuadMesh:
    """The quad mesh of a COMPAS `Mesh` in memory, vertices and faces in its order.

    Parameters
    ----------
    mesh : compas.datastructures.Mesh
        In m. Of COMPAS 1 or 2, or anything with `vertices`, `vertex_coordinates`, `faces` and `face_vertices`.

    Raises
    ------
    InputError
        Faces that are no quads, and what `lamella.projection.quad_mesh.quad_mesh` refuses.

    Examples
    --------
    >>> import lamella
    >>> class Mesh:
    ...     # as much of compas.datastructures.Mesh as is used
    ...     def vertices(self): return [7, 8, 9, 4]
    ...     def vertex_coordinates(self, key): return {7: [0, 0, 0], 8: [1, 0, 0], 9: [1, 1, 0], 4: [0, 1, 0]}[key]
    ...     def faces(self): return [0]
    ...     def face_vertices(self, face): return [7, 8, 9, 4]
    >>> lamella.quad_mesh_of_compas(Mesh())
    QuadMesh(4 vertices, 1 face)
    """
    keys = list(mesh.vertices())
    number = {key: k for k, key in enumerate(keys)}
    faces = [[number[key] for key in mesh.face_vertices(face)] for face in mesh.faces()]
    other = [k for k, face in enumerate(faces) if len(face) != 4]
    if other:
        raise InputError(f"face {other[0]} has {len(faces[other[0]])} corners", "all faces have to be quads")
    points = np.array([mesh.vertex_coordinates(key) for key in keys], np.float64).reshape(-1, 3)
    return quad_mesh(points, np.array(faces, np.int64).reshape(-1, 4))


def compas_at(mesh: Any, moved: QuadMesh) -> Any:
    """A copy of a COMPAS `Mesh` with its vertices where those of `moved`, from `quad_mesh_of_compas`, are.

    Examples
    --------
    >>> import lamella
    >>> class Mesh:
    ...     # as much of a COMPAS mesh as is used
    ...     at = {7: [0, 0, 0], 8: [1, 0, 0], 9: [1, 1, 0], 4: [0, 1, 0]}
    ...     def vertices(self): return list(self.at)
    ...     def vertex_coordinates(self, key): return self.at[key]
    ...     def faces(self): return [0]
    ...     def face_vertices(self, face): return [7, 8, 9, 4]
    ...     def vertex_attributes(self, key, names, values): self.at[key] = values
    ...     def copy(self): return self
    >>> quads = lamella.quad_mesh_of_compas(Mesh())
    >>> moved = lamella.quad_mesh(quads.vertices + [0, 0, 2.5], quads.faces)
    >>> lamella.compas_at(Mesh(), moved).at[7]
    [0.0, 0.0, 2.5]
    """
    copy = mesh.copy()
    for key, place in zip(mesh.vertices(), moved.vertices.tolist(), strict=True):
        copy.vertex_attributes(key, "xyz", place)
    return copy
