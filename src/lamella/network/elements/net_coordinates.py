"""What every lattice on a surface of elements needs, whatever its density: umbilics and isothermic coordinates."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.progress import Progress, Report, silent
from lamella.network.isothermic.holonomy import Holonomy, holonomies
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.mesh_layout import make_integration_mesh
from lamella.network.isothermic.recut import straightened
from lamella.network.isothermic.seamless_transitions import integrate
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.umbilic import refuse_umbilic


@dataclass(frozen=True)
class NetCoordinates:
    """Isothermic coordinates of a surface, without a density of lamellas.

    Attributes
    ----------
    umbilics : Umbilics
    iso : Isothermic
    around : tuple of Holonomy
        Of the holes.
    """

    umbilics: Umbilics
    iso: Isothermic
    around: tuple[Holonomy, ...]


def net_coordinates(surface: ElementSurface, *, seams: bool, progress: Progress = silent) -> NetCoordinates:
    """Umbilics and isothermic coordinates of a surface.

    Parameters
    ----------
    surface : ElementSurface
        Of constant mean curvature, with points that are not umbilic.
    seams : bool
        Whether nets are left open where they do not meet themselves; the cut is made of straight lines then.
    progress : callable

    Raises
    ------
    InputError
    """
    refuse_umbilic(surface)
    umbilics = surface.umbilics
    mesh = make_integration_mesh(surface, umbilics)
    inner = umbilics.orders[mesh.umbilics >= 0].tolist()
    orders = ", ".join(f"order {m}" for m in inner)
    progress(Report.step(f"{len(inner)} umbilics" + (f" ({orders})" if orders else "")))
    iso = integrate(mesh, mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)])
    if seams:
        iso = straightened(iso, surface)
    nodes = f"{iso.mesh.connectivity.node_count:,} nodes"
    progress(Report.step(f"isothermic coordinates on {nodes}: off by {iso.residual:.1e} of their slope"))
    return NetCoordinates(umbilics, iso, holonomies(iso))
