"""How the shifts of isothermic coordinates change when the boundary of a film or its H changes.

To first order a film moves along its normals by a Jacobi field: one linear system for all changes at once. The
coordinates' forms change with it, and the shifts follow by testing this change with the harmonic functions that jump by
1 across one piece of the cut: no coordinates have to be found anew.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.progress import Progress, Report, silent
from lamella.network.isothermic.holonomy import vertex_relations
from lamella.network.isothermic.isothermic import Isothermic, sectors
from lamella.network.isothermic.poisson import Poisson
from lamella.network.isothermic.seamless_transitions import best_shifts, links
from lamella.network.isothermic.umbilic_depth import UmbilicDepths
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.variation import Variation

# of the film's size: how far it is moved for a difference quotient
SENSITIVITY_STEP = 1e-4


def jacobi_fields(film: Film, mean_curvature: float, rim_shifts: Floats, curvature_sensitivities: Floats) -> Floats:
    """Shifts of the nodes along the film's directions that keep it in equilibrium, to first order.

    Parameters
    ----------
    film : Film
        In equilibrium, no loop sliding.
    mean_curvature : float
        H, 1/m.
    rim_shifts : (p, n, 3)
        How nodes of the boundary move with each of p parameters, m; 0 inside.
    curvature_sensitivities : (p,)
        How H changes, 1/m.

    Returns
    -------
    (p, n)
        m.
    """
    directions = film.directions()
    variation = Variation(film.connectivity, directions)
    first = variation.first(film.nodes)
    blocks = variation.second(film.nodes, first, mean_curvature)
    elements = film.connectivity.elements
    i, j = np.tril_indices(elements.shape[1])
    full = np.empty((len(elements), elements.shape[1], elements.shape[1]))
    full[:, i, j] = full[:, j, i] = blocks
    fields = (rim_shifts * directions).sum(2)
    free = film.unknowns >= 0
    flat = elements.ravel()
    right = [
        -np.bincount(flat, np.matmul(full, field[elements][..., None]).ravel(), len(free))
        - 2 * rate * first.volume_gradient
        for field, rate in zip(fields, curvature_sensitivities, strict=True)
    ]
    pattern = film.pattern
    solved = pattern.factor(pattern.assemble(blocks)).solve(np.stack(right, 1)[free])
    fields[:, free] = solved.T
    return np.asarray(fields)


def curvature_rates_of_volume(film: Film, mean_curvature: float, rim_shifts: Floats) -> Floats:
    """Change of H, 1/m, with each of p parameters, (p,), that leaves the enclosed volume as it is, to first order.

    Parameters
    ----------
    film, mean_curvature, rim_shifts
        See `jacobi_fields`.
    """
    count = len(rim_shifts)
    still = np.concatenate([rim_shifts, np.zeros((1, *film.nodes.shape))])
    fields = jacobi_fields(film, mean_curvature, still, np.append(np.zeros(count), 1.0))
    free = (film.unknowns >= 0)[:, None]
    volume = np.empty(count + 1)
    for number, (field, rim) in enumerate(zip(fields, still, strict=True)):
        # the lids go with the rim, which moves in all directions
        move = np.where(free, field[:, None] * film.directions(), rim)
        step = SENSITIVITY_STEP * film.size / max(float(np.abs(move).max()), 1e-12 * film.size)
        ahead, behind = (enclosed_volume(film.at(film.nodes + way * step * move)) for way in (1, -1))
        volume[number] = (ahead - behind) / (2 * step)
    return np.asarray(-volume[:count] / volume[count])


@dataclass(frozen=True)
class Sensitivities:
    """How a net follows p parameters.

    Attributes
    ----------
    shifts : (t, p) complex
        Change of every shift, sqrt(m).
    depth : (z,)
        Distance of the umbilics of order 1 from the rim, m.
    depths : (z, p)
        Change of that.
    """

    shifts: Complexes
    depth: Floats
    depths: Floats


def transition_sensitivities(
    surface: ElementSurface,
    film: Film,
    iso: Isothermic,
    fields: Floats,
    rim_shifts: Floats,
    curvature_sensitivities: Floats,
    progress: Progress = silent,
) -> Sensitivities:
    """Change of every shift, and of how far umbilics are inside the rim, with each of p parameters.

    Parameters
    ----------
    surface : ElementSurface
        The film.
    film : Film
    iso : Isothermic
        On the surface.
    fields : (p, n)
        See `jacobi_fields`.
    rim_shifts, curvature_sensitivities
        See `jacobi_fields`.
    progress : callable
        Is told which parameter it is.
    """
    mesh = iso.mesh
    system = Poisson.of(mesh, iso.sign)
    sector = sectors(mesh.connectivity, iso.cut)
    base, moves = system.solve(sector, *links(mesh, iso.transitions, sector))
    gram, _ = system.quadratic(base, moves)
    relations = list(vertex_relations(mesh, iso.transitions, iso.across, iso.odd).values())
    directions = film.directions()
    sensitivities = np.zeros((len(iso.transitions), len(fields)), complex)
    umbilics = UmbilicDepths.of(surface)
    depths = np.zeros((len(umbilics.depth), len(fields)))
    for number, (field, rate) in enumerate(zip(fields, curvature_sensitivities, strict=True)):
        progress(Report.detail(f"how the net follows: {number} of {len(fields)} parameters", number / len(fields)))
        step = SENSITIVITY_STEP * film.size / max(float(np.abs(field).max()), 1e-12 * film.size)
        moved = ElementSurface(
            surface.kind,
            surface.mean_curvature + step * rate,
            surface.connectivity,
            surface.nodes + step * field[:, None] * directions,
            surface.rim_loop,
        )
        there = replace(mesh, nodes=moved.measured(mesh.places).position, shape=moved.at(mesh.places).shape_entries)
        other = Poisson.of(there, iso.sign)
        # the root's branch is that of each element's own middle: the same one on both surfaces
        same = (other.form_a * system.form_a.conj() + other.form_b * system.form_b.conj()).real.sum(1)
        turn = np.where(same < 0, -1, 1)[:, None]
        pull = system.pull_of(turn * other.form_a - system.form_a, turn * other.form_b - system.form_b)
        right = np.einsum("tek,ek->t", moves, pull) / step
        sensitivities[:, number] = best_shifts(gram, right, relations, np.zeros(len(relations), complex))
        along = rim_shifts[number] - field[:, None] * directions
        depths[:, number] = umbilics.change(surface, moved, step * along) / step
    return Sensitivities(sensitivities, umbilics.depth, depths)
