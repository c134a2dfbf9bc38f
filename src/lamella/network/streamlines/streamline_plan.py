"""What is settled before the lines of a net are traced: where a surface has such lines, and how far apart they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.errors import InputError
from lamella.base.limits import CELLS_MIN
from lamella.base.vectors import diagonal, dots, lengths
from lamella.base.wording import rounded
from lamella.network.charts.charts import Charts
from lamella.network.density_request import NODES_MAX, DensityRequest
from lamella.network.pattern import Pattern
from lamella.network.streamlines.direction_field import CROSSING_ANGLE_MIN, LineField
from lamella.network.streamlines.probing import probes
from lamella.network.streamlines.seeding import SEEDING_RIM_POINTS, Guide, choose_guide
from lamella.network.streamlines.winding import refuse_winding

# share of the surface that has lines, at least, of the normal curvatures that are offered
OFFERED_AREA = 0.1


class Reach(NamedTuple):
    """Where a surface has lines: shares of its area, and the principal curvatures on it, 1/m.

    Attributes
    ----------
    unreal : float
        Share without any direction of the wanted normal curvature.
    flat : float
        Share where there are some, but the families cross at less than `CROSSING_ANGLE_MIN`.
    k1_max, k2_min : float
    """

    unreal: float
    flat: float
    k1_max: float
    k2_min: float


@dataclass(frozen=True)
class StreamlinePlan:
    """How a net of lines from seeds is laid on a surface.

    Attributes
    ----------
    reach : Reach
    field : LineField
    guide : Guide
    distance : float
        Of seeds along the guide, m.
    request : DensityRequest
    size : float
        Of the surface, m.
    estimated_nodes : int
    """

    reach: Reach
    field: LineField
    guide: Guide
    distance: float
    request: DensityRequest
    size: float
    estimated_nodes: int

    @property
    def cells(self) -> int:
        """Cells along the guide."""
        return round(self.guide.length / self.distance)


def plan_streamlines(
    charts: Charts, pattern: Pattern, *, cells: int | None = None, spacing: float | None = None
) -> StreamlinePlan:
    """Where lines of a pattern run on a surface, and how far apart.

    Parameters
    ----------
    charts, pattern, cells, spacing
        See `lamella.network.streamlines.streamline_network.traced_network`.

    Raises
    ------
    InputError
        There are no such lines, or they do not end; too few cells, or too many nodes.
    """
    request = DensityRequest.of(cells, spacing)
    where, area = charts.samples()
    sample = charts.evaluate(where)
    size = diagonal(sample.position)
    scale = float(np.sqrt(np.average(sample.mean**2 + np.abs(sample.deviator) ** 2, weights=area)))
    field = LineField(pattern.normal_curvature, max(scale, 1e-9 / size))
    real, usable = field.is_real(sample.mean, sample.deviator), field.margin(sample.mean, sample.deviator) > 0
    half = np.abs(sample.deviator)
    total = area.sum()
    reach = Reach(
        float(area[~real].sum() / total),
        float(area[real & ~usable].sum() / total),
        float((sample.mean + half).max()),
        float((sample.mean - half).min()),
    )
    _refuse_nowhere(reach, usable, sample.mean, half, pattern)
    guide = choose_guide(charts, field, size)
    distance = _distance(guide, request)
    sines = field.crossing_sine(sample.mean, sample.deviator)[usable]
    spacing_there = distance * guide.share
    # a cell has the area spacing^2 sin(angle)
    crossings = area[usable].sum() / (spacing_there**2 * float(np.median(sines)))
    nodes = crossings + _ends(charts, field, spacing_there)
    least = spacing_there * float(np.sqrt(nodes / NODES_MAX))
    request.refuse_many(nodes, guide.length * guide.share / least, least)
    few = probes(charts, field, where, sample, spacing_there, size)
    refuse_winding(charts, field, few, pattern, spacing_there, size)
    return StreamlinePlan(reach, field, guide, distance, request, size, round(nodes))


def _refuse_nowhere(reach: Reach, usable: Booleans, mean: Floats, half: Floats, pattern: Pattern) -> None:
    if usable.any():
        return
    if pattern.normal_curvature is None:
        raise InputError(
            "the surface is umbilic everywhere: all directions bend alike", "bend it more one way", "surface"
        )
    # the range within which part of the surface has lines that cross well enough
    turn = np.cos(np.radians(CROSSING_ANGLE_MIN))
    low = float(np.quantile(mean - turn * half, OFFERED_AREA))
    high = float(np.quantile(mean + turn * half, 1 - OFFERED_AREA))
    none = reach.unreal >= 1 - 1e-12
    raise InputError(
        f"normal_curvature = {pattern.normal_curvature:g} 1/m: "
        + (
            "no direction of the surface has it"
            if none
            else f"lines of it cross at less than {CROSSING_ANGLE_MIN:g} deg"
        )
        + f", its normal curvatures run from k2 = {reach.k2_min:.4g} to k1 = {reach.k1_max:.4g} 1/m",
        f"choose a value from {rounded(low, up=True):g} to {rounded(high, up=False):g} 1/m (the sign is that of the "
        "surface's normal)",
        "normal_curvature",
    )


def _distance(guide: Guide, request: DensityRequest) -> float:
    """Distance of seeds along the guide, m."""
    if request.spacing is None:
        assert request.cells is not None
        request.refuse_few(request.cells)
        return guide.length / request.cells
    width = guide.length * guide.share
    request.refuse_wide(width / request.spacing, width / CELLS_MIN)
    return request.spacing / guide.share


def _ends(charts: Charts, field: LineField, spacing: float) -> float:
    """Lamellas' ends on the rim: lines of a family are the spacing times the sine of the crossing angle apart."""
    where = charts.rim_points(SEEDING_RIM_POINTS)
    sample, rim = charts.evaluate(where), charts.rim_places(where)
    usable = field.margin(sample.mean, sample.deviator) > 0
    arc = np.zeros(len(where))
    for loop in np.unique(rim.loop):
        mine = np.flatnonzero(rim.loop == loop)
        mine = mine[np.argsort(rim.along[mine], kind="stable")]
        arc[mine] = lengths(np.roll(sample.position[mine], -1, 0) - sample.position[mine])
    sample, arc, tangent = sample.take(usable), arc[usable], rim.tangent[usable]
    apart = spacing * field.crossing_sine(sample.mean, sample.deviator)
    ends = 0.0
    for family in (True, False):
        heading = field.heading(sample.mean, sample.deviator, np.full(len(arc), family))
        line = heading.real[:, None] * sample.e_u + heading.imag[:, None] * sample.e_v
        across = np.sqrt(np.maximum(1 - dots(line, tangent) ** 2, 0))
        ends += float((arc * across / apart).sum())
    return ends
