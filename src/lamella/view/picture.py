"""Still pictures of a run, in perspective.

They need matplotlib, which comes with ``pip install lamella[pictures]``. Nothing is exaggerated: strips have
their own height, surfaces their own proportions.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.network.network import SINGULAR, Network
from lamella.surface.mesh import SurfaceMesh
from lamella.view.camera import Camera
from lamella.view.figure import FAMILIES, INK, SINGULAR_COLOUR, frame, new_figure, require_matplotlib, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamella.strip.lamellas import Lamellas
    from lamella.view.shown_run import ShownRun

Colour = Literal["utilisation", "torsion", "curvature", "planarity", "family", "none"]

# what a colour shows: label of the colour bar
LABELS: dict[str, str] = {
    "utilisation": "utilisation (share of the strength)",
    "torsion": "|geodesic torsion| (1/m)",
    "curvature": "|geodesic curvature| (1/m)",
    "planarity": "planarity score of the twisted strip",
}
SURFACE = (0.80, 0.84, 0.88)
VEIL = 0.42
# quads of strip in a cell at most: more cannot be told apart at the size of a page
QUADS_A_CELL = 4


def draw(
    results: ShownRun,
    path: Path,
    *,
    view: tuple[float, float] = (-60.0, 22.0),
    colour: Colour = "utilisation",
    size: tuple[int, int] = (1200, 900),
) -> None:
    """Draw a run's surface and its strips as a PNG file.

    Every strip is drawn as ruled quads c -+ h/2 n, hidden by what lies in front; the surface is translucent;
    singular nodes are marked by a disc. Without lamellas (a run until "network") strips have the project's height.

    Parameters
    ----------
    results : ShownRun
        From `lamella.compute`.
    path : Path
        File to write.
    view : (float, float)
        Azimuth and elevation of the eye, degrees; azimuth 0 looks against x, 90 against y.
    colour : str
        "utilisation", "torsion", "curvature", "planarity", "family" (A red, B blue) or "none".
    size : (int, int)
        Width and height, pixels.

    Raises
    ------
    InputError
        matplotlib is not installed; the run has not come as far as the colour needs; an unknown colour.
    OSError
        The file cannot be written.
    """
    require_matplotlib()
    scene = Scene(results.mesh, results.network, results.lamellas, results.project.lamella.height)
    barred = scene.network is not None and colour not in ("family", "none")
    with new_figure(size) as figure:
        axes = figure.add_axes((0.01, 0.01, 0.87 if barred else 0.98, 0.98))
        scale = put_scene(axes, scene, view=view, colour=colour)
        if scale is not None:
            _colour_bar(figure, scale, LABELS[colour])
        save(figure, path, scale)


class Scene(NamedTuple):
    """What a picture shows: a surface, the strips of a net (m high) on it, or either alone."""

    mesh: SurfaceMesh | None
    network: Network | None = None
    lamellas: Lamellas | None = None
    height: float = 0.0


def put_scene(axes: Axes, scene: Scene, *, view: tuple[float, float], colour: Colour) -> Any:
    """Draw a scene on axes of two dimensions, see `draw`; the scale for a colour bar, or None."""
    mesh, network = scene.mesh, scene.network
    values = _values(scene, colour)
    points = [] if mesh is None else [mesh.points]
    camera = Camera.around(np.vstack([*points, *([] if network is None else [network.sample_points])]), *view)
    corners, depth, colours = np.empty((0, 4, 2)), np.empty(0), np.empty((0, 4))
    if mesh is not None:
        quads, shades = surface_quads(mesh, camera)
        corners, away = camera.project(quads)
        # behind the strips that stand on it, so that these show at their full height
        depth = away.mean(1) + scene.height + (away.max(1) - away.min(1)) / 2
        colours = np.column_stack([np.outer(shades, SURFACE), np.full(len(shades), VEIL)])
    smooth = np.zeros(len(corners), bool)
    scale = None
    if network is not None:
        strips, first = _strip_quads(network, scene.height)
        flat, strip_away = camera.project(strips)
        paint, scale = _paint(network, values, first, colour)
        paint[:, :3] *= _strip_shades(strips, camera)[:, None]
        corners = np.concatenate([corners, flat])
        depth = np.r_[depth, strip_away.mean(1)]
        colours = np.concatenate([colours, paint])
        smooth = np.r_[smooth, np.ones(len(flat), bool)]
    order = np.argsort(-depth, kind="stable")
    _put_quads(axes, corners[order], colours[order], smooth[order])
    if network is not None:
        _put_singular(axes, network, camera)
    frame(axes, corners.reshape(-1, 2))
    if colour == "family" and network is not None:
        _family_key(axes)
    return scale


def _values(scene: Scene, colour: str) -> Floats | None:
    """What the strips are coloured by, one value a sample."""
    network, lamellas = scene.network, scene.lamellas
    known = (*LABELS, "family", "none")
    if colour not in known:
        raise InputError(f"unknown colour {colour!r}", f"choose one of {', '.join(known)}")
    if network is None or colour in ("family", "none"):
        return None
    if colour == "torsion":
        return np.abs(network.sample_darboux.tg)
    if colour == "curvature":
        return np.abs(network.sample_darboux.kg)
    if lamellas is None:
        raise InputError(f"colour {colour!r} needs the stage lamellas", 'compute it, or choose colour="family"')
    return lamellas.utilisation if colour == "utilisation" else lamellas.planarity


def surface_quads(mesh: SurfaceMesh, camera: Camera) -> tuple[Floats, Floats]:
    """Faces as quads (f, 4, 3) and their shades (f,)."""
    normals = mesh.normals[mesh.faces].mean(1)
    light = _light(camera)
    return mesh.points[mesh.faces], 0.80 + 0.20 * np.abs(normals @ light)


def _light(camera: Camera) -> Floats:
    light = camera.back - 0.5 * camera.right + 0.8 * camera.up
    return np.asarray(light / np.linalg.norm(light))


def _strip_quads(network: Network, height: float) -> tuple[Floats, Integers]:
    """Quads of all strips (q, 4, 3) and the sample at which each begins."""
    reach = height / 2 * network.sample_normals
    low, high = network.sample_points - reach, network.sample_points + reach
    stops = network.sample_offsets[network.stop_owner] + network.stop_samples
    first: list[Integers] = []
    last: list[Integers] = []
    owner = network.stop_owner
    inside = owner[1:] == owner[:-1]
    begin, end = stops[:-1][inside], stops[1:][inside]
    steps = np.minimum(end - begin, QUADS_A_CELL)
    for step in range(QUADS_A_CELL):
        has = steps > step
        first.append(begin[has] + (end - begin)[has] * step // steps[has])
        last.append(begin[has] + (end - begin)[has] * (step + 1) // steps[has])
    a, b = np.concatenate(first), np.concatenate(last)
    return np.stack((low[a], low[b], high[b], high[a]), axis=1), a


def _strip_shades(strips: Floats, camera: Camera) -> Floats:
    across = np.cross(strips[:, 2] - strips[:, 0], strips[:, 3] - strips[:, 1])
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    return np.asarray(0.82 + 0.18 * np.abs(across @ _light(camera)))


def _paint(network: Network, values: Floats | None, first: Integers, colour: str) -> tuple[Floats, Any]:
    """Colours of the strips' quads (q, 4), and the scale for the colour bar."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgba

    if values is None:
        lamella = np.searchsorted(network.sample_offsets, first, "right") - 1
        is_a = (network.families == "A")[lamella][:, None]
        a, b = (to_rgba(INK if colour == "none" else FAMILIES[f]) for f in "AB")
        return np.where(is_a, a, b), None
    # without the palest end, which is lost on white
    steps = colormaps["plasma"](np.linspace(0.0, 0.88, 256))
    scale = ScalarMappable(
        Normalize(0.0, max(float(values.max()), 1e-12)), LinearSegmentedColormap.from_list("l", steps)
    )
    return np.asarray(scale.to_rgba(values[first]), np.float64), scale


