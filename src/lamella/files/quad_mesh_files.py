"""Quad meshes in files, read and written with the same vertices in the same order: .obj, .ply, .3dm, COMPAS .json."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.plausible_size import SMALLEST
from lamella.base.result import Result
from lamella.base.units import RHINO_METRES, metres_of, unit_name
from lamella.base.wording import counted, one_line
from lamella.files.compas_json import compas_bytes, read_compas
from lamella.files.read.file_mesh import Polygons
from lamella.files.read.mesh import LARGEST_FILE, LARGEST_SIZE, check_polygons
from lamella.files.read.mesh_3dm import read_3dm
from lamella.files.read.mesh_obj import read_obj
from lamella.files.read.mesh_ply import read_ply
from lamella.files.write.text import dumped, require_finite, rows
from lamella.projection.mesh_figures import MeshFigures
from lamella.projection.quad_mesh import QuadMesh, quad_mesh

READERS = {".obj": read_obj, ".ply": read_ply, ".3dm": read_3dm}
FORMATS = (*READERS, ".json")
LARGEST_JSON = 64_000_000
"""Bytes; a table of objects takes up to twenty times as much memory."""

FIGURE_UNITS = "star_sphericity star_planarity star_radius moved in m; star_curvature in 1/m; angle in degrees"


@dataclass(frozen=True, eq=False, repr=False)
class QuadFile(Result):
    """A quad mesh with what is needed to write it back.

    Attributes
    ----------
    mesh : QuadMesh
        In m.
    metres : float
        Metres of the file's unit.
    notes : tuple of Message
        What the user should know about the reading.
    vertex_keys, face_keys : tuple of str
        Of a COMPAS mesh; empty for other formats.
    """

    mesh: QuadMesh
    metres: float = 1.0
    notes: tuple[Message, ...] = ()
    vertex_keys: tuple[str, ...] = ()
    face_keys: tuple[str, ...] = ()

    def _line(self) -> str:
        return f"{self.mesh}, {self.metres:g} m a unit"


def read_quad_mesh(path: str | Path, unit: str | None = None) -> QuadFile:
    r"""Read a quad mesh; nothing is merged, turned or left out.

    Parameters
    ----------
    path : str or Path
        The ending tells the format: .obj, .ply, .3dm, or .json of COMPAS.
    unit : str, optional
        Unit of the file's numbers: mm, cm, dm, m, km, in, ft or yd. A .3dm says its own; metres for the others.

    Raises
    ------
    InputError
        The file cannot be read, or is no connected manifold mesh of quads of a believable size.

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "net.obj"
    ...     _ = file.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    ...     print(lamella.read_quad_mesh(file).mesh)
    QuadMesh(4 vertices, 1 face)
    """
    try:
        return _read(Path(path), unit)
    except InputError as error:
        raise InputError(error.message, error.remedy, where=str(path)) from None


def _read(path: Path, unit: str | None) -> QuadFile:
    require_format(path)
    requested = None if unit is None else metres_of(unit)
    if not path.is_file():
        raise InputError("no such file", "check the path")
    size, most = path.stat().st_size, LARGEST_JSON if path.suffix.lower() == ".json" else LARGEST_FILE
    if size > most:
        raise InputError(f"the file has {size / 1e6:,.0f} MB; at most {most / 1e6:.0f} are read", "reduce it")
    data = path.read_bytes()
    if not data.strip():
        raise InputError("the file is empty", "export it again")
    vertex_keys: tuple[str, ...] = ()
    face_keys: tuple[str, ...] = ()
    if path.suffix.lower() == ".json":
        found, vertex_keys, face_keys = read_compas(data)
    else:
        found = READERS[path.suffix.lower()](data)
    check_polygons(found)
    _require_quads(found)
    reported = found.metres_per_unit
    if reported is not None and requested is not None and abs(reported / requested - 1) > 1e-9:
        raise InputError(f"the file says that its unit is {unit_name(reported)}, not {unit}", "leave the unit out")
    metres = reported or requested or 1.0
    notes = found.notes
    if reported is None and requested is None:
        notes += (Message("unit_assumed", "the file says no unit: taken as metres"),)
    mesh = quad_mesh(found.points * metres, found.corners.reshape(-1, 4))
    notes += _check_size(mesh, metres)
    _require_connected(mesh)
    return QuadFile(mesh, metres, notes, vertex_keys, face_keys)


def require_format(path: Path) -> None:
    """Raise `InputError` for an ending that tells no format."""
    if path.suffix.lower() not in FORMATS:
        raise InputError(
            f"the format {path.suffix!r} holds no quad mesh we know", f"take {', '.join(FORMATS)}", where=str(path)
        )


def _require_quads(found: Polygons) -> None:
    other = np.flatnonzero(found.sizes != 4)
    if len(other):
        raise InputError(
            f"{len(other)} of {counted(len(found.sizes), 'face')} are no quads; the first is face {other[0]} with "
            f"{found.sizes[other[0]]} corners (counted from 0)",
            "a net of lamellas needs quads: remesh it, or subdivide every face into quads (Catmull-Clark)",
        )


def _check_size(mesh: QuadMesh, metres: float) -> tuple[Message, ...]:
    size = float(np.ptp(mesh.vertices, axis=0).max())
    if not size > 0:
        raise InputError("the mesh has no size: all its vertices are at one place", "export the mesh again")
    if size > LARGEST_SIZE:
        raise InputError(
            f"the mesh is {size:,.0f} m large in {unit_name(metres)} (at most {LARGEST_SIZE:,.0f} m)",
            f"say its unit: with --unit mm it is {size / metres * 1e-3:,.4g} m large",
        )
    return (
        (Message("unit_small", f"the mesh is {size:.3g} m large: is its unit, {unit_name(metres)}, right?"),)
        if size < SMALLEST
        else ()
    )


def _require_connected(mesh: QuadMesh) -> None:
    loose = np.flatnonzero(mesh.face_count == 0)
    if len(loose):
        raise InputError(
            f"{counted(len(loose), 'vertex is', 'vertices are')} in no face; the first is vertex {loose[0]} (counted "
            "from 0)",
            "remove loose vertices",
        )
    count = len(mesh.vertices)
    graph = sp.coo_matrix((np.ones(len(mesh.edges), bool), tuple(mesh.edges.T)), (count, count))
    pieces, label = connected_components(graph, directed=False)
    if pieces > 1:
        sizes = np.sort(np.bincount(label))[::-1]
        raise InputError(
            f"the mesh has {pieces} pieces that share no vertices, of {', '.join(map(str, sizes[:4]))}"
            f"{' ...' if pieces > 4 else ''} vertices",
            "weld vertices that are at one place, or give each piece in a file of its own",
        )


def quad_mesh_bytes(
    suffix: str,
    mesh: QuadMesh,
    figures: MeshFigures,
    *,
    like: QuadFile,
    name: str,
    version: str,
    colours: dict[str, np.ndarray[tuple[int, int], np.dtype[np.uint8]]] | None = None,
) -> bytes:
    """A quad mesh as the bytes of a file, coordinates in the unit of the file it came from.

    Parameters
    ----------
    suffix : str
        .obj (figures as comments), .ply (figures and colours as properties), .3dm (figures as user text of the mesh,
        colours of vertices), .json (figures as attributes).
    mesh : QuadMesh
    figures : MeshFigures
    like : QuadFile
        Where it came from: unit, and the keys of a COMPAS mesh if the numbers of vertices and faces are the same.
    name, version : str
    colours : "vertices" or "faces" to (n, 3) uint8, optional
        sRGB, for .ply and .3dm.
    """
    points = mesh.vertices / like.metres
    require_finite(points)
    unit = unit_name(like.metres)
    match suffix.lower():
        case ".obj":
            head = f"# lamella {one_line(version)}\n# {one_line(name)}\n# units: {unit}; {FIGURE_UNITS}\n".encode()
            return b"".join(
                (
                    head,
                    rows(points, b"v "),
                    _comments("vertex", figures.vertices, b"#v "),
                    rows(mesh.faces + 1, b"f "),
                    _comments("face", figures.faces, b"#f "),
                )
            )
        case ".ply":
            return _ply(points, mesh, figures, colours or {}, f"{one_line(name)}, lamella {one_line(version)}", unit)
        case ".3dm":
            return _rhino(points, mesh, figures, colours or {}, like.metres, name, version)
    same = len(like.vertex_keys) == len(points) and len(like.face_keys) == len(mesh.faces)
    return compas_bytes(
        points,
        mesh,
        vertex_figures=figures.vertices,
        face_figures=figures.faces,
        vertex_keys=like.vertex_keys if same else (),
        face_keys=like.face_keys if same else (),
        name=name,
    )


def _comments(what: str, figures: dict[str, Floats], head: bytes) -> bytes:
    """Figures in the order of what they are of, as lines that readers of .obj pass over; unknown ones are nan."""
    if not figures:
        return b""
    title = f"# figures of each {what}, in order: {' '.join(figures)}\n".encode()
    return title + rows(np.column_stack(list(figures.values())), head).replace(b"null", b"nan")


def _ply(
    points: Floats,
    mesh: QuadMesh,
    figures: MeshFigures,
    colours: dict[str, np.ndarray[tuple[int, int], np.dtype[np.uint8]]],
    about: str,
    unit: str,
) -> bytes:
    rgb = [(channel, "u1") for channel in ("red", "green", "blue")]
    own = [(axis, "<f8") for axis in "xyz"] + [(key, "<f8") for key in figures.vertices]
    vertices = np.zeros(len(points), own + (rgb if "vertices" in colours else []))
    for axis, column in zip("xyz", points.T, strict=True):
        vertices[axis] = column
    listed = [("count", "u1"), ("vertex_indices", "<i4", (4,))]
    faces = np.zeros(
        len(mesh.faces), listed + [(key, "<f8") for key in figures.faces] + (rgb if "faces" in colours else [])
    )
    faces["count"], faces["vertex_indices"] = 4, mesh.faces
    for kind, table in (("vertices", vertices), ("faces", faces)):
        for key, values in getattr(figures, kind).items():
            table[key] = values
        for channel, (name, _) in enumerate(rgb if kind in colours else []):
            table[name] = colours[kind][:, channel]
    types = {"u": "uchar", "f": "double"}
    head = [
        "ply",
        "format binary_little_endian 1.0",
        f"comment {about}",
        f"comment units: x y z in {unit}; {FIGURE_UNITS}",
        f"element vertex {len(vertices)}",
        *(f"property {types[vertices.dtype[key].kind]} {key}" for key in vertices.dtype.names or ()),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        *(f"property {types[faces.dtype[key].kind]} {key}" for key in (faces.dtype.names or ())[2:]),
        "end_header",
    ]
    return "\n".join(head).encode() + b"\n" + vertices.tobytes() + faces.tobytes()


def _rhino(
    points: Floats,
    mesh: QuadMesh,
    figures: MeshFigures,
    colours: dict[str, np.ndarray[tuple[int, int], np.dtype[np.uint8]]],
    metres: float,
    name: str,
    version: str,
) -> bytes:
    import rhino3dm

    from lamella.files.write.rhino_file import RHINO_TOLERANCE, RhinoFile

    model = RhinoFile("optimised.3dm", name, version)
    unit = next((key for key, value in RHINO_METRES.items() if abs(value / metres - 1) < 1e-9), "Meters")
    settings = model.file.Settings
    settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, unit)
    settings.ModelAbsoluteTolerance = RHINO_TOLERANCE / metres
    model.add_layers({"mesh": (60, 90, 130)})
    made = rhino3dm.Mesh()
    made.Vertices.UseDoublePrecisionVertices = True
    for x, y, z in points.tolist():
        made.Vertices.AddPoint3d(x, y, z)
    for face in mesh.faces.tolist():
        made.Faces.AddFace(*face)
    made.Normals.ComputeNormals()
    for rgb in _of_vertices(mesh, colours).tolist():
        made.VertexColors.Add(*rgb)
    text = {
        f"{kind}.{key}": dumped(values)[1:-1].replace(b"null", b"nan").decode()
        for kind in ("vertices", "faces")
        for key, values in getattr(figures, kind).items()
    }
    model.file.Objects.AddMesh(made, model.attributes("mesh", name, units=FIGURE_UNITS, **text))
    return model.encoded()


def _of_vertices(
    mesh: QuadMesh, colours: dict[str, np.ndarray[tuple[int, int], np.dtype[np.uint8]]]
) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    """Colours of vertices; those of faces as their mean, since a mesh of Rhino has none for faces."""
    if "faces" not in colours:
        return colours.get("vertices", np.zeros((0, 3), np.uint8))
    total = np.zeros((len(mesh.vertices), 3))
    np.add.at(total, mesh.faces.ravel(), np.repeat(colours["faces"].astype(np.float64), 4, axis=0))
    return np.asarray((total / mesh.face_count[:, None]).round(), np.uint8)
