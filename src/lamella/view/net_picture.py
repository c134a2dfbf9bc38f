"""Still pictures of nets side by side, in perspective, coloured by what was measured on them.

They need matplotlib, which comes with ``pip install lamella[pictures]``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.projection.mesh_figures import mesh_figures
from lamella.projection.quad_mesh import QuadMesh
from lamella.view.camera import Camera
from lamella.view.figure import INK, frame, new_figure, require_matplotlib, save
from lamella.view.net_colours import NetColour, NetColours, net_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


PLAIN, EDGE = (0.83, 0.87, 0.91), "#29303d"
# how far lines are drawn nearer than they are, in edges
LIFT = 0.3
# parts each quad is drawn in, along and across: colours of vertices change inside it
PARTS = 3
# height of a panel over its width; pixels for title and scale; width of a panel, pixels
PANEL_TALLEST, PANEL_FLATTEST, PANEL_HEAD, PANEL_FOOT, PANEL_WIDTH = 1.6, 0.55, 34, 66, 460


@dataclass(frozen=True)
class NetPanel:
    """One net of a picture.

    Attributes
    ----------
    title : str
    mesh : QuadMesh
    colour : NetColour, optional
        None: plain.
    marked : tuple of ((k, 3), str)
        Lines to draw, m, with their colours.
    edges : "all", "boundary" or "none"
        Which edges are drawn as lines.
    """

    title: str
    mesh: QuadMesh
    colour: NetColour | None = None
    marked: tuple[tuple[Floats, str], ...] = ()
    edges: Literal["all", "boundary", "none"] = "all"


def draw_nets(
    panels: Sequence[NetPanel],
    path: Path,
    *,
    view: tuple[float, float] = (-60.0, 24.0),
    width: int = PANEL_WIDTH,
) -> None:
    """Draw nets side by side as a PNG file, all seen by one camera, at one scale and with one scale of colours.

    Parameters
    ----------
    panels : sequence of NetPanel
        One to four.
    path : Path
    view : (float, float)
        Azimuth and elevation of the eye, degrees.
    width : int
        Of a panel, pixels.

    Raises
    ------
    InputError
        matplotlib is not installed; no panels or more than four.
    OSError
        The file cannot be written.
    """
    require_matplotlib()
    if not 1 <= len(panels) <= 4:
        raise InputError(f"{len(panels)} panels", "one to four")
    camera = Camera.around(np.concatenate([panel.mesh.vertices for panel in panels]), *view)
    flats = [camera.project(panel.mesh.vertices)[0] for panel in panels]
    # each net in the middle of its panel, all at the scale of the largest
    sizes = np.array([np.ptp(flat, axis=0) for flat in flats]).max(0)
    height = int(width * np.clip(sizes[1] / sizes[0], PANEL_FLATTEST, PANEL_TALLEST))
    scale = 1.05 * max(sizes[0] / width, sizes[1] / height)
    whole = (width * len(panels), height + PANEL_HEAD + PANEL_FOOT)
    found = _colours(panels)
    # a line is in front of the faces it belongs to
    reach = LIFT * float(np.median([panel.mesh.mean_edge for panel in panels]))
    with new_figure(whole) as figure:
        for k, (panel, flat) in enumerate(zip(panels, flats, strict=True)):
            axes = figure.add_axes((k / len(panels), PANEL_FOOT / whole[1], 1 / len(panels), height / whole[1]))
            axes.set_axis_off()
            middle = (flat.min(0) + flat.max(0)) / 2
            axes.set_xlim(middle[0] - scale * width / 2, middle[0] + scale * width / 2)
            axes.set_ylim(middle[1] - scale * height / 2, middle[1] + scale * height / 2)
            colours = found[k]
            _put(axes, panel, colours, camera, reach)
            middle_share = (k + 0.5) / len(panels)
            figure.text(
                middle_share,
                1 - PANEL_HEAD / 2 / whole[1],
                panel.title,
                ha="center",
                va="center",
                fontsize=12,
                color=INK,
            )
            if colours is not None:
                _explain(figure, colours, middle_share, 0.6 / len(panels), whole[1])
        save(figure, path, shaded=True)


def put_net(axes: Axes, panel: NetPanel, view: tuple[float, float]) -> None:
    """Draw one net on axes of two dimensions, without title and scale."""
    camera = Camera.around(panel.mesh.vertices, *view)
    _put(axes, panel, _colours([panel])[0], camera, LIFT * panel.mesh.mean_edge)
    frame(axes, camera.project(panel.mesh.vertices)[0])


def _colours(panels: Sequence[NetPanel]) -> list[NetColours | None]:
    """Colours of all panels: one scale for all of a kind."""
    found = [
        None if panel.colour is None else net_colours(panel.mesh, mesh_figures(panel.mesh), panel.colour)
        for panel in panels
    ]
    limits: dict[str, tuple[float, float]] = {}
    for colours in found:
        if colours is not None:
            low, high = limits.get(colours.key, (colours.low, colours.high))
            limits[colours.key] = min(low, colours.low), max(high, colours.high)
    return [
        None if colours is None else replace(colours, low=limits[colours.key][0], high=limits[colours.key][1])
        for colours in found
    ]


def _put(axes: Axes, panel: NetPanel, colours: NetColours | None, camera: Camera, reach: float) -> None:
    """Draw a net from back to front."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgba

    mesh = panel.mesh
    parts, share = _parts(mesh)
    flat, away = camera.project(parts)
    paint = np.tile(PLAIN, (len(parts), 1)) if colours is None else _paint(mesh, colours, share)
    across = np.cross(parts[:, 2] - parts[:, 0], parts[:, 3] - parts[:, 1])
    normal = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    light = camera.back - 0.5 * camera.right + 0.8 * camera.up
    light /= np.linalg.norm(light)
    # on either side the same, darker where the light grazes
    shade = 0.68 + 0.32 * np.abs(normal @ light)
    polygons, depth = [flat], [away.mean(1)]
    fill, line = [np.column_stack([paint * shade[:, None], np.ones(len(paint))])], [np.full(len(paint), 0.4)]
    step = np.linspace(0, 1, PARTS + 1)[:, None]
    lines = [(a + step * (b - a), EDGE, 0.7) for a, b in _drawn(panel)]
    for points, colour, wide in [*lines, *((points, colour, 2.6) for points, colour in panel.marked)]:
        pieces, distance = camera.project(np.stack([points[:-1], points[1:]], 1))
        polygons.append(pieces[:, [0, 1, 1, 0]])
        depth.append(distance.mean(1) - (reach if wide < 1 else 2 * reach))
        fill.append(np.tile(to_rgba(colour), (len(pieces), 1)))
        line.append(np.full(len(pieces), wide))
    order = np.argsort(-np.concatenate(depth), kind="stable")
    painted = np.concatenate(fill)[order]
    collection = PolyCollection(
        list(np.concatenate(polygons)[order]),
        facecolors=painted,
        edgecolors=painted,
        linewidths=np.concatenate(line)[order],
    )
    collection.set_snap(False)
    axes.add_collection(collection, autolim=False)


