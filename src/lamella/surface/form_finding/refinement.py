"""A found surface on elements as small as a tolerance asks for."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.surface.form_finding.adaptivity import Deviation, deviation_of, refined_sizes
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.found_film import Found
from lamella.surface.form_finding.meshing import is_worn, renewed, straightened, with_sizes
from lamella.surface.form_finding.newton import Equilibrium, NoFilmError
from lamella.surface.form_finding.redistribution import redistributed
from lamella.surface.form_finding.stability import stability_of

REFINEMENT_ROUNDS_MAX = 12
# at the limit of nodes another round is worth its time while it lowers the deviation by more than this
SLOW_FALL = 0.7
# nodes are moved within the surface again rather than elements made smaller while the deviation is at most this many
# times the tolerance, and as long as it falls below this part
NEAR_TOLERANCE, GAIN = 2.5, 0.8
# of the tolerance, kept for what lies between the places that are checked
TOLERANCE_USED = 0.9
# of the curvature scale: a film that is off by more is none to speak of
WRONG = 0.1


def adapted(
    first: Equilibrium,
    settled: Callable[[Film], Equilibrium],
    tolerance: float,
    most_nodes: int,
    steps: int,
    followed: bool,
    progress: Progress,
) -> Found:
    """The same surface on elements as small as a tolerance asks for.

    Parameters
    ----------
    first : Equilibrium
        On coarse elements.
    settled : callable
        Newton's method on new elements.
    tolerance, most_nodes
        See `find_film`.
    steps, followed
        How the first one was found.
    progress : callable

    Raises
    ------
    InputError
        The surface is not there on finer elements.
    """
    try:
        here = _on_sound_elements(first, settled)
    except NoFilmError as error:
        raise InputError(
            f"the surface found on coarse elements breaks on finer ones: {error}",
            "make the boundary less bent, or allow a larger tolerance",
            "loops",
        ) from None
    shortfall = f"it was not reached in {REFINEMENT_ROUNDS_MAX} rounds of refinement"
    best: tuple[float, Equilibrium] | None = None
    for round_ in range(REFINEMENT_ROUNDS_MAX):
        here, deviation = _at_rest(here, settled, tolerance)
        progress(
            Report.step(
                f"{here.film.connectivity.node_count:,} nodes: |H - H0| up to {deviation.largest:.1e} of the curvature "
                f"scale {deviation.scale:.3g} 1/m"
            )
        )
        gain = deviation.weighted / best[0] if best else 0.0
        if best is None or deviation.weighted < best[0]:
            best = (deviation.weighted, here)
        if deviation.weighted <= TOLERANCE_USED * tolerance:
            shortfall = ""
            break
        size, allowed = refined_sizes(here.film, deviation, tolerance, most_nodes, coarsen=round_ < 2)
        if not allowed and here.film.connectivity.node_count > 0.7 * most_nodes and gain > SLOW_FALL:
            shortfall = f"elements as small as that asks for would need more than most_nodes = {most_nodes:,} nodes"
            break
        try:
            here = _settled_anew(with_sizes(here.film, size), here.mean_curvature, settled)
        except NoFilmError as error:
            progress(Report.detail(f"on finer elements: {error}"))
            try:
                here = _settled_anew(straightened(renewed(here.film, 0.6)), here.mean_curvature, settled)
            except NoFilmError as again:
                shortfall = f"on finer elements Newton's method fails ({again})"
                break
    assert best is not None
    here = best[1]
    deviation = deviation_of(here.film, here.mean_curvature)
    if shortfall and deviation.largest > tolerance:
        raise InputError(
            f"H is off by up to {deviation.largest:.2g} of the curvature scale {deviation.scale:.3g} 1/m, more than "
            f"tolerance = {tolerance:g}, {_place(here.film, deviation.of_element)}: {shortfall}",
            f"write tolerance = {_rounded_up(deviation.largest):g}"
            + (", raise most_nodes," if "most_nodes" in shortfall else "")
            + " or make the boundary smoother there (a spline through more points)"
            if deviation.largest < WRONG
            else "make the boundary less bent or less narrow there"
            + (", or raise most_nodes" if "most_nodes" in shortfall else ""),
            "tolerance",
        )
    return Found(
        here,
        stability_of(here.film, here.mean_curvature),
        deviation.largest,
        deviation.scale,
        steps,
        followed,
    )


def _on_sound_elements(first: Equilibrium, settled: Callable[[Film], Equilibrium]) -> Equilibrium:
    """A film ready to be refined.

    Elements that a path has drawn out tell nothing of where smaller ones are needed, and magnify rounding.
    """
    if is_worn(first.film):
        # what is no film on elements made anew may still do as it is
        with suppress(NoFilmError):
            return _settled_anew(renewed(first.film), first.mean_curvature, settled)
    return settled(straightened(first.film))


def _settled_anew(film: Film, mean_curvature: float, settled: Callable[[Film], Equilibrium]) -> Equilibrium:
    """The film on new elements laid over it, of about a mean curvature (1/m).

    Where its normal turns much within an element, as at a reflex corner of its boundary, new nodes along the normals of
    the old elements crowd, and an element folds in the first steps. A film's coordinates solve Laplace x = 2 H n over
    the film itself: solved once, that spreads the nodes and changes the surface by no more than the elements are off.
    """
    try:
        return settled(film)
    except NoFilmError:
        return settled(harmonic_over_itself(film, mean_curvature))


def _at_rest(
    here: Equilibrium, settled: Callable[[Film], Equilibrium], tolerance: float
) -> tuple[Equilibrium, Deviation]:
    """A film with its nodes where its mean curvature comes out best, and its deviation."""
    deviation = deviation_of(here.film, here.mean_curvature)
    while True:
        try:
            moved = settled(redistributed(here.film, here.mean_curvature))
        except NoFilmError:
            return here, deviation
        before, after = deviation.weighted, deviation_of(moved.film, moved.mean_curvature)
        if after.weighted < before:
            here, deviation = moved, after
        if not tolerance < deviation.weighted < min(NEAR_TOLERANCE * tolerance, GAIN * before):
            return here, deviation


def _place(film: Film, off: Floats) -> str:
    """Where the worst element is."""
    return f"near ({coordinates(film.nodes[film.connectivity.faces[off.argmax()]].mean(0))}) m"


def _rounded_up(value: float) -> float:
    """The next number of one digit that leaves some room."""
    power = 10.0 ** np.floor(np.log10(1.2 * value))
    return float(np.ceil(1.2 * value / power) * power)
