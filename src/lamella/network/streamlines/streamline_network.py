"""The network of lines of a given normal curvature, or of principal lines, on any surface.

Where the lines are not the lamellas of a surface of constant mean curvature there are no coordinates to integrate: the
lines are traced one beside the other (`lamella.network.streamlines.streamlines`) from even seeds
(`lamella.network.streamlines.seeding`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.base.wording import rounded
from lamella.network.assemble import Curves, CurveSamples, SampledCurves, assemble
from lamella.network.charts.charts import Charts, ChartSample
from lamella.network.density_request import DensityRequest
from lamella.network.network import A, B, Network
from lamella.network.pattern import Pattern
from lamella.network.sampling import Division, divide, parts_of
from lamella.network.streamlines.direction_field import CROSSING_ANGLE_MIN
from lamella.network.streamlines.intersections import Crossings, find_crossings
from lamella.network.streamlines.seeding import Seeded, seeded_lines
from lamella.network.streamlines.stops import (
    SAME_NODE,
    line_stops,
    median_edge,
    merged_stops,
    rim_nodes,
    stop_nodes,
    whole_edge,
    without_short,
)
from lamella.network.streamlines.streamline_plan import Reach, plan_streamlines
from lamella.network.streamlines.streamlines import Streamlines
from lamella.network.streamlines.winding import refuse_winding
from lamella.network.turning import sideways_slopes, turning
from lamella.network.written_lines import WrittenLines, angle_figures
from lamella.surface.darboux import Darboux
from lamella.surface.element.places import Places

# how far the median cell edge may be from the spacing asked for, and how often seeds are spaced anew for it
OFF_SPACING, MOST_TRIES = 0.1, 3
# share of the area worth telling
AREA_SHARE_MIN = 1e-3
# of the curvature scale: the normal curvature of lamellas is promised to be off by no more (docs/getting-started.md)
PROMISED = 2e-3


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
        Bound of the difference of the normal curvature from the one of the project, at most and at 95 % of the samples,
        1/m: what the surface's second derivatives miss, and how far these may be off those of the surface a mesh means;
        or what the written points miss, where that is more.
    angles : (2, n)
        At regular nodes, deg, see `WrittenLines.node_angles`.
    scale : float
        Curvature scale of the surface, 1/m.
    """

    network: Network
    requested: str
    reach: Reach
    guides: int
    inner_ends: int
    missed: tuple[float, float]
    angles: Floats
    scale: float

    def describe(self) -> dict[str, Any]:
        """Further figures of the network for summary.json."""
        lines = self.network.pattern.kind == "lamellas"
        return angle_figures(self.angles, self.network.pattern.angle) | {
            "node_angle_mean_deg": float(self.angles.mean()),
            "normal_curvature_deviation_max": self.missed[0] if lines else None,
            "normal_curvature_deviation_p95": self.missed[1] if lines else None,
            "guides": self.guides,
            "inner_ends": self.inner_ends,
            "unreal_area_share": self.reach.unreal,
            "flat_area_share": self.reach.flat,
        }

    def corner_stresses(self, _: Floats) -> dict[str, Any]:
        """None: what nets of isothermic coordinates tell apart, see `ElementNetwork`."""
        return {}

    def at_corner(self, _: Floats, utilisation: Floats, searched: object) -> str:
        """Nothing, see `corner_stresses`."""
        return ""

    def warnings(self, finer: float = 1.0) -> Iterator[Message]:
        """Where there are no lamellas, and lamellas of another normal curvature than was asked for.

        Parameters
        ----------
        finer : float
            By how much smaller the tolerance of the surface that is to be judged is than that of this one.
        """
        wanted = self.network.pattern.normal_curvature
        unreal, flat = self.reach.unreal, self.reach.flat
        if wanted is not None and max(unreal, flat) > AREA_SHARE_MIN:
            parts = []
            if unreal > AREA_SHARE_MIN:
                parts.append(f"{unreal:.1%} of the surface has no direction of normal curvature {wanted:g} 1/m")
            if flat > AREA_SHARE_MIN:
                parts.append(
                    f"in {flat:.1%} of the surface the two families cross at less than {CROSSING_ANGLE_MIN:g} deg"
                )
            yield Message(
                "lamellas_none",
                f"{', '.join(parts)}: no lamellas there, {self.inner_ends} of their ends lie inside the surface "
                "(another normal_curvature moves that edge)",
            )
        most, usual = (residual / finer for residual in self.missed)
        if wanted is not None and most > PROMISED * self.scale:
            yield Message(
                "lamellas_off",
                f"the normal curvature of the lamellas is off by up to {most:.2g} 1/m, "
                f"{most / self.scale:.1e} of the curvature scale (at 95 % of the samples by {usual / self.scale:.1e}; "
                f"limit {PROMISED:g}): a finer and smoother mesh, or a smaller tolerance where there "
                "are vertices enough for it, tells directions better",
            )


