"""How dense a net is to be, read once: a number of cells, or a median cell edge; and what is refused for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.errors import InputError
from lamella.base.limits import CELLS_MIN, DEFAULT_CELLS
from lamella.base.wording import rounded

# a net of this many nodes takes a few minutes to compute and write
NODES_MAX = 500_000
# measured at 100,000 nodes for computing and writing, plus a fixed share for the program itself
BYTES_PER_NODE, BYTES_FIXED = 9_000, 150_000_000


@dataclass(frozen=True)
class DensityRequest:
    """A number of cells or a spacing, of which exactly one is given; make it with `of`.

    Attributes
    ----------
    cells : int or None
        What they count, the algorithm of the net says.
    spacing : float or None
        Median cell edge, m.
    is_default : bool
        Whether neither was given.
    """

    cells: int | None
    spacing: float | None
    is_default: bool = False

    @classmethod
    def of(cls, cells: int | None = None, spacing: float | None = None) -> DensityRequest:
        """The request that these values make; `DEFAULT_CELLS` when neither is given.

        Raises
        ------
        InputError
            Both are given; no number of cells; no length.
        """
        if cells is not None and spacing is not None:
            raise InputError(
                f"both cells = {cells} and spacing = {spacing:g} m are given", "give one of the two", "spacing"
            )
        if cells is not None and (isinstance(cells, bool) or not isinstance(cells, int | np.integer)):
            raise InputError(f"cells = {cells!r} is not a whole number", "write a whole number", "cells")
        if spacing is not None and not 0 < spacing < np.inf:
            raise InputError(f"spacing = {spacing!r} m is no length", "write a number above 0, in m", "spacing")
        if spacing is None:
            return cls(DEFAULT_CELLS if cells is None else int(cells), None, cells is None)
        return cls(None, spacing)

    @property
    def parameter(self) -> str:
        """The parameter that errors are reported for."""
        return "cells" if self.spacing is None else "spacing"

    def __str__(self) -> str:
        """As reports name it."""
        if self.spacing is not None:
            return f"spacing = {self.spacing:g} m"
        return f"cells = {self.cells}" + (" (default)" if self.is_default else "")

    def refuse_few(self, cells: int) -> None:
        """Refuse a net of fewer than `CELLS_MIN` cells.

        Raises
        ------
        InputError
        """
        if cells < CELLS_MIN:
            raise InputError(
                f"{cells} cells, at least {CELLS_MIN} are needed", f"write cells = {CELLS_MIN} or more", self.parameter
            )

    def refuse_wide(self, fit: float, widest: float) -> None:
        """Refuse a spacing with which fewer than `CELLS_MIN` cells fit on the surface.

        Parameters
        ----------
        fit : float
            Cells that fit with it.
        widest : float
            Largest spacing with which enough of them do, m.

        Raises
        ------
        InputError
        """
        if fit < CELLS_MIN:
            raise InputError(
                f"spacing = {self.spacing:g} m leaves {fit:.2g} cells across the surface, at least {CELLS_MIN} are "
                "needed",
                f"choose a spacing of at most {rounded(widest, up=False):g} m",
                self.parameter,
            )

    def refuse_many(self, nodes: float, cells: float, spacing: float) -> None:
        """Refuse a net of more than `NODES_MAX` nodes.

        Parameters
        ----------
        nodes : float
            Estimated.
        cells : float
            Largest number of cells with which the net is small enough.
        spacing : float
            Smallest spacing with which it is, m.

        Raises
        ------
        InputError
        """
        if nodes <= NODES_MAX:
            return
        memory = (BYTES_FIXED + BYTES_PER_NODE * nodes) / 1e9
        if cells < CELLS_MIN:
            remedy = "the surface is too long for its width: shorten or widen it"
        elif self.spacing is None:
            remedy = f"at most {int(cells)} cells fit this surface"
        else:
            remedy = f"choose a spacing of at least {rounded(1.01 * spacing, up=True):g} m"
        raise InputError(
            f"{self} would make about {_number(nodes)} nodes and take about {_number(memory)} GB of memory "
            f"(limit {NODES_MAX:,} nodes)",
            remedy,
            self.parameter,
        )


def _number(number: float) -> str:
    return f"{number:,.0f}" if number < 1e12 else f"{number:.3g}"
