"""Meshes to write, break and read back."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay


def grid(rows=6, columns=7, height=None, size=1.0):
    """Points (n, 3) and quads of a grid over the square `size`, heights given by a function of x and y."""
    x, y = np.meshgrid(np.linspace(0, size, columns), np.linspace(0, size, rows), indexing="ij")
    z = height(x, y) if height else 0.3 * x * y
    points = np.column_stack((x.ravel(), y.ravel(), np.broadcast_to(z, x.shape).ravel()))
    number = np.arange(rows * columns).reshape(columns, rows)
    corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    return points, np.stack(corners, axis=-1).reshape(-1, 4)


def triangles(quads):
    """Every quad split alike."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def irregular(n, seed=0, jitter=0.3, border_jitter=0.3):
    """Irregular triangulation of the unit square: about n x n points (n, 2), faces counter-clockwise."""
    rng = np.random.default_rng(seed)
    step = 1 / (n - 1)
    x, y = np.meshgrid(np.arange(n) * step, np.arange(n) * step, indexing="ij")
    x = x + 0.5 * step * (np.arange(n) % 2) * ((x > 0) & (x < 1 - step / 2))
    move = jitter * step * rng.uniform(-1, 1, (2, n, n))
    move[0][[0, -1]] = 0
    move[1][:, [0, -1]] = 0
    move[1][[0, -1]] *= border_jitter / max(jitter, 1e-9)
    uv = np.column_stack(((x + move[0]).ravel(), (y + move[1]).ravel()))
    uv = np.clip(uv, 0, 1)
    faces = Delaunay(uv).simplices.astype(np.int64)
    a, b, c = (uv[faces[:, k]] for k in range(3))
    signed = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces = faces[np.abs(signed) > 1e-9]
    faces = np.where((signed[np.abs(signed) > 1e-9] < 0)[:, None], faces[:, ::-1], faces)
    return uv, faces


def disc(rings=6, around=24, radius=1.0, hole=0.0):
    """A disc, or an annulus if `hole` > 0: points (n, 3), triangles."""
    radii = np.linspace(hole, radius, rings + 1)[(0 if hole else 1) :]
    angle = 2 * np.pi * np.arange(around) / around
    points = (radii[:, None, None] * np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=-1)).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(radii) - 1), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    faces = triangles(np.stack((a, a + around, b + around, b), axis=-1).reshape(-1, 4))
    if not hole:
        centre = len(points)
        points = np.vstack((points, np.zeros(3)))
        first = np.arange(around)
        faces = np.vstack((faces, np.column_stack((np.full(around, centre), first, (first + 1) % around))))
    return points, faces


def torus(n=24, m=12, inner=0.3):
    """A closed torus."""
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    r = 1 + inner * np.cos(v)
    points = np.stack((r * np.cos(u), r * np.sin(u), inner * np.sin(v)), axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b, c, d = (p % n * m + q % m for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    return points, triangles(np.stack((a, b, c, d), axis=-1).reshape(-1, 4))


def sphere(n=24, m=12, radius=1.0):
    """A closed sphere, normals outwards."""
    u, v = 2 * np.pi * np.arange(n) / n, np.pi * np.arange(1, m) / m
    u, v = np.meshgrid(u, v, indexing="ij")
    points = np.stack((np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)), axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m - 2), indexing="ij")
    a, b = i * (m - 1) + j, (i + 1) % n * (m - 1) + j
    faces = triangles(np.stack((a, a + 1, b + 1, b), axis=-1).reshape(-1, 4))
    top, bottom = len(points), len(points) + 1
    i = np.arange(n)
    after = (i + 1) % n
    caps = (
        np.column_stack((np.full(n, top), i * (m - 1), after * (m - 1))),
        np.column_stack((np.full(n, bottom), after * (m - 1) + m - 2, i * (m - 1) + m - 2)),
    )
    return radius * np.vstack((points, [[0, 0, 1], [0, 0, -1]])), np.vstack((faces, *caps))


