"""The level curves of a net as polylines, before crossings are looked for: what is drawn while a boundary moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.result import Result
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_chains import level_chains
from lamella.network.elements.level_curves import make_level_curves
from lamella.network.elements.small_triangles import SmallGrid, small_triangles
from lamella.network.network import FAMILIES, A, B
from lamella.surface.element.places import Places


@dataclass(frozen=True, eq=False, repr=False)
class LevelLines(Result):
    """Polylines, one after the other: corners on the surface where a curve goes over from a small triangle to the next.

    Attributes
    ----------
    points : (n, 3)
        m.
    offsets : (c + 1,) int
        Where each line's points begin.
    families : (c,) str
        "A" or "B".
    places : Places
        Of the points, on the elements that the isothermic coordinates were integrated on.

    Examples
    --------
    >>> import lamella
    >>> rings = [lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.5)]
    >>> lines = lamella.follow_net(lamella.film(rings, tolerance=0.03), cells=12).lines
    >>> first = lines.points[lines.offsets[0] : lines.offsets[1]]
    >>> first.shape[1], str(lines.families[0])
    (3, 'A')
    """

    points: Floats
    offsets: Integers
    families: NDArray[np.str_]
    places: Places

    def _line(self) -> str:
        return f"{len(self.families):,} lines of {len(self.points):,} points"


def level_lines(cells: IntegerGridMap, cut: Booleans, grid: SmallGrid | None = None) -> LevelLines:
    """The level curves of both families; a short piece beside a seam or a corner is one of them.

    Parameters
    ----------
    cells : IntegerGridMap
    cut : (m, 3) bool
        Edges that are cut, see `Isothermic.cut`.
    grid : SmallGrid, optional
        Small triangles of these elements, where they are at hand.
    """
    small = small_triangles(cells, cut, cells.mesh.umbilics[cells.mesh.umbilics >= 0], grid)
    curves = make_level_curves(small, (level_chains(small, cells, A), level_chains(small, cells, B)))
    count = len(curves.family)
    # the begin of each link, and the end of the last one of each curve
    element = np.append(curves.element, curves.element[curves.last])
    local = np.concatenate([curves.local_start, curves.local_end[curves.last]])
    order = np.argsort(np.append(curves.owner, np.arange(count)), kind="stable")
    places = Places(element, local)[order]
    offsets = np.append(curves.first, len(curves.owner)) + np.arange(count + 1)
    return LevelLines(cells.positions(places), offsets, np.array(FAMILIES)[curves.family], places)
