"""model.3dm: surface, centre lines, strips, nodes on named layers, for Rhino and Grasshopper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import rhino3dm

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.files.write.drawn_layer import Body, DrawnLayer, Repeated
from lamella.files.write.nurbs_objects import nurbs_surface
from lamella.files.write.rhino_blocks import add_block
from lamella.files.write.rhino_file import IN_METRES, Frame, RhinoFile
from lamella.files.write.splines import SPLINE_TOLERANCE, Spline, fit_splines
from lamella.files.write.text import require_finite
from lamella.network.network import NODE_KINDS, Network
from lamella.network.turning import derivative
from lamella.strip.lamellas import Lamellas, Section, twisted_strip
from lamella.strip.layers import SIDES
from lamella.surface.mesh import SurfaceMesh

COLOURS = {
    "surface": (200, 200, 200),
    "lamellas A": (200, 60, 40),
    "lamellas B": (30, 90, 170),
    "strips A": (230, 150, 130),
    "strips B": (130, 170, 220),
    "layers A": (240, 190, 170),
    "layers B": (180, 205, 235),
    "nodes regular": (60, 60, 60),
    "nodes boundary": (20, 140, 70),
    "nodes singular": (220, 0, 160),
    "nodes seam": (240, 160, 0),
}
# samples of a layer that make a strip
LEAST_SAMPLES = 4

POINT_OBJECTS = 2_000
"""Nodes up to this number are points named by their index; above, one point cloud a layer."""
TEXTS_MOST = 30_000
"""Places of repeated solids up to which each has user text, which makes it twice as large: 400 bytes a place."""


def model_bytes(
    *,
    name: str,
    version: str,
    surface: SurfaceMesh,
    network: Network,
    lamellas: Lamellas | None = None,
    further: Sequence[DrawnLayer] = (),
    frame: Frame = IN_METRES,
) -> bytes:
    """Return the Rhino model.

    Parameters
    ----------
    name, version : str
        Of the project and of the program; kept as document text ``lamella\\project``, ``lamella\\version``.
    surface : SurfaceMesh
        Goes to layer "surface".
    network : Network
        Centre lines go to "lamellas A" and "lamellas B" as cubic curves with the arc length as parameter,
        within `SPLINE_TOLERANCE` of the length from every sample; nodes to "nodes regular",
        "nodes boundary", "nodes singular" and "nodes seam".
    lamellas : Lamellas, optional
        Twisted strips go to "strips A" and "strips B" as surfaces of degree 3 x 1, ruled along the normals; where a
        lamella has several layers, each of these to "layers A" and "layers B", named A1-1, A1-2, ... from the right one
        (u = n x t is left) to the left one.
    further : sequence of DrawnLayer
        What later stages add.
    frame : Frame
        The file's unit, and where in the drawing points are measured from. Lengths in user text are in metres, as
        their keys say.

    Returns
    -------
    bytes
        The same for the same input: ids of layers and objects come from project name, layer and object name.
    """
    require_finite(network.sample_points, network.sample_normals, network.sample_tangents)
    require_finite(network.sample_arclengths, network.node_points, surface.points, surface.normals)
    model = _Model(name, version, frame).filled(surface, network, lamellas)
    places = sum(len(solid.labels) for layer in further for solid in layer.repeated)
    for layer in further:
        model.add_further(layer, texts=places <= TEXTS_MOST)
    return model.encoded()


class _Model:
    """A .3dm file being filled."""

    def __init__(self, name: str, version: str, frame: Frame) -> None:
        self.version = version
        self.rhino = RhinoFile("model.3dm", name, version, frame)
        self.file = self.rhino.file

    def filled(self, surface: SurfaceMesh, network: Network, lamellas: Lamellas | None) -> _Model:
        left_out: tuple[str, ...] = () if lamellas is not None else ("strips", "layers")
        if lamellas is not None and lamellas.section.layers == 1:
            left_out = ("layers",)
        self.rhino.add_layers({k: colour for k, colour in COLOURS.items() if not k.startswith(left_out)})
        self.rhino.add_mesh(surface, self.rhino.attributes("surface", "surface", version=self.version))
        self._add_centre_lines(network)
        if lamellas is not None:
            require_finite(network.sample_darboux.kn, network.sample_darboux.tg)
            self._add_strips(lamellas.network, lamellas.section)
            if lamellas.section.layers > 1:
                self._add_layers(network, lamellas)
        self._add_nodes(network)
        return self

    def add_further(self, layer: DrawnLayer, *, texts: bool = True) -> None:
        """Polylines and points of a later stage, named by their number, and its solids.

        Parameters
        ----------
        layer : DrawnLayer
        texts : bool
            Whether every place of what is repeated has user text; its name says the same.
        """
        self.rhino.add_layers({layer.name: layer.colour})
        for k, curve in enumerate(layer.curves):
            require_finite(curve)
            knots = np.arange(len(curve), dtype=float)
            attributes = self.rhino.attributes(layer.name, f"curve {k}", version=self.version)
            self.rhino.add_curve(1, knots, curve, attributes)
        for k, point in enumerate(layer.points):
            require_finite(point)
            attributes = self.rhino.attributes(layer.name, f"point {k}", version=self.version)
            self.file.Objects.AddPoint(rhino3dm.Point3d(*self.rhino.placed(point).tolist()), attributes)
        for solid in layer.repeated:
            self._add_repeated(layer.name, solid, texts)
        for body in layer.bodies:
            self._add_body(layer.name, body)

    def _add_body(self, layer: str, body: Body) -> None:
        """A mesh of a solid."""
        require_finite(body.vertices)
        text = {"id": body.name, **body.text}
        attributes = self.rhino.attributes(layer, body.name, **text, version=self.version)
        self.file.Objects.AddMesh(_mesh(self.rhino.placed(body.vertices), body.triangles), attributes)

    def _add_repeated(self, layer: str, solid: Repeated, texts: bool) -> None:
        """A block, and a reference to it for each place."""
        require_finite(solid.vertices, solid.origins, solid.axes)
        mesh = _mesh(solid.vertices / self.rhino.metres, solid.triangles)
        definition = self.rhino.identity("block", solid.name)
        text = {"id": solid.name, **solid.text}
        inside = self.rhino.attributes(layer, f"{solid.name} block", **text, version=self.version)
        add_block(self.file, solid.name, mesh, definition, inside)
        matrix = rhino3dm.Transform.Identity()
        entries = [f"M{row}{column}" for row in range(3) for column in range(4)]
        columns = np.concatenate([solid.axes, self.rhino.placed(solid.origins)[:, None]], axis=1)
        for values, label in zip(columns.transpose(0, 2, 1).reshape(-1, 12).tolist(), solid.labels, strict=True):
            for entry, value in zip(entries, values, strict=True):
                setattr(matrix, entry, value)
            # what all have in common is said in the block: there may be tens of thousands of places
            own = {"id": text["id"], "place": label} if texts else {}
            attributes = self.rhino.attributes(layer, f"{solid.name} {label}", **own)
            self.file.Objects.AddInstanceObject(rhino3dm.InstanceReference(definition, matrix), attributes)

    def encoded(self) -> bytes:
        return self.rhino.encoded()

    def _add_centre_lines(self, network: Network) -> None:
        spans = _spans(network)
        tangents = network.sample_tangents[_ends(spans)]
        splines = _splines(network, network.sample_points, spans, tangents)
        for k, spline in enumerate(splines):
            family, length = str(network.families[k]), float(network.sample_arclengths[spans[k, 1] - 1])
            attributes = self.rhino.attributes(
                f"lamellas {family}",
                network.ids[k],
                id=network.ids[k],
                family=family,
                length_m=repr(length),
                version=self.version,
            )
            self.rhino.add_curve(3, spline.knots[1:-1], spline.controls, attributes)

    def _add_strips(self, network: Network, section: Section) -> None:
        spans = _spans(network)
        edges = np.hstack(twisted_strip(network, section.height))
        slopes = _edge_slopes(network, section.height, _ends(spans))
        for k, spline in enumerate(_splines(network, edges, spans, slopes)):
            self._add_strip(network, section, k, spans[k], spline)

    def _add_layers(self, network: Network, lamellas: Lamellas) -> None:
        layers, section = lamellas.layers, lamellas.section
        require_finite(layers.points, layers.normals)
        known = [_known(layers.followed, first, end) for first, end in _spans(network).tolist()]
        drawn = [k for k, (first, end) in enumerate(known) if end - first >= LEAST_SAMPLES]
        spans = np.array([known[k] for k in drawn], np.int64).reshape(-1, 2)
        splines = []
        for points, normals in zip(layers.points, layers.normals, strict=True):
            reach = section.height / 2 * normals
            edges = np.hstack((points - reach, points + reach))
            slopes = _end_slopes(edges, network.sample_arclengths, spans)
            splines.append(_splines(network, edges, spans, slopes))
        for k, span, *row in zip(drawn, spans, *splines, strict=True):
            for layer, spline in enumerate(row, 1):
                self._add_strip(network, section, k, span, spline, layer)

    def _add_strip(
        self, network: Network, section: Section, k: int, span: Integers, spline: Spline, layer: int = 0
    ) -> None:
        """The strip along a lamella between two edges, or one of its layers."""
        s = network.sample_arclengths
        length = float(s[span[1] - 1] - s[span[0]])
        knots, place, metres = spline.knots[1:-1], self.rhino.placed, self.rhino.metres
        across = np.array([-0.5, 0.5]) * section.height / metres
        lower_upper = place(spline.controls.reshape(-1, 2, 3))
        strip = nurbs_surface((3, 1), (knots / metres, across), lower_upper)
        family = str(network.families[k])
        name = f"{network.ids[k]}-{layer}" if layer else network.ids[k]
        reported = {"side": SIDES[section.layers][layer - 1]} if layer else {}
        attributes = self.rhino.attributes(
            f"{'layers' if layer else 'strips'} {family}",
            name,
            id=name,
            family=family,
            length_m=repr(length),
            height_m=repr(float(section.height)),
            thickness_m=repr(float(section.thickness)),
            version=self.version,
            **reported,
        )
        self.file.Objects.AddSurface(strip, attributes)

    def _add_nodes(self, network: Network) -> None:
        points = self.rhino.placed(network.node_points).tolist()
        for kind, kind_name in enumerate(NODE_KINDS):
            members = np.flatnonzero(network.node_kinds == kind).tolist()
            layer = f"nodes {kind_name}"
            if len(points) > POINT_OBJECTS:
                if members:
                    cloud = rhino3dm.PointCloud([rhino3dm.Point3d(*points[i]) for i in members])
                    self.file.Objects.AddPointCloud(cloud, self.rhino.attributes(layer, layer, version=self.version))
                continue
            for i in members:
                point = rhino3dm.Point(rhino3dm.Point3d(*points[i]))
                self.file.Objects.Add(point, self.rhino.attributes(layer, str(i)))


def _mesh(vertices: Floats, triangles: Integers) -> rhino3dm.Mesh:
    """A mesh in double precision."""
    mesh = rhino3dm.Mesh()
    mesh.Vertices.UseDoublePrecisionVertices = True
    for x, y, z in vertices.tolist():
        mesh.Vertices.AddPoint3d(x, y, z)
    for a, b, c in triangles.tolist():
        mesh.Faces.AddFace(a, b, c)
    return mesh


def _known(followed: Booleans, first: int, end: int) -> tuple[int, int]:
    """The part of a lamella's samples within which its layers are known: its first one, and that after its last."""
    known = np.flatnonzero(followed[first:end]) + first
    return (int(known[0]), int(known[-1]) + 1) if len(known) >= LEAST_SAMPLES else (first, first)


