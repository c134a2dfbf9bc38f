"""Peer: linear triangles, Newton's method with scipy's sparse solver, directions by libigl.

What one writes with the usual mesh tools: each inner vertex moves along its normal until area + 2 H volume is
stationary (exact gradient and second variation of linear triangles), then `igl.principal_curvature` fits a quadric to
the neighbours of each vertex. Reads and writes .npz; run by `peers.py` in `.venv-bench`.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import igl
import numpy as np
from disc import along, disc, harmonic
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

STEPS, RELATIVE_STEP = 30, 1e-10


def cross_matrix(v: Any) -> Any:
    """Matrices of v x, (m, 3, 3)."""
    zero = np.zeros(len(v))
    x, y, z = v.T
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)


def variations(corners: Any, mean_curvature: float) -> tuple[Any, Any]:
    """Gradient (m, 3, 3) and second variation (m, 3, 3, 3, 3) of area + 2 H volume in the corners (m, 3, 3)."""
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    normal = np.cross(sides[:, 2], -sides[:, 1])
    size = np.linalg.norm(normal, axis=1)
    unit = normal / size[:, None]
    # corner i moves the double area vector by d_i = sides_i x
    turning = cross_matrix(sides.reshape(-1, 3)).reshape(-1, 3, 3, 3)
    gradient = np.einsum("eiab,ea->eib", turning, unit) / 2
    across = (np.eye(3) - unit[:, :, None] * unit[:, None, :]) / size[:, None, None]
    second = np.einsum("eiac,eab,ejbd->eicjd", turning, across, turning) / 2
    # the double area vector is bilinear: corner i and the next one
    skew = cross_matrix(unit)
    for i, j, sign in ((0, 1, 1), (1, 2, 1), (2, 0, 1), (1, 0, -1), (2, 1, -1), (0, 2, -1)):
        second[:, i, :, j, :] += sign * -skew / 2
    if mean_curvature:
        a = corners
        for i in range(3):
            gradient[:, i] += 2 * mean_curvature * np.cross(a[:, (i + 1) % 3], a[:, (i + 2) % 3]) / 6
            one, other = (i + 1) % 3, (i + 2) % 3
            second[:, i, :, one, :] += 2 * mean_curvature * -cross_matrix(a[:, other]) / 6
            second[:, i, :, other, :] += 2 * mean_curvature * cross_matrix(a[:, one]) / 6
    return gradient, second


def solve(curve: Any, mean_curvature: float, rings: int) -> tuple[Any, Any, int]:
    """Vertices and triangles of the surface, and Newton's steps."""
    plane, triangles, rim = disc(rings)
    points = harmonic(plane, triangles, along(curve, rim))
    inner = len(points) - rim
    i, j = np.repeat(triangles, 3, 1).ravel(), np.tile(triangles, 3).ravel()
    free = (i < inner) & (j < inner)
    size = np.ptp(curve, axis=0).max()
    for step in range(1, STEPS + 1):
        normals = igl.per_vertex_normals(points, triangles)
        gradient, second = variations(points[triangles], mean_curvature)
        along_normal = normals[triangles]
        load = np.zeros(len(points))
        np.add.at(load, triangles.ravel(), np.einsum("eic,eic->ei", gradient, along_normal).ravel())
        blocks = np.einsum("eic,eicjd,ejd->eij", along_normal, second, along_normal).ravel()
        matrix = coo_matrix((blocks[free], (i[free], j[free])), (inner, inner)).tocsc()
        factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        shift = factor.solve(-load[:inner])
        points[:inner] += shift[:, None] * normals[:inner]
        if abs(shift).max() < RELATIVE_STEP * size:
            return points, triangles, step
    raise SystemExit(f"no convergence in {STEPS} steps")


def main() -> None:
    """Read the boundary, write what was found."""
    given = np.load(sys.argv[1])
    curve, rings = given["curve"], int(given["size"])
    begin = time.process_time()
    points, triangles, steps = solve(curve, float(given["mean_curvature"]), rings)
    found = time.process_time() - begin
    # larger principal value first is the convention of neither sign: both directions are kept
    one, other, k_one, k_other, *_ = igl.principal_curvature(points, triangles, 5)
    seconds = time.process_time() - begin
    inner = len(points) - 6 * rings
    np.savez(
        sys.argv[2],
        points=points[:inner],
        one=one[:inner],
        other=other[:inner],
        k_one=k_one[:inner],
        k_other=k_other[:inner],
        unknowns=inner,
        steps=steps,
        found=found,
        seconds=seconds,
    )


if __name__ == "__main__":
    main()
