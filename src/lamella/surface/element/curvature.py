"""Shape operator of curved elements, from their second derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.surface.element.connectivity import Connectivity
from lamella.surface.points import Complexes, Floats


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
    cross = np.cross(a, b)
    area = np.linalg.norm(cross, axis=1)
    normal = cross / area[:, None]
    length = np.linalg.norm(a, axis=1)
    e_u = a / length[:, None]
    e_v = np.cross(normal, e_u)
    # a = length e_u, b = skew e_u + height e_v
    skew, height = (b * e_u).sum(1), area / length
    laa, lab, lbb = ((d * normal).sum(1) for d in (aa, ab, bb))
    # second fundamental form in the frame: e_u = a / length, e_v = (b - skew / length a) / height
    ratio = skew / length
    suu = laa / length**2
    suv = (lab - ratio * laa) / (length * height)
    svv = (lbb - 2 * ratio * lab + ratio**2 * laa) / height**2
    to_local = np.zeros((len(x), 2, 2))
    to_local[:, 0, 0], to_local[:, 0, 1], to_local[:, 1, 1] = 1 / length, -ratio / height, 1 / height
    return ElementPoints(x, normal, e_u, e_v, (suu + svv) / 2, (suu - svv) / 2 - 1j * suv, to_local)
