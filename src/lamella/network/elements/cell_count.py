"""What `network.cells` counts on a surface of elements.

Around the first hole it counts the curves of one family (that with more of them) that end on the hole's rim. Where the
principal directions follow the rim all of them run on across any loop around the hole, and their number is the period
of chi over l0. Where umbilics near the hole turn the directions against the rim, the curves that come back cancel in
the period, which may be any small number; on the rim they count all the same.

Without a hole it counts cells along the longest principal line. With umbilics of odd order w has no one value, and how
far u or v reaches would hang on where the surface is cut. Around one of them w goes over into itself turned about the
umbilic: a principal line is as long as twice the way from there. Around several it goes over into whatever: there the
diameter of a disc that is as large in the plane of w is counted on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.network.isothermic.holonomy import Holonomy, fixed_point_factors
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.pattern import Pattern

# of the longest principal line: a shorter way around a hole is none to count cells on
LEAST_LOOP = 1e-2
# of a period: what the rim of a hole may pass forth and back besides, without being counted
WAVE = 0.05


@dataclass(frozen=True)
class CellCount:
    """The length that is divided into cells.

    Attributes
    ----------
    length : float
        Isothermic length of what is counted on, sqrt(m): l0 times the number of cells.
    across : float
        Of the longest principal line, or what stands for it, sqrt(m).
    period : complex
        Of w around the first hole, sqrt(m), where the hole's curves are counted; 0: w comes back as -w, or no loop is
        counted on.
    """

    length: float
    across: float
    period: complex

    @classmethod
    def of(cls, iso: Isothermic, around: tuple[Holonomy, ...], pattern: Pattern) -> CellCount:
        """On a surface's coordinates; `around` its holes."""
        across = _across(iso)
        if not around:
            return cls(across, across, 0j)
        first = around[0]
        passed = max(curves_ending(iso, pattern, first.loop))
        if passed <= LEAST_LOOP * across:
            return cls(across, across, 0j)
        if first.sign < 0:
            return cls(passed, across, 0j)
        net = _larger(first.shift, pattern)
        return cls(net if passed <= (1 + WAVE) * net else passed, across, first.shift)

    def cells(self, step: float) -> float:
        """Number of cells at l0 = step, sqrt(m); in general not whole."""
        return self.length / step

    def net(self, pattern: Pattern) -> float:
        """Curves that a loop around the first hole crosses more in one sense than in the other, times l0, sqrt(m)."""
        return _larger(self.period, pattern)

    def follows_period(self, pattern: Pattern) -> bool:
        """Whether the number of cells is the period over l0: then it has to be whole."""
        return bool(self.period) and self.length == self.net(pattern)

    def step(self, cells: int, pattern: Pattern) -> float:
        """The step l0, sqrt(m), of a number of cells.

        Where curves come back to the hole's rim, the period is made whole if that leaves the number what it is.
        """
        net = self.net(pattern)
        if not self.follows_period(pattern) and net:
            multiple = pattern.multiple(self.period)
            whole = round(cells * net / self.length / multiple) * multiple
            if whole and abs(whole * self.length / net - cells) <= 0.5:
                return net / whole
        return self.length / cells


def _across(iso: Isothermic) -> float:
    """Isothermic length of the longest principal line, or what stands for it where w has no one value, sqrt(m)."""
    if not len(iso.odd):
        return iso.longest
    if len(iso.odd) == 1:
        umbilic = complex(fixed_point_factors(iso) @ np.array([piece.shift for piece in iso.transitions]))
        away = iso.on_rim - umbilic
        return 2 * float(max(np.abs(away.real).max(), np.abs(away.imag).max()))
    return 2 * float(np.sqrt(iso.area / np.pi))


def _larger(shift: complex, pattern: Pattern) -> float:
    """Curves of the family that a period crosses more of, times l0, sqrt(m)."""
    chi = shift * pattern.factor
    return max(abs(chi.real), abs(chi.imag))


def curves_ending(iso: Isothermic, pattern: Pattern, loop: int) -> tuple[float, float]:
    """How many A and how many B curves of the whole lattice end on a boundary loop, times l0, sqrt(m)."""
    connectivity = iso.mesh.connectivity
    nodes = connectivity.basis.edge_nodes[connectivity.rim_edges]
    chi = np.diff(iso.value[connectivity.rim_elements[:, None], nodes] * pattern.factor, axis=1)
    chi = chi[iso.mesh.loop[connectivity.rim_nodes[:, 0]] == loop]
    return float(np.abs(chi.imag).sum()), float(np.abs(chi.real).sum())
