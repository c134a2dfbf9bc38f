"""Surfaces of constant mean curvature known in closed form.

Each is given in conformal parameters zeta = U + i V, where the metric is lambda^2 (dU^2 + dV^2), together with
its Hopf differential Q dzeta^2, which is holomorphic because H is constant. Everything else follows:
the second fundamental form is H lambda^2 (dU^2 + dV^2) + 2 Re(Q dzeta^2), so that H^2 - K = (2 |Q| / lambda^2)^2,
and the isothermic coordinates of DESIGN section 2 are u + i v = w = integral of sqrt(2 Q) dzeta.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lamella.surface.outline import Outline

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


class ClosedForm(ABC):
    """A closed-form surface; places on it are complex parameters ``where = U + i V``, shape (n,).

    The surface normal is n = e_U x e_V. Signs and names are those of `lamella`'s package docstring.

    Attributes
    ----------
    kind : str
        Name in a project file.
    mean_curvature : float
        H, 1/m, for the normal given by `normal`.
    outline : Outline
        The piece of the parameter plane the surface covers.
    hopf_order : int
        Order m of the zero of Q at zeta = 0 (0: none). A zero is an umbilic with 2 (m + 2) lamella rays.
    """

    kind: ClassVar[str]
    mean_curvature: float
    outline: Outline
    hopf_order: int = 0

    @abstractmethod
    def position(self, where: Complexes) -> Floats:
        """Position, m, shape (n, 3)."""

    @abstractmethod
    def frame(self, where: Complexes) -> tuple[Floats, Floats, Floats]:
        """Unit tangents e_U, e_V and unit normal n = e_U x e_V, each of shape (n, 3)."""

    @abstractmethod
    def metric(self, where: Complexes) -> Floats:
        """Conformal factor lambda, m per unit of zeta, shape (n,)."""

    @abstractmethod
    def log_metric_gradient(self, where: Complexes) -> Complexes:
        """d(ln lambda)/dU + i d(ln lambda)/dV, shape (n,)."""

    @abstractmethod
    def hopf(self, where: Complexes) -> Complexes:
        """Hopf coefficient Q, m, shape (n,)."""

    @abstractmethod
    def isothermic(self, where: Complexes) -> Complexes:
        """Isothermic coordinates w = u + i v = integral of sqrt(2 Q) dzeta, sqrt(m), shape (n,)."""

    @abstractmethod
    def from_isothermic(self, w: Complexes) -> Complexes:
        """Place with given isothermic coordinates; near a zero of Q the branch of `isothermic`."""

    @property
    @abstractmethod
    def longest_principal_line(self) -> float:
        """Largest isothermic length of a principal line on a simply connected surface, sqrt(m)."""

    def describe(self) -> dict[str, object]:
        """Facts worth telling beside the project's own numbers (for the summary)."""
        return {}

    def warnings(self) -> tuple[str, ...]:
        """What a user should know about this surface before building it."""
        return ()

    def hopf_log_gradient(self, where: Complexes) -> Complexes:
        """d(ln |Q|)/dU + i d(ln |Q|)/dV; zero where Q is constant."""
        return np.zeros(len(where), complex)

    def normal(self, where: Complexes) -> Floats:
        """Unit normal, shape (n, 3)."""
        return self.frame(where)[2]

    def vector(self, where: Complexes, components: Complexes) -> Floats:
        """Tangent vectors Re(components) e_U + Im(components) e_V, shape (n, 3)."""
        e_u, e_v, _ = self.frame(where)
        return components.real[:, None] * e_u + components.imag[:, None] * e_v

    def deviator(self, where: Complexes) -> Complexes:
        """2 Q / lambda^2: trace-free shape operator [[Re, -Im], [-Im, -Re]] in (e_U, e_V), 1/m."""
        return 2 * self.hopf(where) / self.metric(where) ** 2

    def shape_operator(self, where: Complexes) -> Floats:
        """Shape operator S as symmetric matrices in space, S t = -dn(t), 1/m, shape (n, 3, 3)."""
        e_u, e_v, _ = self.frame(where)
        d = self.deviator(where)
        uu, vv = e_u[:, :, None] * e_u[:, None, :], e_v[:, :, None] * e_v[:, None, :]
        uv = e_u[:, :, None] * e_v[:, None, :]
        s = (self.mean_curvature + d.real)[:, None, None] * uu + (self.mean_curvature - d.real)[:, None, None] * vv
        return np.asarray(s - d.imag[:, None, None] * (uv + uv.transpose(0, 2, 1)))

    def principal_curvatures(self, where: Complexes) -> tuple[Floats, Floats]:
        """k1 >= k2, 1/m, each of shape (n,)."""
        half = np.abs(self.deviator(where))
        return self.mean_curvature + half, self.mean_curvature - half

    def principal_directions(self, where: Complexes) -> tuple[Floats, Floats]:
        """Unit d1, d2 with (d1, d2, n) right-handed, each of shape (n, 3); undefined at umbilics."""
        turn = np.exp(-0.5j * np.angle(self.hopf(where)))
        return self.vector(where, turn), self.vector(where, 1j * turn)

    def mu(self, where: Complexes) -> Floats:
        """mu = (H^2 - K)^(1/4), 1/sqrt(m), shape (n,): du = mu <d1, .>, dv = mu <d2, .>."""
        return np.sqrt(np.abs(self.deviator(where)))

    def log_mu_gradient(self, where: Complexes) -> Floats:
        """Surface gradient of ln mu = ln(H^2 - K) / 4, 1/m, shape (n, 3).

        At a zero of Q it is infinite along the radius; there only the finite part, zero by symmetry, is given.
        """
        gradient = self.hopf_log_gradient(where) / 2 - self.log_metric_gradient(where)
        return self.vector(where, gradient / self.metric(where))
