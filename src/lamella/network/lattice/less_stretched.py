"""What to change where cells stretch too much: with how many of them, or how much less of the surface, a net is made.

Next to where a surface runs to infinity a cell's length is an integral of nearly a pole. Whether that can be measured
depends on where curves happen to lie: one more cell may be too many again. So both are tried out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from lamella.base.errors import InputError
from lamella.network.lattice.density import TRIED_NODES_MAX, Density, choose_density
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.scherk import Scherk

# by which the number of cells, and the distance from infinity, grow from one trial to the next
CELLS_BY, DISTANCE_BY = 1.25, 4.0
STRETCH_TRIALS_MAX = 12


def less_stretched(surface: ClosedForm, density: Density, trace: Callable[[ClosedForm, Density], Any]) -> str:
    """The number of cells, and the part of the surface, nearest to the present ones of those tried that make a net.

    Parameters
    ----------
    surface : ClosedForm
    density : Density
        With which cells stretch too much.
    trace : callable
        Makes the net; raises an `InputError` where that cannot be.
    """

    def makes(other: ClosedForm, cells: int) -> bool:
        try:
            there = choose_density(other, cells=cells, pattern=density.pattern)
            if there.estimated_nodes > TRIED_NODES_MAX:
                return False
            trace(other, there)
        except InputError:
            return False
        return True

    counts = (int(np.ceil(density.cells * CELLS_BY**k)) for k in range(1, STRETCH_TRIALS_MAX + 1))
    cells = next((count for count in counts if makes(surface, count)), None)
    ways = [f"write cells = {cells}"] if cells else []
    if isinstance(surface, Scherk):
        left = np.pi / 2 - surface.extent
        extents = (float(f"{np.pi / 2 - left * DISTANCE_BY**k:.9g}") for k in range(1, STRETCH_TRIALS_MAX + 1))
        extent = next((value for value in extents if makes(Scherk(value, surface.scale), density.cells)), None)
        ways += [f"end the surface earlier: extent = {extent:.9g}"] if extent else []
    return ", or ".join(ways) or "end the surface earlier"
