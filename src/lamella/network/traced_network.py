"""The network of lines of a given normal curvature, or of principal lines, on any surface.

Where the lines are not the lamellas of a surface of constant mean curvature there are no coordinates to integrate: the
lines are traced one beside the other (`lamella.network.flow`) from even seeds (`lamella.network.seeds`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError
from lamella.network.density import BYTES_FIXED, BYTES_PER_NODE, LEAST_CELLS, MOST_NODES
from lamella.network.flow import ENDLESS, Flow
from lamella.network.ground import Ground
from lamella.network.lattice import ragged_ranges
from lamella.network.line_field import LEAST_ANGLE, LineField
from lamella.network.meetings import Crossings, find_crossings
from lamella.network.network import Network
from lamella.network.pattern import Pattern
from lamella.network.seeds import Guide, Seeded, choose_guide, seeded_lines
from lamella.network.trace import COARSE, FINE, FINE_LIMIT
from lamella.network.traced_stops import (
    faces_of,
    line_stops,
    long_enough,
    median_edge,
    merged_stops,
    stop_nodes,
)
from lamella.network.turning import turning
from lamella.progress import Progress, silent
from lamella.surface.darboux import Darboux
from lamella.surface.points import Floats

Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]

# how far the median cell edge may be from the spacing asked for, and how often seeds are spaced anew for it
OFF_SPACING, MOST_TRIES = 0.1, 3
# of the spacing: ends and crossings this near to each other are one node (docs/files.md)
SAME_NODE = 1e-6
# samples of a piece of lamella, however short
FEWEST = 3
# share of the area worth telling
LEAST_SHARE = 1e-3


class Reach(NamedTuple):
    """Where a surface has lines: shares of its area, and the principal curvatures on it, 1/m.

    Attributes
    ----------
    unreal : float
        Share without any direction of the wanted normal curvature.
    flat : float
        Share where there are some, but the families cross at less than `LEAST_ANGLE`.
    k1_max, k2_min : float
    """

    unreal: float
    flat: float
    k1_max: float
    k2_min: float


@dataclass(frozen=True)
class TracedNetwork:
    """A network with what it rests on.

    Attributes
    ----------
    network : Network
    requested : str
    reach : Reach
    guides : int
        Guides the seeds were counted along.
    inner_ends : int
        Lamellas' ends inside the surface, where directions stop being real.
    missed : (float, float)
        Difference of the normal curvature from the one asked for, by the surface's second derivatives alone, at most
        and at 95 % of the samples, 1/m.
    """

    network: Network
    requested: str
    reach: Reach
    guides: int
    inner_ends: int
    missed: tuple[float, float]

    def describe(self) -> dict[str, Any]:
        """Further figures of the network for summary.json."""
        angles, lines = self.network.node_angles, self.network.pattern.kind == "lamellas"
        return {
            "node_angle_mean_deg": float(angles.mean()),
            "normal_curvature_deviation_max": self.missed[0] if lines else None,
            "normal_curvature_deviation_p95": self.missed[1] if lines else None,
            "guides": self.guides,
            "inner_ends": self.inner_ends,
            "unreal_area_share": self.reach.unreal,
            "flat_area_share": self.reach.flat,
        }

    def warnings(self) -> Iterator[str]:
        """Where there are no lamellas, and lamellas that do not end."""
        wanted = self.network.pattern.normal_curvature
        unreal, flat = self.reach.unreal, self.reach.flat
        if wanted is not None and unreal + flat > LEAST_SHARE:
            parts = []
            if unreal > LEAST_SHARE:
                parts.append(f"{unreal:.1%} of the surface has no direction of normal curvature {wanted:g} 1/m")
            if flat > LEAST_SHARE:
                parts.append(f"in {flat:.1%} of the surface the two families cross at less than {LEAST_ANGLE:g} deg")
            yield (
                f"{', '.join(parts)}: no lamellas there, {self.inner_ends} of their ends lie inside the surface "
                "(another normal_curvature moves that edge)"
            )


def traced_network(
    ground: Ground,
    pattern: Pattern,
    *,
    mean_curvature: float,
    cells: int | None = None,
    spacing: float | None = None,
    minimum_length: float = 0.5,
    progress: Progress = silent,
) -> TracedNetwork:
    """The network of lines of a given normal curvature, or of principal lines.

    Parameters
    ----------
    ground : Ground
    pattern : Pattern
        With a normal curvature, or of kind "principal".
    mean_curvature : float
        What the net tells as its surface's H, 1/m, see `lamella.network.lines.told_mean_curvature`.
    cells : int, optional
        Lamellas of a family around the first hole; without a hole cells along the longer lamella through the middle.
        24 when spacing is not given either.
    spacing : float, optional
        Wanted median cell edge, m.
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.
    progress : callable

    Raises
    ------
    InputError
    """
    where, area = ground.samples()
    look = ground.look(where)
    size = float(np.linalg.norm(np.ptp(look.position, axis=0)))
    scale = float(np.sqrt(np.average(look.mean**2 + np.abs(look.deviator) ** 2, weights=area)))
    field = LineField(pattern.normal_curvature, max(scale, 1e-9 / size))
    real, usable = field.is_real(look.mean, look.deviator), field.margin(look.mean, look.deviator) > 0
    half = np.abs(look.deviator)
    total = area.sum()
    reach = Reach(
        float(area[~real].sum() / total),
        float(area[real & ~usable].sum() / total),
        float((look.mean + half).max()),
        float((look.mean - half).min()),
    )
    _refuse_nowhere(reach, usable, look.mean, half, pattern)
    guide = choose_guide(ground, field, size)
    distance, requested, key = _wanted(guide, cells, spacing)
    _refuse_many(area[usable].sum(), field.crossing_sine(look.mean, look.deviator)[usable], guide, distance, key)
    best, known, chosen = np.inf, [], None
    for _ in range(MOST_TRIES):
        tried = seeded_lines(ground, field, guide, distance, size)
        _refuse_endless(tried.flow, pattern)
        met = find_crossings(tried.flow, distance * guide.share)
        median = median_edge(tried.flow, met)
        progress(f"  {tried.flow.count} lines from even seeds, {len(met.a):,} crossings {median:.3g} m apart")
        off = 0.0 if spacing is None else abs(np.log(median / spacing)) if np.isfinite(median) else np.inf
        if chosen is None or off < best:
            best, chosen = off, (tried, met, distance)
        if spacing is None or off <= OFF_SPACING or not np.isfinite(median):
            break
        known.append((np.log(distance), np.log(median / spacing)))
        distance = _next_distance(known)
    assert chosen is not None
    seeded, crossings, step = chosen
    network, inner, missed = _network(ground, seeded, crossings, pattern, mean_curvature, step, minimum_length, key)
    return TracedNetwork(network, requested, reach, seeded.guides, inner, missed)


def _refuse_endless(flow: Flow, pattern: Pattern) -> None:
    """Lines that come back to themselves, or wind on: each turn would cross the other family anew."""
    endless = (flow.ends.reshape(-1, 2) == ENDLESS).any(1)
    if endless.any():
        longest = float(flow.lengths[endless].max())
        raise InputError(
            f"{endless.sum()} of {flow.count} lines wind around without reaching the rim (given up after "
            f"{longest:.3g} m): closed lines are offered on surfaces of constant mean curvature only",
            'cut the surface open where they go around, or write surface.mean_curvature = "fit"'
            if pattern.kind == "principal"
            else "cut the surface open where they go around, or choose another normal_curvature",
            "network.kind" if pattern.kind == "principal" else "network.normal_curvature",
        )


def _refuse_nowhere(reach: Reach, usable: Booleans, mean: Floats, half: Floats, pattern: Pattern) -> None:
    if usable.any():
        return
    if pattern.normal_curvature is None:
        raise InputError(
            "the surface is umbilic everywhere: all directions bend alike", "bend it more one way", "surface"
        )
    # the range within which some place has lines that cross well enough
    turn = np.cos(np.radians(LEAST_ANGLE))
    low, high = float((mean - turn * half).min()), float((mean + turn * half).max())
    none = reach.unreal >= 1 - 1e-12
    raise InputError(
        f"normal_curvature = {pattern.normal_curvature:g} 1/m: "
        + ("no direction of the surface has it" if none else f"lines of it cross at less than {LEAST_ANGLE:g} deg")
        + f", its normal curvatures run from k2 = {reach.k2_min:.4g} to k1 = {reach.k1_max:.4g} 1/m",
        f"choose a value from {low:.4g} to {high:.4g} 1/m (the sign is that of the surface's normal)",
        "network.normal_curvature",
    )


def _wanted(guide: Guide, cells: int | None, spacing: float | None) -> tuple[float, str, str]:
    """Distance of seeds along the guide, m, what was asked for, and the key it stands under."""
    if spacing is None:
        requested = f"cells = {cells}" if cells is not None else "cells = 24 (default)"
        cells = 24 if cells is None else cells
        if cells < LEAST_CELLS:
            raise InputError(f"{cells} cells, at least {LEAST_CELLS} are needed", "raise cells", "network.cells")
        return guide.length / cells, requested, "network.cells"
    fit = guide.length * guide.share / spacing
    if fit < LEAST_CELLS:
        raise InputError(
            f"spacing = {spacing:g} m leaves {fit:.2g} cells across the surface, at least {LEAST_CELLS} are needed",
            f"choose a spacing of at most {guide.length * guide.share / LEAST_CELLS:.3g} m",
            "network.spacing",
        )
    return spacing / guide.share, f"spacing = {spacing:g} m", "network.spacing"


def _refuse_many(area: float, sines: Floats, guide: Guide, distance: float, key: str) -> None:
    """Refuse more nodes than memory holds: a cell has the area spacing^2 sin(angle)."""
    spacing = distance * guide.share
    estimate = area / (spacing**2 * float(np.median(sines)))
    if estimate > MOST_NODES:
        memory = (BYTES_FIXED + BYTES_PER_NODE * estimate) / 1e9
        least = spacing * np.sqrt(estimate / MOST_NODES)
        raise InputError(
            f"about {estimate:,.0f} nodes would take about {memory:,.0f} GB of memory (limit {MOST_NODES:,} nodes)",
            f"choose a spacing of at least {least:.3g} m"
            if key == "network.spacing"
            else f"at most {int(guide.length * guide.share / least)} cells fit this surface",
            key,
        )


def _next_distance(known: list[tuple[float, float]]) -> float:
    """Distance of seeds, m, from logarithms of distances tried and of median over wanted cell edge."""
    over, under = [k for k in known if k[1] > 0], [k for k in known if k[1] <= 0]
    if not over or not under:
        log, off = known[-1]
        return float(np.exp(log - off))
    # lines come and go with the distance: between the nearest ones on either side
    (a, high), (b, low) = min(over, key=lambda k: k[1]), max(under, key=lambda k: k[1])
    return float(np.exp(b + (a - b) * np.clip(-low / (high - low), 0.1, 0.9)))


def _network(
    ground: Ground,
    seeded: Seeded,
    crossings: Crossings,
    pattern: Pattern,
    mean_curvature: float,
    distance: float,
    minimum_length: float,
    key: str,
) -> tuple[Network, int, tuple[float, float]]:
    """The network of lines and crossings, how many lamellas' ends lie inside, and `TracedNetwork.missed`."""
    kept = long_enough(seeded.flow, crossings, minimum_length)
    number = np.full(seeded.flow.count, -1)
    number[kept] = np.arange(len(kept))
    flow = seeded.flow.take(kept)
    both = (number[crossings.a] >= 0) & (number[crossings.b] >= 0)
    crossings = Crossings(
        number[crossings.a[both]], number[crossings.b[both]], crossings.s_a[both], crossings.s_b[both]
    )
    if not len(crossings.a):
        raise InputError(
            f"no two lamellas cross: {flow.count} are {flow.lengths.max(initial=0.0):.3g} m long at most",
            "raise network.cells, or lower network.spacing and network.minimum_length",
            key,
        )
    median = median_edge(flow, crossings)
    spacing = median if np.isfinite(median) else distance
    stops = merged_stops(flow, line_stops(flow, crossings), SAME_NODE * spacing)
    node, kinds, inner = stop_nodes(ground, flow, stops, SAME_NODE * spacing)

    owner = stops.line
    first = np.flatnonzero(owner[1:] == owner[:-1])
    length = stops.s[first + 1] - stops.s[first]
    per_cell = FINE if len(kinds) <= FINE_LIMIT else COARSE
    # a lamella shorter than a cell is sampled as finely as a whole cell
    total = np.bincount(owner[first], length, flow.count)[owner[first]]
    count = np.maximum(np.ceil(length / np.minimum(total, spacing) * per_cell - 1e-6), FEWEST).astype(np.int64)
    last = np.r_[owner[first][1:] != owner[first][:-1], True]
    given = count + last
    segment = np.repeat(np.arange(len(count)), given)
    s = stops.s[first[segment]] + ragged_ranges(given) / count[segment] * length[segment]
    where, look, tangents = flow.at(owner[first[segment]], s)
    begin = np.cumsum(given) - given
    stop_sample = np.empty(len(owner), np.int64)
    stop_sample[first] = begin
    stop_sample[first[last] + 1] = (begin + count)[last]
    offsets = np.r_[0, np.cumsum(np.bincount(owner[first], given, minlength=flow.count).astype(np.int64))]

    heading = (tangents * look.e_u).sum(1) + 1j * (tangents * look.e_v).sum(1)
    turned = look.deviator * heading**2
    sideways = np.cross(look.normal, tangents)
    closed = np.zeros(flow.count, bool)
    darboux = Darboux(look.mean + turned.real, turning(tangents, sideways, s, offsets, closed), -turned.imag)
    # lines follow the continuous shape operator; what the positions alone say of them is told
    mean, deviator = ground.measured(where)
    missed = np.abs(mean - look.mean + ((deviator - look.deviator) * heading**2).real)
    node_sample = np.empty(len(kinds), np.int64)
    node_sample[node[::-1]] = stop_sample[::-1]
    faces = faces_of(
        ground, where[node_sample], look.normal[node_sample], tangents, node, stop_sample, first, kinds, inner
    )
    families = np.where(flow.is_a, "A", "B")
    rank = np.where(flow.is_a, np.cumsum(flow.is_a), np.cumsum(~flow.is_a))
    return (
        Network(
            mean_curvature=mean_curvature,
            step=distance,
            cells=seeded.count,
            periods=(),
            left_out=seeded.flow.count - flow.count,
            node_points=look.position[node_sample],
            node_normals=look.normal[node_sample],
            node_kinds=kinds,
            ids=tuple(f"{f}{r}" for f, r in zip(families.tolist(), rank.tolist(), strict=True)),
            families=families,
            closed=closed,
            sample_offsets=offsets,
            sample_points=look.position,
            sample_normals=look.normal,
            sample_tangents=tangents,
            sample_darboux=darboux,
            sample_where=np.column_stack([where.element, where.local]),
            sample_arclengths=s,
            stop_offsets=np.r_[0, np.cumsum(np.bincount(owner, minlength=flow.count))],
            stop_nodes=node,
            stop_samples=stop_sample - offsets[owner],
            stop_arclengths=stops.s,
            face_offsets=faces.offsets,
            face_nodes=faces.nodes,
            faces_left_out=faces.large,
            pattern=pattern,
        ),
        int(inner.sum()),
        (float(missed.max()), float(np.percentile(missed, 95))),
    )
