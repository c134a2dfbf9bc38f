"""Results drawn on axes of matplotlib: what their method `plot` does."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.network.network import Network
from lamella.projection.quad_mesh import QuadMesh
from lamella.strip.lamellas import Lamellas
from lamella.surface.boundary.curve import Loop
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.surface import ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.view.camera import Camera
from lamella.view.drawing_picture import Curve, put_curves
from lamella.view.figure import INK, frame, require_matplotlib
from lamella.view.flat_parts import part_curves, rows, sheet_curves
from lamella.view.net_colours import NetColour
from lamella.view.net_picture import NetPanel, put_net
from lamella.view.picture import LABELS, Colour, Scene, put_scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

VIEW = (-60.0, 22.0)
# points of a loop
SAMPLES = 400


def plot(result: object, ax: Axes | None = None, **options: Any) -> Axes:
    """Draw a result, see `lamella.base.result.Shown.plot`."""
    require_matplotlib()
    if ax is None:
        from matplotlib import pyplot

        _, ax = pyplot.subplots()
    _draw(result, ax, **options)
    return ax


@singledispatch
def _draw(result: object, axes: Axes, **options: Any) -> None:
    raise TypeError(f"there is no picture of a {type(result).__name__}")


@_draw.register(ElementSurface)
@_draw.register(ClosedForm)
def _(surface: ElementSurface | ClosedForm, axes: Axes, *, view: tuple[float, float] = VIEW) -> None:
    put_scene(axes, Scene(surface.mesh()), view=view, colour="none")


@_draw.register(SurfaceMesh)
def _(mesh: SurfaceMesh, axes: Axes, *, view: tuple[float, float] = VIEW) -> None:
    put_scene(axes, Scene(mesh), view=view, colour="none")


@_draw.register(Network)
def _(network: Network, axes: Axes, *, view: tuple[float, float] = VIEW, colour: Colour = "family") -> None:
    # a ribbon of this share of a cell, as a net has no strips yet
    height = 0.1 * float(np.median(network.cell_edges))
    mesh = None if network.surface is None else network.surface.mesh()
    _explained(axes, put_scene(axes, Scene(mesh, network, None, height), view=view, colour=colour), colour)


@_draw.register(Lamellas)
def _(lamellas: Lamellas, axes: Axes, *, view: tuple[float, float] = VIEW, colour: Colour = "utilisation") -> None:
    network = lamellas.network
    mesh = None if network.surface is None else network.surface.mesh()
    scene = Scene(mesh, network, lamellas, lamellas.section.height)
    _explained(axes, put_scene(axes, scene, view=view, colour=colour), colour)


def _explained(axes: Axes, scale: Any, colour: str) -> None:
    """A colour bar beside the axes, where colours stand for numbers."""
    if scale is not None:
        axes.figure.colorbar(scale, ax=axes, shrink=0.7, label=LABELS[colour])


@_draw.register(Loop)
def _(loop: Loop, axes: Axes, *, view: tuple[float, float] = VIEW) -> None:
    points = loop.at(np.linspace(0.0, 1.0, SAMPLES + 1))
    flat, _ = Camera.around(points, *view).project(points)
    axes.plot(*flat.T, color=INK, lw=1.2)
    frame(axes, flat)


@_draw.register(QuadMesh)
def _(mesh: QuadMesh, axes: Axes, *, view: tuple[float, float] = VIEW, colour: NetColour | None = None) -> None:
    put_net(axes, NetPanel("", mesh, colour), view)


@_draw.register(Part)
def _(part: Part, axes: Axes) -> None:
    _put_flat(axes, part_curves(part))


@_draw.register(Parts)
def _(parts: Parts, axes: Axes) -> None:
    _put_flat(axes, [curve for part, x, y in rows(parts) for curve in part_curves(part, x, y)])


@_draw.register(Nesting)
def _(nesting: Nesting, axes: Axes, *, sheet: int = 0) -> None:
    _put_flat(axes, sheet_curves(nesting.source, nesting, sheet))


def _put_flat(axes: Axes, curves: list[Curve]) -> None:
    put_curves(axes, curves, np.zeros(2), fill=True, line=0.7)
    frame(axes, np.concatenate([curve.points for curve in curves]))
