"""The helicoid, the ruled minimal surface: lamellas are its rulings and its helices."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.errors import InputError, require_positive
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Rectangle
from lamella.surface.points import SurfacePoints


class Helicoid(ClosedForm):
    """(c sinh U cos V, c sinh U sin V, +-c V) with c = |pitch| / 2 pi; normal e_U x e_V, H = 0.

    Parameters
    ----------
    pitch : float
        Rise of a full turn, m; negative: left-handed.
    inner_radius, outer_radius : float
        0 <= inner < outer, m.
    turns : float
        Number of full turns.

    Examples
    --------
    >>> import lamella
    >>> lamella.Helicoid(5.0, 1.0, 4.0, 1.0)
    Helicoid(mean curvature 0 1/m, 49.75 m2)
    """

    kind = "helicoid"
    mean_curvature = 0.0
    outline: Rectangle

    def __init__(self, pitch: float, inner_radius: float, outer_radius: float, turns: float) -> None:
        require_positive(pitch=abs(pitch), outer_radius=outer_radius, turns=turns)
        if not 0 <= inner_radius < outer_radius:
            raise InputError(
                f"inner_radius = {inner_radius:g} m has to be at least 0 and below outer_radius = {outer_radius:g} m",
                "swap or change them",
                "inner_radius",
            )
        self._c = abs(pitch) / (2 * np.pi)
        self._sense = float(np.sign(pitch))
        start, end = np.arcsinh(inner_radius / self._c), np.arcsinh(outer_radius / self._c)
        self.outline = Rectangle(complex(start, 0), float(end - start), 2 * np.pi * turns)

    def at(self, where: Complexes) -> SurfacePoints:
        c, s = np.cos(where.imag), np.sin(where.imag)
        r, cosh = self._c * np.sinh(where.real), np.cosh(where.real)
        tanh, sech, zero = np.tanh(where.real), self._sense / cosh, np.zeros_like(c)
        position = np.column_stack([r * c, r * s, self._sense * self._c * where.imag])
        e_u = np.column_stack([c, s, zero])
        e_v = np.column_stack([-tanh * s, tanh * c, sech])
        normal = np.column_stack([sech * s, -sech * c, tanh])
        return self._points(where, (position, e_u, e_v, normal), self._c * cosh, tanh.astype(complex))

    def metric(self, where: Complexes) -> Floats:
        return np.asarray(self._c * np.cosh(where.real))

    def hopf(self, where: Complexes) -> Complexes:
        return np.full(len(where), 0.5j * self._sense * self._c)

    @property
    def _root(self) -> complex:
        return complex(np.sqrt(1j * self._sense * self._c))

    def isothermic(self, where: Complexes) -> Complexes:
        return self._root * where

    def from_isothermic(self, w: Complexes) -> Complexes:
        return w / self._root

    @property
    def whole_length(self) -> float:
        """Principal lines cross the parameter rectangle at 45 degrees: the narrow side decides."""
        return float(np.sqrt(2 * self._c) * min(self.outline.width, self.outline.height))
