"""From planned panels to the plates that are cut: a panel each, triangles where it is not flat enough, or runs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.panels.flat_outlines import on_cylinders, projected, with_true_sides
from lamella.panels.flatness import Planes, planes_of, shorter_diagonal
from lamella.panels.panels import COLD_BENT, FLAT, SINGLE_CURVED
from lamella.panels.polygons import Polygons
from lamella.panels.runs import Runs, run_rails, unfolded


class Plates(NamedTuple):
    """Plates before gaps are taken off; see `lamella.panels.panels.Panels`.

    Attributes
    ----------
    polygons : Polygons
    owners : (q,) int
    ids : tuple of str
    made : (q,) int
    radii : (q,)
    outlines : (e, 2)
    normals : (e, 3)
        Of the plate, or of the planned panel at each side.
    heights : (e,)
        Of the corners over the plate's plane, m; 0 where it is flat.
    """

    polygons: Polygons
    owners: Integers
    ids: tuple[str, ...]
    made: Integers
    radii: Floats
    outlines: Floats
    normals: Floats
    heights: Floats


def single_plates(points: Floats, planned: Polygons, over: Booleans, rule: str, numbers: Integers) -> Plates:
    """A plate for each panel, or triangles.

    Parameters
    ----------
    points : (n, 3)
        At the nodes, m.
    planned : Polygons
        Those that are to be made.
    over : (p,) bool
        Not flat enough.
    rule : str
        What is made of these, see `PanelRules.above_limit`; those with other than four corners become triangles.
    numbers : (p,) int
        In the list of all panels.
    """
    divided = over & ((rule == "triangles") | (planned.sizes != 4)) & (planned.sizes > 3)
    whole = np.flatnonzero(~divided)
    triangles = _triangles(points, planned, np.flatnonzero(divided))
    both = Polygons.joined([planned.kept(whole), triangles[0]])
    owner = np.r_[whole, triangles[1]]
    order = np.lexsort((np.arange(len(owner)), owner))
    both, owner = both.kept(order), owner[order]
    made = np.full(len(owner), FLAT)
    bent = over[owner] & (both.sizes == 4)
    made[bent] = SINGLE_CURVED if rule == "single-curved" else COLD_BENT
    planes = planes_of(points, both)
    outlines, radii = _laid_flat(points, both, planes, made)
    heights = np.where(made[both.owner] == FLAT, 0.0, planes.heights)
    ids = _ids(numbers[owner], divided[owner])
    return Plates(both, numbers[owner], ids, made, radii, outlines, planes.axes[both.owner, 2], heights)


def _triangles(points: Floats, planned: Polygons, some: Integers) -> tuple[Polygons, Integers]:
    """Triangles of polygons, and the number of the polygon of each.

    Quads are divided along their shorter diagonal, what goes around a node from that node, others from their first
    corner, at a rim the node the panel is laid around.
    """
    corners, owners = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    chosen = planned.kept(some)
    for which, at in chosen.by_size():
        n = at.shape[1]
        nodes = chosen.nodes[at]
        if n == 4:
            shift = shorter_diagonal(points[nodes])[:, None]
            nodes = np.take_along_axis(nodes, (np.arange(4) + shift) % 4, axis=1)
        centred = chosen.around[which] & (n > 4)
        for from_centre in (True, False):
            rows = np.flatnonzero(centred == from_centre)
            first = range(n) if from_centre else range(1, n - 1)
            for k in first:
                tip = chosen.centres[which[rows]] if from_centre else nodes[rows, 0]
                corners.append(np.column_stack([tip, nodes[rows, k], nodes[rows, (k + 1) % n]]))
                owners.append(some[which[rows]])
    table, owner = np.concatenate(corners), np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    table, owner = table[order], owner[order]
    count = len(owner)
    none = np.full(count, -1), np.zeros(count, bool)
    return Polygons(3 * np.arange(count + 1), table.ravel(), *none), owner


def _laid_flat(points: Floats, plates: Polygons, planes: Planes, made: Integers) -> tuple[Floats, Floats]:
    """Flat outlines (e, 2), and bending radii (q,), m."""
    outlines, radii = np.zeros((len(plates.nodes), 2)), np.full(len(plates), np.inf)
    for some, at in plates.by_size():
        corner = points[plates.nodes[at]]
        outlines[at] = projected(corner, planes.origins[some], planes.axes[some])
        curved, cold = (np.flatnonzero(made[some] == how) for how in (SINGLE_CURVED, COLD_BENT))
        if len(curved):
            outlines[at[curved]], radii[some[curved]] = on_cylinders(corner[curved])
        if len(cold):
            outlines[at[cold]] = with_true_sides(corner[cold])
            radii[some[cold]] = np.nan
    return outlines, radii


def _ids(numbers: Integers, divided: Booleans) -> tuple[str, ...]:
    """ "P1", and for the triangles of one panel "P1.1", "P1.2"."""
    first = np.r_[True, numbers[1:] != numbers[:-1]] if len(numbers) else np.zeros(0, bool)
    start = np.maximum.accumulate(np.where(first, np.arange(len(numbers)), 0)) if len(numbers) else numbers
    rank = np.arange(len(numbers)) - start + 1
    return tuple(
        f"P{n + 1}.{r}" if d else f"P{n + 1}"
        for n, r, d in zip(numbers.tolist(), rank.tolist(), divided.tolist(), strict=True)
    )


def run_plates(points: Floats, planned: Polygons, planes: Planes, runs: Runs) -> Plates:
    """A plate for each run of quads."""
    nodes, outlines, normals, radii = [np.zeros(0, np.int64)], [np.zeros((0, 2))], [np.zeros((0, 3))], []
    for quads, backs in zip(runs.quads, runs.backs, strict=True):
        left, right = run_rails(planned, quads, backs)
        flat_left, flat_right = unfolded(points[left], points[right])
        normal = planes.axes[quads, 2]
        # from the beginning up the right rail, across, and down the left one
        nodes.append(np.r_[left[:1], right, left[:0:-1]])
        outlines.append(np.concatenate([flat_left[:1], flat_right, flat_left[:0:-1]]))
        normals.append(np.concatenate([normal[:1], normal, normal[-1:], normal[::-1]]))
        radii.append(_least_radius(points[left], points[right], normal))
    sizes = np.array([len(part) for part in nodes[1:]], np.int64)
    count = len(sizes)
    polygons = Polygons(np.r_[0, np.cumsum(sizes)], np.concatenate(nodes), np.full(count, -1), np.zeros(count, bool))
    made = np.where(np.isfinite(radii), SINGLE_CURVED, FLAT) if count else np.zeros(0, np.int64)
    owners = np.array([quads[0] for quads in runs.quads], np.int64)
    ids = tuple(f"S{k + 1}" for k in range(count))
    return Plates(
        polygons,
        owners,
        ids,
        made.astype(np.int64),
        np.array(radii, float),
        np.concatenate(outlines),
        np.concatenate(normals),
        np.zeros(int(sizes.sum())),
    )


def _least_radius(left: Floats, right: Floats, normals: Floats) -> float:
    """Least radius of a run that is bent evenly: half the lengths of two quads over the angle between them, m."""
    if len(normals) == 1:
        return np.inf
    middle = (left + right) / 2
    lengths = np.linalg.norm(np.diff(middle, axis=0), axis=1)
    turn = np.arccos(np.clip(np.einsum("ij,ij->i", normals[1:], normals[:-1]), -1, 1))
    with np.errstate(divide="ignore"):
        return float(((lengths[1:] + lengths[:-1]) / 2 / turn).min())


def joined_plates(parts: list[Plates]) -> Plates:
    """All of some lists, one after the other."""
    polygons = Polygons.joined([part.polygons for part in parts])
    ids = tuple(one for part in parts for one in part.ids)
    arrays = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("owners", "made", "radii", "outlines", "normals", "heights")
    }
    return Plates(polygons, ids=ids, **arrays)
