"""Domains whose sides are lamella directions, as principal lines see them: turned by 45 degrees."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.lattice.domain import RectangleDomain, ScherkDomain, centred
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.closed_forms.closed_form import ClosedForm

# halvings that leave rounding only
DOMAIN_HALVINGS = 60


class PrincipalRectangle(RectangleDomain):
    """A rectangle that principal lines cross at 45 degrees: a node or a cell in its middle."""

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, pattern)
        middle = self.outline.corner + (self.outline.width + 1j * self.outline.height) / 2
        self.origin = middle / self.slope + centred(surface.whole_length / step)

    def extent(self) -> tuple[Floats, Floats]:
        width, height = self.outline.width, self.outline.height
        corners = self.outline.corner + np.array([0, width, width + 1j * height, 1j * height])
        cells = corners / self.slope - self.origin
        return cells.real, cells.imag

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        zeta = self.place(np.zeros(len(base), np.int64), base) - self.outline.corner
        rate = self.slope * direction
        across = np.stack([-zeta.real, self.outline.width - zeta.real]) / rate.real
        up = np.stack([-zeta.imag, self.outline.height - zeta.imag]) / rate.imag
        start, end = np.maximum(across.min(0), up.min(0)), np.minimum(across.max(0), up.max(0))
        return np.asarray(start, np.float64), np.asarray(end, np.float64)


class PrincipalScherk(ScherkDomain):
    """Scherk's curved diamond, which is convex, and symmetric about its diagonals, as principal lines cross it."""

    def extent(self) -> tuple[Floats, Floats]:
        tips = self.reach * np.array([1, 1j, -1, -1j]) / self.slope - self.origin
        return np.asarray(tips.real, np.float64), np.asarray(tips.imag, np.float64)

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        zeta = self.place(np.zeros(len(base), np.int64), base)
        rate = self.slope * direction
        # the place nearest to the middle is the middle of the chord
        foot = -(zeta * np.conj(rate)).real / abs(rate) ** 2
        inside, outside = np.zeros(len(base)), np.full(len(base), 2 * self.reach / abs(rate))
        for _ in range(DOMAIN_HALVINGS):
            half = (inside + outside) / 2
            at = zeta + (foot + half) * rate
            within = np.abs(self._asymptotic(at.imag)) + np.abs(self._asymptotic(at.real)) < self.limit
            inside, outside = np.where(within, half, inside), np.where(within, outside, half)
        return np.asarray(foot - inside, np.float64), np.asarray(foot + inside, np.float64)
