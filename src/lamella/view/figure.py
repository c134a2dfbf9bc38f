"""Figures of matplotlib, the same whatever the user's settings, and small PNG files of them."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.files.whole import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FAMILIES = {"A": "#c8452d", "B": "#1f66b1"}
LAYER_COLOURS = {"CUT": "#111111", "MARK": "#1f66b1", "TEXT": "#1c8a43", "SHEET": "#9a9a9a"}
SINGULAR_COLOUR = "#d6009a"
INK = "#222222"
DPI = 100
# drawn this much finer: where two faces of the translucent surface meet, pixels are covered twice
FINER = 3


def require_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise InputError("pictures need matplotlib, which is not installed", "pip install lamella[pictures]") from None


@contextmanager
def new_figure(size: tuple[int, int]) -> Iterator[Figure]:
    """A white figure of `size` pixels, whatever the user's own settings of matplotlib are."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        figure = Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, facecolor="white")
        FigureCanvasAgg(figure)
        yield figure


def save(figure: Figure, path: Path, scale: Any = None, *, shaded: bool = False) -> None:
    """Write the figure, drawn finer than it is and averaged.

    With 256 colours, a third of the bytes; all of them where it is `shaded`, for which these do not suffice.
    """
    from matplotlib.colors import to_rgb
    from PIL import Image
    from scipy.spatial import cKDTree

    raw, small = io.BytesIO(), io.BytesIO()
    figure.savefig(raw, format="png", dpi=FINER * DPI, metadata={"Software": None})
    averaged = Image.open(raw).convert("RGB").reduce(FINER)
    if shaded:
        averaged.save(small, "PNG", optimize=True)
        write_whole(path, small.getvalue())
        return
    pixels = np.asarray(averaged)
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


def frame(axes: Axes, points: Floats) -> None:
    """Limits around points, equal scales, no axes."""
    low, high = points.min(0), points.max(0)
    pad = 0.015 * float((high - low).max())
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(low[1] - pad, high[1] + pad)
    axes.set_aspect("equal")
    axes.set_axis_off()