def _spans(network: Network) -> Integers:
    """First sample of each lamella, and the one after its last, (m, 2)."""
    return np.column_stack((network.sample_offsets[:-1], network.sample_offsets[1:]))


def _ends(spans: Integers) -> Integers:
    """First and last sample of spans, (m, 2)."""
    return np.column_stack((spans[:, 0], spans[:, 1] - 1))


def _splines(network: Network, values: Floats, spans: Integers, slopes: Floats) -> Iterator[Spline]:
    """Splines by the arc length of the centre line through values along parts of lamellas."""
    s = network.sample_arclengths
    lengths = s[spans[:, 1] - 1] - s[spans[:, 0]]
    return fit_splines(s, values, spans, slopes, SPLINE_TOLERANCE * lengths / 3**0.5)


def _end_slopes(edges: Floats, arclengths: Floats, spans: Integers) -> Floats:
    """Derivatives of edges (k, 6) by arc length at the first and the last sample of parts of them, (n, 2, 6)."""
    if not len(spans):
        return np.empty((0, 2, 6))
    first, end = spans.T
    offsets = np.r_[0, np.cumsum(end - first)]
    samples = np.repeat(first - offsets[:-1], end - first) + np.arange(offsets[-1])
    ends = np.column_stack((offsets[:-1], offsets[1:] - 1)).ravel()
    along = arclengths[samples] - np.repeat(arclengths[first], end - first)
    return derivative(edges[samples], along, offsets, np.zeros(len(spans), bool), ends).reshape(-1, 2, 6)


def _edge_slopes(network: Network, height: float, at: Integers) -> Floats:
    """Derivatives of the edges c -+ h/2 n by the arc length of c, at samples (m, 2), (m, 2, 6)."""
    tangents, normals = network.sample_tangents[at], network.sample_normals[at]
    kn, tg = network.sample_darboux.kn[at][..., None], network.sample_darboux.tg[at][..., None]
    turning = height / 2 * (-kn * tangents - tg * np.cross(normals, tangents))
    return np.concatenate((tangents - turning, tangents + turning), axis=-1)