def traced_network(
    charts: Charts,
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
    charts : Charts
    pattern : Pattern
        With a normal curvature, or of kind "principal".
    mean_curvature : float
        What the net reports as its surface's H, 1/m, see
        `lamella.network.streamlines.applicability.reported_mean_curvature`.
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
    plan = plan_streamlines(charts, pattern, cells=cells, spacing=spacing)
    request, field, guide, distance, size = plan.request, plan.field, plan.guide, plan.distance, plan.size
    best, known, chosen = np.inf, [], None
    for _ in range(MOST_TRIES):
        tried = seeded_lines(charts, field, guide, distance, size)
        refuse_winding(charts, field, tried.streamlines, pattern, distance * guide.share, size)
        met = find_crossings(tried.streamlines, distance * guide.share)
        streamlines, met = without_short(tried.streamlines, met, minimum_length)
        median = median_edge(streamlines, met)
        progress(
            Report.step(
                f"{streamlines.count} lines from even seeds, {len(met.a):,} crossings, median cell edge {median:.3g} m"
            )
        )
        off = 0.0 if spacing is None else abs(np.log(median / spacing)) if np.isfinite(median) else np.inf
        if chosen is None or off < best:
            best, chosen = off, (tried, streamlines, met, distance)
        if spacing is None or off <= OFF_SPACING or not np.isfinite(median):
            break
        known.append((np.log(distance), np.log(median / spacing)))
        distance = _next_distance(known)
    assert chosen is not None
    seeded, streamlines, crossings, step = chosen
    network, inner, missed = _network(
        charts, seeded, streamlines, crossings, pattern, mean_curvature, step, minimum_length, request
    )
    written = WrittenLines.of(network)
    if pattern.normal_curvature is not None:
        missed = np.maximum(missed, written.bend_off(network, pattern.normal_curvature))
    worst = float(missed.max()), float(np.percentile(missed, 95))
    angles = written.node_angles(network)
    return TracedNetwork(network, str(request), plan.reach, seeded.guides, inner, worst, angles, plan.field.scale)


def _next_distance(known: list[tuple[float, float]]) -> float:
    """Distance of seeds, m, from logarithms of distances tried and of median over wanted cell edge."""
    over, under = [k for k in known if k[1] > 0], [k for k in known if k[1] <= 0]
    if not over or not under:
        log, off = known[-1]
        return float(np.exp(log - off))
    # lines come and go with the distance: between the nearest ones on either side
    (a, high), (b, low) = min(over, key=lambda k: k[1]), max(under, key=lambda k: k[1])
    return float(np.exp(b + (a - b) * np.clip(-low / (high - low), 0.1, 0.9)))


def _none_cross(
    seeded: Seeded, kept: Streamlines, distance: float, minimum_length: float, request: DensityRequest
) -> InputError:
    """Why no two of the seeded lines that are kept cross; seeds are a distance (m) apart."""
    count, longest = seeded.streamlines.count, float(seeded.streamlines.lengths.max())
    short = count - kept.count
    if short:
        return InputError(
            f"no two lamellas cross: {short} of {count} are shorter than minimum_length = {minimum_length:g} median "
            f"cell edges, the longest of them {longest:.3g} m",
            "write minimum_length = 0, with which none is left out",
            "minimum_length",
        )
    return InputError(
        f"no two lamellas cross: the longest of {count} is {longest:.3g} m, and they are {distance:.3g} m apart",
        f"write spacing = {rounded(longest / 3, up=False):g} m or less"
        if request.spacing is not None
        else f"write cells = {int(np.ceil(3 * seeded.count * distance / longest))} or more",
        request.parameter,
    )


def _network(
    charts: Charts,
    seeded: Seeded,
    streamlines: Streamlines,
    crossings: Crossings,
    pattern: Pattern,
    mean_curvature: float,
    distance: float,
    minimum_length: float,
    request: DensityRequest,
) -> tuple[Network, int, Floats]:
    """The network of the seeded lines that are kept, how many ends lie inside, and what the surface misses, 1/m, (k,).

    That is a bound of what its positions alone make of the lines' normal curvature: they follow the continuous shape
    operator.
    """
    if not len(crossings.a):
        raise _none_cross(seeded, streamlines, distance, minimum_length, request)
    whole = whole_edge(streamlines, crossings)
    spacing = whole if np.isfinite(whole) else distance
    stops = merged_stops(streamlines, line_stops(streamlines, crossings), SAME_NODE * spacing)
    node, kinds, inner = stop_nodes(charts, streamlines, stops, SAME_NODE * spacing)

    curves = Curves(np.where(streamlines.is_a, A, B), np.zeros(streamlines.count, bool), stops.line, node, kinds)
    sampled, found = _sampled(streamlines, stops.s, curves, spacing)
    sample, tangents, where = found.sample, found.tangents, found.where
    s, offsets, closed = found.arclengths, sampled.offsets, curves.closed

    heading = (tangents * sample.e_u).sum(1) + 1j * (tangents * sample.e_v).sum(1)
    turned = sample.deviator * heading**2
    sideways = np.cross(sample.normal, tangents)
    darboux = Darboux(sample.mean + turned.real, turning(tangents, sideways, s, offsets, closed), -turned.imag)
    mean, deviator = charts.measured(where)
    missed = np.abs(mean - sample.mean + ((deviator - sample.deviator) * heading**2).real) + charts.uncertain(where)
    network = assemble(
        sampled,
        CurveSamples(
            sample.position,
            sample.normal,
            tangents,
            darboux,
            sample.mean,
            sideways_slopes(darboux, sample.mean, s, offsets, closed),
            np.column_stack([where.element, where.local]),
            s,
        ),
        rim_nodes(charts, where[sampled.node_samples], kinds, inner),
        pattern=pattern,
        mean_curvature=mean_curvature,
        step=distance,
        cells=seeded.count,
        periods=(),
        left_out=seeded.streamlines.count - streamlines.count,
    )
    return network, int(inner.sum()), np.asarray(missed, np.float64)


class _Samples(NamedTuple):
    """Samples in order along the lines."""

    tangents: Floats
    where: Places
    sample: ChartSample
    arclengths: Floats


def _sampled(streamlines: Streamlines, stops: Floats, curves: Curves, spacing: float) -> tuple[SampledCurves, _Samples]:
    """Samples along the lines between stops (q,), m, of a net with a spacing (m)."""
    first = curves.first_stops
    owner = curves.owner[first]
    length = stops[first + 1] - stops[first]
    # a lamella shorter than a cell is sampled as finely as a whole cell
    whole = np.minimum(np.bincount(owner, length, streamlines.count)[owner], spacing)

    def along(division: Division) -> _Samples:
        line, s = owner[division.piece], stops[first[division.piece]] + division.fraction * length[division.piece]
        where, sample, tangents = streamlines.at(line, s)
        return _Samples(tangents, where, sample, s)

    division, samples = divide(parts_of(length / whole, len(curves.kinds)), length, owner, along)
    return SampledCurves(curves, division), samples
