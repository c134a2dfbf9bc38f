"""Small good files of every format that is read, to be damaged."""

from __future__ import annotations

import base64
import io
import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import rhino3dm

from lamella.project.starter import starter
from lamella.project.tables import SURFACE_TABLES

EXAMPLES = Path(__file__).parents[2] / "examples"
SIDE = 4
RING = [(3 * np.cos(t), 2 * np.sin(t), 0.3 * np.cos(2 * t)) for t in np.arange(24) * np.pi / 12]


def _grid() -> tuple[list[list[float]], list[list[int]]]:
    """A saddle of quads."""
    points = [[i, j, 0.1 * (i - 2) * (j - 2)] for i in range(SIDE) for j in range(SIDE)]
    corners = [i * SIDE + j for i in range(SIDE - 1) for j in range(SIDE - 1)]
    return points, [[c, c + SIDE, c + SIDE + 1, c + 1] for c in corners]


def _drawn(version: str, *names: str) -> bytes:
    """A drawing in metres with some of the entities below."""
    drawing = ezdxf.new(version)
    drawing.units = 6
    space, rim = drawing.modelspace(), {"layer": "Rim"}
    drawing.layers.add("Rim")
    drawing.blocks.new("block").add_circle((0, 0), 0.5)
    for name in names:
        match name:
            case "parts":
                space.add_line((0, 0, 0), (4, 0, 0), rim)
                space.add_arc((4, 1, 0), 1, -90, 90, rim)
                space.add_polyline2d([(4, 2), (0, 2), (0, 0)], dxfattribs=rim)
            case "block":
                space.add_blockref("block", (1, 1), {"xscale": 2, "yscale": 2})
            case "blocks":
                space.add_blockref("block", (1, 1), {"row_count": 2, "column_count": 2, "row_spacing": 9})
            case "polyline":
                space.add_polyline3d(RING, close=True)
            case "arcs":
                space.add_lwpolyline([(0, 0, 0, 0, 1), (2, 0, 0, 0, 1)], close=True)
            case "ellipse":
                space.add_ellipse((0, 0, 1), (3, 0, 0), 0.5)
            case "fitted":
                space.add_spline([*RING, RING[0]])
            case "spline":
                space.add_open_spline([(0, 0, 0), (1, 1, 0), (2, 0, 1), (3, -1, 0), (0, 0, 0)])
            case "rational":
                space.add_rational_spline([(0, 0, 0), (1, 1, 0), (2, 0, 1), (0, 0, 0)], [1, 2, 1, 1])
            case "text":
                space.add_text("text")
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue().encode()


@cache
def dxf() -> tuple[bytes, ...]:
    old = [("parts", "text"), ("block",), ("blocks",), ("polyline",)]
    new = [*old, ("arcs",), ("ellipse",), ("fitted",), ("spline",), ("rational",)]
    whole = [_drawn("R12", *names) for names in old] + [_drawn("R2010", *names) for names in new]
    whole.append(_drawn("R2000", *{name for names in new for name in names}))
    bare = []
    for drawing in whole:
        # without the tables that take up most of a file, so that damage meets what is read
        version = re.search(rb"AC10\d\d", drawing)
        assert version
        head = b"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n" + version[0] + b"\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n"
        blocks = b"0\nSECTION\n2\nBLOCKS" + drawing.partition(b"\nBLOCKS")[2].partition(b"  0\nSECTION")[0]
        entities = drawing.partition(b"\nENTITIES")[2].partition(b"  0\nENDSEC")[0]
        bare.append(head + blocks + b"0\nSECTION\n2\nENTITIES" + entities + b"0\nENDSEC\n0\nEOF\n")
    return (*whole, *bare, *bare)


def _encoded(model: Any) -> bytes:
    return base64.b64decode(model.Encode())


def _model() -> Any:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    layer = rhino3dm.Layer()
    layer.Name = "Rim"
    model.Layers.Add(layer)
    return model


@cache
def rhino_curves() -> tuple[bytes, ...]:
    point = rhino3dm.Point3d
    curves = [
        rhino3dm.Circle(point(1, 2, 3), 4).ToNurbsCurve(),
        rhino3dm.NurbsCurve.Create(True, 3, [point(*p) for p in RING]),
        rhino3dm.PolylineCurve(rhino3dm.Point3dList([point(*p) for p in [*RING, RING[0]]])),
    ]
    mixed = rhino3dm.PolyCurve()
    mixed.Append(rhino3dm.Line(point(0, 0, 0), point(4, 0, 0)))
    mixed.Append(rhino3dm.Arc(point(4, 0, 0), point(5, 1, 0), point(4, 2, 0)))
    mixed.Append(rhino3dm.Line(point(4, 2, 0), point(0, 0, 0)))
    found = []
    for curve in [*curves, mixed]:
        model = _model()
        model.Objects.AddCurve(curve)
        found.append(_encoded(model))
    model = _model()
    model.Objects.AddCircle(rhino3dm.Circle(point(0, 0, 0), 2.0))
    found.append(_encoded(model))
    model = _model()
    model.InstanceDefinitions.Add("block", "", "", "", point(0, 0, 0), (curves[0],), (rhino3dm.ObjectAttributes(),))
    ident = model.InstanceDefinitions.FindIndex(0).Id
    model.Objects.AddInstanceObject(rhino3dm.InstanceReference(ident, rhino3dm.Transform.Translation(1, 2, 3)))
    model.Objects.AddBrep(rhino3dm.Sphere(point(0, 0, 0), 1).ToBrep())
    model.Objects.AddExtrusion(rhino3dm.Extrusion.Create(curves[0], 2.0, True))
    found.append(_encoded(model))
    return tuple(found)


