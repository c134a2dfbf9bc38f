"""The lattice of cells on a surface of elements: where it lies, and how wide it is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Integers
from lamella.base.limits import CELLS_MIN
from lamella.network.density_request import NODES_MAX, DensityRequest
from lamella.network.elements.cell_count import CellCount
from lamella.network.elements.choose_step import Better, better_density, near_step
from lamella.network.elements.closing_steps import CLOSES, ClosingLengths
from lamella.network.elements.edge_sizes import EdgeSizes
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.isothermic.holonomy import Holonomy
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.lattice_origin import lattice_origin
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
    request: DensityRequest,
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
    cells, requested = request.cells, str(request)
    chosen = step
    if chosen is None and request.spacing is not None:
        wanted = sizes.step(request.spacing / correction)
        room = max(count.length, count.across)
        # what is written as a remedy has to do
        request.refuse_wide(room / wanted, 0.99 * sizes.median(room / CELLS_MIN))
        _refuse_many(request, sizes, wanted, pattern)
        chosen = near_step(count, closing, wanted, pattern)
        if abs(np.log(chosen / wanted)) > MOVED and closing.residual(chosen) <= CLOSES:
            requested += f" ({sizes.median(chosen):.3g} m: the net closes with it)"
    elif chosen is None:
        assert cells is not None
        request.refuse_few(cells)
        if count.follows_period(pattern):
            name = repr(names[around[0].loop]) if names else "the first hole"
            cells = fitting_cells(cells, pattern.multiple(count.period), name, given=True)
        chosen = count.step(cells, pattern)
        _refuse_many(replace(request, cells=cells), sizes, chosen, pattern)
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


def _refuse_many(request: DensityRequest, sizes: EdgeSizes, step: float, pattern: Pattern) -> None:
    """Refuse a net of too many nodes."""
    crossings, ends = sizes.nodes(step, pattern)
    # how many times more cells there may be
    finer = float(np.sqrt(ends**2 + 4 * crossings * NODES_MAX) - ends) / (2 * crossings)
    cells, spacing = request.cells or np.inf, request.spacing or 0.0
    request.refuse_many(crossings + ends, cells * finer, spacing / finer)


def _seams(iso: Isothermic, step: float, pattern: Pattern) -> Integers:
    """Transitions across which an open net does not go on."""
    shifts = IntegerGridMap.of(iso, lattice_origin(iso, step, pattern), step, pattern).shifts
    off = shifts - np.rint(shifts)
    return np.flatnonzero(np.maximum(np.abs(off.real), np.abs(off.imag)) > CLOSES)


def _advice(better: Better | None, sizes: EdgeSizes) -> str:
    if better is None:
        return ""
    density = f"spacing = {sizes.median(better.step):.4g}" if better.cells is None else f"cells = {better.cells}"
    if better.closes:
        return f"{density} closes it with all umbilics on nodes"
    return f"{density} misses whole cells by {better.residual:.2g} only"
