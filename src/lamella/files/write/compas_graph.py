"""Networks and meshes for COMPAS 2: a `Graph` of nodes and cell edges, a `Mesh` of faces. COMPAS itself is not needed.

A graph carries all of network.json: nodes have their normal and kind, edges the lamella they are of and their length,
the graph's attributes the centre lines and faces. `compas.json_load` gives a `compas.datastructures.Graph`.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella import __version__
from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.files.compas_json import mesh_data
from lamella.files.whole import write_whole
from lamella.files.write.network_json import network_bytes
from lamella.network.network import Network
from lamella.projection.quad_mesh import QuadMesh
from lamella.surface.mesh import SurfaceMesh

GRAPH, MESH = "compas.datastructures/Graph", "compas.datastructures/Mesh"


def write_compas(
    what: Network | SurfaceMesh | QuadMesh, path: str | Path, *, mesh: bool = False, name: str = ""
) -> None:
    """A file that ``compas.json_load`` reads: a `Graph` of a network, a `Mesh` of a surface or of a network's faces.

    Parameters
    ----------
    what : Network, SurfaceMesh or QuadMesh
        A surface gives its mesh by ``surface.mesh()``.
    path : str or Path
        Written whole or not at all.
    mesh : bool
        Of a network its faces as a `Mesh`, instead of a `Graph`.
    name : str

    Raises
    ------
    InputError
        What has no such form.
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import lamella, json, tempfile, pathlib
    >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "net.json"
    ...     lamella.write_compas(net, file)
    ...     content = json.loads(file.read_text())
    >>> content["dtype"], len(content["data"]["node"])
    ('compas.datastructures/Graph', 144)
    """
    if isinstance(what, Network) and not mesh:
        write_whole(Path(path), _dumped(GRAPH, graph_data(what, name), name))
        return
    write_whole(Path(path), _dumped(MESH, _mesh(what, name), name))


def graph_data(network: Network, name: str = "") -> dict[str, Any]:
    """What ``Graph.__from_data__`` of COMPAS 2 takes, from the JSON form on: its keys are texts."""
    table = orjson.loads(network_bytes(network, name=name, version=__version__))
    rows = table.pop("nodes")
    nodes = {
        str(k): dict(zip("xyz", row["point"], strict=True), normal=row["normal"], kind=row["kind"])
        for k, row in enumerate(rows)
    }
    edges: dict[str, dict[str, dict[str, Any]]] = {key: {} for key in nodes}
    for line in table["lamellas"]:
        steps = zip(pairwise(line["nodes"]), pairwise(line["node_arclengths"]), strict=True)
        for (u, v), (start, end) in steps:
            own = {"lamella": line["id"], "family": line["family"], "length": end - start}
            # two lamellas between the same two nodes: one edge, of the first
            edges[str(u)].setdefault(str(v), own)
    return {
        "attributes": table,
        "default_node_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "node": nodes,
        "edge": edges,
        "max_node": len(nodes) - 1,
    }


def _mesh(what: Any, name: str) -> dict[str, Any]:
    if isinstance(what, Network):
        used, corner = np.unique(what.face_nodes, return_inverse=True)
        bounds = pairwise(what.face_offsets.tolist())
        faces = [corner[start:end].tolist() for start, end in bounds]
        return _of_faces(what.node_points[used], faces, name, {"node": used.astype(np.float64)})
    if isinstance(what, SurfaceMesh):
        # a triangle repeats its last corner
        faces = [face[:3] if face[2] == face[3] else face for face in what.faces.tolist()]
        figures = {key: getattr(what, key) for key in ("mean_curvature", "gaussian_curvature", "k1", "k2")}
        return _of_faces(what.points, faces, name, figures)
    if isinstance(what, QuadMesh):
        return _of_faces(what.vertices, what.faces.tolist(), name, {})
    raise InputError(
        f"a {type(what).__name__} has no form in COMPAS", "give a network, or a mesh: of a surface by its method mesh()"
    )


def _of_faces(points: Floats, faces: list[list[int]], name: str, figures: dict[str, Floats]) -> dict[str, Any]:
    attributes = {"name": name, "units": "m, 1/m"}
    return mesh_data(points, faces, vertex_figures=figures, face_figures={}, attributes=attributes)


def _dumped(dtype: str, data: dict[str, Any], name: str) -> bytes:
    return orjson.dumps({"lamella": __version__, "dtype": dtype, "data": data, "name": name})