def _drawn(panel: NetPanel) -> Floats:
    """Ends of the edges that are drawn as lines, (e, 2, 3)."""
    mesh = panel.mesh
    if panel.edges == "all":
        return np.asarray(mesh.vertices[mesh.edges])
    if panel.edges == "boundary":
        rim = mesh.twin < 0
        return np.stack([mesh.vertices[mesh.tail[rim]], mesh.vertices[mesh.head[rim]]], 1)
    return np.empty((0, 2, 3))


def _parts(mesh: QuadMesh) -> tuple[Floats, Floats]:
    """Small quads (f PARTS^2, 4, 3) of the faces, and the shares of the four corners at their middles, (PARTS^2, 4)."""
    a, b = (x.ravel() for x in np.meshgrid(np.arange(PARTS), np.arange(PARTS), indexing="ij"))

    def shares(u: Floats, v: Floats) -> Floats:
        return np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], -1)

    corners = np.stack([shares((a + i) / PARTS, (b + j) / PARTS) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))], 1)
    parts = np.einsum("pck,fkx->fpcx", corners, mesh.vertices[mesh.faces]).reshape(-1, 4, 3)
    return parts, shares((a + 0.5) / PARTS, (b + 0.5) / PARTS)


def _paint(mesh: QuadMesh, colours: NetColours, share: Floats) -> Floats:
    """Colours of the small quads, (f PARTS^2, 3): of the face, or mixed from its corners."""
    rgb = colours.rgb / 255
    if colours.on == "faces":
        return np.repeat(rgb, len(share), axis=0)
    known = np.isfinite(colours.values).astype(float)[mesh.faces]
    # where some corners have no value the others decide
    weight = share[None] * (known + 1e-9)[:, None]
    weight /= weight.sum(2, keepdims=True)
    return np.asarray(np.einsum("fpk,fkc->fpc", weight, rgb[mesh.faces]).reshape(-1, 3))


def _explain(figure: Figure, colours: NetColours, middle: float, across: float, height: int) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize
    from matplotlib.ticker import MaxNLocator, ScalarFormatter

    known = colours.values[np.isfinite(colours.values)]
    beyond: Any = "max" if len(known) and known.max() > colours.high and colours.low == 0 else "neither"
    scale = ScalarMappable(
        Normalize(colours.low, colours.high), LinearSegmentedColormap.from_list(colours.key, colours.stops)
    )
    cax = figure.add_axes((middle - across / 2, 44 / height, across, 10 / height))
    bar = figure.colorbar(scale, cax=cax, orientation="horizontal", extend=beyond)
    bar.locator, bar.formatter = MaxNLocator(nbins=4), ScalarFormatter(useOffset=False)
    bar.update_ticks()
    bar.outline.set_linewidth(0.0)
    bar.ax.tick_params(labelsize=9.5, color=INK, labelcolor=INK, length=3, width=0.7, pad=2)
    bar.set_label(colours.label, fontsize=10.5, color=INK, labelpad=2)
