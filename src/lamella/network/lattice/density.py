"""How far apart the lamellas are: from `cells` or `spacing` to the step l0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.limits import CELLS_MIN
from lamella.network.arc_length import ArcLengths, Stretched
from lamella.network.density_request import NODES_MAX, DensityRequest
from lamella.network.lattice.domain import Lines
from lamella.network.lattice.domain_of import domain_of
from lamella.network.lattice.lattice import build_lattice
from lamella.network.lattice.segments import Segments
from lamella.network.lattice.skew_band import check_normal_curvature
from lamella.network.pattern import LAMELLAS, Pattern, fitting_cells
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Ring
from lamella.surface.umbilic import refuse_umbilic

# nets of up to so many nodes are tried out to meet a spacing; in larger ones the rim weighs little
TRIED_NODES_MAX = 20_000
# cells of the coarse net from which densities are judged
TRIAL_CELLS = 48


@dataclass(frozen=True)
class Density:
    """The chosen density.

    Attributes
    ----------
    cells : int
        A lamellas crossed once around the axis, or cells along the longest principal line.
    step : float
        l0, sqrt(m).
    estimated_nodes : int
        From the number of cells that fit on the surface.
    requested : str
        What the project asked for.
    pattern : Pattern
        Of the curves this far apart, those the net has.
    """

    cells: int
    step: float
    estimated_nodes: int
    requested: str
    pattern: Pattern = LAMELLAS


def _coarse_lines(surface: ClosedForm, whole: float, pattern: Pattern) -> Lines:
    return domain_of(surface, whole / TRIAL_CELLS, pattern).lines()


def _estimate(lines: Lines) -> tuple[float, float]:
    """Nodes of a net with c cells, area c^2 + ends c: a crossing a cell, and two ends a lamella."""
    return float(np.maximum(lines.end - lines.start, 0).sum() / 2) / TRIAL_CELLS**2, 2 * len(lines.start) / TRIAL_CELLS


def _median_edge(surface: ClosedForm, whole: float, lines: Lines, pattern: Pattern) -> float:
    """Median cell edge divided by the step, 1 / sqrt(m), weighted alike in the cell plane."""
    lines = lines.take(np.arange(0, len(lines.start), max(1, len(lines.start) // 200)))
    length = np.maximum(lines.end - lines.start, 0)
    count = 64
    t = lines.start[:, None] + length[:, None] * ((np.arange(count) + 0.5) / count)
    point = lines.base[:, None] + t * lines.direction[:, None]
    domain = domain_of(surface, whole / TRIAL_CELLS, pattern)
    where = np.repeat(lines.sheet, count), point.ravel()
    velocity = domain.velocity(*where, np.repeat(lines.direction, count))
    edge = surface.metric(domain.place(*where)) * np.abs(velocity)
    order = np.argsort(edge)
    share = np.cumsum(np.repeat(length, count)[order])
    return float(edge[order][np.searchsorted(share, share[-1] / 2)] / domain.step)


def _nearest(surface: ClosedForm, whole: float, cells: int, spacing: float, pattern: Pattern) -> int:
    """The number of cells near a first guess whose net, pieces cut off by the rim included, has the nearest median."""
    residuals: dict[int, float] = {}

    def residual(count: int) -> float:
        if count not in residuals:
            domain = domain_of(surface, whole / count, pattern)
            lines = domain.lines()
            lines = lines.take(lines.end > lines.start)
            try:
                length = ArcLengths(Segments(domain, build_lattice(domain, lines))).length
            except Stretched:
                length = np.zeros(0)
            residuals[count] = abs(float(np.median(length)) - spacing) if len(length) else np.inf
        return residuals[count]

    while True:
        best = min(
            (n for n in (cells - 1, cells, cells + 1) if n >= CELLS_MIN), key=lambda n: (residual(n), n != cells)
        )
        if best == cells:
            return cells
        cells = best


def choose_density(
    surface: ClosedForm, *, cells: int | None = None, spacing: float | None = None, pattern: Pattern = LAMELLAS
) -> Density:
    """The step l0 that holds a whole number of cells and comes nearest to what is asked.

    Parameters
    ----------
    surface : ClosedForm
    cells : int, optional
        Number of A lamellas that cross a loop once around the axis; on a simply connected surface number of
        cells along its longest principal line. Default 24 when spacing is not given either.
    spacing : float, optional
        Wanted median cell edge, m, before curves are left out.
    pattern : Pattern

    Raises
    ------
    InputError
        Both given; fewer than 3 cells; a net of more than 500,000 nodes; every point of the surface umbilic; a number
        of cells around the axis that is no multiple of what is kept.
    """
    request = DensityRequest.of(cells, spacing)
    refuse_umbilic(surface)
    if pattern.normal_curvature is not None:
        check_normal_curvature(surface, pattern.normal_curvature)
    whole = surface.whole_length
    lines = _coarse_lines(surface, whole, pattern)
    count = request.cells
    if request.spacing is not None:
        count = _cells_for(surface, request, lines, pattern)
    assert count is not None
    if isinstance(surface.outline, Ring):
        turn = complex(surface.isothermic(np.array([2j * np.pi]))[0])
        count = fitting_cells(count, pattern.multiple(turn), "the axis", given=request.spacing is None)
    request.refuse_few(count)
    area, ends = _estimate(lines)
    p, q = pattern.every
    area, ends = area / (p * q), ends * (p + q) / (2 * p * q)
    estimate = area * count**2 + ends * count
    most = int((np.sqrt(ends**2 + 4 * area * NODES_MAX) - ends) / (2 * area))
    request.refuse_many(estimate, most, (request.spacing or 0.0) * count / max(most, 1))
    return Density(count, whole / count, round(estimate), str(request), pattern)


def _cells_for(surface: ClosedForm, request: DensityRequest, lines: Lines, pattern: Pattern) -> int:
    """The number of cells whose net has the median cell edge nearest to a spacing."""
    assert request.spacing is not None
    whole = surface.whole_length
    median = _median_edge(surface, whole, lines, pattern)
    exact = whole * median / request.spacing
    cells = max(round(exact), 1)
    if cells < CELLS_MIN:
        request.refuse_wide(exact, whole * median / CELLS_MIN)
    area, ends = _estimate(lines)
    if area * cells**2 + ends * cells < TRIED_NODES_MAX:
        cells = _nearest(surface, whole, cells, request.spacing, pattern)
    return cells
