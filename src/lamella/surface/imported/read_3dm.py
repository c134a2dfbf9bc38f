"""Meshes in Rhino's .3dm."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import rhino3dm
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.surface.imported.raw_mesh import Floats, Integers, Polygons, mesh_error

MAGIC = b"3D Geometry File Format "
MESH_IT = "mesh it in Rhino (command Mesh), save the mesh alone, or hide everything else"

METRES = {
    "Angstroms": 1e-10,
    "Nanometers": 1e-9,
    "Microns": 1e-6,
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Decimeters": 0.1,
    "Meters": 1.0,
    "Dekameters": 10.0,
    "Hectometers": 100.0,
    "Kilometers": 1000.0,
    "Mils": 2.54e-5,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Yards": 0.9144,
    "Miles": 1609.344,
}
"""Metres of openNURBS' units; those it leaves to the user (None, CustomUnits) are not here."""

SHARED_VERTICES = 2
"""Two objects that have this many places in common share a border (a single one is a touch)."""

Part = tuple[str, Floats, Integers]
"""Name of an object, its points (n, 3) and its faces (f, 4); a triangle repeats its last index."""


def read_3dm(data: bytes) -> Polygons:
    """Read the visible meshes, and the render meshes of visible surfaces if there is no mesh.

    Several mesh objects are one mesh if their borders connect them; otherwise nobody can know which one is meant.
    """
    _require_whole(data)
    model = rhino3dm.File3dm.FromByteArray(data)
    if model is None:
        raise mesh_error("Rhino's own library cannot read this .3dm", "open it in Rhino and save it again")
    shown, hidden = _shown_objects(model)
    parts = [_mesh_part(item, number) for number, item in enumerate(shown) if _kind(item) == "Mesh"]
    notes = [f"{hidden} hidden objects left out"] if hidden else []
    if not parts:
        parts = _render_meshes(shown, hidden)
        notes.append("render mesh of " + ", ".join(name for name, _, _ in parts))
    if len(parts) > 1:
        _require_one_surface(parts)
        notes.append(f"{len(parts)} meshes joined: " + ", ".join(name for name, _, _ in parts))
    points = np.concatenate([points for _, points, _ in parts])
    starts = np.cumsum([0] + [len(points) for _, points, _ in parts])
    faces = np.concatenate([faces + start for (_, _, faces), start in zip(parts, starts, strict=False)])
    sizes = np.where(faces[:, 2] == faces[:, 3], 3, 4).astype(np.int64)
    corners = faces[np.arange(4) < sizes[:, None]]
    unit = METRES.get(_name(model.Settings.ModelUnitSystem))
    return Polygons(points, sizes, corners, tuple(notes), unit)


def _require_whole(data: bytes) -> None:
    """Refuse what is no .3dm, or is cut off: its last words repeat the length of the file."""
    if not data.startswith(MAGIC):
        raise mesh_error("the file does not begin like a .3dm", "save it from Rhino again")
    new, old = data[-20:], data[-12:]
    whole = new[:4] == b"\xff\x7f\x00\x00" and int.from_bytes(new[12:], "little") == len(data)
    whole |= old[:4] == b"\xff\x7f\x00\x00" and int.from_bytes(old[8:], "little") == len(data)
    if not whole:
        raise mesh_error(f"the .3dm is not whole: {len(data)} bytes without its end mark", "save it from Rhino again")


def _shown_objects(model: Any) -> tuple[list[Any], int]:
    """Objects on visible layers, and how many are hidden; parts of blocks count as neither."""
    layers = {str(layer.Id): layer for layer in model.Layers}

    def layer_shown(layer: Any) -> bool:
        for _ in range(len(layers)):
            if layer is None:
                break
            if not layer.Visible:
                return False
            layer = layers.get(str(layer.ParentLayerId))
        return True

    by_index = {layer.Index: layer_shown(layer) for layer in model.Layers}
    shown, hidden = [], 0
    for item in model.Objects:
        if item.Attributes.IsInstanceDefinitionObject:
            continue
        if item.Attributes.Visible and by_index.get(item.Attributes.LayerIndex, True):
            shown.append(item)
        else:
            hidden += 1
    return shown, hidden


