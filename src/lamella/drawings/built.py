"""What the drawings show: the net, its strips and the hardware, and what of it is near a place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.part import Parts
from lamella.hardware.item import Hardware, Item
from lamella.network.network import Network
from lamella.segments.segments import Segments
from lamella.solid.bodies import body_name
from lamella.solid.extrusion import between, item_solid
from lamella.solid.solid import Solid
from lamella.solid.strip import layer_rows, strip_solid
from lamella.strip.lamellas import Lamellas

EDGE_PIECES = 20
"""Pieces of a strip's edge for each of its heights."""


@dataclass(frozen=True, eq=False)
class Built:
    """A structure to be drawn.

    Attributes
    ----------
    network : Network
    lamellas : Lamellas
    parts : Parts
    hardware : Hardware
    name, version : str
        Of the project and of the program.
    material : str
        Of the strips.
    kind : str
        How lamellas are joined, `joint.kind`.
    segments : Segments or None
        Which parts are assembled, carried and lifted in one, where the structure is divided.
    """

    network: Network
    lamellas: Lamellas
    parts: Parts
    hardware: Hardware
    name: str
    version: str
    material: str
    kind: str = "interlocked"
    segments: Segments | None = None


@dataclass(frozen=True, eq=False)
class Piece:
    """A solid in its place; what it is of."""

    name: str
    item: Item | None
    solid: Solid

    @property
    def middle(self) -> Floats:
        """Of the bounding box of its triangles, m, (3,)."""
        corners = self.solid.vertices[self.solid.triangles].reshape(-1, 3)
        return np.asarray((corners.min(axis=0) + corners.max(axis=0)) / 2)


def hardware_near(built: Built, centre: Floats, radius: float) -> Iterator[Piece]:
    """Pieces of hardware that reach into a ball, m."""
    for item in built.hardware:
        if item.bent:
            for bent in item.bent:
                if np.linalg.norm(bent.low - centre, axis=1).min() < radius:
                    yield Piece(item.id, item, between(bent.rings, bent.low, bent.high))
            continue
        own = item_solid(item)
        away = np.linalg.norm(item.places.origins - centre, axis=1)
        for k in np.flatnonzero(away < radius + np.linalg.norm(own.vertices, axis=1).max()).tolist():
            vertices = item.places.chosen(np.array([k])).world(own.vertices)[0]
            if _distance(Solid(vertices, own.triangles), centre) < radius:
                yield Piece(item.id, item, Solid(vertices, own.triangles))


def strips_near(built: Built, centre: Floats, radius: float) -> Iterator[Piece]:
    """Pieces of strips that reach into a ball, m."""
    network, section = built.network, built.lamellas.section
    reach = radius + section.height / 2 + section.layers * section.offset
    near = np.linalg.norm(network.sample_points - centre, axis=1)
    steps = network.cell_edges.max(initial=0.0)
    lamellas = np.flatnonzero(np.minimum.reduceat(near, network.sample_offsets[:-1]) < reach + steps)
    for part in built.parts.parts:
        if part.lamella in lamellas:
            for row in layer_rows(part, built.lamellas):
                solid = strip_solid(part, built.lamellas, row, step=section.height / EDGE_PIECES)
                if _distance(solid, centre) < radius:
                    yield Piece(body_name(part, row), None, solid)


def _distance(solid: Solid, centre: Floats) -> float:
    """Of a solid's surface from a point, about, m."""
    corners = solid.vertices[solid.triangles]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    # nearest point of each triangle's plane, pulled back to its bounding box
    nearest = np.clip(centre, np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c))
    return float(np.linalg.norm(nearest - centre, axis=1).min())
