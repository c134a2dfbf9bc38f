"""Films with sliding edges, from the film of the same edges held: these are let go little by little.

Let go at once, an edge that is held far from where its film has it runs away from the elements. So the edges are held
by springs where the film last had them, whose stiffness falls from film to film: with stiffness c per length an edge
moves by sin(a) / c, where the film meets its support a away from 90 degrees. That is the proximal point method
(Rockafellar, SIAM J. Control Optim. 14 (1976), 877-898, doi:10.1137/0314056): each film is the least of area, pressure
and springs, and the last ones need no springs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.progress import Progress, Report
from lamella.surface.form_finding.continuation import Reached
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film, Loop
from lamella.surface.form_finding.meshing import is_worn, renewed
from lamella.surface.form_finding.newton import Equilibrium, FixedH, NoFilmError, Volume, find_equilibrium

# stiffness of the first springs times the film's size, how it falls and rises, and the most and least of it
SPRINGS_FIRST, SPRINGS_FALL, SPRINGS_RISE, SPRINGS_MAX, SPRINGS_MIN = 10.0, 4.0, 8.0, 1e6, 1e-3
# films on the way, and Newton steps of one
RELEASE_FILMS_MAX, RELEASE_STEPS_MAX = 60, 15
# once the springs' largest force is below this part of the film's tension, the film is tried without them
CALM = 0.05


def release(start: Equilibrium, loops: tuple[Loop, ...], volume: float | None, progress: Progress) -> Reached:
    """The film of a held one's mean curvature, or of a volume, with its edges free to slide.

    Parameters
    ----------
    start : Equilibrium
        In the loops held, see `lamella.surface.form_finding.fixed_support.held`.
    loops : tuple of Loop
    volume : float or None
        m^3; None: H stays.
    progress : callable

    Raises
    ------
    NoFilmError
        An edge runs away, or the film breaks.
    """
    film, curvature, steps = replace(start.film, loops=loops), start.mean_curvature, 0
    size = start.film.size

    def found(springs: Floats | None) -> Equilibrium:
        condition = FixedH() if volume is None else Volume(volume - enclosed_volume(film))
        return find_equilibrium(
            film, curvature, condition, springs=springs, most_steps=RELEASE_STEPS_MAX, progress=progress
        )

    stiffness, calm = SPRINGS_FIRST / size, True
    for _ in range(RELEASE_FILMS_MAX):
        if calm:
            try:
                free = found(None)
            except NoFilmError as error:
                steps += RELEASE_STEPS_MAX
                progress(Report.detail(f"edges cannot be let go yet: {error}"))
            else:
                return Reached(free, steps + free.steps)
        if stiffness * size < SPRINGS_MIN:
            raise NoFilmError("the sliding edges find no place", film)
        try:
            there = found(stiffness * rim_lengths(film))
        except NoFilmError as error:
            steps, stiffness, calm = steps + RELEASE_STEPS_MAX, stiffness * SPRINGS_RISE, False
            if stiffness * size > SPRINGS_MAX:
                raise NoFilmError(f"let go, the sliding edges run away ({error})", film) from None
            continue
        steps += there.steps
        moved = np.linalg.norm(there.film.nodes - film.nodes, axis=1)[film.connectivity.rim_nodes].max()
        progress(Report.detail(f"edges held with {stiffness * size:.3g} over the film's size move by {moved:.3g} m"))
        film, curvature, calm = there.film, there.mean_curvature, bool(moved * stiffness < CALM)
        stiffness /= SPRINGS_FALL
        if is_worn(film):
            film = renewed(film)
    raise NoFilmError(f"the sliding edges find no place in {RELEASE_FILMS_MAX} films", film)


def rim_lengths(film: Film) -> Floats:
    """Length of the boundary that belongs to each node, m, (n,): Newton and Cotes' weights along its edges."""
    rim = film.connectivity.rim_nodes
    p = rim.shape[1] - 1
    powers = np.arange(p + 1)
    weights = np.linalg.solve((np.arange(p + 1) / p) ** powers[:, None], 1 / (powers + 1))
    length = np.linalg.norm(np.diff(film.nodes[rim], axis=1), axis=2).sum(1)
    return np.bincount(rim.ravel(), np.outer(length, weights).ravel(), len(film.nodes)).astype(np.float64)
