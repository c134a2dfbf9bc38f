"""Curves and points on a layer of their own, as stages add them to the model."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats


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
    """

    name: str
    curves: tuple[Floats, ...] = ()
    points: tuple[Floats, ...] = ()
    colour: tuple[int, int, int] = (90, 90, 90)
