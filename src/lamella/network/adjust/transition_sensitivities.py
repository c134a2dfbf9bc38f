"""How the shifts of isothermic coordinates change when the boundary of a film or its H changes.

To first order a film moves along its normals by a Jacobi field: one linear system for all changes at once. The
coordinates' forms change with it, and the shifts follow by testing this change with the harmonic functions that jump by
1 across one piece of the cut: one gradient by the film's nodes serves all changes
(`lamella.network.adjust.shift_gradients`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.adjust.shift_gradients import depth_gradients, shift_gradients
from lamella.network.isothermic.holonomy import vertex_relations
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.seamless_transitions import best_shifts
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
    surface: ElementSurface, film: Film, iso: Isothermic, fields: Floats, rim_shifts: Floats
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
    rim_shifts : (p, n, 3)
        See `jacobi_fields`.
    """
    moves = fields[..., None] * film.directions()
    flat = moves.reshape(len(fields), -1).T
    gradients = shift_gradients(surface, iso)
    right = gradients.reshape(len(gradients), len(flat)) @ flat
    relations = list(vertex_relations(iso.mesh, iso.transitions, iso.across, iso.odd).values())
    still = np.zeros(len(relations), complex)
    shifts = np.zeros(right.shape, complex)
    for number, column in enumerate(right.T):
        shifts[:, number] = best_shifts(iso.gram, column, relations, still)
    umbilics = UmbilicDepths.of(surface)
    inwards = depth_gradients(surface, umbilics).reshape(len(umbilics.depth), len(flat)) @ flat
    depths = inwards - np.einsum("zc,pzc->zp", umbilics.inwards, rim_shifts[:, umbilics.rim_node])
    return Sensitivities(shifts, umbilics.depth, depths)
