"""Enneper's surfaces of any order, with a flat point of order n - 2 in the middle."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.errors import InputError, require_positive
from lamella.base.message import Message
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Disc
from lamella.surface.points import SurfacePoints


class Enneper(ClosedForm):
    """Weierstrass data g = zeta^(n-1), f = 2: x = Re of the integral of (1 - g^2, i (1 + g^2), 2 g) dzeta.

    lambda = 1 + |g|^2, Q = -(n - 1) zeta^(n-2), normal e_U x e_V, H = 0 (all lengths times `scale`).

    Parameters
    ----------
    order : int
        n >= 2: 2 is the classical surface, 3 has one hexagonal node.
    radius : float
        Radius of the parameter disc, no unit.
    scale : float
        m per unit of the parametrisation.

    Examples
    --------
    >>> import lamella
    >>> lamella.Enneper(order=3, radius=0.9, scale=2.0).singular_orders()
    (1,)
    """

    kind = "enneper"
    mean_curvature = 0.0
    outline: Disc

    def __init__(self, order: int, radius: float, scale: float = 1.0) -> None:
        require_positive(radius=radius, scale=scale)
        if int(order) != order or order < 2:
            raise InputError(
                f"order = {order!r} is no whole number of at least 2", "2 is the classical surface", "order"
            )
        self.order, self.scale = order, scale
        self.outline = Disc(radius)
        self.hopf_order = order - 2

    @property
    def crossing_radius(self) -> float:
        """Parameter radius from which on the surface cuts itself, (2 n - 1)^(1 / (2 n - 2))."""
        return float((2 * self.order - 1) ** (1 / (2 * self.order - 2)))

    def warnings(self) -> tuple[Message, ...]:
        if self.outline.radius < self.crossing_radius:
            return ()
        return (
            Message(
                "surface_crosses",
                f"radius = {self.outline.radius:g}: Enneper's surface of order {self.order} cuts through "
                f"itself from a parameter radius of {self.crossing_radius:.4g} on; it cannot be built there",
            ),
        )

    def at(self, where: Complexes) -> SurfacePoints:
        n = self.order
        high = where ** (2 * n - 1) / (2 * n - 1)
        position = self.scale * np.column_stack(
            [(where - high).real, (1j * (where + high)).real, (2 * where**n / n).real]
        )
        g = where ** (n - 1)
        size = 1 + np.abs(g) ** 2
        phi = np.column_stack([1 - g**2, 1j * (1 + g**2), 2 * g]) / size[:, None]
        normal = np.column_stack([2 * g.real, 2 * g.imag, size - 2]) / size[:, None]
        frame = position, np.ascontiguousarray(phi.real), np.ascontiguousarray(-phi.imag), normal
        k, r2 = 2 * n - 2, np.abs(where) ** 2
        return self._points(
            where,
            frame,
            self.scale * size,
            k * np.abs(where) ** (k - 2) * where / size,
            # at the flat point itself the gradient is infinite along the radius, and zero across it by symmetry
            self.hopf_order * where / np.where(r2 > 0, r2, np.inf),
        )

    def metric(self, where: Complexes) -> Floats:
        return np.asarray(self.scale * (1 + np.abs(where) ** (2 * self.order - 2)))

    def hopf(self, where: Complexes) -> Complexes:
        return np.asarray(-self.scale * (self.order - 1) * where**self.hopf_order)

    @property
    def _root(self) -> complex:
        """sqrt(2 Q) at zeta = 1, times 2 / n."""
        return 2j / self.order * float(np.sqrt(2 * self.scale * (self.order - 1)))

    def isothermic(self, where: Complexes) -> Complexes:
        return np.asarray(self._root * where ** (self.order / 2))

    def from_isothermic(self, w: Complexes) -> Complexes:
        return np.asarray((w / self._root) ** (2 / self.order))

    @property
    def whole_length(self) -> float:
        """Twice the isothermic radius: from rim to rim past the middle."""
        return float(2 * abs(self._root) * self.outline.radius ** (self.order / 2))
