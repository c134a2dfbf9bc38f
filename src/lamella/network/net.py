"""The net of any surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from lamella.base.errors import InputError
from lamella.base.progress import Progress, silent
from lamella.network.charts.charts_of import charts_of
from lamella.network.density_request import DensityRequest
from lamella.network.elements.element_network import Closing, ElementNetwork, element_network
from lamella.network.lattice.density import choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.network import Network
from lamella.network.pattern import NetKind, Pattern
from lamella.network.streamlines.applicability import check_traced, is_traced, reported_mean_curvature
from lamella.network.streamlines.streamline_network import TracedNetwork, traced_network
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface
from lamella.surface.umbilic import refuse_umbilic


def net(
    surface: Surface[Any],
    *,
    cells: int | None = None,
    spacing: float | None = None,
    minimum_length: float = 0.5,
    kind: NetKind = "lamellas",
    every: tuple[int, int] = (1, 1),
    normal_curvature: float | None = None,
    closing: Closing = "open",
    progress: Progress = silent,
) -> Network:
    """The network of lamellas, or of principal lines, on a surface.

    Parameters
    ----------
    surface : Surface
        A closed form, or a surface of elements: a film (`lamella.film`) or one of a mesh (`lamella.fit_cmc`,
        `fit_surface`).
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
    progress : callable
        Receives what is being done on surfaces of elements; `print` will do.

    Returns
    -------
    Network
        With `describe` and `warnings`: on surfaces of elements its umbilics, how many cells are missing where it does
        not meet itself, and how far lamellas are off their normal curvature.

    Raises
    ------
    InputError
        See `lamella.network.lattice.density.choose_density`; a sphere or a plane; or no two lamellas cross.

    See Also
    --------
    lamella.compute : a project's network with its warnings, strips and parts.

    Examples
    --------
    >>> import lamella
    >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
    >>> net
    Network(12 cells: 24 lamellas, 144 nodes, 120 faces)
    >>> print(f"{net.node_angles.min():.6f} to {net.node_angles.max():.6f} degrees")
    90.000000 to 90.000000 degrees
    """
    if not isinstance(surface, ClosedForm | ElementSurface):
        raise InputError(
            f"a net needs a surface, not a {type(surface).__name__}",
            "take a closed form, or what lamella.film, fit_cmc, fit_surface or make_surface returns",
        )
    DensityRequest.of(cells, spacing)
    pattern = Pattern(kind, every, normal_curvature)
    made: TracedNetwork | ElementNetwork
    if is_traced(surface, pattern):
        check_traced(surface, pattern, closing)
        refuse_umbilic(surface)
        made = traced_network(
            charts_of(surface),
            pattern,
            mean_curvature=reported_mean_curvature(surface, pattern),
            cells=cells,
            spacing=spacing,
            minimum_length=minimum_length,
            progress=progress,
        )
    elif isinstance(surface, ElementSurface):
        made = element_network(
            surface,
            cells=cells,
            spacing=spacing,
            closing=closing,
            minimum_length=minimum_length,
            pattern=pattern,
            progress=progress,
        )
    else:
        density = choose_density(surface, cells=cells, spacing=spacing, pattern=pattern)
        return replace(trace_closed_form(surface, density, minimum_length=minimum_length), surface=surface)
    return replace(made.network, surface=surface, figures=made.describe(), notes=tuple(made.warnings()))
