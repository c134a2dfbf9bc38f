"""Surfaces of constant mean curvature known in closed form: they answer as `lamella.surface.surface.Surface` does.

Each is given in conformal parameters zeta = U + i V, where the metric is lambda^2 (dU^2 + dV^2), together with
its Hopf differential Q dzeta^2, which is holomorphic because H is constant. Everything else follows:
the second fundamental form is H lambda^2 (dU^2 + dV^2) + 2 Re(Q dzeta^2), so that H^2 - K = (2 |Q| / lambda^2)^2,
and isothermic coordinates, whose lines are the principal ones, are u + i v = w = integral of sqrt(2 Q) dzeta.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.message import Message
from lamella.base.result import Shown
from lamella.surface.closed_forms import sampling
from lamella.surface.closed_forms.outline import Outline
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.points import SurfacePoints


class ClosedForm(ABC, Shown):
    """A closed-form surface; places on it are complex parameters ``where = U + i V``, shape (n,).

    The surface normal is n = e_U x e_V. Signs and names are those of `lamella`'s package docstring.

    Attributes
    ----------
    kind : str
        Name in a project file.
    mean_curvature : float
        H, 1/m, for the normal e_U x e_V.
    outline : Outline
        The piece of the parameter plane the surface covers.
    hopf_order : int
        Order m of the zero of Q at zeta = 0 (0: none). A zero is an umbilic with 2 (m + 2) lamella rays.
    """

    kind: ClassVar[str]
    mean_curvature: float
    outline: Outline
    hopf_order: int = 0

    def _line(self) -> str:
        return f"mean curvature {self.mean_curvature:.6g} 1/m, {self.area():.4g} m2"

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        """See `lamella.surface.surface.Surface.has_lattice`."""
        return normal_curvature in (None, self.mean_curvature)

    @abstractmethod
    def at(self, where: Complexes) -> SurfacePoints:
        """Everything about places `where`, shape (n,), in one evaluation."""

    @abstractmethod
    def metric(self, where: Complexes) -> Floats:
        """Conformal factor lambda, m per unit of zeta, shape (n,)."""

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
    def whole_length(self) -> float:
        """Isothermic length that holds a whole number of cells, sqrt(m).

        Once around the axis; on a simply connected surface, along its longest principal line.
        """

    def places(self, rows: int, columns: int) -> tuple[Complexes, Integers]:
        """A grid of places over the outline and its faces, see `lamella.surface.closed_forms.sampling.grid`."""
        return sampling.grid(self.outline, rows, columns)

    def check_places(self) -> Complexes:
        """A grid over the whole outline."""
        return self.places(17, 17)[0]

    def check_points(self) -> SurfacePoints:
        """Everything about these places."""
        return self.at(self.check_places())

    def mesh(self, tolerance: float = 1e-3) -> SurfaceMesh:
        """The surface sampled for files and pictures.

        Parameters
        ----------
        tolerance : float
            Largest distance of the faces from the surface over the diagonal of the bounding box, as far as
            `lamella.surface.closed_forms.sampling.MOST_LINES` vertices along either parameter allow.
        """
        return sampling.surface_mesh(self.places, self.at, tolerance)

    def area(self) -> float:
        """Area by quadrature, m^2."""
        return sampling.area(self.outline, self.metric)

    def measured_mean_curvature(self, where: Complexes, step: float = 1e-3) -> Floats:
        """H from positions and normals alone, by differences over `step`, 1/m, (n,)."""
        return sampling.measured_mean_curvature(self.at, where, step)

    def singular_orders(self) -> tuple[int, ...]:
        """The order of the zero of Q, if there is one."""
        return (self.hopf_order,) if self.hopf_order else ()

    def describe(self) -> dict[str, Any]:
        """Facts worth telling beside the project's own numbers (for the summary)."""
        return {}

    def warnings(self) -> tuple[Message, ...]:
        """What a user should know about this surface before building it."""
        return ()

    def _points(
        self,
        where: Complexes,
        frame: tuple[Floats, Floats, Floats, Floats],
        metric: Floats,
        log_metric_gradient: Complexes,
        log_hopf_gradient: Complexes | float = 0.0,
    ) -> SurfacePoints:
        """Points from position, e_U, e_V, n; lambda; and d/dU + i d/dV of ln lambda and of ln |Q|."""
        return SurfacePoints(
            *frame,
            np.full(len(where), self.mean_curvature),
            2 * self.hopf(where) / metric**2,
            (log_hopf_gradient / 2 - log_metric_gradient) / metric,
        )
