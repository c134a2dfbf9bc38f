"""The lattice of cells on a surface of elements: where it lies, and how wide it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.elements.cell_count import CellCount
from lamella.network.elements.choose_step import LEAST_CELLS, Better, better_density, near_step
from lamella.network.elements.closing_steps import CLOSES, ClosingLengths
from lamella.network.elements.edge_sizes import EdgeSizes
from lamella.network.elements.integer_grid_map import CellMap
from lamella.network.elements.lattice_origin import lattice_origin
from lamella.network.isothermic.holonomy import Holonomy
from lamella.network.isothermic.isothermic import Integers, Isothermic
from lamella.network.lattice.density import BYTES_FIXED, BYTES_PER_NODE, MOST_NODES
from lamella.network.pattern import LAMELLAS, Pattern, fitting_cells

# share of a spacing; moved by more for a net that closes, the new one is reported
MOVED = 0.02
NO_SEAMS = np.zeros(0, np.int64)


@dataclass(frozen=True)
class Lattice:
    """How the lattice of cells lies on a surface.

    Attributes
    ----------
    origin : complex
        w of a lattice point, sqrt(m).
    step : float
        l0, sqrt(m).
    cells : int
        See `lamella.network.elements.cell_count`; where a spacing was given, the nearest whole number.
    requested : str
    estimated_nodes : int
        Crossings and ends on the rim.
    edge : float
        Expected median cell edge, m, before curves are left out.
    advice : str
        What density lets the net close with its umbilics on nodes, or brings it much nearer; empty: this one closes, or
        none near it does.
    better_closes : bool
        Whether all closes with that.
    """

    origin: complex
    step: float
    cells: int
    requested: str
    estimated_nodes: int
    edge: float
    advice: str
    better_closes: bool


def choose_lattice(
    iso: Isothermic,
    around: tuple[Holonomy, ...],
    cells: int | None,
    spacing: float | None,
    *,
    step: float | None = None,
    pattern: Pattern = LAMELLAS,
    names: tuple[str, ...] = (),
    seams: bool = True,
    correction: float = 1.0,
) -> Lattice:
    """Origin and step l0: of a number of cells, or near the step with a given median cell edge.

    With a step, sqrt(m), that is taken, and the number of cells is what follows. `seams` is whether the net is left
    open where it does not meet itself: that costs nodes.

    Raises
    ------
    InputError
        The surface has no room for three cells, or the net too many nodes.
    """
    count, closing = CellCount.of(iso, around, pattern), ClosingLengths.of(iso, pattern)
    sizes = EdgeSizes.of(iso, pattern, NO_SEAMS)
    requested, key = f"cells = {cells}", "network.cells"
    if spacing is not None:
        requested, key = f"spacing = {spacing:g} m", "network.spacing"
    elif cells is None:
        cells, requested = 24, "cells = 24 (default)"
    chosen = step
    if chosen is None and spacing is not None:
        wanted = sizes.step(spacing / correction)
        _check_room(count, sizes, wanted, spacing)
        _check_size(sizes, wanted, pattern, requested, key, spacing)
        chosen = near_step(count, closing, wanted, pattern)
        if abs(np.log(chosen / wanted)) > MOVED and closing.miss(chosen) <= CLOSES:
            requested += f" ({sizes.median(chosen):.3g} m: the net closes with it)"
    elif chosen is None:
        assert cells is not None
        if cells < LEAST_CELLS:
            raise InputError(
                f"{cells} cells, at least {LEAST_CELLS} are needed", f"write cells = {LEAST_CELLS} or more", key
            )
        if count.follows_period(pattern):
            name = repr(names[around[0].loop]) if names else "the first hole"
            cells = fitting_cells(cells, pattern.multiple(count.period), name, given=True)
        chosen = count.step(cells, pattern)
        _check_size(sizes, chosen, pattern, requested, key, None, cells)
    better = better_density(count, closing, chosen, pattern) if step is None else None
    ended = EdgeSizes.of(iso, pattern, _seams(iso, chosen, pattern)) if seams else sizes
    return Lattice(
        lattice_origin(iso, chosen, pattern),
        chosen,
        max(round(count.cells(chosen)), 1) if cells is None or step is not None else cells,
        requested,
        round(sum(ended.nodes(chosen, pattern))),
        sizes.median(chosen),
        _advice(better, sizes),
        better is not None and better.closes,
    )


def _check_room(count: CellCount, sizes: EdgeSizes, step: float, spacing: float) -> None:
    """Refuse a spacing with which fewer than three cells have room."""
    room = max(count.length, count.across)
    if room / step < LEAST_CELLS:
        # rounded down: what is written has to do
        most = rounded(0.99 * sizes.median(room / LEAST_CELLS), up=False)
        raise InputError(
            f"spacing = {spacing:g} m leaves {room / step:.2g} cells across the surface, at least {LEAST_CELLS} are "
            "needed",
            f"choose a spacing of at most {most:g} m",
            "network.spacing",
        )


def _check_size(
    sizes: EdgeSizes, step: float, pattern: Pattern, requested: str, key: str, spacing: float | None, cells: int = 0
) -> None:
    """Refuse a net of too many nodes."""
    crossings, ends = sizes.nodes(step, pattern)
    estimate = crossings + ends
    if estimate <= MOST_NODES:
        return
    memory = (BYTES_FIXED + BYTES_PER_NODE * estimate) / 1e9
    finer = float(np.sqrt(ends**2 + 4 * crossings * MOST_NODES) - ends) / (2 * crossings)
    raise InputError(
        f"{requested} would make about {estimate:,.0f} nodes and take about {memory:,.0f} GB of memory (limit "
        f"{MOST_NODES:,} nodes)",
        f"at most {int(cells * finer)} cells fit this surface"
        if spacing is None
        else f"choose a spacing of at least {rounded(1.01 * spacing / finer, up=True):g} m",
        key,
    )


def _seams(iso: Isothermic, step: float, pattern: Pattern) -> Integers:
    """Transitions across which an open net does not go on."""
    shifts = CellMap.of(iso, lattice_origin(iso, step, pattern), step, pattern).shifts
    off = shifts - np.rint(shifts)
    return np.flatnonzero(np.maximum(np.abs(off.real), np.abs(off.imag)) > CLOSES)


def _advice(better: Better | None, sizes: EdgeSizes) -> str:
    if better is None:
        return ""
    density = f"spacing = {sizes.median(better.step):.4g}" if better.cells is None else f"cells = {better.cells}"
    if better.closes:
        return f"{density} closes it with all umbilics on nodes"
    return f"{density} misses whole cells by {better.miss:.2g} only"
