"""Curves, points and solids on a layer of their own, as stages add them to the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from lamella.base.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class Repeated:
    """A solid that stands in several places.

    Attributes
    ----------
    name : str
        Of the block.
    vertices : (v, 3)
        In the solid's own axes, m.
    triangles : (f, 3) int
        Counter-clockwise seen from outside.
    origins : (q, 3)
        Of the places, m.
    axes : (q, 3, 3)
        Rows: where the solid's x, y and z point there.
    labels : tuple of str
        Name of each place.
    text : dict
        User text of the solid: `id`, where it is another one than the name, and more.
    finish : str
        "metal", "timber" or "fibre": what it looks like.
    """

    name: str
    vertices: Floats
    triangles: Integers
    origins: Floats
    axes: Floats
    labels: tuple[str, ...]
    text: Mapping[str, str] = field(default_factory=dict)
    finish: str = "metal"


@dataclass(frozen=True, eq=False)
class Body:
    """A solid in its place, like no other.

    Attributes
    ----------
    name : str
    vertices : (v, 3)
        m.
    triangles : (f, 3) int
        Counter-clockwise seen from outside.
    text : dict
        User text: `id`, where it is another one than the name, and more.
    finish : str
        As that of `Repeated`.
    """

    name: str
    vertices: Floats
    triangles: Integers
    text: Mapping[str, str] = field(default_factory=dict)
    finish: str = "metal"


@dataclass(frozen=True)
class DrawnLayer:
    """A layer of the model.

    Attributes
    ----------
    name : str
        Of the layer.
    curves : tuple of (k, 3)
        Polylines, m.
    points : tuple of (3,)
        m.
    colour : (int, int, int)
        Red, green, blue, 0 to 255.
    repeated : tuple of Repeated
    bodies : tuple of Body
    """

    name: str
    curves: tuple[Floats, ...] = ()
    points: tuple[Floats, ...] = ()
    colour: tuple[int, int, int] = (90, 90, 90)
    repeated: tuple[Repeated, ...] = ()
    bodies: tuple[Body, ...] = ()