def moebius(n=30, m=4):
    """A Möbius strip."""
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, np.linspace(-0.3, 0.3, m + 1), indexing="ij")
    r = 1 + v * np.cos(u / 2)
    points = np.stack((r * np.cos(u), r * np.sin(u), v * np.sin(u / 2)), axis=-1).reshape(-1, 3)

    def number(i, j):
        return np.where(i < n, i * (m + 1) + j, m - j)

    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    corners = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1))
    return points, triangles(np.stack(corners, axis=-1).reshape(-1, 4))


def obj_text(points, faces, corner="{0}"):
    """Text of an .obj; `corner` formats a number from 1."""
    lines = ["# a comment", "mtllib none.mtl", "o thing", "vt 0 0", "vn 0 0 1", "s off"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(points).tolist()]
    lines += ["g part", "usemtl none"]
    lines += ["f " + " ".join(corner.format(i + 1) for i in face) for face in faces]
    return "\n".join(lines) + "\n"


def ply_bytes(points, faces, order="ascii", real="double", extras=False, newline="\n"):
    """Content of a .ply; `extras` adds properties and elements in between."""
    code = {"double": "f8", "float": "f4"}[real]
    head = ["ply", f"format {order} 1.0", "comment a comment", "obj_info none"]
    if extras:
        head += ["element material 2", "property list uchar float weights", "property short kind"]
    head += [f"element vertex {len(points)}"]
    head += ["property uchar red"] if extras else []
    head += [f"property {real} {axis}" for axis in ("z", "x", "y")]
    head += [f"element face {len(faces)}"]
    head += ["property ushort group", "property list uchar double uv"] if extras else []
    head += ["property list uchar int vertex_indices"]
    head += ["property float quality"] if extras else []
    head += ["end_header"]
    result = newline.join(head).encode() + newline.encode()
    mark = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[order]
    rows = []

    def put(*numbers):
        if mark is None:
            rows.append(newline.join([" ".join(str(number) for number, _ in numbers), ""]).encode())
        else:
            rows.append(b"".join(np.array(number, dtype=mark + kind).tobytes() for number, kind in numbers))

    if extras:
        put((1, "u1"), (0.5, "f4"), (-7, "i2"))
        put((2, "u1"), (0.5, "f4"), (0.25, "f4"), (-8, "i2"))
    for x, y, z in np.asarray(points).tolist():
        red = [(200, "u1")] if extras else []
        put(*red, (z, code), (x, code), (y, code))
    for face in faces:
        before = [(3, "u2"), (1, "u1"), (0.125, "f8")] if extras else []
        after = [(0.5, "f4")] if extras else []
        put(*before, (len(face), "u1"), *((int(i), "i4") for i in face), *after)
    return result + b"".join(rows)


def stl_bytes(points, faces, binary=True, header=b"solid but binary"):
    """Content of an .stl."""
    corners = np.asarray(points)[np.asarray(faces)]
    if binary:
        table = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
        table["v"] = corners
        return header.ljust(80, b" ") + len(corners).to_bytes(4, "little") + table.tobytes()
    lines = ["solid a thing"]
    for facet in corners.tolist():
        lines += [" facet normal 0 0 1", "  outer loop"]
        lines += [f"   vertex {x:.7e} {y:.7e} {z:.7e}" for x, y, z in facet]
        lines += ["  endloop", " endfacet"]
    return ("\n".join([*lines, "endsolid a thing"]) + "\n").encode()


def rhino_bytes(meshes, unit="Millimeters", extra=None):
    """Content of a .3dm with meshes (name, points, faces)."""
    import base64

    import rhino3dm

    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, unit)
    for name, points, faces in meshes:
        mesh = rhino3dm.Mesh()
        mesh.Vertices.UseDoublePrecisionVertices = True
        for x, y, z in np.asarray(points).tolist():
            mesh.Vertices.AddPoint3d(x, y, z)
        for face in np.asarray(faces).tolist():
            mesh.Faces.AddFace(*face)
        attributes = rhino3dm.ObjectAttributes()
        attributes.Name = name
        model.Objects.AddMesh(mesh, attributes)
    if extra:
        extra(model, rhino3dm)
    return base64.b64decode(model.Encode())
