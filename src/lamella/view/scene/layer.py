"""Layers of a scene: meshes, lines, points, equal pieces in many places, and strips swept along curves.

Points are in metres, in the coordinates of the results (`Results.origin` is their zero in the drawing). What a layer's
values and owners run over, its elements: the vertices of a mesh, of lines and of points, the places of instances, the
samples of strips.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.view.scene.quantity import Quantity

Material = Literal["steel", "timber", "fibre", "surface", "ground", "person", "plain"]
MATERIALS = ("steel", "timber", "fibre", "surface", "ground", "person", "plain")


@dataclass(frozen=True, eq=False, kw_only=True)
class Layer:
    """What all layers have.

    Attributes
    ----------
    name : str
        Unique in a scene, "strips A".
    label : str
        What people read, "Lamellas A".
    groups : tuple of str
        Switches of the viewer: the layer is seen while all of them are on. A switch is made for every group, in the
        order in which groups first appear; it is off at first where all layers of the group are off.
    visible : bool
        Whether its switches are on at first.
    material : str
        What it looks like, one of `MATERIALS`, where it is not coloured by a quantity.
    colour : str
        As #rrggbb, tints the material; empty: the material's own.
    opacity : float
        1: nothing is seen through it.
    quantities : tuple of Quantity
        What it can be coloured by: one value an element each.
    quantity : str
        Key of the one it is coloured by at first; empty: by its material; "layer": by its own colour.
    palette : str
        Name of the list, "Lamellas", from which one colouring is chosen for all layers that have it; the layer given
        last decides the first one. Empty: it stays as it is.
    ids : tuple of str
        Names of what can be pointed at.
    owner : (n,) int or None
        Index into `ids` of each element; None: the layer cannot be pointed at (strips: each curve has its id).
    replaces : tuple of str
        Names of layers that are not drawn while this one is.
    """

    kind: ClassVar[str]

    name: str
    label: str
    groups: tuple[str, ...] = ()
    visible: bool = True
    material: Material = "plain"
    colour: str = ""
    opacity: float = 1.0
    quantities: tuple[Quantity, ...] = ()
    quantity: str = ""
    palette: str = ""
    ids: tuple[str, ...] = ()
    owner: Integers | None = None
    replaces: tuple[str, ...] = ()

    @property
    def points(self) -> Floats:
        """Points that the layer is about, (n, 3): what a camera has to see."""
        raise NotImplementedError

    @property
    def reach(self) -> Floats:
        """Points that it reaches to, (n, 3)."""
        return self.points

    @property
    def count(self) -> int:
        """Number of elements."""
        return len(self.points)


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshLayer(Layer):
    """Triangles.

    Attributes
    ----------
    positions : (n, 3)
    faces : (f, 3) int
        Counter-clockwise seen from outside.
    normals : (n, 3) or None
        Unit; None: every face is flat.
    like : str
        Name of the layer of strips whose quantities and ids it takes; empty: it has its own.
    samples : (n,) int or None
        With `like`, the element of that layer for each vertex.
    """

    kind = "mesh"

    positions: Floats
    faces: Integers
    normals: Floats | None = None
    like: str = ""
    samples: Integers | None = None

    @property
    def points(self) -> Floats:
        """See `Layer`."""
        return self.positions


@dataclass(frozen=True, eq=False, kw_only=True)
class LinesLayer(Layer):
    """Polylines.

    Attributes
    ----------
    positions : (n, 3)
        Points of the lines one after the other.
    offsets : (m + 1,) int
        Where the points of each begin.
    width : float
        On the screen, pixels.
    """

    kind = "lines"

    positions: Floats
    offsets: Integers
    width: float = 1.5

    @property
    def points(self) -> Floats:
        """See `Layer`."""
        return self.positions


@dataclass(frozen=True, eq=False, kw_only=True)
class PointsLayer(Layer):
    """Round points.

    Attributes
    ----------
    positions : (n, 3)
    size, least : float
        On the screen, pixels: at most, and at least where the net is seen from afar.
    """

    kind = "points"

    positions: Floats
    size: float = 4.0
    least: float = 0.6

    @property
    def points(self) -> Floats:
        """See `Layer`."""
        return self.positions


@dataclass(frozen=True, eq=False, kw_only=True)
class InstancesLayer(Layer):
    """A solid that stands in several places.

    Attributes
    ----------
    positions : (n, 3)
        In the solid's own axes.
    faces : (f, 3) int
        Counter-clockwise seen from outside.
    origins : (q, 3)
        Of the places.
    axes : (q, 3, 3)
        Rows: where the solid's x, y and z point there.
    """

    kind = "instances"

    positions: Floats
    faces: Integers
    origins: Floats
    axes: Floats

    @property
    def points(self) -> Floats:
        """See `Layer`."""
        return self.origins


@dataclass(frozen=True, eq=False, kw_only=True)
class StripsLayer(Layer):
    """Strips with their thickness: rectangles swept along curves, upright on normals. The viewer makes the faces.

    Attributes
    ----------
    positions, normals : (n, 3)
        Samples of the curves one after the other, and where up is there, unit.
    offsets : (m + 1,) int
        Where the samples of each curve begin.
    sides : (l,) or (l, n)
        Layers: their distances from the curve, or at each sample, towards normal x tangent, m.
    height, thickness : float
        Of each layer, m.
    level : float
        From the curve to the middle of the strip along the normal, m.
    """

    kind = "strips"

    positions: Floats
    normals: Floats
    offsets: Integers
    sides: Floats
    height: float
    thickness: float
    level: float = 0.0

    @property
    def points(self) -> Floats:
        """See `Layer`."""
        return self.positions

    @property
    def reach(self) -> Floats:
        """The edges of a strip on every sample."""
        half = self.height / 2
        return np.concatenate([self.positions + (self.level + side * half) * self.normals for side in (-1, 1)])
