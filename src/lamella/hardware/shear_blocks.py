"""Shear blocks: what couples the layers of a lamella between its nodes (paper, 3.2).

A block fills the gap between two neighbouring layers and is bolted through both; with more than two layers one screw
goes through all blocks that lie beside each other. A block is flat and the layers are not: beside its middle they leave
their tangent planes by kg x^2 / 2 + tg x z and more. How far they do is taken from the layers themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.hardware.bores import Bores
from lamella.hardware.classes import classes, rounded_down
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import LayerFaces, ahead, area
from lamella.hardware.rules import MM, JointRules
from lamella.hardware.screws import screws
from lamella.hardware.shape import Prism, circle, rectangle
from lamella.strip.lamellas import Lamellas

WIDTH_STEP = 5e-4
"""m; blocks whose gaps differ by less are made alike, as wide as the narrowest of them."""

WIDTH_ROUNDING = 1e-4
"""m; blocks are a whole number of these wide."""


@dataclass(frozen=True, eq=False)
class ShearBlocks:
    """Blocks, their screws and the holes these need.

    Attributes
    ----------
    items : tuple of Item
    bores : Bores
    cells_without : int
        Cells too short for a block.
    """

    items: tuple[Item, ...]
    bores: Bores
    cells_without: int


def shear_blocks(
    lamellas: Lamellas, rules: JointRules, keep_clear: Floats, splices: Floats | None = None
) -> ShearBlocks:
    """Blocks along every lamella, at equal distances in every cell.

    Parameters
    ----------
    lamellas : Lamellas
    rules : JointRules
        At most `block_spacing` is between blocks where there is room for them.
    keep_clear : (q,)
        How far from each stop no block may reach, m.
    splices : (c, 3), optional
        Lamella, arc length (m) and half length (m) of what joins its pieces: no block lies there.

    Returns
    -------
    ShearBlocks
    """
    owner, arclengths, without = _positions(lamellas, rules, keep_clear, splices)
    ids = lamellas.network.ids
    labels = tuple(f"{ids[k]} at {MM * s:.0f} mm" for k, s in zip(owner.tolist(), arclengths.tolist(), strict=True))
    items = (
        *_blocks(lamellas, rules, owner, arclengths, labels),
        *screws(lamellas, owner, arclengths, rules, labels, "block"),
    )
    hole = np.full(len(owner), rules.block_size.hole)
    return ShearBlocks(items, Bores(owner, arclengths, np.zeros(len(owner)), hole), without)


def _positions(
    lamellas: Lamellas, rules: JointRules, keep_clear: Floats, splices: Floats | None
) -> tuple[Integers, Floats, int]:
    """Lamella and arc length of every block, and the number of cells without."""
    network = lamellas.network
    owner, arc = network.stop_owner, network.stop_arclengths
    cell = np.flatnonzero(owner[1:] == owner[:-1])
    begin, end = arc[cell], arc[cell + 1]
    # rounded, so that equal cells have equally many
    number = np.ceil(np.round((end - begin) / rules.block_spacing, 6)).astype(np.int64)
    of_cell = np.repeat(np.arange(len(cell)), number)
    share = (np.arange(len(of_cell)) - np.repeat(np.cumsum(number) - number, number) + 0.5) / number[of_cell]
    at = begin[of_cell] + share * (end - begin)[of_cell]
    half = rules.block_length / 2
    fits = (at - half >= (begin + keep_clear[cell])[of_cell]) & (at + half <= (end - keep_clear[cell + 1])[of_cell])
    for lamella, place, reach in [] if splices is None else splices.tolist():
        fits &= (owner[cell][of_cell] != lamella) | (np.abs(at - place) > reach + half)
    without = len(cell) - len(np.unique(of_cell[fits]))
    return owner[cell][of_cell[fits]], at[fits], without


def _blocks(
    lamellas: Lamellas, rules: JointRules, owner: Integers, arclengths: Floats, labels: tuple[str, ...]
) -> list[Item]:
    """Blocks of all gaps, those of nearly the same width alike."""
    length, height = rules.block_length, rules.block_height(lamellas.section)
    faces = LayerFaces.of(lamellas, owner, arclengths, *area(length, height))
    gaps, middles, axes = [], [], []
    for row in range(lamellas.section.layers - 1):
        middle = (faces.middles[row] + faces.middles[row + 1]) / 2
        axes.append(faces.axes(faces.middles[row + 1] - faces.middles[row]))
        to_right = ahead(faces.left[row], middle, axes[-1][:, 2]).min(axis=1)
        to_left = ahead(faces.right[row + 1], middle, -axes[-1][:, 2]).min(axis=1)
        gaps.append(2 * (np.minimum(to_right, to_left) - rules.play))
        middles.append(middle)
    if len(gaps) > 1:
        labels = tuple(f"{label} gap {row + 1}" for row in range(len(gaps)) for label in labels)
    places = Places(np.concatenate(middles), np.concatenate(axes), labels)
    return filling("block", "shear block", rules, length, height, np.concatenate(gaps), places, (0.0,))


def filling(
    name: str,
    description: str,
    rules: JointRules,
    length: float,
    height: float,
    widths: Floats,
    places: Places,
    holes: tuple[float, ...],
) -> list[Item]:
    """Blocks across gaps, those of nearly the same width alike.

    Parameters
    ----------
    name, description : str
        Of the items.
    rules : JointRules
    length, height : float
        m.
    widths : (b,)
        The largest each may have, m; none is made where nothing is left.
    places : Places
        Of the blocks' middles: x along the lamella, z across the gap.
    holes : tuple of float
        Where along x the screws' holes are, m.
    """
    size = rules.block_size
    some = widths > WIDTH_ROUNDING
    kind, smallest = classes(widths[some], WIDTH_STEP, lowest=True)
    places = places.chosen(some)
    items = []
    for number, width in enumerate(rounded_down(smallest, WIDTH_ROUNDING).tolist()):
        bored = tuple(circle(size.hole, (x, 0.0)) for x in holes)
        shape = Prism(rectangle(length, height), -width / 2, width / 2, bored)
        text = f"{description} {MM * length:.4g} x {MM * height:.4g} x {MM * width:.4g} mm, hole {MM * size.hole:g} mm"
        at = places.chosen(kind == number)
        items.append(Item(f"{name}-{number + 1}", name, text, *rules.block, (shape,), at))
    return items
