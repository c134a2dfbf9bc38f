"""The strips of a structure as they are built, each layer a body of its own with the id it has in the lists."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.fabrication.flat import ARC_PARTS
from lamella.fabrication.part import Part, Parts
from lamella.solid.solid import Solid
from lamella.solid.strip import layer_rows, strip_solid
from lamella.strip.lamellas import Lamellas
from lamella.strip.layers import SIDES

TRIANGLE_LIMIT = 1_000_000
"""Triangles of all strips up to which files hold them unasked: some 60 MB."""

STEPS_PER_CELL = 4
"""Least number of pieces of an edge from node to node."""


@dataclass(frozen=True, eq=False)
class StripBody:
    """One piece of strip, bent and twisted into its place.

    Attributes
    ----------
    name : str
        The part's id, and the number of the layer from the right one (1) on where one part stands for several.
    part : Part
    row : int
        Which layer it is, from the right one (0) on.
    side : str
        Name of the layer: R, L; see `lamella.strip.layers.SIDES`.
    solid : Solid
    """

    name: str
    part: Part
    row: int
    side: str
    solid: Solid


def body_name(part: Part, row: int) -> str:
    """Name of a part's piece in a layer."""
    return part.id if part.layer else f"{part.id}-{row + 1}"


def strip_bodies(parts: Parts, lamellas: Lamellas, step: float) -> Iterator[StripBody]:
    """All pieces, in the order of the parts, from the right layer to the left one.

    Parameters
    ----------
    parts : Parts
    lamellas : Lamellas
        That they were made from.
    step : float
        Longest piece of their edges, m.
    """
    sides = SIDES[lamellas.section.layers]
    for part in parts.parts:
        for row in layer_rows(part, lamellas):
            solid = strip_solid(part, lamellas, row, step=step)
            yield StripBody(body_name(part, row), part, row, sides[row], solid)


def body_step(lamellas: Lamellas) -> float:
    """Longest piece of an edge, m, so that flat triangles leave the twisted, bent face by a quarter of the thickness.

    Two triangles between rulings a step apart leave the ruled face by tg h step / 4, a chord its arc by kg step^2 / 8.
    """
    network, section = lamellas.network, lamellas.section
    torsion = float(np.abs(network.sample_darboux.tg).max(initial=0.0))
    bend = float(np.abs(network.sample_darboux.kg).max(initial=0.0))
    step = float(np.median(network.cell_edges)) / STEPS_PER_CELL if len(network.cell_edges) else section.height
    if torsion > 0:
        step = min(step, section.thickness / (torsion * section.height))
    if bend > 0:
        step = min(step, float(np.sqrt(2 * section.thickness / bend)))
    return step


def triangle_count(parts: Parts, step: float) -> int:
    """About how many triangles the bodies of all strips have."""
    corners = 0.0
    for part in parts.parts:
        edges = np.linalg.norm(np.roll(part.outline[:, :2], -1, axis=0) - part.outline[:, :2], axis=1)
        ring = float(np.maximum(np.ceil(edges / step), 1).sum())
        holes = 2 * ARC_PARTS * len(part.holes)
        corners += part.quantity * (ring + holes)
    # two caps and the walls: about four triangles a corner
    return int(4 * corners)
