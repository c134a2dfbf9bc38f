"""The network stage as one function."""

from __future__ import annotations

from typing import Any

from lamella.base.errors import InputError
from lamella.network.charts.ground_of import ground_of
from lamella.network.density_request import DensityRequest
from lamella.network.elements.element_network import Closing, element_network
from lamella.network.lattice.density import choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.network import Network
from lamella.network.pattern import NetKind, Pattern
from lamella.network.streamlines.applicability import check_traced, is_traced, told_mean_curvature
from lamella.network.streamlines.streamline_network import traced_network
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface
from lamella.surface.umbilic import refuse_umbilic


def make_network(
    surface: Surface[Any],
    *,
    cells: int | None = None,
    spacing: float | None = None,
    minimum_length: float = 0.5,
    kind: NetKind = "lamellas",
    every: tuple[int, int] = (1, 1),
    normal_curvature: float | None = None,
    closing: Closing = "open",
) -> Network:
    """The network of lamellas, or of principal lines, on a surface.

    Parameters
    ----------
    surface : Surface
        A closed form, or a surface of elements: one that was found, or a mesh (`lamella.make_surface`,
        `lamella.find_film`).
    cells : int, optional
        A lamellas crossed once around the axis, or around the first hole; on a simply connected surface, cells along
        its longest principal line. 24 when spacing is not given either.
    spacing : float, optional
        Wanted median cell edge, m; the nearest whole number of cells is taken, or on surfaces of elements a spacing up
        to a tenth away with which the net closes and its umbilics are nodes.
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.
    kind : "lamellas" or "principal"
        Principal lines: for panels that are planar quads; no strip stands on them straight or with one radius.
    every : (int, int)
        Of the net of that density one in so many A and B curves is kept.
    normal_curvature : float, optional
        Of all lamellas, 1/m, where it is not to be H: 0 for asymptotic lines. Where the surface is none of revolution
        the lines start from even seeds, and a run says where there are none. Needed where the mean curvature varies
        (meshes kept as they are), unless principal lines are made.
    closing : "open" or "round"
        Where the net of a surface of elements misses whole cells: a seam, or bent to the nearest whole numbers.

    Raises
    ------
    InputError
        See `lamella.network.lattice.density.choose_density`; a sphere or a plane; or no two lamellas cross.

    See Also
    --------
    lamella.compute : a project's network with its warnings, strips and parts.
    """
    if not isinstance(surface, ClosedForm | ElementSurface):
        raise InputError(
            f"a net needs a surface, not a {type(surface).__name__}",
            'take a closed form, what make_surface returns, or find_film(...).surface("form-found")',
        )
    DensityRequest.of(cells, spacing)
    pattern = Pattern(kind, every, normal_curvature)
    if is_traced(surface, pattern):
        check_traced(surface, pattern, closing)
        refuse_umbilic(surface)
        return traced_network(
            ground_of(surface),
            pattern,
            mean_curvature=told_mean_curvature(surface, pattern),
            cells=cells,
            spacing=spacing,
            minimum_length=minimum_length,
        ).network
    if isinstance(surface, ElementSurface):
        return element_network(
            surface, cells=cells, spacing=spacing, closing=closing, minimum_length=minimum_length, pattern=pattern
        ).network
    density = choose_density(surface, cells=cells, spacing=spacing, pattern=pattern)
    return trace_closed_form(surface, density, minimum_length=minimum_length)
