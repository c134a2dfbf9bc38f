"""Asymptotic nets with right angles: planar vertex stars, the discrete minimal surfaces of paper section 2.1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.base.sparse import Backend
from lamella.projection.problems.crossing import AngleForm
from lamella.projection.problems.star_net import StarNet, star_net
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Iteration


def asymptotic(
    mesh: QuadMesh,
    *,
    angle: float = 90.0,
    form: AngleForm = "circles",
    iterations: int = 100,
    tolerance: float = 1e-10,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> StarNet:
    """Move a net's vertices as little as needed until its polylines are asymptotic and cross at the angle.

    Straight strips stand upright on such a net. At 90 degrees it is a discrete minimal surface; at another angle
    2 phi the ratio of its principal curvatures is constant, k1 / k2 = -tan^2 phi (paper, section 2).

    Parameters
    ----------
    mesh : QuadMesh
        See `lamella.projection.quad_mesh.quad_mesh`.
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
    >>> x, y = np.mgrid[0:4, 0:4].reshape(2, -1) / 3
    >>> k = np.arange(16).reshape(4, 4)
    >>> faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    >>> net = lamella.asymptotic(lamella.quad_mesh(np.stack([x, y, 0.1 * x * y], 1), faces))
    >>> net.solution.verdict
    'solved'
    """
    return star_net(
        mesh,
        np.inf,
        angle=angle,
        form=form,
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
