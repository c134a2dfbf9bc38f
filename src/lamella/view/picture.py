"""Still pictures of a run, in perspective.

They need matplotlib, which comes with ``pip install lamella[pictures]``. Nothing is exaggerated: strips have
their own height, surfaces their own proportions.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.network.network import SINGULAR, Network
from lamella.surface.mesh import SurfaceMesh
from lamella.view.figure import FAMILIES, INK, SINGULAR_COLOUR, frame, new_figure, require_matplotlib, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamella.stages.pipeline import Results

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


@dataclass(frozen=True)
class Camera:
    """A perspective camera that looks at a point.

    Attributes
    ----------
    target : (3,)
        m.
    right, up, back : (3,)
        Orthonormal; `back` points from the target to the eye.
    distance : float
        From target to eye, m.
    """

    target: Floats
    right: Floats
    up: Floats
    back: Floats
    distance: float

    @classmethod
    def around(cls, points: Floats, azimuth: float, elevation: float) -> Camera:
        """A camera for points (n, 3), seen from azimuth and elevation in degrees."""
        a, e = np.radians((azimuth, elevation))
        back = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        low, high = points.min(0), points.max(0)
        # three diameters away: depth can be read and proportions still hold
        return cls((low + high) / 2, right, np.cross(back, right), back, 3 * float(np.linalg.norm(high - low)))

    def project(self, points: Floats) -> tuple[Floats, Floats]:
        """Picture coordinates (..., 2) and distances from the eye (...) of points (..., 3), m."""
        local = points - self.target
        away = self.distance - local @ self.back
        flat = np.stack((local @ self.right, local @ self.up), axis=-1)
        return flat * (self.distance / away)[..., None], away


def draw(
    results: Results,
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
    results : Results
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
    network = results.network
    values = _values(results, colour)
    points = results.mesh.points if network is None else np.vstack([results.mesh.points, network.sample_points])
    camera = Camera.around(points, *view)
    quads, shades = _surface_quads(results.mesh, camera)
    corners, away = camera.project(quads)
    height = results.project.lamella.height
    # behind the strips that stand on it, so that these show at their full height
    depth = away.mean(1) + height + (away.max(1) - away.min(1)) / 2
    colours = np.column_stack([np.outer(shades, SURFACE), np.full(len(shades), VEIL)])
    smooth = np.zeros(len(corners), bool)
    scale = None
    if network is not None:
        strips, first = _strip_quads(network, height)
        flat, strip_away = camera.project(strips)
        paint, scale = _paint(network, values, first, colour)
        paint[:, :3] *= _strip_shades(strips, camera)[:, None]
        corners = np.concatenate([corners, flat])
        depth = np.r_[depth, strip_away.mean(1)]
        colours = np.concatenate([colours, paint])
        smooth = np.r_[smooth, np.ones(len(flat), bool)]
    order = np.argsort(-depth, kind="stable")
    with new_figure(size) as figure:
        axes = figure.add_axes((0.01, 0.01, 0.98 if scale is None else 0.87, 0.98))
        _put_quads(axes, corners[order], colours[order], smooth[order])
        if network is not None:
            _put_singular(axes, network, camera)
        frame(axes, corners.reshape(-1, 2))
        if scale is not None:
            _colour_bar(figure, scale, LABELS[colour])
        elif colour == "family" and network is not None:
            _family_key(axes)
        save(figure, path, scale)


def _values(results: Results, colour: str) -> Floats | None:
    """What the strips are coloured by, one value a sample."""
    network, lamellas = results.network, results.lamellas
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


def _surface_quads(mesh: SurfaceMesh, camera: Camera) -> tuple[Floats, Floats]:
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
