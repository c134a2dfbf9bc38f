"""Shape operator of curved elements, from their second derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.blocks import blocks
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.element.connectivity import Connectivity

# elements worked on at a time: their tables stay in the processor's cache
CURVATURE_BLOCK = 96


@dataclass(frozen=True)
class ElementFrames:
    """Points of curved elements with their tangent planes: one row a point.

    Attributes
    ----------
    position, normal, e_u, e_v : (n, 3)
        m; orthonormal frame with e_u along the first local coordinate, normal = e_u x e_v.
    to_local : (n, 2, 2)
        Local coordinates of tangent vectors: d(x, y) = to_local @ (components along e_u, e_v).
    """

    position: Floats
    normal: Floats
    e_u: Floats
    e_v: Floats
    to_local: Floats


@dataclass(frozen=True)
class ElementPoints:
    """Points of curved elements: one row a point.

    Attributes
    ----------
    position, normal, e_u, e_v : (n, 3)
        m; orthonormal frame with e_u along the first local coordinate, normal = e_u x e_v.
    mean_curvature : (n,)
        H, 1/m.
    deviator : (n,) complex
        Trace-free shape operator, see `SurfacePoints`.
    to_local : (n, 2, 2)
        Local coordinates of tangent vectors: d(x, y) = to_local @ (components along e_u, e_v).
    """

    position: Floats
    normal: Floats
    e_u: Floats
    e_v: Floats
    mean_curvature: Floats
    deviator: Complexes
    to_local: Floats


def frames(position: Floats, first: Floats, second: Floats) -> ElementFrames:
    """Frames at points (n, 3) with tangent vectors (n, 3) along the local coordinates."""
    cross = crosses(first, second)
    area = lengths(cross)
    normal = cross / area[:, None]
    length = lengths(first)
    e_u = first / length[:, None]
    e_v = crosses(normal, e_u)
    # first = length e_u, second = skew e_u + height e_v
    skew, height = dots(second, e_u), area / length
    to_local = np.zeros((len(position), 2, 2))
    to_local[:, 0, 0], to_local[:, 0, 1], to_local[:, 1, 1] = 1 / length, -skew / length / height, 1 / height
    return ElementFrames(position, normal, e_u, e_v, to_local)


def curvature_sizes(connectivity: Connectivity, corners: Floats, local: Floats) -> tuple[Floats, Floats, Floats]:
    """Positions (m, q, 3), mean curvatures (m, q) and sizes of the trace-free shape operator (m, q) in elements.

    Parameters
    ----------
    connectivity : Connectivity
    corners : (m, k, 3)
        Nodes of each element.
    local : (q, 2)
        Local coordinates, the same in every element.
    """
    jet = connectivity.basis.second_jet(local)
    m, q = len(corners), len(local)
    position, mean, deviator = np.empty((m, q, 3)), np.empty((m, q)), np.empty((m, q))
    for some in blocks(m, CURVATURE_BLOCK):
        x, a, b, aa, ab, bb = (np.matmul(f, corners[some]) for f in jet)
        cross = crosses(a, b)
        e, f, g = dots(a, a), dots(a, b), dots(b, b)
        determinant = e * g - f * f
        # second fundamental form times the area element
        l_, m_, n_ = (dots(d, cross) for d in (aa, ab, bb))
        half = (e * n_ - 2 * f * m_ + g * l_) / (2 * determinant)
        gauss = (l_ * n_ - m_ * m_) / determinant
        position[some] = x
        mean[some] = half / np.sqrt(determinant)
        deviator[some] = np.sqrt(np.maximum(half * half - gauss, 0) / determinant)
    return position, mean, deviator


def element_points(connectivity: Connectivity, corners: Floats, local: Floats, paired: bool) -> ElementPoints:
    """Points of elements with nodes (m, k, 3).

    Parameters
    ----------
    connectivity : Connectivity
    corners : (m, k, 3)
        Nodes of each element.
    local : (q, 2)
        Local coordinates: the same in every element (m q points, element by element), or one an element if `paired`.
    """
    jet = connectivity.basis.second_jet(local)
    if paired:
        x, a, b, aa, ab, bb = (np.einsum("nk,nkc->nc", f, corners) for f in jet)
    else:
        x, a, b, aa, ab, bb = (np.matmul(f, corners).reshape(-1, 3) for f in jet)
    there = frames(x, a, b)
    laa, lab, lbb = (dots(d, there.normal) for d in (aa, ab, bb))
    # second fundamental form in the frame: e_u = p a, e_v = q a + r b
    p, q, r = there.to_local[:, 0, 0], there.to_local[:, 0, 1], there.to_local[:, 1, 1]
    suu = laa * p**2
    suv = (q * laa + r * lab) * p
    svv = r**2 * lbb + 2 * q * r * lab + q**2 * laa
    return ElementPoints(
        x, there.normal, there.e_u, there.e_v, (suu + svv) / 2, (suu - svv) / 2 - 1j * suv, there.to_local
    )
