"""Which curves of the isothermic lattice are the curves of a net.

w = u + i v are isothermic coordinates, principal lines u, v = const. The curves of a net are Im chi = whole (family A)
and Re chi = whole (family B) of the cell coordinate

    chi = (1 + i) w / l0 = ((u - v) + i (u + v)) / l0     lamellas: A is u + v = const, B is u - v = const
    chi = w / l0         = (u + i v) / l0                 principal lines: A is v = const, B is u = const

so that a principal line passes as many cells of either net: along their sides, or across them from corner to corner.
Of these curves every p-th of family A and every q-th of family B may be kept, counted from the lattice's origin.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm
from typing import Literal

import numpy as np

from lamella.base.arrays import Complexes
from lamella.base.errors import InputError

# share of a period beyond which the curves of a family count as crossed by its loop
CROSSED = 1e-3
# curves around a hole
LEAST_KEPT = 3
NetKind = Literal["lamellas", "principal"]


@dataclass(frozen=True)
class Pattern:
    """Which curves of the lattice a net has.

    Attributes
    ----------
    kind : "lamellas" or "principal"
    every : (int, int)
        p, q: one in p curves of family A is kept, one in q of family B.
    normal_curvature : float, optional
        Of the curves, 1/m, where it is not H: they cross at other angles than 90 degrees then.
    angle : float
        Degrees; what a surface of other node angles than 90 was found for, which node angles are compared with.
    """

    kind: NetKind = "lamellas"
    every: tuple[int, int] = (1, 1)
    normal_curvature: float | None = None
    angle: float = 90.0

    @property
    def factor(self) -> complex:
        """chi l0 / w."""
        return 1 + 1j if self.kind == "lamellas" else 1 + 0j

    @property
    def no_strips(self) -> str:
        """Why no strips are made for these curves, "" where they are."""
        if self.kind == "principal":
            return (
                "a strip normal to the surface along a principal line is developable, but unrolls neither straight nor "
                "with one radius"
            )
        return ""

    @property
    def edge(self) -> float:
        """Cell edge of the whole lattice times mu over l0."""
        return 1 / abs(self.factor)

    def multiple(self, shift: complex) -> int:
        """What the number of cells on a loop with a period of w has to be a multiple of, so that the net closes."""
        chi = shift * self.factor
        crossed = (abs(part) > CROSSED * abs(chi) for part in (chi.imag, chi.real))
        return lcm(*(n for n, some in zip(self.every, crossed, strict=True) if some))

    def cells(self, w: Complexes, step: float) -> Complexes:
        """chi in kept cells, of isothermic coordinates w for l0 = step (sqrt(m))."""
        whole = w * (self.factor / step)
        return np.asarray(whole.real / self.every[1] + 1j * (whole.imag / self.every[0]), np.complex128)

    def isothermic(self, chi: Complexes, step: float) -> Complexes:
        """w (sqrt(m)) of chi in kept cells."""
        whole = chi.real * self.every[1] + 1j * (chi.imag * self.every[0])
        return np.asarray(whole * (step / self.factor), np.complex128)

    def crossed(self, shift: complex, step: float) -> tuple[float, float]:
        """Kept A and B curves that are crossed on a loop with a period of w (sqrt(m))."""
        chi = complex(self.cells(np.array([shift]), step)[0])
        return abs(chi.imag), abs(chi.real)


LAMELLAS = Pattern()


def fitting_cells(cells: int, multiple: int, around: str, *, given: bool) -> int:
    """A number of cells around a hole from which every n-th curve can be left out all the way around.

    Parameters
    ----------
    cells : int
        As given, or as wanted.
    multiple : int
        See `Pattern.multiple`.
    around : str
        The hole.
    given : bool
        Whether the number was asked for; else the nearest one that fits is taken.

    Raises
    ------
    InputError
        A given number does not fit; or fewer than `LEAST_KEPT` would be left.
    """
    nearest = max(round(cells / multiple), LEAST_KEPT) * multiple
    if cells == nearest or (multiple > 1 and not given and cells >= LEAST_KEPT):
        return nearest
    if multiple == 1:
        return cells
    below, above = cells // multiple * multiple, (cells // multiple + 1) * multiple
    fits = [str(n) for n in (below, above) if n >= LEAST_KEPT * multiple] or [str(LEAST_KEPT * multiple)]
    why = f"is no multiple of {multiple}" if cells % multiple else f"leaves {cells // multiple}, at least {LEAST_KEPT}"
    raise InputError(
        f"cells = {cells} around {around} {why}"
        + (": with every n-th curve kept the net would not meet itself" if cells % multiple else " are needed"),
        f"write cells = {' or '.join(fits)}, or another every",
        "cells",
    )
