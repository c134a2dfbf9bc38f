"""Meshes for other programs: the surface as .obj and .ply, the network as .obj."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.arrays import Integers
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.text import dumped, require_finite, rows
from lamella.network.network import Network
from lamella.surface.mesh import SurfaceMesh

VERTEX_PROPERTIES = ("x", "y", "z", "nx", "ny", "nz", "H", "K", "k1", "k2")


def surface_obj_bytes(mesh: SurfaceMesh, *, name: str, version: str) -> bytes:
    """Return the surface as Wavefront .obj: vertices with normals, triangles and quads."""
    require_finite(mesh.points, mesh.normals)
    quads, triangles = _quads_and_triangles(mesh.faces)
    return b"".join(
        (
            _obj_head(name, version),
            f"# faces within {mesh.sag():.1e} m of the surface\n".encode(),
            b"o surface\n",
            rows(mesh.points, b"v "),
            rows(mesh.normals, b"vn "),
            _obj_faces(quads),
            _obj_faces(triangles),
        )
    )


def surface_ply_bytes(mesh: SurfaceMesh, *, name: str, version: str) -> bytes:
    """Return the surface as binary .ply in double precision, with H, K, k1 and k2 at each vertex."""
    columns = (mesh.mean_curvature, mesh.gaussian_curvature, mesh.k1, mesh.k2)
    vertices = np.column_stack((mesh.points, mesh.normals, *columns))
    require_finite(vertices)
    quads, triangles = _quads_and_triangles(mesh.faces)
    head = [
        "ply",
        "format binary_little_endian 1.0",
        f"comment lamella {one_line(version)}",
        f"comment project {one_line(name)}",
        "comment units: x y z in m; H k1 k2 in 1/m; K in 1/m^2",
        f"comment faces within {mesh.sag():.1e} m of the surface",
        "comment H is measured from positions alone; k1 and k2 are those of the surface's own H, K = k1 k2",
        f"element vertex {len(vertices)}",
        *(f"property double {key}" for key in VERTEX_PROPERTIES),
        f"element face {len(quads) + len(triangles)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    return b"".join(
        (
            "\n".join(head).encode() + b"\n",
            vertices.astype("<f8").tobytes(),
            _ply_faces(quads),
            _ply_faces(triangles),
        )
    )


def network_obj_bytes(network: Network, *, name: str, version: str) -> bytes:
    """Return the network as Wavefront .obj.

    Vertex i + 1 is node i. Object ``faces`` holds the cells as polygons of 3 to 6 nodes; objects
    ``lamellas_A`` and ``lamellas_B`` hold one group a lamella, named by its id, with a polyline through its
    nodes.
    """
    require_finite(network.node_points, network.node_normals)
    parts = [
        _obj_head(name, version),
        rows(network.node_points, b"v "),
        rows(network.node_normals, b"vn "),
    ]
    sizes = np.diff(network.face_offsets)
    if len(sizes):
        parts.append(b"o faces\n")
    for size in np.unique(sizes):
        starts = network.face_offsets[:-1][sizes == size]
        parts.append(_obj_faces(network.face_nodes[starts[:, None] + np.arange(size)]))
    stops = (network.stop_nodes + 1).tolist()
    offsets = network.stop_offsets.tolist()
    for family in ("A", "B"):
        members = np.flatnonzero(network.families == family).tolist()
        if members:
            parts.append(f"o lamellas_{family}\n".encode())
        for k in members:
            line = " ".join(map(str, stops[offsets[k] : offsets[k + 1]]))
            parts.append(f"g {network.ids[k]}\nl {line}\n".encode())
    return b"".join(parts)


def write_surface_obj(path: Path, mesh: SurfaceMesh, *, name: str, version: str) -> None:
    """Write `surface_obj_bytes`; OSError if it cannot be written whole."""
    write_whole(path, surface_obj_bytes(mesh, name=name, version=version))


def write_surface_ply(path: Path, mesh: SurfaceMesh, *, name: str, version: str) -> None:
    """Write `surface_ply_bytes`; OSError if it cannot be written whole."""
    write_whole(path, surface_ply_bytes(mesh, name=name, version=version))


def write_network_obj(path: Path, network: Network, *, name: str, version: str) -> None:
    """Write `network_obj_bytes`; OSError if it cannot be written whole."""
    write_whole(path, network_obj_bytes(network, name=name, version=version))


def _quads_and_triangles(faces: Integers) -> tuple[Integers, Integers]:
    triangle = faces[:, 2] == faces[:, 3]
    return faces[~triangle], faces[triangle, :3]


def _obj_head(name: str, version: str) -> bytes:
    return f"# lamella {one_line(version)}\n# project {one_line(name)}\n# units: m\n".encode()


def _obj_faces(faces: Integers) -> bytes:
    """Return faces of one size as lines ``f v//vn ...``; a vertex and its normal have the same number."""
    if not len(faces):
        return b""
    inner = dumped(np.repeat(faces[:, :, None] + 1, 2, axis=2))[3:-3]
    lines = inner.replace(b"]],[[", b"\nf ").replace(b"],[", b" ").replace(b",", b"//")
    return b"f " + lines + b"\n"


def _ply_faces(faces: Integers) -> bytes:
    size = faces.shape[1]
    table = np.empty(len(faces), dtype=[("count", "u1"), ("indices", "<i4", (size,))])
    table["count"] = size
    table["indices"] = faces
    return table.tobytes()
