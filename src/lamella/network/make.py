"""The network stage as one function."""

from __future__ import annotations

from lamella.network.density import choose_density
from lamella.network.network import Network
from lamella.network.trace import trace_closed_form
from lamella.surface.closed_form import ClosedForm


def make_network(
    surface: ClosedForm, *, cells: int | None = None, spacing: float | None = None, minimum_length: float = 0.5
) -> Network:
    """The network of lamellas on a surface.

    Parameters
    ----------
    surface : ClosedForm
    cells : int, optional
        A lamellas crossed once around the axis; on a simply connected surface, cells along its longest principal
        line. 24 when spacing is not given either.
    spacing : float, optional
        Wanted median cell edge, m; the nearest whole number of cells is taken.
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.

    Raises
    ------
    InputError
        See `lamella.network.density.choose_density`; or no two lamellas cross.
    """
    density = choose_density(surface, cells=cells, spacing=spacing)
    return trace_closed_form(surface, density, minimum_length=minimum_length)
