"""Pictures of drawings as the laser gets them, read back from the DXF files."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes


from lamella.base.arrays import Floats
from lamella.view.figure import INK, LAYER_COLOURS, frame, new_figure, require_matplotlib, save

# mm
FLATNESS = 0.05


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
    require_matplotlib()
    curves = _read_drawing(drawing)
    frames = [curve.points for curve in curves if curve.layer == "SHEET" and curve.closed][:sheets]
    if not frames:
        raise InputError(f"{drawing} holds no sheets", "name the file sheets.dxf of a run")
    sizes = [np.ptp(frame, axis=0) for frame in frames]
    margin = 0.01 * float(sizes[0][0])
    heading = 0.12 * float(sizes[0][1])
    total = sum(float(size[1]) + heading for size in sizes) + margin
    across = max(float(size[0]) for size in sizes) + 2 * margin
    with new_figure((width, max(1, round(width * total / across)))) as figure:
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        top = 0.0
        for number, (frame, extent) in enumerate(zip(frames, sizes, strict=True), 1):
            low = frame.min(0)
            inside = [c for c in curves if c.layer != "SHEET" and _within(c.points, low, low + extent)]
            shift = np.array([margin, top - heading - float(extent[1])]) - low
            put_curves(axes, [Curve("SHEET", True, frame, ""), *inside], shift, fill=True, line=0.7)
            label = f"sheet {number}: {extent[0]:,.0f} x {extent[1]:,.0f} mm"
            axes.text(margin, top - 0.75 * heading, label, fontsize=11, color=INK)
            top -= float(extent[1]) + heading
        axes.set_xlim(0, across)
        axes.set_ylim(-total, 0)
        save(figure, path)


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
    require_matplotlib()
    curves = _read_drawing(drawing)
    names = list(dict.fromkeys(curve.part for curve in curves if curve.part))
    name = part if part is not None else next(iter(names), "")
    if name not in names:
        raise InputError(f"{drawing} has no part {name!r}", f"it has {', '.join(names[:5])}, ...")
    own = _level([curve for curve in curves if curve.part == name])
    with new_figure(size) as figure:
        whole = figure.add_axes((0.02, 0.66, 0.96, 0.32))
        put_curves(whole, own, np.zeros(2), fill=True, line=0.7)
        frame(whole, np.concatenate([curve.points for curve in own]))
        start = figure.add_axes((0.02, 0.02, 0.96, 0.62))
        put_curves(start, own, np.zeros(2), fill=True, line=1.3)
        _name_features(start, own, length, size[1] / size[0] * 0.62 / 0.96)
        save(figure, path)


@dataclass(frozen=True)
class Curve:
    """A polyline of a drawing, mm or m: layer, whether it is closed, points (n, 2), id of its part."""

    layer: str
    closed: bool
    points: Floats
    part: str


def _read_drawing(drawing: Path) -> list[Curve]:
    """Curves of a DXF file that a run wrote; arcs become polylines within `FLATNESS`."""
    import ezdxf
    from ezdxf import path as paths

    from lamella.files.write.dxf_text import APPLICATION

    curves = []
    for entity in ezdxf.readfile(str(drawing)).modelspace():
        part = ""
        if entity.has_xdata(APPLICATION):
            tags = {tag.code: tag.value for tag in entity.get_xdata(APPLICATION)}
            part = str(tags[1000]) if tags[1071] == 1 else f"{tags[1000]}#{tags[1071]}"
        way = paths.make_path(entity)
        points = np.array([(p.x, p.y) for p in way.flattening(FLATNESS)], float)
        curves.append(Curve(str(entity.dxf.layer), bool(way.is_closed), points, part))
    return curves


def _within(points: Floats, low: Floats, high: Floats) -> bool:
    return bool((points.min(0) >= low - 1).all() and (points.max(0) <= high + 1).all())


def put_curves(axes: Axes, curves: list[Curve], shift: Floats, *, fill: bool, line: float) -> None:
    """Draw curves shifted by (2,) in the colours of their layers, with equal scales."""
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


def _level(curves: list[Curve]) -> list[Curve]:
    """A part turned so that its start is upright at the origin, the +n side up."""
    outline = next(curve.points for curve in curves if curve.layer == "CUT")
    # the first vertex is the start's corner on the -n side, the last one that on the +n side
    corners = outline[:-1] if np.allclose(outline[0], outline[-1]) else outline
    start, side = (corners[0] + corners[-1]) / 2, corners[-1] - corners[0]
    upright = complex(*side) / 1j / abs(complex(*side))

    def turned(points: Floats) -> Floats:
        local = ((points - start) @ np.array([1, 1j])) / upright
        return np.column_stack([local.real, local.imag])

    return [Curve(c.layer, c.closed, turned(c.points), c.part) for c in curves]


def _name_features(axes: Axes, curves: list[Curve], length: float, aspect: float) -> None:
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