def _name(value: Any) -> str:
    """Name of a value of one of rhino3dm's enumerations."""
    return str(value).rpartition(".")[2]


def _kind(item: Any) -> str:
    return _name(item.Geometry.ObjectType)


def _label(item: Any, number: int) -> str:
    name = item.Attributes.Name
    return f"{name!r}" if name else f"{_kind(item).lower()} {number + 1}"


def _mesh_part(item: Any, number: int) -> Part:
    return (_label(item, number), *_arrays([item.Geometry]))


def _arrays(meshes: list[Any]) -> tuple[Floats, Integers]:
    """Points and faces of rhino3dm's meshes, put one after the other."""
    points: list[tuple[float, float, float]] = []
    faces: list[Integers] = []
    for mesh in meshes:
        table = mesh.Faces
        rows = np.array([table[i] for i in range(len(table))], dtype=np.int64).reshape(-1, 4)
        faces.append(rows + len(points))
        # Points in double precision are handed out by this call alone.
        points.extend((p.X, p.Y, p.Z) for p in mesh.Vertices.ToPoint3dArray())
    return np.array(points, dtype=np.float64).reshape(-1, 3), np.concatenate(faces)


def _render_meshes(shown: list[Any], hidden: int) -> list[Part]:
    """Render meshes of surfaces, as Rhino keeps them beside what it has shown shaded."""
    parts, bare = [], []
    for number, item in enumerate(shown):
        geometry = item.Geometry
        if _kind(item) == "Brep":
            meshes = [face.GetMesh(rhino3dm.MeshType.Any) for face in geometry.Faces]
        elif _kind(item) == "Extrusion":
            meshes = [geometry.GetMesh(rhino3dm.MeshType.Any)]
        else:
            if _kind(item) in ("SubD", "Surface"):
                bare.append(item)
            continue
        meshes = [mesh for mesh in meshes if mesh is not None and len(mesh.Faces)]
        if meshes:
            parts.append((_label(item, number), *_arrays(meshes)))
        else:
            bare.append(item)
    if not parts:
        raise mesh_error(*_nothing(shown, bare, hidden))
    return parts


def _nothing(shown: list[Any], bare: list[Any], hidden: int) -> tuple[str, str]:
    if bare:
        kinds = {"Brep": "surface", "SubD": "SubD", "Surface": "surface", "Extrusion": "extrusion"}
        counts = Counter(kinds[_kind(item)] for item in bare)
        held = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in counts.items())
        return f"the .3dm holds {held} without a mesh, and no mesh", MESH_IT
    counts = Counter(_kind(item) for item in shown)
    held = ", ".join(f"{count} {kind}" for kind, count in counts.items()) or "nothing visible"
    hint = f" ({hidden} hidden objects were not looked at)" if hidden else ""
    if counts["InstanceReference"]:
        return f"the .3dm holds no mesh outside of blocks (it holds {held}){hint}", "explode the block with the mesh"
    return f"the .3dm holds no mesh (it holds {held}){hint}", MESH_IT


def _require_one_surface(parts: list[Part]) -> None:
    """Refuse objects whose vertices do not meet."""
    points = np.concatenate([points for _, points, _ in parts])
    owner = np.repeat(np.arange(len(parts)), [len(points) for _, points, _ in parts])
    good = np.isfinite(points).all(axis=1)
    points, owner = points[good], owner[good]
    if not len(points):
        return
    with np.errstate(over="ignore"):
        tolerance = 1e-6 * float(np.ptp(points, axis=0).max())
    if not np.isfinite(tolerance):
        return
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    pairs = np.sort(owner[pairs], axis=1)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    links, shared = np.unique(pairs, axis=0, return_counts=True)
    links = links[shared >= SHARED_VERTICES]
    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(len(parts), len(parts)))
    count, label = connected_components(graph, directed=False)
    if count > 1:
        groups = [" + ".join(parts[i][0] for i in np.flatnonzero(label == k)) for k in range(count)]
        listed = "; ".join(groups[:6]) + (f"; and {count - 6} more" if count > 6 else "")
        raise mesh_error(
            f"the .3dm holds {count} meshes that do not share borders: {listed}",
            "keep one of them, or hide the others (hidden objects are left out)",
        )
