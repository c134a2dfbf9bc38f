"""The lattice of cells on a surface of elements: where it lies, and how wide it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.errors import InputError
from lamella.network.density import BYTES_FIXED, BYTES_PER_NODE, LEAST_CELLS, MOST_NODES
from lamella.network.holonomy import Holonomy
from lamella.network.isothermic import Isothermic
from lamella.network.lattice_origin import lattice_origin
from lamella.network.pattern import LAMELLAS, Pattern, fitting_cells
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.points import Floats

# of the longest principal line: a shorter period around a hole is none to count cells on
LEAST_PERIOD = 1e-2


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
    requested : str
    estimated_nodes : int
        Crossings and ends on the rim.
    """

    origin: complex
    step: float
    cells: int
    requested: str
    estimated_nodes: int


def choose_lattice(
    iso: Isothermic,
    around: tuple[Holonomy, ...],
    cells: int | None,
    spacing: float | None,
    *,
    step: float | None = None,
    pattern: Pattern = LAMELLAS,
    names: tuple[str, ...] = (),
) -> Lattice:
    """Origin and step: a singular node on the lattice, a whole number of cells around the first hole or across.

    With a step, sqrt(m), that is taken, and the number of cells is what follows.
    """
    whole, period = _whole_length(iso, around, pattern)
    points, weights = triangle_rule(8)
    mu_area, edge = _cell_densities(iso, points, weights, pattern)
    requested = f"cells = {cells}"
    key = "network.cells"
    if cells is None and spacing is None:
        cells, requested = 24, "cells = 24 (default)"
    if spacing is not None:
        key, requested = "network.spacing", f"spacing = {spacing:g} m"
        order = np.argsort(edge)
        running = np.cumsum(mu_area[order])
        median = float(edge[order][np.searchsorted(running, running[-1] / 2)])
        cells = max(round(whole * median / spacing), 1)
        if cells < LEAST_CELLS:
            raise InputError(
                f"spacing = {spacing:g} m leaves {whole * median / spacing:.2g} cells across the surface, at least "
                f"{LEAST_CELLS} are needed",
                f"choose a spacing of at most {whole * median / LEAST_CELLS:.3g} m",
                key,
            )
    assert cells is not None
    if period:
        name = repr(names[around[0].loop]) if names else "the first hole"
        cells = fitting_cells(cells, pattern.multiple(period), name, given=spacing is None)
    if cells < LEAST_CELLS:
        raise InputError(f"{cells} cells, at least {LEAST_CELLS} are needed", "raise cells", key)
    if step is None:
        step = whole / cells
    else:
        cells = round(whole / step)
    p, q = pattern.every
    # a crossing a cell, and two ends a lamella
    crossings, ends = float(mu_area.sum()) / (step**2 * p * q), _ends(iso, pattern, step)
    estimate = crossings + ends
    if estimate > MOST_NODES:
        memory = (BYTES_FIXED + BYTES_PER_NODE * estimate) / 1e9
        finer = (np.sqrt(ends**2 + 4 * crossings * MOST_NODES) - ends) / (2 * crossings)
        raise InputError(
            f"{requested} would make about {estimate:,.0f} nodes and take about {memory:,.0f} GB of memory (limit "
            f"{MOST_NODES:,} nodes)",
            f"at most {int(cells * finer)} cells fit this surface"
            if spacing is None
            else f"choose a spacing of at least {spacing / finer:.3g} m",
            key,
        )
    return Lattice(lattice_origin(iso, step, pattern), step, cells, requested, round(estimate))


def _ends(iso: Isothermic, pattern: Pattern, step: float) -> float:
    """Ends of lamellas on the rim: whole numbers that both parts of chi pass along it."""
    connectivity = iso.mesh.connectivity
    nodes = connectivity.basis.edge_nodes[connectivity.rim_edges]
    along = np.diff(pattern.cells(iso.value[connectivity.rim_elements[:, None], nodes], step), axis=1)
    return float((np.abs(along.real) + np.abs(along.imag)).sum())


def _cell_densities(iso: Isothermic, points: Floats, weights: Floats, pattern: Pattern) -> tuple[Floats, Floats]:
    """Area of the cell plane, |factor dw|^2, m, and cell edge over l0, 1 / |factor mu|, at integration points."""
    connectivity = iso.mesh.connectivity
    basis = connectivity.basis
    x, y = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
    w_x, w_y = iso.value @ x.T, iso.value @ y.T
    area = np.abs(w_x.real * w_y.imag - w_x.imag * w_y.real) * weights
    corners = iso.mesh.nodes[connectivity.elements]
    flat = np.linalg.norm(np.cross(np.matmul(x, corners), np.matmul(y, corners)), axis=2) * weights
    area = area / pattern.edge**2
    edge = np.sqrt(flat / np.maximum(area, 1e-300))
    return area.ravel(), edge.ravel()


def _whole_length(iso: Isothermic, around: tuple[Holonomy, ...], pattern: Pattern) -> tuple[float, complex]:
    """What `cells` divides, sqrt(m), and the period it is: around the first hole, or 0: the longest principal line."""
    longest = iso.longest
    if around and around[0].sign == 1:
        chi = around[0].shift * pattern.factor
        counted = max(abs(chi.real), abs(chi.imag))
        if counted > LEAST_PERIOD * longest:
            return counted, around[0].shift
    return longest, 0j
