"""What every surface answers about places on it: position, frame, shape operator, gradient of mu."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.result import Result
from lamella.base.vectors import symmetric
from lamella.base.wording import counted


@dataclass(frozen=True, eq=False, repr=False)
class SurfacePoints(Result):
    """Points of a surface in bulk; tangent vectors are complex numbers: h means Re(h) e_u + Im(h) e_v.

    Attributes
    ----------
    position : (n, 3)
        m.
    e_u, e_v, normal : (n, 3)
        Orthonormal, normal = e_u x e_v.
    mean_curvature : (n,)
        H, 1/m.
    deviator : (n,) complex
        Trace-free shape operator [[Re, -Im], [-Im, -Re]] in (e_u, e_v), 1/m; its size is (k1 - k2) / 2.
    log_mu_gradient : (n,) complex
        Tangent vector grad ln mu = grad ln(H^2 - K) / 4, 1/m.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> points = lamella.Catenoid(2.0, (-1.0, 1.0)).at(np.array([0.0 + 0.0j]))
    >>> k1, k2 = points.principal_curvatures
    >>> print(points.position.round(6) + 0.0, k1.round(6), k2.round(6))
    [[2. 0. 0.]] [0.5] [-0.5]
    """

    position: Floats
    e_u: Floats
    e_v: Floats
    normal: Floats
    mean_curvature: Floats
    deviator: Complexes
    log_mu_gradient: Complexes

    def _line(self) -> str:
        return counted(len(self.position), "point")

    def vector(self, components: Complexes) -> Floats:
        """Tangent vectors in space, (n, 3)."""
        return np.asarray(components.real[:, None] * self.e_u + components.imag[:, None] * self.e_v)

    def components(self, vectors: Floats) -> Complexes:
        """Components of tangent vectors given in space (n, 3), as complex numbers (n,)."""
        return np.asarray(np.einsum("ij,ij->i", vectors, self.e_u) + 1j * np.einsum("ij,ij->i", vectors, self.e_v))

    @property
    def shape_entries(self) -> Floats:
        """Shape operator S, S t = -dn(t), as a symmetric matrix in space, 1/m, (n, 6): xx, xy, xz, yy, yz, zz."""
        return shape_entries(self.e_u, self.e_v, self.mean_curvature, self.deviator)

    @property
    def shape_operator(self) -> Floats:
        """The same as matrices, (n, 3, 3)."""
        return self.shape_entries[:, [[0, 1, 2], [1, 3, 4], [2, 4, 5]]]

    @property
    def principal_curvatures(self) -> tuple[Floats, Floats]:
        """k1 >= k2, 1/m, each (n,)."""
        half = np.abs(self.deviator)
        return self.mean_curvature + half, self.mean_curvature - half

    @property
    def principal_directions(self) -> tuple[Floats, Floats]:
        """Unit d1, d2 with (d1, d2, n) right-handed, each (n, 3); arbitrary at umbilics."""
        turn = np.exp(-0.5j * np.angle(self.deviator))
        return self.vector(turn), self.vector(1j * turn)

    @property
    def mu(self) -> Floats:
        """mu = (H^2 - K)^(1/4), 1/sqrt(m), (n,): du = mu <d1, .>, dv = mu <d2, .> (docs/theory.md)."""
        return np.sqrt(np.abs(self.deviator))


def shape_entries(e_u: Floats, e_v: Floats, mean: Floats, deviator: Complexes) -> Floats:
    """Entries (n, 6) of shape operators, 1/m, in frames (n, 3): see `SurfacePoints.shape_entries`."""
    return symmetric(e_u, e_v, mean + deviator.real, -deviator.imag, mean - deviator.real)
