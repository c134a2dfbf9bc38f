"""Still pictures: a run in perspective, and its drawings as the laser gets them.

They need matplotlib, which comes with ``pip install lamella[pictures]``. Nothing is exaggerated: strips have
their own height, surfaces their own proportions.
"""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError
from lamella.files.whole import write_whole
from lamella.network.network import SINGULAR, Network
from lamella.surface.mesh import SurfaceMesh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamella.pipeline import Results

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Colour = Literal["utilisation", "torsion", "curvature", "planarity", "family", "none"]

# what a colour shows: label of the colour bar
LABELS: dict[str, str] = {
    "utilisation": "utilisation (share of the strength)",
    "torsion": "|geodesic torsion| (1/m)",
    "curvature": "|geodesic curvature| (1/m)",
    "planarity": "planarity score of the twisted strip",
}
FAMILIES = {"A": "#c8452d", "B": "#1f66b1"}
SURFACE = (0.80, 0.84, 0.88)
VEIL = 0.42
SINGULAR_COLOUR = "#d6009a"
INK = "#222222"
DPI = 100
# drawn this much finer: where two faces of the translucent surface meet, pixels are covered twice
FINER = 3
# quads of strip in a cell at most: more cannot be told apart at the size of a page
QUADS_A_CELL = 4
LAYER_COLOURS = {"CUT": "#111111", "MARK": "#1f66b1", "TEXT": "#1c8a43", "SHEET": "#9a9a9a"}
# mm
FLATNESS = 0.05


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
    _require_matplotlib()
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
    with _figure(size) as figure:
        axes = figure.add_axes((0.01, 0.01, 0.98 if scale is None else 0.87, 0.98))
        _put_quads(axes, corners[order], colours[order], smooth[order])
        if network is not None:
            _put_singular(axes, network, camera)
        _frame(axes, corners.reshape(-1, 2))
        if scale is not None:
            _colour_bar(figure, scale, LABELS[colour])
        elif colour == "family" and network is not None:
            _family_key(axes)
        _save(figure, path, scale)


def draw_sheets(drawing: Path, path: Path, *, sheets: int = 2, width: int = 1200) -> None:
    """Draw the first sheets of a written ``sheets.dxf``, one below the other, as a PNG file.

    Parameters
    ----------
    drawing : Path
        A DXF file that a run wrote.
    path : Path
        File to write.
    sheets : int
        How many sheets.
    width : int
        Of the picture, pixels.

    Raises
    ------
    InputError
        matplotlib is not installed, or the drawing holds no sheets.
    OSError
        A file cannot be read or written.
    """
    _require_matplotlib()
    curves = _read_drawing(drawing)
    frames = [curve.points for curve in curves if curve.layer == "SHEET" and curve.closed][:sheets]
    if not frames:
        raise InputError(f"{drawing} holds no sheets", "name the file sheets.dxf of a run")
    sizes = [np.ptp(frame, axis=0) for frame in frames]
    margin = 0.01 * float(sizes[0][0])
    heading = 0.12 * float(sizes[0][1])
    total = sum(float(size[1]) + heading for size in sizes) + margin
    across = max(float(size[0]) for size in sizes) + 2 * margin
    with _figure((width, max(1, round(width * total / across)))) as figure:
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        top = 0.0
        for number, (frame, extent) in enumerate(zip(frames, sizes, strict=True), 1):
            low = frame.min(0)
            inside = [c for c in curves if c.layer != "SHEET" and _within(c.points, low, low + extent)]
            shift = np.array([margin, top - heading - float(extent[1])]) - low
            _put_curves(axes, [_Curve("SHEET", True, frame, ""), *inside], shift, fill=True, line=0.7)
            label = f"sheet {number}: {extent[0]:,.0f} x {extent[1]:,.0f} mm"
            axes.text(margin, top - 0.75 * heading, label, fontsize=11, color=INK)
            top -= float(extent[1]) + heading
        axes.set_xlim(0, across)
        axes.set_ylim(-total, 0)
        _save(figure, path)


