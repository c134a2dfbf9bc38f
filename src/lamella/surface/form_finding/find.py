"""Form finding: from boundary loops to the surface of constant mean curvature between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, patient, silent
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film, Loop
from lamella.surface.form_finding.first_film import FirstFilm
from lamella.surface.form_finding.found_film import Found
from lamella.surface.form_finding.nearest_existing import Tries
from lamella.surface.form_finding.necessary_conditions import (
    ImpossibleError,
    refuse_afloat,
    refuse_impossible,
    refuse_single,
)
from lamella.surface.form_finding.newton import Equilibrium, FixedH, Volume, find_equilibrium
from lamella.surface.form_finding.not_found import impossible, not_found
from lamella.surface.form_finding.refinement import adapted
from lamella.surface.form_finding.search_error import SearchError
from lamella.surface.form_finding.self_crossing import self_crossing

if TYPE_CHECKING:
    from lamella.surface.boundary import Loop as BoundaryLoop

# of the film's size: a film of the same mean curvature this near is told
OTHER_FILM_DISTANCE = 0.02
# tolerance of the elements on which other films than the one asked for are tried
OTHER_FILMS_TOLERANCE = 2e-2
# Newton steps spent on other films before no further one is tried: some seconds, whatever the boundary
OTHER_FILMS_STEPS_MAX = 120
# of the film's size: it hangs where it is this much lower than its whole boundary, and nowhere higher by as much
HANGS = 0.01

__all__ = ["Found", "adapted", "find_film", "notes_on", "remarks_on"]


def remarks_on(loops: tuple[BoundaryLoop, ...]) -> tuple[Message, ...]:
    """What was done to boundary curves when they were read."""
    return tuple(remark.of(f"the loop {loop.name!r}") for loop in loops for remark in loop.remarks)


def notes_on(found: Found, *, given_curvature: bool = True) -> tuple[Message, ...]:
    """What a user should know about a film before building it."""
    notes = []
    verdict = found.stability
    if verdict.verdict == "unstable":
        notes.append(
            Message(
                "film_unstable",
                f"the surface is unstable as a film at this mean curvature (lowest Jacobi eigenvalue "
                f"{verdict.lowest:.4g} 1/m2, {verdict.negative} negative): a soap film would leave it "
                # one condition holds back one mode
                + ("unless" if verdict.negative == 1 else "even if")
                + " its volume is held; a stiff net need not",
            )
        )
    elif verdict.verdict == "fold":
        notes.append(
            Message(
                "film_fold",
                f"the surface is at the fold of its family (lowest Jacobi eigenvalue {verdict.lowest:.2g} 1/m2): a "
                "slightly different boundary may have no surface at all",
            )
        )
    if (
        given_curvature
        and verdict.verdict != "fold"
        and verdict.beside < OTHER_FILM_DISTANCE * found.equilibrium.film.size
    ):
        stable = verdict.verdict == "stable"
        notes.append(
            Message(
                "film_beside",
                f"another surface of the same mean curvature is beside this one, up to about {verdict.beside:.2g} m "
                f'away: this is the {verdict.verdict} one, branch = "{"unstable" if stable else "stable"}" finds the '
                "other. Which of the two is the one meant may depend on small changes of the boundary",
            )
        )
    hanging = _hanging(found.equilibrium.film, found.equilibrium.mean_curvature, given_curvature=given_curvature)
    if hanging:
        notes.append(hanging)
    crossing = self_crossing(found.equilibrium.film)
    if crossing is not None:
        place = crossing[np.linalg.norm(crossing - crossing.mean(0), axis=1).argmin()]
        notes.append(
            Message(
                "surface_crosses",
                f"the surface passes through itself, as near ({coordinates(place)}) m: it is a surface of this "
                "boundary, but cannot be built",
            )
        )
    return tuple(notes)


def _hanging(film: Film, mean_curvature: float, *, given_curvature: bool) -> Message | None:
    """That a film is pressed down below its boundary, z being up, and what makes a dome of it; None: it is not.

    A film without pressure stays in the convex hull of its boundary.
    """
    height = film.nodes[:, 2]
    rim = height[np.unique(film.connectivity.rim_nodes)]
    below, above, least = rim.min() - height.min(), height.max() - rim.max(), HANGS * film.size
    if below <= least or above > least:
        return None
    value = f"mean_curvature = {-mean_curvature:.6g}"
    return Message(
        "film_hangs",
        f"the surface hangs up to {below:.3g} m below its boundary (z is up): where a dome is meant, "
        + (f"write {value}" if given_curvature else "write the volume with the other sign")
        + ", or reverse the first loop",
    )


def find_film(
    loops: tuple[Loop, ...],
    mean_curvature: float = 0.0,
    *,
    volume: float | None = None,
    order: int = 4,
    tolerance: float = 2e-3,
    branch: Literal["stable", "unstable"] = "stable",
    most_nodes: int = 100_000,
    progress: Progress = silent,
) -> Found:
    """The film of a mean curvature, or of a volume, in boundary loops.

    Parameters
    ----------
    loops : tuple of Loop
        The outer one first; the film's normal follows it by the right-hand rule.
    mean_curvature : float
        H, 1/m.
    volume : float, optional
        Enclosed volume with lids over the loops, m^3, instead of H.
    order : int
        Of the elements, 2 to 4.
    tolerance : float
        Largest |H - H0| at the check points, over the curvature scale.
    branch : "stable" or "unstable"
        Which film, where there are two.
    most_nodes : int
        Limit of the elements' nodes.
    progress : callable
        Is told what is done; details begin with four spaces.

    Raises
    ------
    InputError
        There is no such film, or none could be found.
    """
    progress = patient(progress)
    unstable = branch == "unstable"
    coarse = max(tolerance, OTHER_FILMS_TOLERANCE)

    tried = 0

    def finds(others: tuple[Loop, ...], value: float, unstable: bool = False) -> bool:
        nonlocal tried
        if tried > OTHER_FILMS_STEPS_MAX:
            return False
        progress(Report.step(f"trying mean_curvature = {value:g} 1/m"))
        search = FirstFilm(others, order, silent, short=len(others) == 1)
        try:
            _found(others, value, None, order, coarse, unstable, most_nodes, silent, search)
        except (InputError, SearchError):
            return False
        finally:
            tried += search.steps
        return True

    refuse_afloat(loops)
    tries = Tries(loops, order, finds)
    if volume is None and not any(loop.slides for loop in loops):
        try:
            refuse_impossible(loops, mean_curvature)
            if unstable:
                refuse_single(loops, mean_curvature)
        except ImpossibleError as error:
            progress(Report.foreseen(InputError(error.message, where=error.where)))
            raise impossible(error, tries, mean_curvature, unstable) from None
    search = FirstFilm(loops, order, progress)
    try:
        return _found(loops, mean_curvature, volume, order, tolerance, unstable, most_nodes, progress, search)
    except SearchError as error:
        progress(Report.foreseen(InputError(f"the search did not arrive at a film. {error}", where="loops")))
        raise not_found(search, error, mean_curvature, volume, unstable, tries) from None


def _found(
    loops: tuple[Loop, ...],
    mean_curvature: float,
    volume: float | None,
    order: int,
    tolerance: float,
    unstable: bool,
    most_nodes: int,
    progress: Progress,
    search: FirstFilm | None = None,
) -> Found:
    """See `find_film`; a search that ends without a film is a SearchError, and no bound is asked."""
    search = search or FirstFilm(loops, order, progress)
    first = search.of_curvature(mean_curvature, unstable=unstable) if volume is None else search.of_volume(volume)
    text = f"{'path' if first.followed else 'Newton'}: {first.steps} steps"
    progress(Report.step(text + (" on the whole path" if first.followed else " from the harmonic start")))

    def settled(film: Film) -> Equilibrium:
        if volume is not None:
            missing = volume - enclosed_volume(film)
            guess = first.equilibrium.mean_curvature
            return find_equilibrium(film, guess, Volume(missing), progress=progress)
        return find_equilibrium(film, mean_curvature, FixedH(stable=not unstable), progress=progress)

    found = adapted(first.equilibrium, settled, tolerance, most_nodes, first.steps, first.followed, progress)
    verdict = found.stability
    branch = "unstable" if unstable else "stable"
    if volume is None and verdict.verdict != "fold" and (verdict.negative > 0) != unstable:
        raise InputError(
            f"the surface found is {verdict.verdict} ({verdict.negative} negative eigenvalues), not {branch} as asked",
            f'write branch = "{verdict.verdict}" to take it',
            "branch",
        )
    return found
