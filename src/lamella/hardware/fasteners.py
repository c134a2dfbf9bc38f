"""Bolts and screws by their lengths, and nuts, as items of the hardware."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.hardware.bolts import BoltSize
from lamella.hardware.item import Item, Places
from lamella.hardware.rules import MM, NUT_HOLE, JointRules
from lamella.hardware.shape import Prism, circle, hexagon, polygon

NECK_PLAY = 1e-4
"""m; between a carriage bolt's square neck and its hole, on each side."""

GRIP_DECIMALS = 6
"""Of grips in m: equal ones have equal bolts, whatever rounding says."""


def carriage_bolts(name: str, rules: JointRules, size: BoltSize, heads: Places, grip: Floats) -> list[Item]:
    """Carriage bolts, a kind for each length, see `hexagon_screws`."""
    head = Prism(circle(size.head), 0.0, size.head_height)
    return _by_length(name, "bolt", "carriage bolt DIN 603", head, rules, size, heads, grip)


def hexagon_screws(name: str, rules: JointRules, size: BoltSize, heads: Places, grip: Floats) -> list[Item]:
    """Hexagon screws, a kind for each length.

    Parameters
    ----------
    name : str
        Of the items: "screw" gives "screw-1", "screw-2", ...
    rules : JointRules
    size : BoltSize
    heads : Places
        Where the heads' lower faces are, z away from what is bolted.
    grip : (q,)
        What each one holds together, m.
    """
    head = Prism(hexagon(size.flats), 0.0, size.hex_height)
    return _by_length(name, "screw", "hexagon screw ISO 4017", head, rules, size, heads, grip)


def flange_nuts(name: str, rules: JointRules, size: BoltSize, places: Places) -> Item:
    """Nuts, z away from what is bolted."""
    shape = Prism(hexagon(size.flats), 0.0, size.nut, (circle(NUT_HOLE * size.diameter),))
    text = f"flange nut EN 1661 {size.name}"
    return Item(f"{name}-1", "nut", text, rules.material, rules.density, (shape,), places)


def neck_hole(size: BoltSize) -> Floats:
    """Outline of the square hole for a carriage bolt's neck."""
    reach = size.neck / 2 + NECK_PLAY
    return polygon([[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]])


def _by_length(
    name: str,
    kind: str,
    standard: str,
    head: Prism,
    rules: JointRules,
    size: BoltSize,
    heads: Places,
    grip: Floats,
) -> list[Item]:
    lengths = np.array([size.length(g) for g in np.round(grip, GRIP_DECIMALS).tolist()])
    items = []
    for number, length in enumerate(np.unique(lengths).tolist()):
        shape = (head, Prism(circle(size.diameter), -length, 0.0))
        text = f"{standard} {size.name} x {MM * length:g}"
        at = heads.chosen(lengths == length)
        items.append(Item(f"{name}-{number + 1}", kind, text, rules.material, rules.density, shape, at, length=length))
    return items
