"""Vertices that scatter about a smooth surface: how much, where they are without it, and what that leaves unknown.

With each vertex v moved by d_v along its normal, what polynomials of degree p around the vertices miss is r + J d, rows
being divided by the power p + 1 of their reach: derivatives of that order, roughly. The moves are the least of

    sum_v d_v^2  +  m |r + J d|^2,

the mean of the surfaces given the vertices if scatter is independent from vertex to vertex, of one variance s^2, and
those derivatives are, of the variance s^2 / m (Wahba, J. R. Stat. Soc. B 45 (1983), 133-150). m and s are those of the
largest restricted likelihood (Wood, J. R. Stat. Soc. B 73 (2011), 3-36, doi:10.1111/j.1467-9868.2010.00749.x), which
forty vertices can determine: the heights of a smooth surface fall off with the wave length, however coarse its mesh is,
those of scatter do not. Whether anything scatters, and the border too, is decided by that likelihood; the degree is the
one of the least generalised cross-validation (Craven and Wahba, Numer. Math. 31 (1979), 377-403).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, eye_array
from scipy.sparse.linalg import SuperLU, splu

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.from_mesh.edges import vertex_areas, vertex_normals
from lamella.surface.from_mesh.vertex_fits import EXPONENTS, TERMS, local_heights

NOISE_VERTICES_MIN, NOISE_VERTICES_MAX = 30, 5_000
"""Vertices: fewer leave too little beside a quartic, more are fitted by elements larger than their faces."""

NEIGHBOURS = {2: 9, 3: 14, 4: 22}
"""Vertices a polynomial is fitted to, at least, by its degree."""

READING = 3
"""Degree of the fits that curvatures of smoothed vertices are read from: at borders, quartics multiply what is left of
the scatter by three to ten."""

RANK, BEND_RANK = 1e-6, 0.02
"""Singular values of a stencil below this part of the largest count as none: vertices in three rows, say. Second
derivatives need more: of nearly straight rows they would be read from what is left of the scatter."""

DECADES = np.arange(-4.0, 12.1, 1.0)
"""Weights m that are tried, over that of the shortest waves, as powers of ten: from no smoothing to polynomials."""

EVIDENCE = 3.0
"""What scatter has to add to twice the logarithm of the likelihood: chance adds as much in one of 25 meshes (half a
chi-square of one degree of freedom, Self and Liang, J. Am. Stat. Assoc. 82 (1987), 605-610). Vertices on a smooth
surface add nothing."""

SECOND, BEND = slice(2, 5), np.array([2.0, 1.0, 2.0])
"""Terms x^2, xy and y^2 of `EXPONENTS`, and their second derivatives."""

NOISE_SAMPLES, DEVIATIONS = 64, 2.0
"""Surfaces drawn from those that vertices and scatter admit; standard deviations reported as the error."""


class Smoothed(NamedTuple):
    """Vertices without their scatter.

    Attributes
    ----------
    points : (v, 3)
        m.
    scatter : float
        Standard deviation across the surface, m.
    curvature_error : (v,)
        What the scatter leaves unknown of normal curvatures, two standard deviations, 1/m.
    """

    points: Floats
    scatter: float
    curvature_error: Floats


class _Stencils(NamedTuple):
    """What polynomials around vertices (n,) miss of these and their neighbours (n, k), as a function of moves.

    Attributes
    ----------
    vertices, neighbours
    missed : (n, k)
        r.
    rows : (n, k, k)
        J by the moves of the neighbours.
    bend : (n, 3, k)
        Second derivatives xx, xy, yy of the polynomials by the moves, 1/m^2.
    """

    vertices: Integers
    neighbours: Integers
    missed: Floats
    rows: Floats
    bend: Floats


class _Form(NamedTuple):
    """|r + J d|^2 = left + 2 pull . d + d . matrix d; `out` is the least of it, which no moves d take away."""

    degree: int
    matrix: csc_array
    pull: Floats
    left: float
    out: float


class _Fitted(NamedTuple):
    """What a degree says of vertices of which some may move.

    Attributes
    ----------
    form, free, weight
        |r + J d|^2, which vertices may move, (v,), and m.
    moves : (v,)
        m.
    scatter : float
        Standard deviation, m.
    evidence : float
        What scatter adds to twice the logarithm of the likelihood.
    left_out : float
        Generalised cross-validation: mean square by which vertices would be missed if they were left out, m^2.
    """

    form: _Form
    free: Booleans
    weight: float
    moves: Floats
    scatter: float
    evidence: float
    left_out: float


def without_scatter(points: Floats, faces: Integers, border: Booleans) -> Smoothed | None:
    """Vertices (v, 3) without their scatter; None: there is none that can be told from a smooth surface.

    Parameters
    ----------
    points, faces
        A clean mesh, m.
    border : (v,) bool
        Its border vertices. They stay where the likelihood is larger with them held, that is where the border does not
        scatter itself.
    """
    if not NOISE_VERTICES_MIN <= len(points) <= NOISE_VERTICES_MAX:
        return None
    normals = vertex_normals(points, faces)
    forms = [_form(points, faces, normals, degree) for degree in NEIGHBOURS]
    choices = [free for free in (np.ones(len(points), bool), ~border) if free.sum() >= NOISE_VERTICES_MIN / 2]
    fits = [fit for fit in (_fitted(form, free) for free in choices for form in forms) if fit is not None]
    if not fits:
        return None
    free = max(fits, key=lambda fit: fit.evidence).free
    fitted = min((fit for fit in fits if fit.free is free), key=lambda fit: fit.left_out)
    # normals of scattered vertices are off themselves: once more along those of the smoothed ones
    normals = vertex_normals(points + fitted.moves[:, None] * normals, faces)
    again = _fitted(_form(points, faces, normals, fitted.form.degree), free)
    if again is None:
        return None
    moved = points + again.moves[:, None] * normals
    return Smoothed(moved, again.scatter, _curvature_error(points, faces, normals, again))


def _stencils(points: Floats, faces: Integers, normals: Floats, degree: int) -> Iterator[_Stencils]:
    powers = EXPONENTS[: TERMS[degree]]
    areas = vertex_areas(points, faces)
    for block in local_heights(points, faces, normals, NEIGHBOURS[degree]):
        there = block.present
        basis = block.x[..., None] ** powers[:, 0] * block.y[..., None] ** powers[:, 1]
        basis = np.concatenate([basis, np.ones((*there.shape, 1))], axis=2) * there[:, :, None]
        inverse = np.linalg.pinv(basis, rcond=RANK)
        residual = there[:, :, None] * np.eye(there.shape[1]) - basis @ inverse
        # heights change by the moves times the cosines between the normals
        cosine = np.einsum("vkc,vc->vk", normals[block.neighbours], normals[block.vertices]) * there
        scale = np.sqrt(areas[block.vertices] / there.sum(1)) / block.reach ** (degree + 1)
        yield _Stencils(
            block.vertices,
            block.neighbours,
            (scale * block.reach)[:, None] * np.einsum("vkl,vl->vk", residual, block.z),
            residual * (scale[:, None] * cosine)[:, None, :],
            BEND[:, None]
            * np.linalg.pinv(basis, rcond=BEND_RANK)[:, SECOND]
            * (cosine / block.reach[:, None] ** 2)[:, None, :],
        )


def _form(points: Floats, faces: Integers, normals: Floats, degree: int) -> _Form:
    count = len(points)
    matrix, pull, left = csc_array((count, count)), np.zeros(count), 0.0
    for block in _stencils(points, faces, normals, degree):
        square = block.rows.transpose(0, 2, 1) @ block.rows
        row = np.broadcast_to(block.neighbours[:, :, None], square.shape)
        column = np.broadcast_to(block.neighbours[:, None, :], square.shape)
        matrix = matrix + coo_array((square.ravel(), (row.ravel(), column.ravel())), (count, count)).tocsc()
        np.add.at(pull, block.neighbours, np.einsum("vkl,vk->vl", block.rows, block.missed))
        left += float((block.missed**2).sum())
    form = _Form(degree, csc_array(matrix), pull, left, 0.0)
    shortest = float(form.matrix.diagonal().max())
    if not shortest > 0:
        return form
    moves = -_factor(form.matrix, 10 ** DECADES[-1] / shortest).solve(pull) * 10 ** DECADES[-1] / shortest
    return form._replace(out=max(_residual(form, form.matrix, pull, moves), 0.0))


def _residual(form: _Form, matrix: csc_array, pull: Floats, moves: Floats) -> float:
    """|r + J d|^2 that moves d could take away."""
    return form.left - form.out + float(2 * pull @ moves + moves @ (matrix @ moves))


def _fitted(form: _Form, free: Booleans) -> _Fitted | None:
    """The moves of the largest likelihood, of free vertices (v,) only; None: without scatter it is as large."""
    matrix, pull = csc_array(form.matrix[free][:, free]), form.pull[free]
    shortest = float(form.matrix.diagonal().max())
    if not (shortest > 0 and form.left > form.out):
        return None
    degrees = len(free) - TERMS[form.degree] - 1

    def solved(decade: float) -> tuple[Floats, float, float]:
        """Moves, the least of the sum, and minus twice the logarithm of the likelihood."""
        weight = 10**decade / shortest
        factor = _factor(matrix, weight)
        moves = -weight * factor.solve(pull)
        least = float(moves @ moves) + weight * max(_residual(form, matrix, pull, moves), 0.0)
        determinant = float(np.log(np.abs(factor.U.diagonal())).sum())
        return moves, least, float(degrees * np.log(max(least / weight, np.finfo(float).tiny)) + determinant)

    misfit = [solved(decade)[2] for decade in DECADES]
    best = int(np.argmin(misfit))
    if misfit[0] - misfit[best] < EVIDENCE:
        return None
    decade = float(DECADES[best])
    if best < len(DECADES) - 1:
        # the vertex of the parabola through the three
        before, here, after = misfit[best - 1 : best + 2]
        decade += 0.5 * (before - after) / (before - 2 * here + after)
    moves = np.zeros(len(free))
    moves[free], least, _ = solved(decade)
    weight = 10**decade / shortest
    probes = np.random.default_rng(0).choice([-1.0, 1.0], (int(free.sum()), NOISE_SAMPLES))
    # 1 less the mean influence of a vertex on its own place (Hutchinson's estimate of the trace)
    without = 1 - float((probes * _factor(matrix, weight).solve(probes)).mean())
    left_out = float((moves[free] ** 2).mean()) / max(without, np.finfo(float).tiny) ** 2
    return _Fitted(form, free, weight, moves, float(np.sqrt(least / degrees)), misfit[0] - misfit[best], left_out)


def _factor(matrix: csc_array, weight: float) -> SuperLU:
    whole = (eye_array(matrix.shape[0], format="csc") + weight * matrix).tocsc()
    return splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def _curvature_error(points: Floats, faces: Integers, normals: Floats, fitted: _Fitted) -> Floats:
    """What scatter leaves unknown of normal curvatures at each vertex, 1/m, (v,).

    By surfaces drawn from all that vertices and scatter admit: the least of the sum with both of its parts perturbed
    by their own variance (Papandreou and Yuille, Adv. Neural Inf. Process. Syst. 23 (2010), 1858-1866).
    """
    form, free = fitted.form, fitted.free
    draw = np.random.default_rng(0)
    right = draw.normal(size=(len(points), NOISE_SAMPLES))
    for block in _stencils(points, faces, normals, form.degree):
        noise = draw.normal(size=(*block.neighbours.shape, NOISE_SAMPLES))
        np.add.at(right, block.neighbours, np.sqrt(fitted.weight) * (block.rows.transpose(0, 2, 1) @ noise))
    moves = np.zeros_like(right)
    matrix = csc_array(form.matrix[free][:, free])
    moves[free] = fitted.scatter * _factor(matrix, fitted.weight).solve(right[free])
    result = np.zeros(len(points))
    for block in _stencils(points, faces, normals, READING):
        xx, xy, yy = np.moveaxis(block.bend @ moves[block.neighbours], 1, 0)
        # the largest normal curvature of a difference of second forms is their norm at most
        result[block.vertices] = DEVIATIONS * np.sqrt((xx**2 + 2 * xy**2 + yy**2).mean(axis=1))
    return result