def _put_quads(axes: Axes, corners: Floats, colours: Floats, smooth: Booleans) -> None:
    """Quads from back to front; the veil without edges, which would show as lines where two faces meet."""
    from matplotlib.collections import PolyCollection

    edges = np.where(smooth[:, None], colours, 0.0)
    collection = PolyCollection(
        list(corners),
        facecolors=colours,
        edgecolors=edges,
        linewidths=np.where(smooth, 0.35, 0.0),
        antialiaseds=smooth,
    )
    collection.set_snap(False)
    axes.add_collection(collection)


def _put_singular(axes: Axes, network: Network, camera: Camera) -> None:
    points = network.node_points[network.node_kinds == SINGULAR]
    if len(points):
        flat, _ = camera.project(points)
        axes.plot(flat[:, 0], flat[:, 1], "o", ms=13, mfc=SINGULAR_COLOUR, mec="white", mew=1.8)


def _colour_bar(figure: Figure, scale: Any, label: str) -> None:
    bar = figure.colorbar(scale, cax=figure.add_axes((0.895, 0.22, 0.016, 0.56)))
    bar.set_label(label, fontsize=12, color=INK)
    bar.ax.tick_params(labelsize=11, color=INK, labelcolor=INK)
    bar.outline.set_linewidth(0.5)


def _family_key(axes: Axes) -> None:
    for row, (family, colour) in enumerate(FAMILIES.items()):
        axes.text(
            0.99,
            0.97 - 0.045 * row,
            f"family {family}",
            color=colour,
            fontsize=13,
            fontweight="bold",
            ha="right",
            transform=axes.transAxes,
        )
