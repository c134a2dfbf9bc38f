"""Mesh files: which reader, and what is checked whatever the format."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.byte_order import unmarked
from lamella.base.drawing_origin import Origin, origin_of
from lamella.base.errors import InputError
from lamella.base.limits import MOST_COORDINATE
from lamella.base.message import Message
from lamella.base.plausible_size import refuse_doubtful
from lamella.base.units import METRES, metres_of, unit_name
from lamella.base.wording import counted
from lamella.files.read.file_mesh import MAXIMUM_FACES, Polygons, mesh_error
from lamella.files.read.mesh_3dm import read_3dm
from lamella.files.read.mesh_obj import read_obj
from lamella.files.read.mesh_off import read_off
from lamella.files.read.mesh_ply import read_ply
from lamella.files.read.mesh_stl import read_stl
from lamella.surface.from_mesh.raw_mesh import RawMesh
from lamella.surface.from_mesh.split_polygons import split_faces

READERS = {".obj": read_obj, ".off": read_off, ".ply": read_ply, ".stl": read_stl, ".3dm": read_3dm}
LARGEST_FILE = 250_000_000
"""Bytes; text of `MAXIMUM_FACES` triangles with normals has 160 million, and takes some twenty seconds."""

LARGEST_SIZE = 5000.0
"""m; a larger "gridshell" was drawn in millimetres."""


def read_mesh(path: Path, unit: str | None = None, origin: Origin | None = None) -> RawMesh:
    """Read a mesh from .obj, .off, .ply, .stl or .3dm and split its faces into triangles.

    Parameters
    ----------
    path : Path
        The ending tells the format.
    unit : str, optional
        Unit of the file's numbers: mm, cm, dm, m, km, in, ft or yd. A .3dm says its own; metres for the others if
        nothing is said.
    origin : tuple of float, optional
        Point of the drawing to measure from, m; one beside the mesh where it is far away for its size.

    Returns
    -------
    RawMesh
        Points in m from its `origin`; nothing mended.

    Raises
    ------
    InputError
        For whatever is wrong with the file.
    """
    requested = None if unit is None else metres_of(unit)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise mesh_error(f"{path.name}: the format {path.suffix!r} is not known", "take .obj, .off, .ply, .stl or .3dm")
    found = reader(_bytes(path))
    check_polygons(found)
    metres, notes = _metres(found, requested)
    with np.errstate(over="ignore"):
        points = found.points * metres
    _check_size(points[found.corners], metres)
    size = float(np.ptp(points[found.corners], axis=0).max())
    if requested is None:
        refuse_doubtful("the mesh", size, metres, unit_name(metres), "unit")
    origin = origin_of(points[found.corners]) if origin is None else origin
    points = points - np.array(origin)
    try:
        faces, left_out = split_faces(points, found.sizes, found.corners)
    except InputError as error:
        raise mesh_error(error.message, error.remedy) from None
    if left_out:
        notes += (Message("faces_covered", f"{counted(left_out, 'face')} that lie on others left out"),)
    source = (
        f"{path.name}: {len(points)} vertices, {len(found.sizes)} faces"
        f"{_kinds(found)}, unit {unit_name(metres)}, {size:.4g} m large"
    )
    return RawMesh(points, faces, source, found.notes + notes, origin)


def _bytes(path: Path) -> bytes:
    try:
        if not path.exists():
            raise mesh_error(f"{path} does not exist", "a relative path starts at the project file's folder")
        if not path.is_file():
            raise mesh_error(f"{path} is not a file", "name a file .obj, .off, .ply, .stl or .3dm")
        length = path.stat().st_size
        if length > LARGEST_FILE:
            raise mesh_error(
                f"{path.name} has {length / 1e6:,.0f} MB; at most {LARGEST_FILE / 1e6:.0f} MB are read",
                "reduce the mesh: a few thousand faces are enough",
            )
        data = path.read_bytes()
    except OSError as reason:
        raise mesh_error(f"{path} cannot be read: {reason.strerror}", "check the file and its permissions") from None
    if not data.strip():
        raise mesh_error(f"{path.name} is empty", "export the file again")
    # the words of a binary file may begin like a mark
    return data if path.suffix.lower() in (".3dm", ".stl") else unmarked(data)


def check_polygons(found: Polygons) -> None:
    """Refuse what cannot be a mesh."""
    count = len(found.sizes)
    if not count:
        raise mesh_error("the file has no faces", "export a mesh with faces")
    if count > MAXIMUM_FACES or len(found.corners) - 2 * count > MAXIMUM_FACES:
        raise mesh_error(
            f"the mesh has {count} faces; at most {MAXIMUM_FACES} triangles are read",
            "reduce it: curvature needs a few thousand",
        )
    missing = (found.corners < 0) | (found.corners >= len(found.points))
    if missing.any():
        raise mesh_error(
            f"{np.count_nonzero(missing)} corners of faces name vertices that are not there; the file has "
            f"{len(found.points)} vertices",
            "is the file cut off? Export it again",
        )
    used = found.points[found.corners]
    endless = ~np.isfinite(used).all(axis=1)
    if endless.any():
        bad = found.corners[endless]
        number = int(bad.min()) + 1
        raise mesh_error(
            f"{counted(len(np.unique(bad)), 'vertex that is not a number', 'vertices that are not numbers')} (nan or "
            f"infinite); the first is number {number}",
            "export the mesh again",
        )
    largest = np.abs(used).max(axis=1)
    farthest = int(largest.argmax())
    if largest[farthest] > MOST_COORDINATE:
        raise mesh_error(
            f"vertex number {found.corners[farthest] + 1} has a coordinate of {largest[farthest]:.3g} (limit "
            f"{MOST_COORDINATE:g})",
            "export the mesh again, near its origin",
        )


def _metres(found: Polygons, requested: float | None) -> tuple[float, tuple[Message, ...]]:
    """Metres of the file's unit."""
    reported = found.metres_per_unit
    if reported is not None and requested is not None and abs(reported / requested - 1) > 1e-9:
        return requested, (
            Message(
                "unit_overruled",
                f"unit {unit_name(requested)} of the project, not {unit_name(reported)} as the file says",
            ),
        )
    if reported is None and requested is None:
        return 1.0, (Message("unit_assumed", "the file says no unit: taken as metres"),)
    return requested or reported or 1.0, ()


def _check_size(corners: np.ndarray[tuple[int, int], np.dtype[np.float64]], metres: float) -> None:
    size = float(np.ptp(corners, axis=0).max())
    if not size > 0:
        raise mesh_error("the mesh has no size: all its vertices are at one place", "export the mesh again")
    if not size <= LARGEST_SIZE:
        smaller = next(
            (unit for unit in ("mm", "cm") if METRES[unit] < metres and size / metres * METRES[unit] < LARGEST_SIZE),
            "mm",
        )
        mend = f'set unit = "{smaller}"'
        raise mesh_error(
            f"the mesh is {size:,.0f} m large (at most {LARGEST_SIZE:,.0f} m); in {smaller} it would be "
            f"{size / metres * METRES[smaller]:,.4g} m",
            mend,
        )


def _kinds(found: Polygons) -> str:
    triangles, quads = np.count_nonzero(found.sizes == 3), np.count_nonzero(found.sizes == 4)
    others = len(found.sizes) - triangles - quads
    if triangles == len(found.sizes):
        return " (triangles)"
    parts = ((triangles, "triangles"), (quads, "quads"), (others, "larger"))
    return " (" + ", ".join(f"{count} {name}" for count, name in parts if count) + ")"
