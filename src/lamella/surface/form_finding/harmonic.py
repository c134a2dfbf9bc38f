"""The harmonic surface over a chart: where form finding starts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.sparse import SingularError, SymmetricPattern, packed
from lamella.surface.form_finding.chart import Chart, Curve
from lamella.surface.form_finding.film import NoFilmError


def harmonic_surface(chart: Chart, loops: Sequence[Curve], rounds: int = 0) -> Floats:
    """Vertices (v, 3) of the surface whose coordinates are harmonic in the chart.

    Parameters
    ----------
    chart : Chart
    loops : sequence of Curve
    rounds : int
        How often the surface is made harmonic over itself again, which lowers its area (Pinkall and Polthier,
        Experim. Math. 2 (1993), 15-36, doi:10.1080/10586458.1993.10504266).
    """
    points = np.zeros((len(chart.points), 3))
    for index, loop in enumerate(loops):
        mine = chart.loop == index
        points[mine] = loop.at(chart.parameter[mine])
    free = chart.loop < 0
    unknown = np.where(free, np.cumsum(free) - 1, -1)
    pattern = SymmetricPattern.from_elements(unknown[chart.faces], int(free.sum()))
    places = np.column_stack([chart.points, np.zeros(len(chart.points))])
    for _ in range(rounds + 1):
        blocks = _cotangents(places[chart.faces])
        pull = np.einsum("fij,fjc->fic", blocks, np.where(free[:, None], 0, points)[chart.faces])
        flat = chart.faces.ravel()
        right = [-np.bincount(flat, pull[..., c].ravel(), len(points))[free].astype(np.float64) for c in range(3)]
        try:
            points[free] = pattern.factor(pattern.assemble(packed(blocks))).solve(np.stack(right, 1))
        except SingularError as error:
            raise NoFilmError(str(error)) from None
        places = points
    return points


def _cotangents(corners: Floats) -> Floats:
    """Dirichlet energy of linear functions on triangles (m, 3, 3 coordinates), as blocks (m, 3, 3)."""
    sides = np.roll(corners, -2, 1) - np.roll(corners, -1, 1)
    double_area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    floor = 1e-6 * (sides**2).sum((1, 2))
    return np.asarray(np.matmul(sides, sides.transpose(0, 2, 1)) / (2 * np.maximum(double_area, floor))[:, None, None])
