"""What strips on the lines of a principal net would be, to compare their cost with that of lamellas.

Along a principal line tg = 0: the normals make a developable surface, and a strip upright on it is bent by kg and not
twisted. Its flat outline has the curvature kn of the line, which varies: no two strips are cut alike but by symmetry,
and none from straight stock (the Eiffel Tower Pavilions were built so: Schiftner, Leduc, Bompas, Baldassini, Eigensatz,
Advances in Architectural Geometry 2012).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.network import Network

SAME_OUTLINE = 1e-4
"""Of lengths, over the longest, and of turnings (rad) by which strips that are cut alike differ at most."""


@dataclass(frozen=True)
class PrincipalStrips:
    """What strips on the lines of a principal net would be.

    Attributes
    ----------
    different : int
        Outlines that differ by their length or by how much they turn, in all or quarter by quarter.
    bend_max : float
        Largest |kg|, 1/m.
    twist_max : float
        Largest |tg|, 1/m: 0 but for rounding.
    edgewise_min, edgewise_max : float
        Least and largest kn, the curvature of the outlines, 1/m.
    """

    different: int
    bend_max: float
    twist_max: float
    edgewise_min: float
    edgewise_max: float


def principal_strips(network: Network) -> PrincipalStrips:
    """The figures of a principal net."""
    kn, kg, tg = network.sample_darboux
    return PrincipalStrips(
        _different(network, kn),
        float(np.abs(kg).max()),
        float(np.abs(tg).max()),
        float(kn.min()),
        float(kn.max()),
    )


def _different(network: Network, kn: Floats) -> int:
    """Kinds of flat outlines: a strip may be turned end for end, and over."""
    starts, ends = network.sample_offsets[:-1], network.sample_offsets[1:] - 1
    arc = network.sample_arclengths
    step = np.diff(arc)
    # the turning from each line's start to each sample, by the trapezoidal rule
    turned = np.r_[0, np.cumsum(np.where(step > 0, step, 0) * (kn[1:] + kn[:-1]) / 2)]
    place = np.r_[0, np.cumsum(np.where(step > 0, step, 0))]
    quarters = []
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        quarters.append(np.interp(place[starts] + share * (place[ends] - place[starts]), place, turned))
    turns = np.diff(np.stack(quarters, 1), axis=1)
    length = arc[ends] / arc[ends].max()
    ways = np.stack([turns, turns[:, ::-1], -turns, -turns[:, ::-1]])
    row = np.concatenate([np.broadcast_to(length[None, :, None], (4, len(length), 1)), ways], 2)
    ranks = np.unique(np.rint(row / SAME_OUTLINE).reshape(-1, 5) + 0.0, axis=0, return_inverse=True)[1].reshape(4, -1)
    return len(np.unique(ranks.min(axis=0)))
