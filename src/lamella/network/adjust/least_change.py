"""The least change of a boundary that undoes what a net misses, to first order and within limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.adjust.film_net import FilmNet
from lamella.network.adjust.least_squares_within import least_squares_within

# range of the logarithm of the lattice's spacing
SPACING = 0.1
# how much more a miss of a cell (see `Isothermic.dirichlet`) weighs than a full range
WEIGHT = 1e4


@dataclass(frozen=True)
class LeastChange:
    """Least squares of p shares and of the logarithm of the spacing.

    Of the shares themselves, or of what they differ by from those that they shall be near, with what they cannot undo
    weighing more.

    Attributes
    ----------
    system, right : (m, p + 1), (m,)
    now : (p + 1,)
        Where the parameters are.
    """

    system: Floats
    right: Floats
    now: Floats

    @classmethod
    def of(cls, net: FilmNet, rates: Complexes, residuals: Complexes, near: Floats | None = None) -> LeastChange:
        """For what a net misses.

        Parameters
        ----------
        net : FilmNet
        rates : (t, p + 1) complex
            Of the shifts in cells, see `FilmNet.cell_sensitivities`.
        residuals : (t,) complex
            What is to be undone, cells.
        near : (p,), optional
            Shares.
        """
        measured, missed = net.whole.measured(rates), net.whole.measured(residuals)
        sensitivities = np.vstack([measured.real, measured.imag])
        sensitivities[:, -1] *= SPACING
        wanted = np.concatenate([missed.real, missed.imag])
        now = np.append(net.shares, 0.0)
        system = np.vstack([WEIGHT * sensitivities, np.eye(len(now))])
        middle = np.zeros(len(now)) if near is None else np.append(near, 0.0)
        return cls(system, np.concatenate([WEIGHT * (wanted + sensitivities @ now), middle]), now)

    def within(self, limits: Floats, planes: tuple[Floats, Floats]) -> tuple[Floats, float]:
        """The change (p + 1,) within limits, and what it costs.

        Parameters
        ----------
        limits : (n, 3, p)
            Shares x are allowed where |limits x| <= 1.
        planes : (z, p) and (z,)
            And where normals x <= bounds.
        """
        count = len(self.now)
        every = np.zeros((len(limits) + 1, 3, count))
        every[:-1, :, :-1] = limits
        every[-1, 0, -1] = 1
        normals, bounds = planes
        finite = np.isfinite(bounds)
        # the spacing moves no umbilic
        normals = np.column_stack([normals, np.zeros(len(normals))])[finite]
        found = least_squares_within(self.system, self.right, every, (normals, bounds[finite]))
        change = found - self.now
        change[-1] *= SPACING
        return change, self._cost(found)

    @property
    def least_cost(self) -> float:
        """What it costs without limits."""
        return self._cost(np.asarray(np.linalg.lstsq(self.system, self.right, rcond=None)[0], np.float64))

    def _cost(self, place: Floats) -> float:
        return float(((self.system @ place - self.right) ** 2).sum() / 2)
