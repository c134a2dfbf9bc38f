"""Peer: guided projection by geometrylab (D. Pellis, H. Wang), faces of a quad mesh made planar.

Its Gauss-Newton iterations go on, one at a time, until all faces are planar to the given share of an edge. Fairness is
left out, so that vertices move as little as they can, as with this program. Reads and writes .npz; the folder that
holds `geometrylab` is the third argument (github.com/WWmore/geometrylab; needs pypardiso, numpy before 2.4).
"""

from __future__ import annotations

import sys
import time
import types
from pathlib import Path

import numpy as np

STEPS = 50

# the package imports its viewer (mayavi) first thing: its parts are imported without it
package = types.ModuleType("geometrylab")
package.__path__ = [str(Path(sys.argv[3]) / "geometrylab")]
sys.modules["geometrylab"] = package

from geometrylab.optimization import Gridshell, GuidedProjection  # noqa: E402


def main() -> None:
    """Read the mesh, write what came of it."""
    given = np.load(sys.argv[1])
    vertices, faces, limit = given["vertices"], given["faces"], float(given["limit"])
    begin = time.process_time()
    mesh = Gridshell()
    mesh.make_mesh(vertices.tolist(), faces.tolist())
    mesh.initialize()
    projection = GuidedProjection()
    projection.verbose = False
    for name in ("mesh_fairness", "tangential_fairness", "boundary_fairness"):
        projection.set_weight(name, 0)
    projection.set_weight("planarity", 1)
    projection.mesh = mesh
    steps = 0
    while steps == 0 or (steps < STEPS and off_plane(projection.vertices(), faces) > limit):
        projection.optimize()
        steps += 1
    seconds = time.process_time() - begin
    np.savez(sys.argv[2], vertices=projection.vertices(), steps=steps, seconds=seconds)


def off_plane(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Largest distance of the diagonals of a quad, over the mean edge."""
    a, b, c, d = vertices[faces].transpose(1, 0, 2)
    normal = np.cross(c - a, d - b)
    distance = abs(((b - a) * normal).sum(1)) / np.linalg.norm(normal, axis=1)
    return float(distance.max() / np.linalg.norm(b - a, axis=1).mean())


if __name__ == "__main__":
    main()
