"""Still pictures of a surface without strips: shaded, and coloured by its curvatures.

They need matplotlib, which comes with ``pip install lamella[pictures]``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.surface.element.lagrange import EDGES
from lamella.surface.element.surface import EDGE_PARTS_DRAWN_MAX, ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.view.camera import Camera
from lamella.view.figure import INK, new_figure, require_matplotlib, save
from lamella.view.scene.quantity import Quantity
from lamella.view.scene.surface_quantities import surface_quantities

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamella.view.shown_run import ShownRun

Panel = Literal["shade", "deviation", "K", "ratio", "k1", "k2"]

# sRGB of the two sides: the one the normal points out of, and the other
FRONT, BACK = (0.78, 0.85, 0.92), (0.93, 0.86, 0.77)
RIM = (0.13, 0.15, 0.18)
EDGE = (0.40, 0.47, 0.55)
UNKNOWN = "#b4b8bd"
# widths of lines, pixels
RIM_WIDTH, EDGE_WIDTH = 1.9, 0.75
# small triangles of a picture, about: a side of one is then a few pixels
TRIANGLES = 40_000
# sag of other surfaces' meshes over the diagonal of the bounding box: a tenth of a pixel
PICTURE_SAG = 1e-4
# pixels: below a panel for its scale and caption; around and between panels
PICTURE_FOOT, GAP = 84, 22


def draw_surface(
    results: ShownRun,
    path: Path,
    *,
    view: tuple[float, float] = (-60.0, 24.0),
    panels: Sequence[Panel] = ("shade", "deviation", "K"),
    size: tuple[int, int] | None = None,
) -> None:
    """Draw a run's surface as a PNG file, in panels side by side.

    Each panel shows the same view: faces hide what lies behind them, the boundary is drawn as a line.

    Parameters
    ----------
    results : ShownRun
        From `lamella.compute`; its network is not drawn.
    path : Path
        File to write.
    view : (float, float)
        Azimuth and elevation of the eye, degrees; azimuth 0 looks against x, 90 against y.
    panels : sequence of str
        Up to three: "shade" (the two sides in two tones, with the edges of the curved triangles), "deviation"
        (H - H0), "K", "ratio" (of the principal curvatures), "k1", "k2".
    size : (int, int), optional
        Width and height, pixels; 520 a panel and what its proportions ask for when not given.

    Raises
    ------
    InputError
        matplotlib is not installed; an unknown panel, or none, or more than three.
    OSError
        The file cannot be written.
    """
    require_matplotlib()
    mesh, rim, edges = _sampled(results)
    quantities = surface_quantities(mesh, results.surface.mean_curvature)
    unknown = [panel for panel in panels if panel not in ("shade", *quantities)]
    if unknown or not 1 <= len(panels) <= 3:
        wrong = f"unknown panel {unknown[0]!r}" if unknown else f"{len(panels)} panels"
        raise InputError(wrong, f"choose one to three of shade, {', '.join(quantities)}")
    scene = _Scene.seen(mesh, rim, edges, Camera.around(mesh.points, *view))
    width, height = size or _fitting_size(scene, len(panels))
    with new_figure((width, height)) as figure:
        share = 1 / len(panels)
        for k, panel in enumerate(panels):
            box = (
                k * share + GAP / width / 2,
                PICTURE_FOOT / height,
                share - GAP / width,
                1 - (PICTURE_FOOT + GAP / 2) / height,
            )
            axes = figure.add_axes(box)
            scale = scene.framed(axes, width * box[2], height * box[3])
            quantity = quantities.get(panel)
            scene.put(axes, quantity, scale)
            _explain(figure, box, height, quantity, _caption(results))
        save(figure, path, shaded=True)


def _caption(results: ShownRun) -> str:
    surface = results.surface
    if not isinstance(surface, ElementSurface):
        return f"Surface, H0 = {surface.mean_curvature:.4g} 1/m".replace("-", "−")
    count, order = len(surface.connectivity.elements), surface.connectivity.basis.order
    return f"{count:,} curved triangles of order {order}"


def _sampled(results: ShownRun) -> tuple[SurfaceMesh, Floats, Floats]:
    """A fine mesh, and segments (s, 2, 3) of its boundary and of the edges of the curved triangles, m."""
    surface = results.surface
    if not isinstance(surface, ElementSurface):
        mesh = surface.mesh(PICTURE_SAG)
        return mesh, _open_edges(mesh), np.empty((0, 2, 3))
    elements = surface.connectivity.elements
    parts = int(np.clip(np.ceil(np.sqrt(TRIANGLES / len(elements))), 1, EDGE_PARTS_DRAWN_MAX))
    step = np.linspace(0, 1, parts + 1)[:, None]
    corners = np.array([[0.0, 0], [1, 0], [0, 1]])
    neighbours = surface.connectivity.neighbours
    rim: list[Floats] = []
    edges: list[Floats] = []
    for local, (a, b) in enumerate(EDGES):
        basis = surface.connectivity.basis.basis((1 - step) * corners[a] + step * corners[b])
        across = neighbours[:, local]
        for chosen, into in ((across < 0, rim), (across > np.arange(len(across)), edges)):
            lines = np.matmul(basis, surface.nodes[elements[chosen]])
            into.append(np.stack([lines[:, :-1], lines[:, 1:]], 2).reshape(-1, 2, 3))
    return surface.subdivided(parts), np.concatenate(rim), np.concatenate(edges)


def _open_edges(mesh: SurfaceMesh) -> Floats:
    """Edges of one face only, as segments (s, 2, 3), m."""
    ends = np.stack([mesh.faces, np.roll(mesh.faces, -1, 1)], 2).reshape(-1, 2)
    ends = ends[ends[:, 0] != ends[:, 1]]
    keys = ends.min(1) * len(mesh.points) + ends.max(1)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    return np.asarray(mesh.points[ends[first[count == 1]]])


@dataclass(frozen=True)
class _Scene:
    """What a camera sees of a surface; picture coordinates are metres across the middle of the surface.

    Attributes
    ----------
    triangles : (t, 3) int
    flat : (n, 2)
        Vertices in the picture.
    depth : (t,)
        Distance of the triangles from the eye.
    normals, to_eye : (n, 3)
        Unit.
    camera : Camera
    lines : tuple of ((s, 2, 2), (s,))
        Boundary and edges: segments in the picture and their distances from the eye, a little nearer than they are.
    """

    triangles: Integers
    flat: Floats
    depth: Floats
    normals: Floats
    to_eye: Floats
    camera: Camera
    lines: tuple[tuple[Floats, Floats], tuple[Floats, Floats]]

    @classmethod
    def seen(cls, mesh: SurfaceMesh, rim: Floats, edges: Floats, camera: Camera) -> _Scene:
        faces = mesh.faces
        quads = faces[:, 2] != faces[:, 3]
        triangles = np.concatenate([faces[:, :3], faces[quads][:, [0, 2, 3]]])
        flat, away = camera.project(mesh.points)
        corners = away[triangles]
        # a line is in front of the triangles it belongs to
        reach = 0.8 * float(np.percentile(np.ptp(corners, axis=1), 99))

        def seen_line(segments: Floats) -> tuple[Floats, Floats]:
            on_picture, distance = camera.project(segments)
            return on_picture, distance.mean(1) - reach

        to_eye = camera.target + camera.distance * camera.back - mesh.points
        to_eye /= np.linalg.norm(to_eye, axis=1)[:, None]
        lines = (seen_line(rim), seen_line(edges))
        return cls(triangles, flat, corners.mean(1), mesh.normals, to_eye, camera, lines)

    def framed(self, axes: Axes, width: float, height: float) -> float:
        """Set the limits of axes of that many pixels, without frame; metres a pixel."""
        low, high = self.flat.min(0), self.flat.max(0)
        scale = float(((high - low) / (width - 2 * RIM_WIDTH, height - 2 * RIM_WIDTH)).max())
        middle, half = (low + high) / 2, scale * np.array([width, height]) / 2
        axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
        axes.set_axis_off()
        return scale

    def put(self, axes: Axes, quantity: Quantity | None, scale: float) -> None:
        """Draw the surface, shaded by itself or coloured by a quantity, at that many metres a pixel."""
        from matplotlib.collections import TriMesh
        from matplotlib.tri import Triangulation

        rim, edges = self.lines
        places = [self.flat[self.triangles], _ribbons(rim[0], RIM_WIDTH * scale)]
        colours = [self._colours(quantity)[self.triangles], _one_colour(RIM, 2 * len(rim[0]))]
        depths = [self.depth, np.repeat(rim[1], 2)]
        if quantity is None:
            places.append(_ribbons(edges[0], EDGE_WIDTH * scale))
            colours.append(_one_colour(EDGE, 2 * len(edges[0])))
            depths.append(np.repeat(edges[1], 2))
        order = np.argsort(-np.concatenate(depths), kind="stable")
        corners = np.concatenate(places)[order].reshape(-1, 2)
        painted = np.concatenate(colours)[order].reshape(-1, 3)
        triangles = np.arange(len(corners)).reshape(-1, 3)
        mesh = TriMesh(Triangulation(corners[:, 0], corners[:, 1], triangles))
        opaque: Any = np.column_stack([painted, np.ones(len(painted))])
        mesh.set_facecolor(opaque)
        axes.add_collection(mesh, autolim=False)

    def _colours(self, quantity: Quantity | None) -> Floats:
        """Colours of the vertices, (n, 3)."""
        facing = np.einsum("ij,ij->i", self.normals, self.to_eye)
        normals = np.where(facing < 0, -1.0, 1.0)[:, None] * self.normals
        light = self.camera.back - 0.55 * self.camera.right + 0.85 * self.camera.up
        light /= np.linalg.norm(light)
        # also past the terminator it grows darker, where a plain cosine would leave a flat patch
        diffuse = ((1 + normals @ light)[:, None] / 2) ** 2
        half = self.to_eye + light
        half /= np.linalg.norm(half, axis=1)[:, None]
        gloss = np.clip(np.einsum("ij,ij->i", normals, half), 0, 1)[:, None] ** 40
        if quantity is None:
            # the tones meet where the surface is seen edge-on, over a few degrees
            side = np.clip(facing / 0.06, -1, 1)[:, None]
            tone = (1 + side) / 2 * FRONT + (1 - side) / 2 * BACK
            return np.asarray(np.clip(tone * (0.52 + 0.52 * diffuse) + 0.10 * gloss, 0, 1))
        # colours have to be read off the scale: less shade, hardly any gloss
        return np.asarray(np.clip(_coloured(quantity) * (0.74 + 0.29 * diffuse) + 0.03 * gloss, 0, 1))


def _coloured(quantity: Quantity) -> Floats:
    """Colours (n, 3) of the values of a quantity."""
    from matplotlib.colors import to_rgb

    if quantity.is_constant:
        return np.tile(to_rgb(quantity.stops[0]), (len(quantity.values), 1))
    mapping = _mapping(quantity)
    return np.asarray(mapping.to_rgba(np.ma.masked_invalid(quantity.values)))[:, :3]


def _mapping(quantity: Quantity, unit: float = 1.0) -> Any:
    """Scale and colours of a quantity, in `unit` of its own."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    colours = LinearSegmentedColormap.from_list(quantity.key, quantity.stops).with_extremes(bad=UNKNOWN)
    return ScalarMappable(Normalize(quantity.low / unit, quantity.high / unit), colours)


