"""First films with sliding edges: those with the edges held, and then let go."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from lamella.base.progress import Report
from lamella.surface.form_finding.boundary_homotopy import is_moved
from lamella.surface.form_finding.chart import make_chart
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Loop
from lamella.surface.form_finding.fixed_support import held
from lamella.surface.form_finding.meshing import start_film
from lamella.surface.form_finding.newton import Equilibrium, find_equilibrium
from lamella.surface.form_finding.no_film import NoFilmError, SearchError
from lamella.surface.form_finding.release import let_go

if TYPE_CHECKING:
    from lamella.surface.form_finding.first_film import FirstFilm

# H times the film's size, of a film followed at fixed volume: it is the wanted one but for rounding
NEARLY = 1e-3
# Newton steps to the wanted one
FEW = 12


def from_held(search: FirstFilm, mean_curvature: float, volume: float | None) -> Iterator[Equilibrium]:
    """Films of a mean curvature (1/m) or near it, or of a volume (m^3), with edges held near where they are drawn.

    Where nothing comes of that, straight between their ends. The search is told the steps, and where ways end.
    """
    near, straight = held(search.loops), held(search.loops, straight=True)
    for loops in (near, straight) if is_moved(near, straight) else (near,):
        search.progress(Report.detail("the sliding edges are held, and let go little by little"))
        there = replace(search, loops=loops, steps=0, reasons=[], fold=None, calm=False, unstable=None)
        try:
            if volume is None:
                start = there.of_curvature(mean_curvature).equilibrium
            else:
                start = there.of_volume(volume + _lids_apart(search, loops)).equilibrium
        except SearchError as error:
            search.steps += error.steps
            search.tell(f"with its sliding edges held: {error}")
            continue
        search.steps += there.steps
        # where the pressure that is held drives the edges away, the volume may hold them
        own = enclosed_volume(replace(start.film, loops=search.loops))
        for fixed in (None, own) if volume is None else (volume,):
            try:
                reached = let_go(start, search.loops, fixed, search.progress)
            except NoFilmError as error:
                kept = "mean curvature" if fixed is None else "volume"
                search.tell(f"from its sliding edges held, which are let go at the same {kept}: {error}")
            else:
                search.steps += reached.steps
                found = reached.equilibrium
                yield found if volume is not None else _exactly(found, mean_curvature)


def _exactly(here: Equilibrium, mean_curvature: float) -> Equilibrium:
    """A film of very nearly a mean curvature (1/m), stable or not, with that one."""
    if abs(here.mean_curvature - mean_curvature) * here.film.size > NEARLY:
        return here
    try:
        return find_equilibrium(here.film, mean_curvature, stable=False, most_steps=FEW)
    except NoFilmError:
        return here


def _lids_apart(search: FirstFilm, loops: tuple[Loop, ...]) -> float:
    """By how much the volume of a film is larger (m^3) in loops that are held: their lids are others."""
    film = start_film(make_chart(loops), loops, search.order)
    return enclosed_volume(film) - enclosed_volume(replace(film, loops=search.loops))
