"""The picture of docs/architecture.md: rooms, who may import whom, and the way of a boundary point to a drawing."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from lamella.view.figure import INK, new_figure, save

# room: left edge, bottom, width, height, what it holds
ROOMS: dict[str, tuple[float, float, float, float, str]] = {
    "command/": (0, 9.2, 6.2, 0.8, "the command line"),
    "view/": (6.6, 9.2, 5.4, 0.8, "report, pictures, plots"),
    "stages/": (0, 7.2, 12, 1.6, ""),
    "project/": (0, 5.9, 2.3, 0.9, "tables of the\nproject file"),
    "files/": (10.0, 5.9, 2.0, 0.9, "formats:\nread, write"),
    "fabrication/": (7.4, 5.9, 2.4, 0.9, "parts, sheets,\ndrawings"),
    "strip/": (2.5, 5.9, 2.2, 0.9, "strips,\nstresses"),
    "structure/": (4.9, 5.9, 2.3, 0.9, "beams,\nequilibrium"),
    "network/": (0, 3.5, 8.9, 2.0, ""),
    "projection/": (9.2, 3.5, 2.8, 2.0, "quad meshes\npulled onto\nconstraints"),
    "surface/": (0, 1.1, 12, 2.0, ""),
    "base/": (0, 0, 12, 0.7, "errors, arrays, units, sparse systems, progress, ties"),
}
INNER: dict[str, tuple[float, float, float, float]] = {
    "surface": (0.2, 7.35, 2.6, 0.6),
    "network ": (3.1, 7.35, 2.6, 0.6),
    "lamellas": (6.0, 7.35, 2.6, 0.6),
    "fabrication ": (8.9, 7.35, 2.9, 0.6),
    "lattice/": (0.2, 3.65, 1.6, 0.6),
    "isothermic/": (2.0, 3.65, 2.1, 0.6),
    "elements/": (4.3, 3.65, 1.9, 0.6),
    "streamlines/": (6.4, 3.65, 2.3, 0.6),
    "charts/": (6.4, 4.4, 2.3, 0.6),
    "adjust/": (4.3, 4.4, 1.9, 0.6),
    "boundary/": (0.2, 1.25, 1.9, 0.6),
    "remesh/": (2.3, 1.25, 1.7, 0.6),
    "form_finding/": (4.2, 1.25, 2.5, 0.6),
    "element/": (6.9, 1.25, 1.7, 0.6),
    "closed_forms/": (6.9, 2.0, 2.4, 0.6),
    "from_mesh/": (8.8, 1.25, 2.2, 0.6),
}
# of a boundary point, numbered as on the page
WAY: tuple[tuple[float, float], ...] = (
    (1.1, 6.05),
    (1.4, 7.5),
    (1.2, 1.4),
    (5.4, 1.4),
    (3.0, 3.8),
    (5.2, 3.8),
    (3.6, 6.05),
    (8.6, 6.05),
    (11.0, 6.05),
)


def make_picture(folder: Path) -> None:
    """Write architecture.png into a folder."""
    with new_figure((1000, 860)) as figure:
        ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
        for name, (x, y, width, height, holds) in ROOMS.items():
            _box(ax, x, y, width, height, "#f3f1ec")
            ax.text(
                x + 0.12, y + height - 0.1, f"$\\bf{{{name}}}$".replace("_", r"\_"), va="top", color=INK, fontsize=9
            )
            ax.text(x + width - 0.12, y + height - 0.12, holds, va="top", ha="right", color=INK, fontsize=7.5)
        for name, (x, y, width, height) in INNER.items():
            _box(ax, x, y, width, height, "#ffffff")
            ax.text(x + 0.1, y + height / 2, name.strip(), va="center", color=INK, fontsize=8)
        for number, ((x, y), (u, v)) in enumerate(pairwise(WAY), 1):
            bend = 0.16 if number % 2 else -0.16
            arrow = {"arrowstyle": "-|>", "color": "#c8501e", "lw": 1.1, "connectionstyle": f"arc3,rad={bend}"}
            ax.annotate("", (u, v), (x, y), arrowprops=arrow | {"shrinkA": 7, "shrinkB": 7}, zorder=4)
        for number, (x, y) in enumerate(WAY, 1):
            ax.text(x, y, str(number), ha="center", va="center", color="white", fontsize=8, zorder=5).set_bbox(
                {"boxstyle": "circle,pad=0.25", "facecolor": "#c8501e", "edgecolor": "none"}
            )
        ax.set_xlim(-0.1, 12.1)
        ax.set_ylim(-0.1, 10.1)
        ax.axis("off")
        save(figure, folder / "architecture.png")


def _box(ax: object, x: float, y: float, width: float, height: float, colour: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    shape = FancyBboxPatch((x, y), width, height, boxstyle="round,pad=0,rounding_size=0.12", fc=colour, ec=INK, lw=0.8)
    ax.add_patch(shape)  # type: ignore[attr-defined]


if __name__ == "__main__":
    make_picture(Path(__file__).parent / "pictures")
