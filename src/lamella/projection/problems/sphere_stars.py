"""Nets with spherical vertex stars: the discrete constant-mean-curvature surfaces of paper section 2.1."""

from __future__ import annotations

from collections.abc import Callable

from lamella.base.sparse import Backend
from lamella.projection.problems.crossing import AngleForm
from lamella.projection.problems.star_net import StarNet, star_net
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Iteration


def sphere_stars(
    mesh: QuadMesh,
    *,
    radius: float | None = None,
    angle: float = 90.0,
    form: AngleForm = "circles",
    iterations: int = 100,
    tolerance: float = 1e-10,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> StarNet:
    """Move a net's vertices as little as needed until each star lies on a sphere of one radius, at the angle.

    Circular strips of that radius stand upright on such a net. At 90 degrees it is a discrete surface of constant
    mean curvature H = 1 / radius; at another angle 2 phi a linear Weingarten surface (paper, section 2).

    Parameters
    ----------
    mesh : QuadMesh
        See `lamella.projection.quad_mesh.quad_mesh`.
    radius : float, optional
        m. Without it the radius is found; ask `StarNet.ill_determined` whether the net says enough about it.
    angle : float
        Degrees.
    form : "circles", "chords" or "faces"
        How the angle is measured, see `AngleForm`.
    iterations, tolerance, on_iteration, backend
        See `lamella.projection.solve.solve`.

    Returns
    -------
    StarNet

    Raises
    ------
    InputError
        See `star_net`.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> U, V = np.mgrid[0:4, 0:4].reshape(2, -1) / 8
    >>> turn, height = U + V, U - V  # on a cylinder of radius 2, along curves at 45 degrees
    >>> k = np.arange(16).reshape(4, 4)
    >>> faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    >>> points = 2 * np.stack([np.cos(turn), np.sin(turn), height], 1)
    >>> net = lamella.sphere_stars(lamella.quad_mesh(points, faces))
    >>> print(f"{net.solution.verdict}, radius {abs(net.radius):.1f} m")
    solved, radius 4.0 m
    """
    return star_net(
        mesh,
        radius,
        angle=angle,
        form=form,
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
