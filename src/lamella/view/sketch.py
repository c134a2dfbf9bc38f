"""Small pictures of results as SVG, for notebooks: lines alone, and nothing that has to be installed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import singledispatch
from html import escape
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.network.network import SINGULAR, Network
from lamella.projection.quad_mesh import QuadMesh
from lamella.strip.lamellas import Lamellas
from lamella.surface.boundary.curve import Loop
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.surface import ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.view.camera import Camera
from lamella.view.figure import FAMILIES, INK, LAYER_COLOURS, SINGULAR_COLOUR
from lamella.view.flat_parts import part_curves, rows, sheet_curves
from lamella.view.picture import surface_quads

VIEW = (-60.0, 22.0)
# pixels
SKETCH_WIDTH, SKETCH_HEIGHT_MAX, SKETCH_MARGIN = 420, 320, 6
# of the surface for a sketch, see `Surface.mesh`; faces that are filled one by one, samples of a net that are drawn
SKETCH_TOLERANCE, MOST_FACES, MOST_SAMPLES = 0.02, 1_200, 6_000
# parts drawn below each other; points of a loop
SKETCH_PARTS_MAX, SKETCH_SAMPLES = 8, 200
# from little to all of the strength
SCALE = ("#0d0887", "#6a00a8", "#b12a90", "#e16462", "#fca636")
PLAIN = "#d9e0e7"


class Layer(NamedTuple):
    """Polylines (n, 2) of one colour, y upwards; `fill` "" leaves them open."""

    lines: Sequence[Floats]
    stroke: str
    width: float = 0.8
    fill: str = ""
    dots: bool = False


def html(result: object) -> str:
    """A sketch of a result above what it prints."""
    return f"<div>{svg(result)}<div><code>{escape(repr(result))}</code></div></div>"


def svg(result: object) -> str:
    """A sketch of a result as an SVG element."""
    layers = [layer for layer in _layers(result) if layer.lines]
    points = np.concatenate([line for layer in layers for line in layer.lines])
    low, high = points.min(0), points.max(0)
    size = np.maximum(high - low, 1e-9 * float((high - low).max()) or 1.0)
    scale = float(min((SKETCH_WIDTH - 2 * SKETCH_MARGIN) / size[0], (SKETCH_HEIGHT_MAX - 2 * SKETCH_MARGIN) / size[1]))
    width, height = (round(scale * float(x)) + 2 * SKETCH_MARGIN for x in size)

    def written(line: Floats) -> str:
        places = np.column_stack([line[:, 0] - low[0], high[1] - line[:, 1]]) * scale + SKETCH_MARGIN
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in places.tolist())

    drawn = []
    for lines, stroke, wide, fill, dots in layers:
        if dots:
            at = [place.split(",") for line in lines for place in written(line).split()]
            drawn += [f'<circle cx="{x}" cy="{y}" r="4" fill="{stroke}"/>' for x, y in at]
            continue
        end = "Z" if fill else ""
        path = "".join(f"M{written(line)}{end}" for line in lines)
        drawn.append(
            f'<path d="{path}" fill="{fill or "none"}" stroke="{stroke}" stroke-width="{wide:g}" '
            'stroke-linejoin="round"/>'
        )
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">'
    return head + "".join(drawn) + "</svg>"


@singledispatch
def _layers(result: object) -> Iterator[Layer]:
    raise TypeError(f"there is no sketch of a {type(result).__name__}")


@_layers.register(ElementSurface)
@_layers.register(ClosedForm)
def _(surface: ElementSurface | ClosedForm) -> Iterator[Layer]:
    return _layers(surface.mesh(SKETCH_TOLERANCE))


@_layers.register(SurfaceMesh)
def _(mesh: SurfaceMesh) -> Iterator[Layer]:
    camera = Camera.around(mesh.points, *VIEW)
    quads, shades = surface_quads(mesh, camera)
    corners, away = camera.project(quads)
    if len(corners) > MOST_FACES:
        yield Layer(list(corners), PLAIN, 0.3, PLAIN)
        return
    for k in np.argsort(-away.mean(1), kind="stable").tolist():
        grey = "#" + "".join(f"{round(255 * float(shades[k]) * c):02x}" for c in (0.80, 0.84, 0.88))
        yield Layer([corners[k]], "#9aa5b1", 0.3, grey)


@_layers.register(Network)
def _(network: Network) -> Iterator[Layer]:
    lines = _centre_lines(network)
    for family, colour in FAMILIES.items():
        yield Layer([line for line, own in zip(lines, network.families, strict=True) if own == family], colour)
    yield from _singular(network)


@_layers.register(Lamellas)
def _(lamellas: Lamellas) -> Iterator[Layer]:
    network = lamellas.network
    most = np.maximum.reduceat(lamellas.utilisation, network.sample_offsets[:-1])
    step = np.minimum((most * len(SCALE)).astype(int), len(SCALE) - 1)
    lines = _centre_lines(network)
    for k, colour in enumerate(SCALE):
        yield Layer([line for line, own in zip(lines, step.tolist(), strict=True) if own == k], colour, 1.2)
    yield from _singular(network)


def _camera(network: Network) -> Camera:
    return Camera.around(network.sample_points, *VIEW)


def _centre_lines(network: Network) -> list[Floats]:
    """The centre lines as they are seen, thinned out where a net is large."""
    flat, _ = _camera(network).project(network.sample_points)
    step = -(-len(flat) // MOST_SAMPLES)
    bounds = zip(network.sample_offsets[:-1].tolist(), network.sample_offsets[1:].tolist(), strict=True)
    return [flat[np.unique(np.append(np.arange(start, end, step), end - 1))] for start, end in bounds]


def _singular(network: Network) -> Iterator[Layer]:
    points = network.node_points[network.node_kinds == SINGULAR]
    yield Layer([_camera(network).project(points)[0]] if len(points) else [], SINGULAR_COLOUR, dots=True)


@_layers.register(Loop)
def _(loop: Loop) -> Iterator[Layer]:
    points = loop.at(np.linspace(0.0, 1.0, SKETCH_SAMPLES + 1))
    yield Layer([Camera.around(points, *VIEW).project(points)[0]], INK, 1.2)


@_layers.register(QuadMesh)
def _(mesh: QuadMesh) -> Iterator[Layer]:
    corners, _ = Camera.around(mesh.vertices, *VIEW).project(mesh.vertices[mesh.faces])
    yield Layer(list(corners), INK, 0.5, PLAIN)


@_layers.register(Part)
def _(part: Part) -> Iterator[Layer]:
    for curve in part_curves(part, marks=False):
        yield Layer([curve.points], LAYER_COLOURS["CUT"], 0.8, PLAIN)


@_layers.register(Parts)
def _(parts: Parts) -> Iterator[Layer]:
    drawn = [part_curves(part, x, y, marks=False) for part, x, y in rows(Parts(parts.parts[:SKETCH_PARTS_MAX], ()))]
    yield Layer([curve.points for curves in drawn for curve in curves], LAYER_COLOURS["CUT"], 0.6, PLAIN)


@_layers.register(Nesting)
def _(nesting: Nesting) -> Iterator[Layer]:
    curves = sheet_curves(nesting.source, nesting, 0, marks=False)
    yield Layer([curve.points for curve in curves if curve.layer == "SHEET"], LAYER_COLOURS["SHEET"])
    yield Layer([curve.points for curve in curves if curve.layer == "CUT"], LAYER_COLOURS["CUT"], 0.4, PLAIN)