def _ribbons(segments: Floats, width: float) -> Floats:
    """Segments (s, 2, 2) as ribbons of two triangles, (2 s, 3, 2), a little longer, so that they join."""
    a, b = segments[:, 0], segments[:, 1]
    along = b - a
    length = np.linalg.norm(along, axis=1)[:, None]
    along = np.where(length > 0, along / np.where(length > 0, length, 1), (1.0, 0.0)) * width / 2
    across = np.stack([-along[:, 1], along[:, 0]], 1)
    a, b = a - 0.5 * along, b + 0.5 * along
    ribbons = np.stack([a - across, b - across, b + across, a - across, b + across, a + across], 1)
    return np.asarray(ribbons.reshape(-1, 3, 2))


def _one_colour(colour: tuple[float, float, float], count: int) -> Floats:
    return np.broadcast_to(np.array(colour), (count, 3, 3))


def _fitting_size(scene: _Scene, panels: int) -> tuple[int, int]:
    """520 pixels a panel, and the height that the surface then has, within reason."""
    width, height = np.ptp(scene.flat, axis=0)
    picture = np.clip((520 - GAP) * height / width, 260, 760)
    return 520 * panels, round(picture + PICTURE_FOOT + GAP / 2)


def _explain(
    figure: Figure, box: tuple[float, float, float, float], height: int, quantity: Quantity | None, caption: str
) -> None:
    """Write what a panel shows below it, with its scale."""
    middle, top = box[0] + box[2] / 2, PICTURE_FOOT / height
    if quantity is None or quantity.is_constant:
        text = caption if quantity is None else f"{quantity.label} = {_number(quantity.low)} {quantity.remark}"
        figure.text(middle, top * 0.53, text, ha="center", va="center", fontsize=11.5, color=INK)
        return
    power = _power(max(abs(quantity.low), abs(quantity.high)))
    across = 0.62 * box[2]
    cax = figure.add_axes((middle - across / 2, top * 0.60, across, 11 / height))
    beyond = quantity.least < quantity.low, quantity.most > quantity.high
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[beyond]
    bar = figure.colorbar(_mapping(quantity, 10.0**power), cax=cax, orientation="horizontal", extend=extend)
    bar.locator = _ticks()
    bar.update_ticks()
    bar.outline.set_linewidth(0.0)
    bar.ax.tick_params(labelsize=10, color=INK, labelcolor=INK, length=3, width=0.7, pad=2)
    unit = " ".join(part for part in (f"10{_superscript(power)}" if power else "", quantity.unit) if part)
    bar.set_label(f"{quantity.label} ({unit})" if unit else quantity.label, fontsize=11.5, color=INK, labelpad=3)


def _ticks() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10])


def _power(size: float) -> int:
    """Power of ten a scale is written in: 0 where numbers are short without."""
    power = int(np.floor(np.log10(size)))
    return 0 if -2 <= power <= 3 else power


def _number(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")


def _superscript(number: int) -> str:
    return str(number).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
