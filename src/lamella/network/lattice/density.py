"""How far apart the lamellas are: from `cells` or `spacing` to the step l0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.arc_length import ArcLengths, Stretched
from lamella.network.lattice.domain import Lines
from lamella.network.lattice.domain_of import domain_of
from lamella.network.lattice.lattice import build_lattice
from lamella.network.lattice.segments import Segments
from lamella.network.lattice.skew_band import check_normal_curvature
from lamella.network.pattern import LAMELLAS, Pattern, fitting_cells
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Ring
from lamella.surface.umbilic import refuse_umbilic

LEAST_CELLS = 3
# nets of up to so many nodes are tried out to meet a spacing; in larger ones the rim weighs little
MOST_TRIED = 20_000
# cells of the coarse net from which densities are judged
TRIAL = 48
# a net of this many nodes takes a few minutes to compute and write
MOST_NODES = 500_000
# measured at 100,000 nodes for computing and writing, plus a fixed share for the program itself
BYTES_PER_NODE, BYTES_FIXED = 9_000, 150_000_000


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
    return domain_of(surface, whole / TRIAL, pattern).lines()


def _estimate(lines: Lines) -> tuple[float, float]:
    """Nodes of a net with c cells, area c^2 + ends c: a crossing a cell, and two ends a lamella."""
    return float(np.maximum(lines.end - lines.start, 0).sum() / 2) / TRIAL**2, 2 * len(lines.start) / TRIAL


def _median_edge(surface: ClosedForm, whole: float, lines: Lines, pattern: Pattern) -> float:
    """Median cell edge divided by the step, 1 / sqrt(m), weighted alike in the cell plane."""
    lines = lines.take(np.arange(0, len(lines.start), max(1, len(lines.start) // 200)))
    length = np.maximum(lines.end - lines.start, 0)
    count = 64
    t = lines.start[:, None] + length[:, None] * ((np.arange(count) + 0.5) / count)
    point = lines.base[:, None] + t * lines.direction[:, None]
    domain = domain_of(surface, whole / TRIAL, pattern)
    where = np.repeat(lines.sheet, count), point.ravel()
    velocity = domain.velocity(*where, np.repeat(lines.direction, count))
    edge = surface.metric(domain.place(*where)) * np.abs(velocity)
    order = np.argsort(edge)
    share = np.cumsum(np.repeat(length, count)[order])
    return float(edge[order][np.searchsorted(share, share[-1] / 2)] / domain.step)


def _nearest(surface: ClosedForm, whole: float, cells: int, spacing: float, pattern: Pattern) -> int:
    """The number of cells near a first guess whose net, pieces cut off by the rim included, has the nearest median."""
    misses: dict[int, float] = {}

    def miss(count: int) -> float:
        if count not in misses:
            domain = domain_of(surface, whole / count, pattern)
            lines = domain.lines()
            lines = lines.take(lines.end > lines.start)
            try:
                length = ArcLengths(Segments(domain, build_lattice(domain, lines))).length
            except Stretched:
                length = np.zeros(0)
            misses[count] = abs(float(np.median(length)) - spacing) if len(length) else np.inf
        return misses[count]

    while True:
        best = min((n for n in (cells - 1, cells, cells + 1) if n >= LEAST_CELLS), key=lambda n: (miss(n), n != cells))
        if best == cells:
            return cells
        cells = best


def _round(number: float) -> str:
    return f"{number:,.0f}" if number < 1e12 else f"{number:.3g}"


def check_requested(cells: int | None, spacing: float | None) -> None:
    """Refuse both at once, and what is no number of cells or no length.

    Raises
    ------
    InputError
    """
    if cells is not None and spacing is not None:
        raise InputError(
            f"both cells = {cells} and spacing = {spacing:g} m are given", "give one of the two", "network"
        )
    if cells is not None and (isinstance(cells, bool) or not isinstance(cells, int | np.integer)):
        raise InputError(f"cells = {cells!r} is not a whole number", "write a whole number", "network.cells")
    if spacing is not None and not 0 < spacing < np.inf:
        raise InputError(f"spacing = {spacing!r} m is no length", "write a number above 0, in m", "network.spacing")


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
    check_requested(cells, spacing)
    refuse_umbilic(surface)
    if pattern.normal_curvature is not None:
        check_normal_curvature(surface, pattern.normal_curvature)
    whole = surface.whole_length
    requested = f"cells = {cells}"
    if cells is None and spacing is None:
        cells, requested = 24, "cells = 24 (default)"
    key = "network.cells"
    lines = _coarse_lines(surface, whole, pattern)
    if spacing is not None:
        key, requested = "network.spacing", f"spacing = {spacing:g} m"
        median = _median_edge(surface, whole, lines, pattern)
        exact = whole * median / spacing
        cells = max(round(exact), 1)
        if cells < LEAST_CELLS:
            raise InputError(
                f"spacing = {spacing:g} m leaves {exact:.2g} cells across the surface, at least {LEAST_CELLS} are "
                "needed",
                f"choose a spacing of at most {rounded(whole * median / LEAST_CELLS, up=False):g} m",
                key,
            )
        area, ends = _estimate(lines)
        if area * cells**2 + ends * cells < MOST_TRIED:
            cells = _nearest(surface, whole, cells, spacing, pattern)
    assert cells is not None
    if isinstance(surface.outline, Ring):
        turn = complex(surface.isothermic(np.array([2j * np.pi]))[0])
        cells = fitting_cells(cells, pattern.multiple(turn), "the axis", given=spacing is None)
    if cells < LEAST_CELLS:
        raise InputError(
            f"{cells} cells, at least {LEAST_CELLS} are needed", f"write cells = {LEAST_CELLS} or more", key
        )
    area, ends = _estimate(lines)
    p, q = pattern.every
    area, ends = area / (p * q), ends * (p + q) / (2 * p * q)
    estimate = area * cells**2 + ends * cells
    if estimate > MOST_NODES:
        most = int((np.sqrt(ends**2 + 4 * area * MOST_NODES) - ends) / (2 * area))
        memory = (BYTES_FIXED + BYTES_PER_NODE * estimate) / 1e9
        if most < LEAST_CELLS:
            remedy = "the surface is too long for its width: shorten or widen it"
        elif spacing is not None:
            remedy = f"choose a spacing of at least {rounded(1.01 * spacing * cells / most, up=True):g} m"
        else:
            remedy = f"at most {most} cells fit this surface"
        raise InputError(
            f"{requested} would make about {_round(estimate)} nodes and take about {_round(memory)} GB of memory "
            f"(limit {MOST_NODES:,} nodes)",
            remedy,
            key,
        )
    return Density(cells, whole / cells, round(estimate), requested, pattern)
