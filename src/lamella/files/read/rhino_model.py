"""What a Rhino file holds, as plain data; read in a process that can be ended (`lamella.files.read.bounded`)."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.files.read.bounded import BrokeDown, Limits, TookTooLong, has_processes, limits_for, run_bounded

Wanted = Literal["curves", "meshes"]

CHILD = "lamella.files.read.rhino_child"
MAGIC = b"3D Geometry File Format "

# Measured: 0.2 s for starting and a small file, 0.35 s and 29 bytes for each byte of a mesh's file; a file that is
# packed holds up to four times as much.
SECONDS, SECONDS_PER_MEGABYTE = 10, 2
MEMORY, MEMORY_PER_BYTE = 2**29, 128
REMEMBERED = 10_000_000
"""Bytes; the last two files up to this size are not read again."""


@dataclass(frozen=True)
class RhinoLayer:
    """A layer.

    Attributes
    ----------
    index : int
        What objects name it by.
    id, parent_id : str
    name, full_path : str
        ``full_path`` has the names of the layers above it in front, with "::" between.
    visible, locked : bool
        Its own; a layer is shown when those above it are too.
    """

    index: int
    id: str
    parent_id: str
    name: str
    full_path: str
    visible: bool
    locked: bool


@dataclass(frozen=True, eq=False)
class RhinoCurve:
    """A curve's NURBS form.

    Attributes
    ----------
    degree : int
    knots : (m,)
        As the format has them, without the first and the last one.
    controls : (n, 4)
        Homogeneous: w x, w y, w z, w; the file's unit.
    """

    degree: int
    knots: Floats
    controls: Floats


@dataclass(frozen=True, eq=False)
class RhinoMesh:
    """A mesh.

    Attributes
    ----------
    points : (n, 3)
        In the file's unit.
    faces : (f, 4) int
        A triangle repeats its last index.
    """

    points: Floats
    faces: Integers


@dataclass(frozen=True, eq=False)
class RhinoObject:
    """An object.

    Attributes
    ----------
    kind : str
        Of openNURBS: "Curve", "Mesh", "Brep", "Extrusion", "InstanceReference", ...
    type : str
        Of the library: "PolylineCurve", "NurbsCurve", ...
    id, name : str
    layer : int
        Index of its layer.
    visible, locked : bool
        Its own.
    in_block : bool
        Part of a block's definition: it stands where instances put it.
    on_page : bool
        In a layout, not in the model.
    curves : tuple of RhinoCurve
        Of "curves": the curve itself, or the naked edges of a Brep or an extrusion.
    meshes : tuple of RhinoMesh
        Of "meshes": the mesh itself, or render meshes of faces.
    faces : int
        Of "curves": number of faces of a Brep or an extrusion.
    block : str
        Of an instance: id of its definition.
    transform : (4, 4)
        Of an instance; the unit matrix for other objects.
    """

    kind: str
    type: str
    id: str
    name: str
    layer: int
    visible: bool
    locked: bool
    in_block: bool
    on_page: bool
    curves: tuple[RhinoCurve, ...]
    meshes: tuple[RhinoMesh, ...]
    faces: int
    block: str
    transform: Floats


@dataclass(frozen=True)
class RhinoBlock:
    """A block's definition: its id, name, and the ids of its objects."""

    id: str
    name: str
    members: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class RhinoModel:
    """A file.

    Attributes
    ----------
    unit : str
        Name of the model's unit in openNURBS: "Millimeters", ...; "None" and "CustomUnits" tell no length.
    tolerance : float
        Absolute tolerance of the model, the file's unit.
    layers, objects, blocks : tuple
    """

    unit: str
    tolerance: float
    layers: tuple[RhinoLayer, ...]
    objects: tuple[RhinoObject, ...]
    blocks: tuple[RhinoBlock, ...]


def read_rhino(data: bytes, wanted: Wanted, where: str) -> RhinoModel:
    """Read a .3dm.

    Parameters
    ----------
    data : bytes
        All of the file.
    wanted : "curves" or "meshes"
        Which geometry is taken; objects are listed in any case.
    where : str
        Key for messages.

    Raises
    ------
    InputError
        No .3dm, a damaged one, or one that takes longer than `SECONDS` and `SECONDS_PER_MEGABYTE` allow.
    """
    if not data.startswith(MAGIC):
        raise InputError("the file does not begin like a .3dm", "save it from Rhino again", where)
    if has_processes():
        packed = _read_apart(data, wanted, where)
    else:
        from lamella.files.read.rhino_child import packed_model

        packed = packed_model(data, wanted)
    model = _unpacked(packed)
    if model is None:
        raise InputError("Rhino's own library cannot read this .3dm", "open it in Rhino and save it again", where)
    return model


def _read_apart(data: bytes, wanted: Wanted, where: str) -> bytes:
    limits = limits_for(len(data), SECONDS, SECONDS_PER_MEGABYTE, MEMORY, MEMORY_PER_BYTE)
    try:
        return _remembered(data, wanted, limits) if len(data) <= REMEMBERED else _read(data, wanted, limits)
    except TookTooLong:
        what = f"reading {len(data) / 1e6:.3g} MB took longer than {limits.seconds} s in Rhino's own library"
    except BrokeDown:
        what = f"Rhino's own library breaks down on this .3dm, or needs over {limits.memory / 1e6:,.0f} MB for it"
    raise InputError(
        f"{what}: the file is damaged",
        f"open it in Rhino and save it again, with nothing but the {wanted} that are needed",
        where,
    )


def _read(data: bytes, wanted: Wanted, limits: Limits) -> bytes:
    return run_bounded(CHILD, [wanted], data, limits)


# the loops of a project are often curves of one file, and check and run look at it several times
_remembered = lru_cache(maxsize=2)(_read)


def _unpacked(packed: bytes) -> RhinoModel | None:
    """The model from what `lamella.files.read.rhino_child` writes: arrays, and a table that names them by number."""
    with np.load(io.BytesIO(packed), allow_pickle=False) as arrays:
        about: dict[str, Any] = json.loads(arrays["about"].tobytes())
        if not about["read"]:
            return None
        flat, whole = arrays["floats"], arrays["integers"]
    return RhinoModel(
        about["unit"],
        about["tolerance"],
        tuple(RhinoLayer(**layer) for layer in about["layers"]),
        tuple(
            RhinoObject(
                **item
                | {
                    "curves": tuple(_curve(curve, flat) for curve in item["curves"]),
                    "meshes": tuple(_mesh(mesh, flat, whole) for mesh in item["meshes"]),
                    "transform": np.array(item["transform"], float).reshape(4, 4),
                }
            )
            for item in about["objects"]
        ),
        tuple(RhinoBlock(block["id"], block["name"], tuple(block["members"])) for block in about["blocks"]),
    )


def _curve(entry: list[int], flat: Floats) -> RhinoCurve:
    degree, start, knots, points = entry
    middle = start + knots
    return RhinoCurve(degree, flat[start:middle], flat[middle : middle + 4 * points].reshape(-1, 4))


def _mesh(entry: list[int], flat: Floats, whole: Integers) -> RhinoMesh:
    first_point, points, first_face, faces = entry
    return RhinoMesh(
        flat[first_point : first_point + 3 * points].reshape(-1, 3),
        whole[first_face : first_face + 4 * faces].reshape(-1, 4),
    )
