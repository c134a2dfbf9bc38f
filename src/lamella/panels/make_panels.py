"""Panels on a net."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.network import BOUNDARY, SEAM, SINGULAR, Network
from lamella.panels.alike import kinds_of
from lamella.panels.angles import corner_angles, kink_angles, sides_across
from lamella.panels.every_second_node import every_second_node
from lamella.panels.flatness import Planes, planes_of
from lamella.panels.gaps import LEAST_SIDE, has_room, inset, largest_distance, shortest_side
from lamella.panels.layout import diagonal_panels, face_panels
from lamella.panels.panels import FLAT, INSIDE, RIM, UMBILIC, Panels
from lamella.panels.plates import Plates, joined_plates, run_plates, single_plates
from lamella.panels.polygons import Polygons
from lamella.panels.rules import PanelRules
from lamella.panels.runs import first_directions, runs_of
from lamella.panels.warnings import panel_warnings

PLANAR = PanelRules()

MOST_PLATE_CORNERS = 12
"""Of a plate that corners are taken off; more have runs only."""

NEAR_FOCAL = 0.98
"""Share of the least radius of curvature that panels may be moved by: beyond the radius the surface is turned over."""


def make_panels(network: Network, rules: PanelRules = PLANAR) -> Panels:
    """Panels over every second node of a net, or over its cells.

    Parameters
    ----------
    network : Network
        Of lamellas; of principal lines, whose cells are the panels.
    rules : PanelRules

    Raises
    ------
    InputError
        The net has no cells, or none that are squares; an offset beyond the surface's radius of curvature; a gap as
        wide as the panels.

    Examples
    --------
    >>> import lamella
    >>> from lamella.panels.make_panels import make_panels
    >>> from lamella.panels.rules import PanelRules
    >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=24)
    >>> print(len(make_panels(net, PanelRules(offset=0.1)).ids))
    264
    """
    _check_offset(network, rules.offset)
    _check_cells(network, rules.on)
    conflicts = np.zeros((0, 2), np.int64)
    if rules.on == "cells" or network.pattern.kind == "principal":
        planned = face_panels(network)
    else:
        corners, conflicts = every_second_node(network)
        planned = diagonal_panels(network, corners)
    if not len(planned):
        raise InputError("the net has no cells, so there are no panels", "choose a denser net", "network")
    points = network.node_points + rules.offset * network.node_normals
    planes = planes_of(points, planned)
    over = planes.out_of_plane > rules.limit
    laid = _laid(network, planned, on_diagonals=planned.centres.max() >= 0)
    plates = _plates(network, points, planned, planes, over, laid, rules)
    _check_gap(plates, laid, rules.gap)
    plates = _without_short_sides(plates, rules.gap / 2)
    room = _room(plates, rules.gap / 2)
    middles = np.stack([np.bincount(planned.owner, points[planned.nodes, k]) for k in range(3)], axis=1)
    left_out = (middles / planned.sizes[:, None])[plates.owners[~room]]
    plates = _kept(plates, np.flatnonzero(room))
    kept = plates.polygons
    outlines, spatial, areas = _with_gaps(points, plates, rules.gap / 2)
    return Panels(
        rules=rules,
        points=points,
        planned=planned,
        laid=laid,
        planes=planes,
        over=over,
        plates=kept,
        owners=plates.owners,
        ids=plates.ids,
        made=plates.made,
        radii=plates.radii,
        outlines=outlines,
        corners=spatial,
        angles=corner_angles(points, kept),
        kinks=kink_angles(points, kept, plates.normals, sides_across(kept)),
        areas=areas,
        kinds=kinds_of(plates.outlines, kept, plates.heights, plates.made),
        left_out=left_out,
        notes=panel_warnings(rules, points, planned, planes, laid, over, left_out, conflicts),
    )


def _check_cells(network: Network, on: str) -> None:
    """Refuse diagonals that are no principal directions.

    Raises
    ------
    InputError
    """
    p, q = network.pattern.every
    if on == "diagonals" and network.pattern.kind == "lamellas" and p != q:
        raise InputError(
            f"every = [{p}, {q}] leaves out more lamellas of one family: the cells are no squares, and their diagonals "
            "no principal directions",
            'write every as one number, or on = "cells"',
            "network",
        )


def _check_offset(network: Network, offset: float) -> None:
    """Refuse panels that lie near or beyond the surface's centres of curvature.

    Raises
    ------
    InputError
    """
    kn, _, tg = network.sample_darboux
    mean = network.sample_mean_curvature
    deviation = np.hypot(kn - mean, tg)
    # towards the normal's side the larger principal curvature decides, to the other the smaller one
    most = float((mean + deviation).max() if offset > 0 else (deviation - mean).max())
    if abs(offset) * most >= NEAR_FOCAL:
        limit = rounded(NEAR_FOCAL / most, up=False)
        raise InputError(
            f"offset = {offset:g} m: the surface's least radius of curvature to that side is {1 / most:.4g} m, and "
            "panels moved so far meet or turn over",
            f"write offset = {limit if offset > 0 else -limit:g} or nearer to the surface",
            "offset",
        )


def _laid(network: Network, planned: Polygons, *, on_diagonals: bool) -> Integers:
    """Where each panel lies, see `lamella.panels.panels.LAID`."""

    def touches(some: Booleans) -> Booleans:
        return np.bincount(planned.owner, some[planned.nodes], len(planned)) > 0

    kinds = network.node_kinds
    cut = touches((kinds == BOUNDARY) | (kinds == SEAM)) | (planned.sizes != 4)
    if on_diagonals:
        cut |= ~planned.around
    singular = touches(kinds == SINGULAR)
    centred = planned.centres >= 0
    singular |= centred & (kinds[planned.centres] == SINGULAR)
    return np.where(singular, UMBILIC, np.where(cut, RIM, INSIDE))


def _plates(
    network: Network,
    points: Floats,
    planned: Polygons,
    planes: Planes,
    over: Booleans,
    laid: Integers,
    rules: PanelRules,
) -> Plates:
    """What is cut, before gaps are taken off."""
    in_runs = np.zeros(len(planned), bool)
    parts = []
    if rules.kind == "single-curved":
        in_runs = (laid != RIM) & (planned.sizes == 4) & ~over
        node = np.where(planned.centres >= 0, planned.centres, planned.nodes[planned.offsets[:-1]])
        directions = first_directions(network)[node]
        in_runs &= np.isfinite(directions).all(axis=1)
        parts.append(run_plates(points, planned, planes, runs_of(points, planned, in_runs, directions, rules.along)))
    rest = np.flatnonzero(~in_runs)
    return joined_plates([single_plates(points, planned.kept(rest), over[rest], rules.above_limit, rest), *parts])


def _check_gap(plates: Plates, laid: Integers, gap: float) -> None:
    """Refuse a gap that leaves nothing of whole panels.

    Raises
    ------
    InputError
    """
    polygons = plates.polygons
    whole = laid[plates.owners] == INSIDE
    least = min(
        (
            largest_distance(plates.outlines[at[whole[some]]])
            for some, at in polygons.by_size()
            if at.shape[1] == 4 and whole[some].any()
        ),
        default=np.inf,
    )
    if gap > 2 * least:
        raise InputError(
            f"gap = {gap:g} m: of the smallest panel inside the net it leaves no side of {1000 * LEAST_SIDE:g} mm",
            f"write gap = {rounded(2 * least, up=False):g} or less, or choose a coarser net",
            "gap",
        )


def _room(plates: Plates, distance: float) -> Booleans:
    """Plates that something is left of, (q,)."""
    room = np.ones(len(plates.owners), bool)
    for some, at in plates.polygons.by_size():
        room[some] = has_room(plates.outlines[at], distance)
    return room


def _without_short_sides(plates: Plates, distance: float) -> Plates:
    """Flat plates without corners at the end of sides that half a gap takes away, as far as three are left."""
    for _ in range(MOST_PLATE_CORNERS - 3):
        polygons = plates.polygons
        stays = np.ones(len(polygons.nodes), bool)
        for some, at in polygons.by_size():
            n = at.shape[1]
            short = (
                (plates.made[some] == FLAT) & ~has_room(plates.outlines[at], distance) & (3 < n <= MOST_PLATE_CORNERS)
            )
            side = shortest_side(plates.outlines[at[short]], distance)
            stays[at[short, (side + 1) % n]] = False
        if stays.all():
            break
        sizes = np.bincount(polygons.owner[stays], minlength=len(polygons))
        plates = plates._replace(
            polygons=replace(polygons, offsets=np.r_[0, np.cumsum(sizes)], nodes=polygons.nodes[stays]),
            outlines=plates.outlines[stays],
            normals=plates.normals[stays],
            heights=plates.heights[stays],
        )
    return plates


def _kept(plates: Plates, some: Integers) -> Plates:
    """Some of the plates."""
    polygons = plates.polygons
    corner = np.isin(polygons.owner, some)
    return Plates(
        polygons.kept(some),
        plates.owners[some],
        tuple(plates.ids[k] for k in some.tolist()),
        plates.made[some],
        plates.radii[some],
        plates.outlines[corner],
        plates.normals[corner],
        plates.heights[corner],
    )


def _with_gaps(points: Floats, plates: Plates, distance: float) -> tuple[Floats, Floats, Floats]:
    """Flat outlines, corners in space and areas of plates moved inwards on all sides."""
    polygons = plates.polygons
    outlines, spatial = np.empty_like(plates.outlines), np.empty((len(polygons.nodes), 3))
    areas = np.zeros(len(polygons))
    for some, at in polygons.by_size():
        flat = inset(plates.outlines[at], None, distance)
        x, y = flat[..., 0], flat[..., 1]
        areas[some] = (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1) / 2
        outlines[at] = flat
        spatial[at] = inset(points[polygons.nodes[at]], plates.normals[at], distance)
    return outlines, spatial, areas