@cache
def rhino_meshes() -> tuple[bytes, ...]:
    points, faces = _grid()
    found = []
    for double in (False, True):
        model = _model()
        mesh = rhino3dm.Mesh()
        mesh.Vertices.UseDoublePrecisionVertices = double
        for point in points:
            mesh.Vertices.AddPoint3d(*point) if double else mesh.Vertices.Add(*point)
        for face in faces:
            mesh.Faces.AddFace(*face)
        mesh.Normals.ComputeNormals()
        model.Objects.AddMesh(mesh)
        found.append(_encoded(model))
    return tuple(found)


@cache
def obj() -> tuple[bytes, ...]:
    points, faces = _grid()
    rows = [f"v {x} {y} {z}" for x, y, z in points] + ["vn 0 0 1", "vt 0 0", "g part", "usemtl paint"]
    plain = [*rows, *("f " + " ".join(str(k + 1) for k in face) for face in faces)]
    full = [*rows, *("f " + " ".join(f"{k - len(points)}/1/1" for k in face) for face in faces), "l 1 2", "# end"]
    return tuple("\n".join(lines).encode() + b"\n" for lines in (plain, full))


@cache
def ply() -> tuple[bytes, ...]:
    points, faces = _grid()
    rows = [" ".join(map(str, [*point, 200])) for point in points] + ["4 " + " ".join(map(str, f)) for f in faces]
    vertices = np.zeros(len(points), [("p", "d", (3,)), ("c", "u1")])
    vertices["p"] = points
    loops = np.zeros(len(faces), [("n", "u1"), ("k", "i4", (4,))])
    loops["n"], loops["k"] = 4, faces
    binary = vertices.tobytes() + loops.tobytes()
    turned = b""
    for row in vertices:
        turned += np.asarray(row["p"], ">f8").tobytes() + bytes([row["c"]])
    for row in loops:
        turned += bytes([4]) + np.asarray(row["k"], ">i4").tobytes()
    bodies = {"ascii": "\n".join(rows).encode(), "binary_little_endian": binary, "binary_big_endian": turned}
    return tuple(
        f"ply\nformat {kind} 1.0\ncomment a saddle\nelement vertex {len(points)}\nproperty double x\n"
        f"property double y\nproperty double z\nproperty uchar red\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
        "end_header\n".encode()
        + body
        for kind, body in bodies.items()
    )


@cache
def stl() -> tuple[bytes, ...]:
    points, faces = _grid()
    triangles = [[points[f[k]] for k in three] for f in faces for three in ((0, 1, 2), (0, 2, 3))]
    facet = np.zeros(len(triangles), [("n", "<f4", (3,)), ("p", "<f4", (3, 3)), ("a", "<u2")])
    facet["p"] = triangles
    text = ["solid s"]
    for triangle in triangles:
        text += ["facet normal 0 0 1", "outer loop"]
        text += [f"vertex {x} {y} {z}" for x, y, z in triangle] + ["endloop", "endfacet"]
    return ("\n".join([*text, "endsolid s"]).encode(), bytes(80) + len(facet).to_bytes(4, "little") + facet.tobytes())


@cache
def off() -> tuple[bytes, ...]:
    points, faces = _grid()
    rows = [" ".join(map(str, point)) for point in points] + ["4 " + " ".join(map(str, f)) for f in faces]
    return (f"OFF\n{len(points)} {len(faces)} 0\n".encode() + "\n".join(rows).encode(),)


@cache
def curve_json() -> tuple[bytes, ...]:
    square = [[0, 0, 0], [4000, 0, 1000], [4000, 4000, 0], [0, 4000, 1000]]
    curves = {
        "outer": {"points": square, "interpolation": "polyline"},
        "oculus": {"points": (1000 * np.array(RING)).tolist()},
    }
    return tuple(
        json.dumps({"unit": "mm", "curves": {name: curves[name] for name in names}}, indent=indent).encode()
        for names in (("outer",), ("oculus",), ("outer",), ("outer", "oculus"))
        for indent in (None, 1)
    )


@cache
def compas_json() -> tuple[bytes, ...]:
    points, faces = _grid()
    data = {
        "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "vertex": {str(k): dict(zip("xyz", point, strict=True)) for k, point in enumerate(points)},
        "face": {str(k): face for k, face in enumerate(faces)},
        "facedata": {},
    }
    new = {"dtype": "compas.datastructures/Mesh", "data": data, "name": "saddle"}
    return tuple(json.dumps(table, indent=1).encode() for table in (new, {"value": data}))


@cache
def projects() -> tuple[bytes, ...]:
    found = [path.read_bytes() for path in sorted(EXAMPLES.glob("0*.toml"))]
    found += [path.read_bytes() for path in sorted(EXAMPLES.glob("1*.toml"))]
    return (*found, *(starter(kind, "x").encode() for kind in SURFACE_TABLES))
