"""Points of the layers' faces around places where something flat is bolted to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.strip.lamellas import Lamellas
from lamella.strip.layer_map import LayerMap

RING = 16
"""Points around a head or a nut."""


@dataclass(frozen=True, eq=False)
class LayerFaces:
    """Faces of all layers around b places, at p points each.

    Attributes
    ----------
    middles : (layers, b, 3)
        Where the layers' centre lines are beside each place, m.
    right, left : (layers, b, p, 3)
        Points of the faces, m.
    normals : (b, 3)
        Unit normals of the surface, a mean of the layers'.
    """

    middles: Floats
    right: Floats
    left: Floats
    normals: Floats

    @classmethod
    def of(cls, lamellas: Lamellas, owner: Integers, arclengths: Floats, x: Floats, z: Floats) -> LayerFaces:
        """The faces around places on lamellas.

        Parameters
        ----------
        lamellas : Lamellas
        owner : (b,) int
            Lamella of each place.
        arclengths : (b,)
            Along its centre line, m.
        x, z : (p,)
            The points, along the lamella and over the centre line, m.
        """
        count = lamellas.section.layers
        middles = np.empty((count, len(owner), 3))
        right, left = np.empty((2, count, len(owner), len(x), 3))
        normals = np.zeros((len(owner), 3))
        order = np.argsort(owner, kind="stable")
        present, starts = np.unique(owner[order], return_index=True)
        for lamella, some in zip(present.tolist(), np.split(order, starts[1:]), strict=True):
            at = (arclengths[some, None] + x).ravel()
            for row in range(count):
                layer = LayerMap.of(lamellas, lamella, row, by_arclength=True)
                middles[row, some], _, normal, _ = layer.frames(arclengths[some])
                normals[some] += normal
                faces = layer.surfaces(at, np.tile(z, len(some)), lamellas.section.thickness)
                right[row, some], left[row, some] = (face.reshape(len(some), -1, 3) for face in faces)
        return cls(middles, right, left, normals / np.linalg.norm(normals, axis=1)[:, None])

    def axes(self, sideways: Floats) -> Floats:
        """Axes (b, 3, 3) of a flat part between layers: x along the lamella, y up, z against `sideways`, to the right.

        Parameters
        ----------
        sideways : (b, 3)
            From the right to the left layer.
        """
        z = -sideways / np.linalg.norm(sideways, axis=1)[:, None]
        y = self.normals - np.einsum("ij,ij->i", self.normals, z)[:, None] * z
        y /= np.linalg.norm(y, axis=1)[:, None]
        return np.stack([np.cross(y, z), y, z], axis=1)


def area(length: float, height: float) -> tuple[Floats, Floats]:
    """Corners, middles of edges and middle of a rectangle, (9,) each, m."""
    across = np.array([-0.5, 0.0, 0.5])
    return np.repeat(across, 3) * length, np.tile(across, 3) * height


def ring(diameter: float) -> tuple[Floats, Floats]:
    """Points of a circle, (`RING`,) each, m."""
    angle = 2 * np.pi * np.arange(RING) / RING
    return diameter / 2 * np.cos(angle), diameter / 2 * np.sin(angle)


def ahead(points: Floats, origins: Floats, directions: Floats) -> Floats:
    """How far points (b, p, 3) lie from origins (b, 3) along unit directions (b, 3), (b, p), m."""
    return np.asarray(np.einsum("bpi,bi->bp", points - origins[:, None], directions))
