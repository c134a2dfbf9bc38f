"""The film between boundary curves, as the library offers it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from numpy.typing import ArrayLike

from lamella.base.drawing_origin import origin_figure, reported_from
from lamella.base.progress import Progress, silent
from lamella.surface.boundary.checks import check_corner_count, check_loops
from lamella.surface.boundary.curve import Loop
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film, notes_on, remarks_on
from lamella.surface.form_finding.given_loops import given_loops, refuse_both


def film(
    loops: Sequence[Loop | ArrayLike] | Loop,
    mean_curvature: float = 0.0,
    *,
    volume: float | None = None,
    tolerance: float = 2e-3,
    order: int = 4,
    branch: Literal["stable", "unstable"] = "stable",
    most_nodes: int = 100_000,
    progress: Progress = silent,
) -> ElementSurface:
    """The surface of constant mean curvature between boundary curves: a soap film, or an inflated one.

    Parameters
    ----------
    loops : sequence of Loop
        The outer one first, then those of the holes (`lamella.circle`, `spline`, `polyline`, `ellipse`, `joined`,
        `read_loop`); points (n, 3), m, mean the spline through them. The surface's normal follows the outer loop by
        the right-hand rule.
    mean_curvature : float
        H, 1/m.
    volume : float, optional
        Instead of H: between the surface and lids over the loops, m^3.
    tolerance : float
        Largest |H - H0| over the curvature scale: it decides how many elements there are.
    order : int
        Of the elements, 2 to 4.
    branch : "stable" or "unstable"
        Which film, where there are two.
    most_nodes : int
        Limit of the elements' nodes.
    progress : callable
        Is called with what is done.

    Returns
    -------
    ElementSurface
        `describe` has its stability, volume, numbers of nodes and steps; `warnings` what to know before building it.

    Raises
    ------
    InputError
        There is no such film, or none was found; loops that cross or touch; both mean_curvature and volume.

    Examples
    --------
    The catenoid between two rings, and the radius of its neck:

    >>> import lamella
    >>> film = lamella.film([lamella.circle((0, 0, z), 3.0) for z in (0.0, 3.2)], tolerance=0.02)
    >>> places, nearest = film.closest([[2.0, 0.0, 1.6]])
    >>> print(f"{film.describe()['stability']}, {nearest[0, 0]:.3f} m")
    stable, 2.461 m
    """
    refuse_both(mean_curvature, volume)
    curves, origin = given_loops(loops)
    with reported_from(origin):
        check_loops(curves)
        check_corner_count(curves, most_nodes, tolerance)
        found = find_film(
            curves,
            mean_curvature,
            volume=volume,
            order=order,
            tolerance=tolerance,
            branch=branch,
            most_nodes=most_nodes,
            progress=progress,
        )
        notes = remarks_on(curves) + notes_on(found, given_curvature=volume is None)
    return found.surface("form-found", notes, tolerance=tolerance, **origin_figure(origin))
