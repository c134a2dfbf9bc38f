"""Peer: scikit-fem, the graph of a function on quadratic curved triangles, Newton's method as in its example 10.

Minimal or CMC graph z(x, y) over the plan of the boundary: div(grad z / sqrt(1 + |grad z|^2)) = 2 H,
elements of order 2. Second derivatives are those of gradients projected onto the same elements (L2), projected once
more to have values at vertices. Reads and writes .npz; run by `peers.py` in `.venv-bench`.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from typing import Any

import numpy as np
from disc import along, disc, harmonic
from skfem import Basis, BilinearForm, ElementTriP2, LinearForm, MeshTri, MeshTri2, condense, solve
from skfem.helpers import dot, grad

STEPS, RELATIVE_STEP = 30, 1e-10


@BilinearForm
def laplacian(u: Any, v: Any, _: Any) -> Any:
    """Of the start."""
    return dot(grad(u), grad(v))


@BilinearForm
def jacobian(u: Any, v: Any, w: Any) -> Any:
    """Second variation of the area."""
    root = np.sqrt(1 + dot(w["z"].grad, w["z"].grad))
    return dot(grad(u), grad(v)) / root - dot(w["z"].grad, grad(u)) * dot(w["z"].grad, grad(v)) / root**3


@LinearForm
def residual(v: Any, w: Any) -> Any:
    """First variation of area + 2 H volume."""
    root = np.sqrt(1 + dot(w["z"].grad, w["z"].grad))
    return dot(w["z"].grad, grad(v)) / root + 2 * w["mean_curvature"] * v


def curved_mesh(curve: Any, rings: int) -> tuple[MeshTri2, Any]:
    """The plan of the boundary in quadratic triangles, and z of their nodes on the boundary (nan elsewhere)."""
    plane, triangles, rim = disc(rings)
    # corners and mid-side nodes of the boundary, at equal arc length
    points = along(curve, 2 * rim)
    plan = harmonic(plane, triangles, points[::2, :2])
    straight = MeshTri(plan.T.copy(), triangles.T.copy())
    mesh = MeshTri2.from_mesh(straight)
    places, count, inner = mesh.doflocs.copy(), len(plan), len(plan) - rim
    height = np.full(places.shape[1], np.nan)
    height[inner:count] = points[::2, 2]
    sides = straight.boundary_facets()
    one, other = np.sort(straight.facets[:, sides] - inner, axis=0)
    # of vertices k and k + 1 around the rim, or the last and the first
    middle = np.where((one == 0) & (other == rim - 1), 2 * rim - 1, 2 * one + 1)
    places[:, count + sides] = points[middle, :2].T
    height[count + sides] = points[middle, 2]
    return replace(mesh, doflocs=places), height


def film(curve: Any, mean_curvature: float, rings: int) -> tuple[Basis, Any, int]:
    """Basis, z and Newton's steps."""
    mesh, height = curved_mesh(curve, rings)
    basis = Basis(mesh, ElementTriP2())
    count = mesh.nvertices
    at = np.r_[basis.nodal_dofs[0], basis.facet_dofs[0]]
    values = np.r_[height[:count], height[count:]]
    held = at[~np.isnan(values)]
    z = np.zeros(basis.N)
    z[at] = np.nan_to_num(values)
    z = solve(*condense(laplacian.assemble(basis), np.zeros(basis.N), x=z, D=held))
    size = np.ptp(curve, axis=0).max()
    for step in range(1, STEPS + 1):
        now = {"z": basis.interpolate(z), "mean_curvature": mean_curvature}
        shift = solve(*condense(jacobian.assemble(basis, **now), -residual.assemble(basis, **now), D=held))
        z += shift
        if abs(shift).max() < RELATIVE_STEP * size:
            return basis, z, step
    raise SystemExit(f"no convergence in {STEPS} steps")


def derivatives(basis: Basis, z: Any) -> tuple[Any, Any]:
    """Gradient (n, 2) and second derivatives (n, 2, 2) at the vertices."""
    inside = basis.interpolate(z).grad
    first = [basis.project(inside[i]) for i in range(2)]
    slopes = [basis.interpolate(one).grad for one in first]
    at = basis.nodal_dofs[0]
    second = [[basis.project((slopes[i][j] + slopes[j][i]) / 2)[at] for j in range(2)] for i in range(2)]
    return np.column_stack([one[at] for one in first]), np.moveaxis(np.array(second), -1, 0)


def directions(gradient: Any, second: Any) -> tuple[Any, Any]:
    """Unit principal directions (n, 3) of the graph, that of the larger principal curvature first."""
    metric = np.eye(2) + gradient[:, :, None] * gradient[:, None, :]
    lower = np.linalg.cholesky(metric)
    inverse = np.linalg.inv(lower)
    _, vectors = np.linalg.eigh(inverse @ second @ inverse.transpose(0, 2, 1))
    plan = inverse.transpose(0, 2, 1) @ vectors
    found = [np.column_stack([plan[:, :, k], (gradient * plan[:, :, k]).sum(1)]) for k in (1, 0)]
    return found[0], found[1]


def main() -> None:
    """Read the boundary, write what was found."""
    given = np.load(sys.argv[1])
    rings = int(given["size"])
    begin = time.process_time()
    basis, z, steps = film(given["curve"], float(given["mean_curvature"]), rings)
    found = time.process_time() - begin
    one, other = directions(*derivatives(basis, z))
    seconds = time.process_time() - begin
    inner = basis.mesh.nvertices - 6 * rings
    points = np.column_stack([basis.mesh.doflocs.T[: basis.mesh.nvertices], z[basis.nodal_dofs[0]]])[:inner]
    np.savez(
        sys.argv[2],
        points=points,
        one=one[:inner],
        other=other[:inner],
        unknowns=int(basis.N - len(basis.get_dofs().flatten())),
        steps=steps,
        found=found,
        seconds=seconds,
    )


if __name__ == "__main__":
    main()
