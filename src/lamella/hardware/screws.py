"""Hexagon screws through all layers of a lamella, with their nuts."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.hardware.fasteners import flange_nuts, hexagon_screws
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import LayerFaces, ahead, ring
from lamella.hardware.rules import SEAT_PLAY, JointRules
from lamella.strip.lamellas import Lamellas


def screws(
    lamellas: Lamellas, owner: Integers, arclengths: Floats, rules: JointRules, labels: tuple[str, ...], name: str
) -> list[Item]:
    """Screws through the layers at places of lamellas, heads to the right, and their nuts.

    Heads and nuts are flat: they rest on the highest places around their holes.

    Parameters
    ----------
    lamellas : Lamellas
    owner, arclengths : (b,)
        Lamella and arc length of each screw, m.
    rules : JointRules
    labels : tuple of str
        Where each screw is.
    name : str
        Of the items: "block" gives "block-screw-1", "block-nut-1".
    """
    if not len(owner):
        return []
    size = rules.block_size
    faces = LayerFaces.of(lamellas, owner, arclengths, *ring(size.nut_flange))
    axes = faces.axes(faces.middles[-1] - faces.middles[0])
    turned = axes * np.array([1.0, -1.0, -1.0])[:, None]
    begin = ahead(faces.right[0], faces.middles[0], axes[:, 2]).max(axis=1) + SEAT_PLAY
    end = ahead(faces.left[-1], faces.middles[-1], turned[:, 2]).max(axis=1) + SEAT_PLAY
    heads = Places(faces.middles[0] + begin[:, None] * axes[:, 2], axes, labels)
    nuts = Places(faces.middles[-1] + end[:, None] * turned[:, 2], turned, labels)
    grip = np.linalg.norm(nuts.origins - heads.origins, axis=1)
    return [
        *hexagon_screws(f"{name}-screw", rules, size, heads, grip),
        flange_nuts(f"{name}-nut", rules, size, nuts),
    ]
