"""Scherk's doubly periodic minimal surface z = ln(cos y / cos x) over a square."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.errors import InputError, require_positive
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.elliptic import first_kind, jacobi
from lamella.surface.closed_forms.outline import Square
from lamella.surface.closed_forms.sampling import grid_faces, quadrature
from lamella.surface.points import SurfacePoints


def asymptotic_to_conformal(p: Floats) -> Floats:
    """Integral of dp / sqrt(cosh p) from 0: sqrt(2) F(phi | 1/2) with sin phi = sqrt(2) sin(gd(p) / 2)."""
    sine = np.sqrt(2.0) * np.sin(np.arctan(np.sinh(p)) / 2)
    return np.asarray(np.sqrt(2.0) * first_kind(sine, 0.5))


class Scherk(ClosedForm):
    """In asymptotic parameters p = X + Y, q = X - Y, where X = gd^-1(x), Y = gd^-1(y).

    The metric is [cosh q dp^2 + cosh p dq^2] / (cosh p + cosh q), so that zeta = U + i V with
    dU = dq / sqrt(cosh q), dV = dp / sqrt(cosh p) is conformal; U, V = const are already the lamellas. The
    integrals invert by Jacobi's functions of parameter 1/2: cosh p = 1 / cn^2, sinh p = sqrt(2) sn dn / cn^2 at
    V / sqrt(2). Normal upwards, H = 0 (all lengths times `scale`).

    Parameters
    ----------
    extent : float
        Half side of the square |x|, |y| <= extent < pi / 2 (before scaling).
    scale : float
        m per unit of the parametrisation.

    Examples
    --------
    >>> import lamella
    >>> lamella.Scherk(1.0, 1.0)
    Scherk(mean curvature 0 1/m, 5.698 m2)
    """

    kind = "scherk"
    mean_curvature = 0.0
    outline: Square

    def __init__(self, extent: float, scale: float = 1.0) -> None:
        require_positive(extent=extent, scale=scale)
        if extent >= np.pi / 2:
            raise InputError(
                f"extent = {extent:g}: the surface runs to infinity at pi / 2 = 1.5708",
                "choose a smaller extent",
                "extent",
            )
        self.extent, self.scale = extent, scale
        self.outline = Square(float(np.arcsinh(np.tan(extent))))

    @staticmethod
    def hyperbolic(coordinate: Floats) -> tuple[Floats, Floats]:
        """cosh and sinh of the asymptotic parameter that belongs to a conformal one."""
        f = jacobi(coordinate / np.sqrt(2.0), 0.5)
        return 1 / f.cn**2, np.sqrt(2.0) * f.sn * f.dn / f.cn**2

    def from_gudermannian(self, x: Floats, y: Floats) -> Complexes:
        """Places with given X, Y."""
        return np.asarray(asymptotic_to_conformal(x - y) + 1j * asymptotic_to_conformal(x + y))

    def places(self, rows: int, columns: int) -> tuple[Complexes, Integers]:
        """A grid over the square, by steps of X and Y."""
        half = self.outline.half_side
        x, y = np.meshgrid(np.linspace(-half, half, rows), np.linspace(-half, half, columns), indexing="ij")
        return self.from_gudermannian(x.ravel(), y.ravel()), grid_faces(rows, columns, False)

    def area(self) -> float:
        """Quadrature of the area element of (X, Y), sqrt(1 - tanh^2 X tanh^2 Y), m^2."""
        line, weight = quadrature(-self.outline.half_side, self.outline.half_side)
        x, y = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
        element = np.sqrt(1 - (np.tanh(x) * np.tanh(y)) ** 2)
        return float(self.scale**2 * (np.outer(weight, weight).ravel() * element).sum())

    def at(self, where: Complexes) -> SurfacePoints:
        (cosh_p, sinh_p), (cosh_q, sinh_q) = self.hyperbolic(where.imag), self.hyperbolic(where.real)
        p, q = np.arcsinh(sinh_p), np.arcsinh(sinh_q)
        x, y = (p + q) / 2, (p - q) / 2
        position = self.scale * np.column_stack(
            [np.arctan(np.sinh(x)), np.arctan(np.sinh(y)), np.log(np.cosh(x) / np.cosh(y))]
        )
        # derivatives by X and by Y of (gd X, gd Y, ln cosh X - ln cosh Y)
        zero = np.zeros_like(x)
        by_x = np.column_stack([1 / np.cosh(x), zero, np.tanh(x)])
        by_y = np.column_stack([zero, 1 / np.cosh(y), -np.tanh(y)])
        e_u, e_v = by_x - by_y, by_x + by_y
        e_u /= np.linalg.norm(e_u, axis=1)[:, None]
        e_v /= np.linalg.norm(e_v, axis=1)[:, None]
        total = cosh_p + cosh_q
        by_v = np.sqrt(cosh_p) * (sinh_p / cosh_p - sinh_p / total) / 2
        by_u = np.sqrt(cosh_q) * (sinh_q / cosh_q - sinh_q / total) / 2
        metric = self.scale * np.sqrt(cosh_p * cosh_q / total)
        return self._points(where, (position, e_u, e_v, np.cross(e_u, e_v)), metric, by_u + 1j * by_v)

    def metric(self, where: Complexes) -> Floats:
        (cosh_p, _), (cosh_q, _) = self.hyperbolic(where.imag), self.hyperbolic(where.real)
        return np.asarray(self.scale * np.sqrt(cosh_p * cosh_q / (cosh_p + cosh_q)))

    def hopf(self, where: Complexes) -> Complexes:
        return np.full(len(where), -0.25j * self.scale)

    @property
    def _root(self) -> complex:
        return complex(np.sqrt(-0.5j * self.scale))

    def isothermic(self, where: Complexes) -> Complexes:
        return self._root * where

    def from_isothermic(self, w: Complexes) -> Complexes:
        return w / self._root

    @property
    def whole_length(self) -> float:
        """The diagonal p = q, that is y = 0 from rim to rim."""
        half = float(asymptotic_to_conformal(np.array([self.outline.half_side]))[0])
        return float(2 * np.sqrt(2) * abs(self._root) * half)
