"""Among the surfaces of constant mean curvature in one border, the one nearest to the vertices of a mesh.

The surfaces that a border holds are a family of one parameter, the volume V that is swept; their mean curvature H goes
with it. Along the family nodes move by ds/dV along their directions d, which one solve with the second variation gives
(a Jacobi field: J ds/dV = -2 dH/dV dV/ds, with dV/ds . ds/dV = 1). A vertex at the signed distance r from the surface
then comes nearer by w = (d . n) ds/dV, and

    dV = sum(A r w) / sum(A w^2)

is the Gauss-Newton step to the least sum(A r^2), A being the area around a vertex. Vertices lie on the surface they
were taken from, points of flat facets do not: so H is off by what the elements leave, not by the sagitta of the facets.
By the volume rather than by H itself, because H has a fold (at a hemisphere, say) where V has none.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report
from lamella.base.sparse import SingularError
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.newton import Equilibrium, NoFilmError, Volume, find_equilibrium
from lamella.surface.form_finding.variation import Variation

NEAREST_STEPS_MAX = 12
# a step that moves no vertex by more than this part of the size changes H by less than the elements' error
LAST_MOVE = 1e-7
NEAREST_HALVINGS_MAX = 6


def nearest_of_family(start: Equilibrium, points: Floats, areas: Floats, progress: Progress) -> Equilibrium:
    """The surface through the same border that comes nearest to points.

    Parameters
    ----------
    start : Equilibrium
        A surface of the family, its whole border held.
    points : (n, 3)
        Vertices of a mesh of it, m.
    areas : (n,)
        Their weights.
    progress : callable
        Is told each step.

    Returns
    -------
    Equilibrium
        With `steps` of all Newton solves on the way; `start` itself where no step brings it nearer.
    """
    here, steps = start, start.steps
    off, answer = _distances(here, points)
    for _ in range(NEAREST_STEPS_MAX):
        if not areas @ answer**2 > 0:
            break
        volume = float(areas @ (off * answer) / (areas @ answer**2))
        move = float(np.abs(volume * answer).max())
        if move <= LAST_MOVE * here.film.size:
            break
        new = _stepped(here, volume, points, areas, float(areas @ off**2))
        if new is None:
            break
        here, off, answer = new
        steps += here.steps
        progress(
            Report.detail(
                f"nearest to the vertices: H = {here.mean_curvature:.6g} 1/m, moved by {move:.2e} m, "
                f"{np.sqrt(areas @ off**2 / areas.sum()):.2e} m off ({here.steps} steps)"
            )
        )
    return Equilibrium(here.film, here.mean_curvature, steps, here.negative, here.moves)


def _stepped(
    here: Equilibrium, volume: float, points: Floats, areas: Floats, before: float
) -> tuple[Equilibrium, Floats, Floats] | None:
    """The surface a volume further, or a part of it, that is nearer; None: there is none."""
    for _ in range(NEAREST_HALVINGS_MAX):
        try:
            new = find_equilibrium(here.film, here.mean_curvature, Volume(volume), most_steps=12)
            off, answer = _distances(new, points)
        except (NoFilmError, SingularError):
            volume /= 2
            continue
        if areas @ off**2 < before:
            return new, off, answer
        volume /= 2
    return None


def _distances(here: Equilibrium, points: Floats) -> tuple[Floats, Floats]:
    """Signed distances of points from a surface (m), and how these fall by the volume swept (1/m^2), (n,) each."""
    film = here.film
    places, position = ClosestPoint(film.connectivity, film.nodes)(points)
    directions = film.directions()
    basis = film.connectivity.basis
    elements = film.connectivity.elements[places.element]
    x, y = (np.einsum("nk,nkc->nc", basis.basis(places.local, *d), film.nodes[elements]) for d in ((1, 0), (0, 1)))
    normal = np.cross(x, y)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    shift = _jacobi_field(film, directions, here.mean_curvature)[:, None] * directions
    answer = np.einsum("nk,nkc,nc->n", basis.basis(places.local), shift[elements], normal)
    return ((points - position) * normal).sum(1), answer


def _jacobi_field(film: Film, directions: Floats, mean_curvature: float) -> Floats:
    """Shifts of the nodes by the volume swept along the family, 1/m^2, (n,)."""
    free = film.unknowns >= 0
    variation = Variation(film.connectivity, directions)
    first = variation.first(film.nodes)
    pattern = film.bordered_pattern
    border = np.append(first.volume_gradient[free], 0.0)
    factor = pattern.factor(pattern.assemble(variation.second(film.nodes, first, mean_curvature), border[None]))
    right = np.zeros(len(border))
    right[-1] = 1.0
    field = np.zeros(len(free))
    field[free] = factor.solve(right)[:-1]
    return field
