"""The network stage as one function."""

from __future__ import annotations

from lamella.network.density import choose_density
from lamella.network.lines import check_traced, ground_of, is_traced
from lamella.network.network import Network
from lamella.network.pattern import NetKind, Pattern
from lamella.network.trace import trace_closed_form
from lamella.network.traced_network import traced_network
from lamella.surface.closed_form import ClosedForm


def make_network(
    surface: ClosedForm,
    *,
    cells: int | None = None,
    spacing: float | None = None,
    minimum_length: float = 0.5,
    kind: NetKind = "lamellas",
    every: tuple[int, int] = (1, 1),
    normal_curvature: float | None = None,
) -> Network:
    """The network of lamellas, or of principal lines, on a surface.

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
    kind : "lamellas" or "principal"
        Principal lines: for panels that are planar quads; no strip stands on them straight or with one radius.
    every : (int, int)
        Of the net of that density one in so many A and B curves is kept.
    normal_curvature : float, optional
        Of all lamellas, 1/m, where it is not to be H: 0 for asymptotic lines. Where the surface is none of revolution
        the lines start from even seeds, and a run says where there are none.

    Raises
    ------
    InputError
        See `lamella.network.density.choose_density`; or no two lamellas cross.
    """
    pattern = Pattern(kind, every, normal_curvature)
    if is_traced(surface, pattern):
        check_traced(surface, pattern)
        return traced_network(
            ground_of(surface),
            pattern,
            mean_curvature=surface.mean_curvature,
            cells=cells,
            spacing=spacing,
            minimum_length=minimum_length,
        ).network
    density = choose_density(surface, cells=cells, spacing=spacing, pattern=pattern)
    return trace_closed_form(surface, density, minimum_length=minimum_length)
