"""Unrolling a strip: the plane curve whose curvature is the centre line's normal curvature.

On the strip that stands along the surface normals the centre line's geodesic curvature is kn, so its
development is straight for H = 0 and a circle of radius 1/H otherwise (paper section 2). `develop` does it
numerically, from written points alone, to check exactly that.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers

# points of the finite-difference formula: error O(h^4) inside, O(h^3) at the ends
STENCIL = 5
# samples worked on at a time, so that the stencils stay in the processor's cache
UNROLL_BLOCK = 8192


def _derivative_weights(t: Floats, own: Integers) -> tuple[Floats, Floats]:
    """Weights of first and second derivative, at one of its points, of the polynomial through given values.

    Parameters
    ----------
    t : (w, k)
        Abscissae of k stencils of w points, 0 at the point of interest.
    own : (k,) int
        Row of that point.

    Returns
    -------
    first, second : (w, k)
        Barycentric differentiation weights (Berrut & Trefethen, SIAM Review 46, 2004, section 9.3).
    """
    width = len(t)
    gaps = [[t[i] - t[j] for j in range(width)] for i in range(width)]
    scale = np.abs(t).max(0)
    weight = np.empty_like(t)
    for i in range(width):
        product = np.ones_like(scale)
        for j in range(width):
            if i != j:
                product = product * (gaps[i][j] / scale)
        weight[i] = 1 / product
    mine = np.arange(width)[:, None] == own
    gap = np.where(mine, 1.0, -t)
    first = np.where(mine, 0.0, weight / np.take_along_axis(weight, own[None], 0) / gap)
    centre = -first.sum(0)
    second = np.where(mine, 0.0, 2 * first * (centre - 1 / gap))
    return np.where(mine, centre, first), np.where(mine, -second.sum(0), second)


def _normal_curvature(points: Floats, normals: Floats, offsets: Integers) -> tuple[Floats, Floats]:
    """Normal curvature at samples of curves, and arc length from each sample to the next, from points alone."""
    count = np.diff(offsets)
    curve = np.repeat(np.arange(len(count)), count)
    chord = np.linalg.norm(np.diff(points, axis=0, append=points[-1:]), axis=1)
    chord[offsets[1:] - 1] = 0.0
    running = np.cumsum(chord) - chord
    width = np.minimum(count, STENCIL)[curve]
    kn, kappa = np.zeros(len(points)), np.zeros(len(points))
    blocks = [
        (w, block)
        for w in np.unique(width[width >= 3]).tolist()
        for block in np.array_split(np.flatnonzero(width == w), 1 + np.count_nonzero(width == w) // UNROLL_BLOCK)
    ]
    for w, at in blocks:
        first = np.clip(at - w // 2, offsets[curve[at]], offsets[curve[at] + 1] - w)
        index = first + np.arange(w)[:, None]
        d1, d2 = _derivative_weights(running[index] - running[at], at - first)
        stencil = points[index]
        velocity = np.einsum("wk,wkc->kc", d1, stencil)
        acceleration = np.einsum("wk,wkc->kc", d2, stencil)
        speed2 = np.einsum("ij,ij->i", velocity, velocity)
        kn[at] = np.einsum("ij,ij->i", acceleration, normals[at]) / speed2
        kappa[at] = np.linalg.norm(np.cross(velocity, acceleration), axis=1) / speed2**1.5
    # chord to arc of the osculating circle
    mean = (kappa + np.append(kappa[1:], 0.0)) / 2
    return kn, chord * (1 + (mean * chord) ** 2 / 24)


def develop(points: Floats, normals: Floats, offsets: Integers) -> tuple[Complexes, Floats]:
    """Unroll centre lines numerically: plane curves x + i y of the same length, with curvature kn.

    Parameters
    ----------
    points, normals : (k, 3)
        Samples of centre lines one after the other, m, and unit surface normals.
    offsets : (m + 1,) int
        Where each centre line begins.

    Returns
    -------
    plane : (k,) complex
        Developed samples, m, each curve from 0 along the real axis; +i is the side of the normal.
    arclengths : (k,)
        m, from each curve's start.
    """
    kn, arc = _normal_curvature(points, normals, offsets)
    turn = arc * (kn + np.append(kn[1:], 0.0)) / 2
    before = np.cumsum(turn) - turn
    curve = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    heading = before - before[offsets[curve]]
    # each step is the chord of a circular arc
    step = arc * np.sinc(turn / (2 * np.pi)) * np.exp(1j * (heading + turn / 2))
    plane, length = np.cumsum(step) - step, np.cumsum(arc) - arc
    return plane - plane[offsets[curve]], length - length[offsets[curve]]


def developed_line(arclengths: Floats, curvature: float | Floats) -> Complexes:
    """The straight line or circle that starts at 0 along the real axis and bends towards +i, m, (k,)."""
    half = arclengths * curvature / 2
    return np.asarray(arclengths * np.sinc(half / np.pi) * np.exp(1j * half))


def development_deviation(points: Floats, normals: Floats, offsets: Integers, curvature: float | Floats) -> Floats:
    """Largest distance of each numerically unrolled centre line from its straight line or circle.

    Parameters
    ----------
    points, normals, offsets
        As for `develop`.
    curvature : float or (m,)
        1/r of the intended development, 1/m, positive towards the normal.

    Returns
    -------
    (m,)
        m, after the best rigid placement of the one on the other.
    """
    plane, arclengths = develop(points, normals, offsets)
    starts, count = offsets[:-1], np.diff(offsets)
    ideal = developed_line(arclengths, np.repeat(curvature, count) if np.ndim(curvature) else curvature)

    def centred(curve: Complexes) -> Complexes:
        return np.asarray(curve - np.repeat(np.add.reduceat(curve, starts) / count, count))

    plane, ideal = centred(plane), centred(ideal)
    rotation = np.add.reduceat(plane * np.conj(ideal), starts)
    rotation /= np.maximum(np.abs(rotation), 1e-300)
    return np.asarray(np.maximum.reduceat(np.abs(plane - np.repeat(rotation, count) * ideal), starts))
