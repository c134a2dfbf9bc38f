"""One orientation for all faces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Floats, Integers
from lamella.base.message import Message
from lamella.surface.from_mesh.edges import Edges, face_normals
from lamella.surface.from_mesh.raw_mesh import mesh_error

LEVEL = 1e-3
"""Below this part of the flux of a sphere of the same area, a surface has no side that is "outwards"."""


def orient(points: Floats, faces: Integers, edges: Edges) -> tuple[Integers, Message]:
    """Turn faces so that neighbours agree.

    Every face stands twice in a graph, as it is and turned; edges join the copies that agree. If a face is connected
    with its own turned copy, going around some loop turns it over: the surface has one side.

    Parameters
    ----------
    points, faces
        A connected mesh with at most two faces at an edge.
    edges : Edges
        Of `faces`.

    Returns
    -------
    faces : (m, 3) int
    note : Message
        The file's own orientation if all faces agreed; otherwise the normal away from the centroid, or that of most
        of the file's faces where the surface has no outside.
    """
    count = len(faces)
    pairs = edges.inner_pairs
    start = faces.ravel()[pairs]
    agree = start[:, 0] != start[:, 1]
    one, two = (pairs // 3).T
    rows = np.concatenate((one, one + count))
    columns = np.concatenate((np.where(agree, two, two + count), np.where(agree, two + count, two)))
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(2 * count, 2 * count))
    _, label = connected_components(graph, directed=False)
    if (label[:count] == label[count:]).any():
        raise mesh_error(
            "the mesh has one side only, like a Möbius strip: no normal can be chosen",
            "cut it open, or look for a face that is twisted against its neighbours",
        )
    if agree.all():
        return faces, Message("normals_kept", "normals: the file's own orientation")
    turned = label[:count] != label[0]
    number = int(min(np.count_nonzero(turned), np.count_nonzero(~turned)))
    faces = np.where(turned[:, None], faces[:, ::-1], faces)
    outwards = _outwards(points, faces)
    if outwards == 0:
        most = 2 * np.count_nonzero(turned) > count
        faces = faces[:, ::-1] if most else faces
        return faces, Message(
            "normals_most", f"normals: {number} of {count} faces disagreed with the others and were turned"
        )
    faces = faces if outwards > 0 else faces[:, ::-1]
    return faces, (
        Message(
            "normals_outwards",
            f"normals: the faces did not agree ({number} of {count} against the others); "
            "now all point away from the centroid",
        )
    )


def _outwards(points: Floats, faces: Integers) -> int:
    """1 if the normals point away from the centroid on the whole, -1 if towards it, 0 if neither."""
    normals = face_normals(points, faces) / 2
    areas = np.linalg.norm(normals, axis=1)
    middles = points[faces].mean(axis=1)
    centroid = areas @ middles / areas.sum()
    flux = float(np.einsum("ij,ij->", middles - centroid, normals))
    sphere = float(areas.sum()) ** 1.5 / np.sqrt(4 * np.pi)
    return 0 if abs(flux) < LEVEL * sphere else int(np.sign(flux))
