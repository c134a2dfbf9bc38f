"""Where a boundary is on its way to a net that closes, and ways that do not lead there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes
from lamella.network.adjust.film_net import FilmNet


@dataclass(frozen=True)
class Aim:
    """A net on its way to whole shifts (t,), in cells of a lattice with a spacing l0 (sqrt(m)).

    `sensitivities` (t, p + 1) are those of `Films.cell_sensitivities`, carried on from the step before; None: to be
    found.
    """

    net: FilmNet
    whole: Complexes
    step: float
    sensitivities: Complexes | None = None

    @property
    def residuals(self) -> Complexes:
        """What the shifts lack to the whole ones, (t,), cells."""
        return np.asarray(self.whole - self.net.cells(self.step), np.complex128)

    @property
    def size(self) -> float:
        """Square root of the integral of |change of dw|^2 if they were rounded: it does not depend on the cut."""
        return self.net.whole.size(self.residuals)


class LostError(ArithmeticError):
    """Whole shifts that are not reached; `aim` is how far it went, `missed` what is left, cells."""

    def __init__(self, aim: Aim, reason: str) -> None:
        self.aim, self.missed = aim, worst(aim.residuals)
        super().__init__(f"misses of up to {self.missed:.2g} cells are left ({reason})")


class StuckError(LostError):
    """Whole shifts on the way to which steps get shorter."""


def worst(residuals: Complexes) -> float:
    return float(max(np.abs(residuals.real).max(initial=0.0), np.abs(residuals.imag).max(initial=0.0)))
