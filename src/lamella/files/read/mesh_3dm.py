"""Meshes in Rhino's .3dm."""

from __future__ import annotations

from collections import Counter

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.base.message import Message
from lamella.base.units import RHINO_METRES
from lamella.base.wording import cut
from lamella.files.read.file_mesh import FILE, Polygons, mesh_error
from lamella.files.read.rhino_model import MAGIC, RhinoLayer, RhinoModel, RhinoObject, read_rhino

MESH_IT = "mesh it in Rhino (command Mesh), save the mesh alone, or hide everything else"

SHARED_VERTICES = 2
"""Two objects that have this many places in common share a border (a single one is a touch)."""

Part = tuple[str, Floats, Integers]
"""Name of an object, its points (n, 3) and its faces (f, 4); a triangle repeats its last index."""


def read_3dm(data: bytes) -> Polygons:
    """Read the visible meshes, and the render meshes of visible surfaces if there is no mesh.

    Several mesh objects are one mesh if their borders connect them; otherwise nobody can know which one is meant.
    """
    _require_whole(data)
    model = read_rhino(data, "meshes", FILE)
    shown, hidden = _shown_objects(model)
    parts = [_part(item, number) for number, item in enumerate(shown) if item.kind == "Mesh"]
    notes = [Message("objects_hidden", f"{hidden} hidden objects left out")] if hidden else []
    if not parts:
        parts = _render_meshes(shown, hidden)
        notes.append(Message("mesh_rendered", "render mesh of " + ", ".join(name for name, _, _ in parts)))
    if len(parts) > 1:
        _require_one_surface(parts)
        notes.append(
            Message("meshes_joined", f"{len(parts)} meshes joined: " + ", ".join(name for name, _, _ in parts))
        )
    points = np.concatenate([points for _, points, _ in parts])
    starts = np.cumsum([0] + [len(points) for _, points, _ in parts])
    faces = np.concatenate([faces + start for (_, _, faces), start in zip(parts, starts, strict=False)])
    sizes = np.where(faces[:, 2] == faces[:, 3], 3, 4).astype(np.int64)
    corners = faces[np.arange(4) < sizes[:, None]]
    unit = RHINO_METRES.get(model.unit)
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


def _shown_objects(model: RhinoModel) -> tuple[list[RhinoObject], int]:
    """Objects on visible layers, and how many are hidden; parts of blocks count as neither."""
    layers = {layer.id: layer for layer in model.layers}

    def layer_shown(layer: RhinoLayer | None) -> bool:
        for _ in range(len(layers)):
            if layer is None:
                break
            if not layer.visible:
                return False
            layer = layers.get(layer.parent_id)
        return True

    by_index = {layer.index: layer_shown(layer) for layer in model.layers}
    placed = [item for item in model.objects if not item.in_block]
    shown = [item for item in placed if item.visible and by_index.get(item.layer, True)]
    return shown, len(placed) - len(shown)


def _label(item: RhinoObject, number: int) -> str:
    return f"{cut(item.name, 40)!r}" if item.name else f"{item.kind.lower()} {number + 1}"


def _part(item: RhinoObject, number: int) -> Part:
    """An object's meshes, put one after the other."""
    starts = np.cumsum([0] + [len(mesh.points) for mesh in item.meshes])
    faces = [mesh.faces + start for mesh, start in zip(item.meshes, starts, strict=False)]
    points = [mesh.points for mesh in item.meshes]
    return _label(item, number), np.concatenate(points), np.concatenate(faces)


def _render_meshes(shown: list[RhinoObject], hidden: int) -> list[Part]:
    """Render meshes of surfaces, as Rhino keeps them beside what it has shown shaded."""
    parts = [_part(item, number) for number, item in enumerate(shown) if item.meshes]
    bare = [item for item in shown if item.kind in ("Brep", "Extrusion", "SubD", "Surface") and not item.meshes]
    if not parts:
        raise mesh_error(*_nothing(shown, bare, hidden))
    return parts


def _nothing(shown: list[RhinoObject], bare: list[RhinoObject], hidden: int) -> tuple[str, str]:
    if bare:
        kinds = {"Brep": "surface", "SubD": "SubD", "Surface": "surface", "Extrusion": "extrusion"}
        counts = Counter(kinds[item.kind] for item in bare)
        held = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in counts.items())
        return f"the .3dm holds {held} without a mesh, and no mesh", MESH_IT
    counts = Counter(item.kind for item in shown)
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