def draw_part(
    drawing: Path, path: Path, *, part: str | None = None, length: float = 900.0, size: tuple[int, int] = (1200, 640)
) -> None:
    """Draw one part of a written ``A.dxf`` or ``B.dxf`` as a PNG file: the whole of it, and its start with names.

    Parameters
    ----------
    drawing : Path
        A DXF file that a run wrote.
    path : Path
        File to write.
    part : str, optional
        Id; the drawing's first part if not given.
    length : float
        How much of the start is shown large, mm.
    size : (int, int)
        Width and height, pixels.

    Raises
    ------
    InputError
        matplotlib is not installed, or the drawing has no such part.
    OSError
        A file cannot be read or written.
    """
    _require_matplotlib()
    curves = _read_drawing(drawing)
    names = list(dict.fromkeys(curve.part for curve in curves if curve.part))
    name = part if part is not None else next(iter(names), "")
    if name not in names:
        raise InputError(f"{drawing} has no part {name!r}", f"it has {', '.join(names[:5])}, ...")
    own = _level([curve for curve in curves if curve.part == name])
    with _figure(size) as figure:
        whole = figure.add_axes((0.02, 0.66, 0.96, 0.32))
        _put_curves(whole, own, np.zeros(2), fill=True, line=0.7)
        _frame(whole, np.concatenate([curve.points for curve in own]))
        start = figure.add_axes((0.02, 0.02, 0.96, 0.62))
        _put_curves(start, own, np.zeros(2), fill=True, line=1.3)
        _name_features(start, own, length, size[1] / size[0] * 0.62 / 0.96)
        _save(figure, path)


def _require_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise InputError("pictures need matplotlib, which is not installed", "pip install lamella[pictures]") from None


