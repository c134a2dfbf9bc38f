"""Runs of quads along one principal direction, which one plate covers that is bent along the sides between them.

A run is laid flat by unfolding the two triangles of each quad, whose lengths it keeps exactly; quads of principal nets
are planar up to terms of fourth order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.network import Network
from lamella.panels.angles import sides_across
from lamella.panels.polygons import Polygons


class Runs(NamedTuple):
    """Runs, and their quads.

    Attributes
    ----------
    quads : list of (k,) int
        Of each run in order.
    backs : list of (k,) int
        The side (0 to 3) that each quad is entered by.
    """

    quads: list[Integers]
    backs: list[Integers]


def first_directions(network: Network) -> Floats:
    """Direction of the larger principal curvature at the nodes, (n, 3); nan where no A and B lamella meet.

    Of a net of lamellas it lies between A, where the geodesic torsion is positive, and B, counter-clockwise from A;
    of a principal net it is that of A.
    """
    sample = network.sample_offsets[network.stop_owner] + network.stop_samples
    is_a = network.families[network.stop_owner] == "A"
    pair = np.full((2, len(network.node_points), 3), np.nan)
    for k, some in enumerate((is_a, ~is_a)):
        pair[k, network.stop_nodes[some]] = network.sample_tangents[sample[some]]
    a, b = pair
    if network.pattern.kind == "principal":
        return np.asarray(a)
    sense = np.einsum("ij,ij->i", np.cross(a, b), network.node_normals)
    between = a + np.sign(sense)[:, None] * b
    return np.asarray(between / np.linalg.norm(between, axis=1)[:, None])


def runs_of(points: Floats, polygons: Polygons, some: Booleans, directions: Floats, along: int) -> Runs:
    """The longest runs of quads.

    Parameters
    ----------
    points : (n, 3)
        At the nodes, m.
    polygons : Polygons
    some : (p,) bool
        Quads that may be parts of runs.
    directions : (p, 3)
        Of the larger principal curvature at each polygon.
    along : 1 or 2
        The principal direction that runs follow.
    """
    quads = np.flatnonzero(some)
    at = polygons.offsets[:-1][quads][:, None] + np.arange(4)
    corner = points[polygons.nodes[at]]
    sides = np.roll(corner, -1, axis=1) - corner
    sides = sides / np.linalg.norm(sides, axis=2)[:, :, None]
    share = np.abs(np.einsum("qni,qi->qn", sides, directions[quads]))
    # sides along the first direction are crossed by runs along the second one
    first_even = share[:, 0] + share[:, 2] > share[:, 1] + share[:, 3]
    entered = np.where(first_even == (along == 2), 0, 1)
    number = np.full(len(polygons), -1)
    number[quads] = np.arange(len(quads))
    across = sides_across(polygons)[at]
    beyond = np.where(across >= 0, number[polygons.owner[across]], -1)
    side = across - polygons.offsets[:-1][polygons.owner[across]]
    # a neighbour is of the same run where it is entered by that side
    fits = (beyond >= 0) & (side % 2 == entered[beyond])
    return _walked(quads, entered, np.where(fits, beyond, -1), side)


def _walked(quads: Integers, entered: Integers, beyond: Integers, side: Integers) -> Runs:
    """Runs from their ends, then those that close, from their first quad."""
    quads_of, backs_of = [], []
    done = np.zeros(len(quads), bool)
    table, sides = beyond.tolist(), side.tolist()
    begins = [(k, e) for k, e in enumerate(entered.tolist()) if table[k][e] < 0]
    begins += [(k, e + 2) for k, e in enumerate(entered.tolist()) if table[k][e + 2] < 0]
    begins.sort()
    for start, back in [*begins, *enumerate(entered.tolist())]:
        run, backs, here = [], [], start
        while here >= 0 and not done[here]:
            done[here] = True
            run.append(here)
            backs.append(back)
            ahead = (back + 2) % 4
            here, back = table[here][ahead], sides[here][ahead]
        if run:
            quads_of.append(quads[np.array(run)])
            backs_of.append(np.array(backs))
    return Runs(quads_of, backs_of)


def run_rails(polygons: Polygons, quads: Integers, backs: Integers) -> tuple[Integers, Integers]:
    """Nodes on the left and on the right of a run, from its beginning to its end, (k + 1,) each."""
    at = polygons.offsets[:-1][quads]
    left, right, far_right, far_left = (polygons.nodes[at + (backs + k) % 4] for k in range(4))
    return np.r_[left, far_left[-1]], np.r_[right, far_right[-1]]


def unfolded(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """The two rails of a run, (k + 1, 3) each, laid flat, (k + 1, 2) each, m: the first cross side along x."""
    across = np.linalg.norm(right - left, axis=1)
    left_side, right_side = (np.linalg.norm(np.diff(rail, axis=0), axis=1) for rail in (left, right))
    diagonal = np.linalg.norm(left[1:] - right[:-1], axis=1)
    width = across[:-1]
    # each quad in a frame of its own: its first cross side from 0 along the real axis
    ahead = _third(np.zeros_like(width), width, left_side, diagonal)
    beside = width + (ahead - width) / diagonal * _third(np.zeros_like(width), diagonal, right_side, across[1:]).conj()
    turn = (beside - ahead) / across[1:]
    heading = np.r_[1, np.cumprod(turn)]
    heading /= np.abs(heading)
    at = np.r_[0, np.cumsum(heading[:-1] * ahead)]
    end = at + heading * across
    return np.column_stack([at.real, at.imag]), np.column_stack([end.real, end.imag])


def _third(start: Floats, base: Floats, near: Floats, far: Floats) -> np.ndarray[tuple[int], np.dtype[np.complex128]]:
    """The third corner, above the base from start along the real axis, of triangles with these sides."""
    x = (base**2 + near**2 - far**2) / (2 * base)
    return np.asarray(start + x + 1j * np.sqrt(np.maximum(near**2 - x**2, 0)))