@contextmanager
def _figure(size: tuple[int, int]) -> Iterator[Figure]:
    """A white figure of `size` pixels, whatever the user's own settings of matplotlib are."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        figure = Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, facecolor="white")
        FigureCanvasAgg(figure)
        yield figure


def _save(figure: Figure, path: Path, scale: Any = None) -> None:
    """Write the figure, drawn finer than it is and averaged, with 256 colours: a third of the bytes."""
    from matplotlib.colors import to_rgb
    from PIL import Image
    from scipy.spatial import cKDTree

    raw, small = io.BytesIO(), io.BytesIO()
    figure.savefig(raw, format="png", dpi=FINER * DPI, metadata={"Software": None})
    pixels = np.asarray(Image.open(raw).convert("RGB").reduce(FINER))
    colours, place = np.unique(pixels.reshape(-1, 3), axis=0, return_inverse=True)
    grey = np.ptp(colours, axis=1) < 24
    bar = np.empty((0, 3), np.uint8) if scale is None else scale.cmap(np.linspace(0, 1, 64), bytes=True)[:, :3]
    named = np.array([to_rgb(c) for c in ("white", INK, SINGULAR_COLOUR, *FAMILIES.values(), *LAYER_COLOURS.values())])
    # greys count by how much they fill, other colours once, so that scales and the thinnest lines stay true
    veil = _palette(colours[place[grey[place]]], 64)
    rest = _palette(colours[~grey], 256 - 64 - len(named) - len(bar))
    palette = np.concatenate([np.rint(255 * named).astype(np.uint8), bar, veil, rest])
    nearest = cKDTree(palette.astype(float)).query(colours.astype(float))[1]
    image = Image.fromarray(nearest[place].reshape(pixels.shape[:2]).astype(np.uint8), "P")
    image.putpalette(palette.tobytes())
    image.save(small, "PNG", optimize=True)
    write_whole(path, small.getvalue())


def _palette(colours: NDArray[np.uint8], count: int) -> NDArray[np.uint8]:
    """At most `count` colours (k, 3) that stand for colours (n, 3)."""
    from PIL import Image

    if len(colours) <= count:
        return colours
    palette = Image.fromarray(colours[None]).quantize(count, method=Image.Quantize.MEDIANCUT, kmeans=2).getpalette()
    return np.array(palette, np.uint8).reshape(-1, 3)[:count]


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


def _put_quads(axes: Axes, corners: Floats, colours: Floats, smooth: NDArray[np.bool_]) -> None:
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


def _frame(axes: Axes, points: Floats) -> None:
    """Limits around points, equal scales, no axes."""
    low, high = points.min(0), points.max(0)
    pad = 0.015 * float((high - low).max())
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(low[1] - pad, high[1] + pad)
    axes.set_aspect("equal")
    axes.set_axis_off()


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


@dataclass(frozen=True)
class _Curve:
    """A polyline of a drawing, mm: layer, whether it is closed, points (n, 2), id of its part."""

    layer: str
    closed: bool
    points: Floats
    part: str


def _read_drawing(drawing: Path) -> list[_Curve]:
    """Curves of a DXF file that a run wrote; arcs become polylines within `FLATNESS`."""
    import ezdxf
    from ezdxf import path as paths

    from lamella.fabrication.dxf_text import APPLICATION

    curves = []
    for entity in ezdxf.readfile(str(drawing)).modelspace():
        part = ""
        if entity.has_xdata(APPLICATION):
            tags = {tag.code: tag.value for tag in entity.get_xdata(APPLICATION)}
            part = str(tags[1000]) if tags[1071] == 1 else f"{tags[1000]}#{tags[1071]}"
        way = paths.make_path(entity)
        points = np.array([(p.x, p.y) for p in way.flattening(FLATNESS)], float)
        curves.append(_Curve(str(entity.dxf.layer), bool(way.is_closed), points, part))
    return curves


def _within(points: Floats, low: Floats, high: Floats) -> bool:
    return bool((points.min(0) >= low - 1).all() and (points.max(0) <= high + 1).all())


def _put_curves(axes: Axes, curves: list[_Curve], shift: Floats, *, fill: bool, line: float) -> None:
    from matplotlib.collections import LineCollection, PolyCollection

    by_layer: dict[str, list[Floats]] = defaultdict(list)
    for curve in curves:
        by_layer[curve.layer].append(curve.points + shift)
    if fill:
        axes.add_collection(PolyCollection(by_layer["CUT"], facecolors="#eceff2", edgecolors="none", zorder=1))
    for layer, lines in by_layer.items():
        collection = LineCollection(
            lines, colors=LAYER_COLOURS.get(layer, INK), linewidths=line, zorder=2 if layer == "SHEET" else 3
        )
        axes.add_collection(collection)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _level(curves: list[_Curve]) -> list[_Curve]:
    """A part turned so that its start is upright at the origin, the +n side up."""
    outline = next(curve.points for curve in curves if curve.layer == "CUT")
    # the first vertex is the start's corner on the -n side, the last one that on the +n side
    corners = outline[:-1] if np.allclose(outline[0], outline[-1]) else outline
    start, side = (corners[0] + corners[-1]) / 2, corners[-1] - corners[0]
    upright = complex(*side) / 1j / abs(complex(*side))

    def turned(points: Floats) -> Floats:
        local = ((points - start) @ np.array([1, 1j])) / upright
        return np.column_stack([local.real, local.imag])

    return [_Curve(c.layer, c.closed, turned(c.points), c.part) for c in curves]


def _name_features(axes: Axes, curves: list[_Curve], length: float, aspect: float) -> None:
    """Limits around a part's first millimetres, and names and measures beside its features there."""
    inside = [c for c in curves if c.points[:, 0].min() < length]
    outline = next(c.points for c in curves if c.layer == "CUT")
    seen = outline[(outline[:, 0] < length) & (outline[:, 1] < 0.5 * length)]
    middle = float(seen[:, 1].min() + seen[:, 1].max()) / 2
    half = 1.03 * length * aspect / 2
    axes.set_xlim(-0.03 * length, length)
    axes.set_ylim(middle - half, middle + half)
    # two lines of text above, one below
    rows = [middle + share * half for share in (0.92, 0.62, -0.75)]

    def note(text: str, at: Floats, x: float, row: int) -> None:
        axes.annotate(
            text,
            (float(at[0]), float(at[1])),
            (x, rows[row]),
            fontsize=12,
            color=INK,
            va="center",
            arrowprops={"arrowstyle": "-|>", "lw": 0.9, "color": "#777777", "shrinkB": 1, "relpos": (0.12, 0.5)},
            zorder=5,
        )

    marks = [c.points for c in inside if c.layer == "MARK" and not c.closed and c.points[:, 0].max() < length]
    marks.sort(key=lambda points: float(points[:, 0].mean()))
    arrow = next((c.points for c in inside if c.layer == "MARK" and c.closed), None)
    letters = [c.points for c in inside if c.layer == "TEXT"]
    if arrow is not None:
        note("start mark: in the upper (+n) half, points to the part's end", arrow[:3].mean(0), 0.02 * length, 0)
    if letters:
        note("id of the part", np.concatenate(letters).mean(0), 0.02 * length, 2)
    if len(marks) > 1:
        note("node centre line", marks[1].mean(0), float(marks[1][:, 0].mean()) + 0.06 * length, 2)
    slots = _slot_mouths(outline[outline[:, 0] < length])
    if len(slots):
        mouth = slots[np.abs(slots[:, 0] - 0.25 * length).argmin()]
        note("slots, one for each layer of the other family", mouth, float(mouth[0]) - 0.08 * length, 1)


def _slot_mouths(outline: Floats) -> Floats:
    """Middles of the slots' open ends on an outline: long wall, short foot, long wall back."""
    steps = np.diff(outline, axis=0)
    size = np.hypot(*steps.T)
    walls = np.einsum("ij,ij->i", steps[:-2], steps[2:]) < 0
    foot = (size[1:-1] < 0.2 * np.minimum(size[:-2], size[2:])) & walls
    first = np.flatnonzero(foot)
    return np.asarray((outline[first] + outline[first + 3]) / 2)
