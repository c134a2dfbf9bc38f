"""A first film on coarse elements: the ways to one, the shortest first.

Newton's method from the harmonic surface; from the minimal film along its family; from the same loops drawn together,
whose films are followed while the loops go back to their places. Nothing found is no proof that nothing is there: what
is raised then tells how far each way went.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.surface.form_finding.boundary_homotopy import (
    BreakError,
    along_flat,
    along_loops,
    are_apart,
    drawn_together,
    is_moved,
)
from lamella.surface.form_finding.chart import make_chart
from lamella.surface.form_finding.continuation import FoldError, Reached, VolumeFoldError, to_curvature, to_volume
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film, Loop, NoFilmError, harmonic_over_itself
from lamella.surface.form_finding.fixed_support import held
from lamella.surface.form_finding.meshing import renewed, start_film
from lamella.surface.form_finding.necessary_conditions import refuse_apart
from lamella.surface.form_finding.newton import Equilibrium, FixedH, find_equilibrium
from lamella.surface.form_finding.release import release
from lamella.surface.form_finding.search_error import SearchError

# Newton steps from the harmonic start before a path is taken
DIRECT_STEPS = 12
# times that elements are made anew on the way to a film
AREA_ROUNDS = 4
# shares of the way from loops drawn together to the given ones at which a film is looked for
SHARES = (0.6, 0.4, 0.25, 0.15, 0.08)
# of those, how many are followed to the given loops
MOST_PATHS = 2
# H times the film's size, of a film followed at fixed volume: it is the wanted one but for rounding
NEARLY_REQUESTED = 1e-3
# Newton steps to the wanted one
EXACT_STEPS_MAX = 12


@dataclass(frozen=True)
class First:
    """A first film, the Newton steps it took, and whether a path was followed."""

    equilibrium: Equilibrium
    steps: int
    followed: bool


@dataclass
class FirstFilm:
    """A search for films in given loops.

    Attributes
    ----------
    loops : tuple of Loop
    order : int
        Of the elements.
    progress : callable
    steps : int
        Newton steps so far.
    reasons : list of str
        Where ways ended.
    fold : float or None
        See `SearchError`.
    calm : bool
        Whether a film without pressure was found on the way to one of a volume.
    most : float or None
        Volume at which that of the films followed turns back, m^3.
    unstable : Equilibrium or None
        An unstable film of the wanted mean curvature that was found on the way to a stable one.
    short : bool
        Leave out the long way from flat loops.
    """

    loops: tuple[Loop, ...]
    order: int
    progress: Progress
    steps: int = 0
    reasons: list[str] = field(default_factory=list)
    fold: float | None = None
    calm: bool = False
    most: float | None = None
    unstable: Equilibrium | None = None
    short: bool = False

    def of_curvature(self, mean_curvature: float, *, unstable: bool = False) -> First:
        """The film of a mean curvature (1/m), the stable or the unstable one.

        Raises
        ------
        SearchError
        """
        here = self._direct(self.loops, mean_curvature)
        if here and not unstable:
            return First(here, here.steps, False)
        starts = iter([here]) if here else self._starts(mean_curvature)
        for start in starts:
            at_target = abs(start.mean_curvature - mean_curvature) * start.film.size < 1e-9
            if at_target and (start.negative > 0) == unstable:
                return First(start, self.steps, True)
            if at_target and not unstable:
                self.unstable = start
            with suppress(NoFilmError, FoldError):
                return self._followed(start, mean_curvature, unstable)
        raise SearchError(tuple(self.reasons), self.fold, self.steps)

    def _starts(self, mean_curvature: float) -> Iterator[Equilibrium]:
        """Films in the given loops, of the wanted mean curvature or without pressure, the shorter ways first."""
        yield from self._from_fixed_support(mean_curvature, None)
        minimal = not self._no_minimal()
        if mean_curvature and minimal:
            calm = self._direct(self.loops, 0.0)
            if calm:
                minimal = False
                yield calm
        yield from self._from_drawn(mean_curvature)
        if minimal and not self.short:
            calm = self._minimal()
            if calm:
                yield calm

    def of_volume(self, volume: float) -> First:
        """The film of an enclosed volume, m^3, stable or not at its own pressure.

        Raises
        ------
        SearchError
        """
        minimal = not self._no_minimal()
        calm = self._direct(self.loops, 0.0) if minimal else None
        if calm and (first := self._inflated(calm, volume)):
            return first
        for start in self._from_fixed_support(0.0, volume):
            return First(start, self.steps, True)
        for start in self._from_drawn(0.0, volume):
            return First(start, self.steps, True)
        if minimal and not calm:
            calm = self._minimal()
            if calm and (first := self._inflated(calm, volume)):
                return first
        raise SearchError(tuple(self.reasons), self.fold, self.steps)

    def _inflated(self, calm: Equilibrium, volume: float) -> First | None:
        try:
            reached = to_volume(calm, volume, self.progress)
        except NoFilmError as error:
            self.calm = True
            if isinstance(error, VolumeFoldError):
                self.most = error.volume
            self.tell(f"followed from the film without pressure: {error}")
            return None
        return First(reached.equilibrium, self.steps + reached.steps, True)

    def exists(self, mean_curvature: float) -> bool:
        """Whether a short search finds a film of a mean curvature (1/m)."""
        if self._direct(self.loops, mean_curvature):
            return True
        let = next(self._from_fixed_support(mean_curvature, None), None)
        if let and let.mean_curvature == mean_curvature:
            return True
        # where there is a film without pressure, it is from there that one is missing, not for the sign
        return self._no_minimal() and next(self._from_drawn(mean_curvature), None) is not None

    def _followed(self, start: Equilibrium, mean_curvature: float, unstable: bool) -> First:
        """From any film along its family."""
        try:
            reached = to_curvature(start, mean_curvature, self.progress, unstable=unstable)
        except FoldError as fold:
            self.steps += fold.steps
            self.fold = fold.mean_curvature
            self.tell(f"followed from H = {start.mean_curvature:.5g} 1/m {fold} (an estimate)")
            raise
        except NoFilmError as error:
            self.tell(f"followed from H = {start.mean_curvature:.5g} 1/m: {error}")
            raise
        self.steps += reached.steps
        return First(reached.equilibrium, self.steps, True)

    def tell(self, reason: str) -> None:
        """Note where a way ended, once."""
        self.progress(Report.detail(reason))
        if reason not in self.reasons:
            self.reasons.append(reason)

    def _no_minimal(self) -> bool:
        """Whether the loops are too far apart for a film without pressure."""
        if len(self.loops) != 2 or any(loop.slides for loop in self.loops):
            return False
        try:
            refuse_apart(self.loops)
        except InputError:
            return True
        return False

    def _direct(self, loops: tuple[Loop, ...], mean_curvature: float) -> Equilibrium | None:
        """Newton from the harmonic surface."""
        film = self._harmonic(loops)
        return self._from_harmonic(film, mean_curvature) if film else None

    def _harmonic(self, loops: tuple[Loop, ...]) -> Film | None:
        try:
            chart = make_chart(loops)
            film = harmonic_over_itself(start_film(chart, loops, self.order))
        except NoFilmError as error:
            self.progress(Report.detail(f"no harmonic start: {error}"))
            return None
        self.progress(
            Report.detail(
                f"start: harmonic over a {chart.kind}, {film.connectivity.node_count:,} nodes of order {self.order}"
            )
        )
        return film

    def _from_harmonic(self, film: Film, mean_curvature: float) -> Equilibrium | None:
        here = self._newton(film, mean_curvature, "the harmonic start")
        if here or not mean_curvature:
            return here
        try:
            # blown up to about the wanted curvature first
            film = harmonic_over_itself(film, mean_curvature)
        except NoFilmError as error:
            self.progress(Report.detail(f"no start with pressure: {error}"))
            return None
        return self._newton(film, mean_curvature, "a start with pressure")

    def _newton(self, film: Film, mean_curvature: float, start: str) -> Equilibrium | None:
        try:
            here = find_equilibrium(film, mean_curvature, most_steps=DIRECT_STEPS, progress=self.progress)
        except NoFilmError as error:
            self.steps += DIRECT_STEPS
            self.progress(Report.detail(f"from {start}: {error}"))
            return None
        self.steps += here.steps
        return here

    def _minimal(self) -> Equilibrium | None:
        """A minimal film: with elements made anew on the way, by lowering the area first, or from flat loops."""
        if any(loop.slides for loop in self.loops):
            # on these ways the edges run away: they were held, and let go
            return None
        chart = make_chart(self.loops)
        for rounds in (0, 20):
            try:
                film = harmonic_over_itself(start_film(chart, self.loops, self.order, rounds, 0.7))
                for _ in range(AREA_ROUNDS):
                    try:
                        here = find_equilibrium(film, 0.0, most_steps=DIRECT_STEPS, progress=self.progress)
                        self.steps += here.steps
                        return here
                    except NoFilmError as error:
                        self.steps += DIRECT_STEPS
                        self.progress(Report.detail(f"{error}; elements are made anew"))
                        film = harmonic_over_itself(renewed(error.last or film, 0.7))
            except NoFilmError as error:
                self.progress(Report.detail(f"{error}"))
        try:
            reached = along_flat(chart, self.loops, self.order, self.progress)
        except BreakError as error:
            self.steps += error.steps
            self.tell(
                f"followed from flat loops to the given ones the films without pressure break at {error.share:.3g} of "
                f"the way ({error})"
            )
            return None
        self.steps += reached.steps
        return reached.equilibrium

    def _from_fixed_support(self, mean_curvature: float, volume: float | None) -> Iterator[Equilibrium]:
        """Films of a mean curvature (1/m) or near it, or of a volume (m^3), with edges held near where they are drawn.

        Where nothing comes of that, straight between their ends.
        """
        if not any(loop.slides for loop in self.loops):
            return
        near, straight = held(self.loops), held(self.loops, straight=True)
        for loops in (near, straight) if is_moved(near, straight) else (near,):
            self.progress(Report.detail("the sliding edges are held, and let go little by little"))
            there = replace(self, loops=loops, steps=0, reasons=[], fold=None, calm=False, unstable=None)
            try:
                if volume is None:
                    start = there.of_curvature(mean_curvature).equilibrium
                else:
                    start = there.of_volume(volume + _lids_apart(loops, self.loops, self.order)).equilibrium
            except SearchError as error:
                self.steps += error.steps
                self.tell(f"with its sliding edges held: {error}")
                continue
            self.steps += there.steps
            # where the pressure that is held drives the edges away, the volume may hold them
            own = enclosed_volume(replace(start.film, loops=self.loops))
            for fixed in (None, own) if volume is None else (volume,):
                try:
                    reached = release(start, self.loops, fixed, self.progress)
                except NoFilmError as error:
                    kept = "mean curvature" if fixed is None else "volume"
                    self.tell(f"from its sliding edges held, which are let go at the same {kept}: {error}")
                else:
                    self.steps += reached.steps
                    found = reached.equilibrium
                    yield found if volume is not None else _exactly(found, mean_curvature)

    def _from_drawn(self, mean_curvature: float, volume: float | None = None) -> Iterator[Equilibrium]:
        """Films in the given loops, followed from the same loops drawn together."""
        path, paths = drawn_together(self.loops), 0
        if len(self.loops) == 1 or not is_moved(path(0.0), self.loops):
            return
        for share in SHARES:
            near = path(share)
            film = None
            if are_apart(near):
                with suppress(InputError):
                    film = self._harmonic(near)
            if not film:
                # loops drawn together further would have to pass through each other
                return
            here = self._from_harmonic(film, mean_curvature)
            if not here:
                continue
            try:
                reached: Reached = along_loops(
                    here, path, share, self.loops, self.progress, volume=volume, stable=False
                )
            except BreakError as error:
                self.steps += error.steps
                self.tell(
                    f"followed from loops drawn together to {share:g} of their distance the films break at "
                    f"{error.share:.3g} of it ({error})"
                )
            else:
                self.steps += reached.steps
                yield reached.equilibrium
            paths += 1
            # behind a fold there may be another film, but more seldom than beyond a broken path
            if paths == MOST_PATHS or self.fold is not None:
                return


def _exactly(here: Equilibrium, mean_curvature: float) -> Equilibrium:
    """A film of very nearly a mean curvature (1/m), stable or not, with that one."""
    if abs(here.mean_curvature - mean_curvature) * here.film.size > NEARLY_REQUESTED:
        return here
    try:
        return find_equilibrium(here.film, mean_curvature, FixedH(stable=False), most_steps=EXACT_STEPS_MAX)
    except NoFilmError:
        return here


def _lids_apart(fixed_loops: tuple[Loop, ...], loops: tuple[Loop, ...], order: int) -> float:
    """By how much the volume of a film is larger (m^3) in loops that are held: their lids are others."""
    film = start_film(make_chart(fixed_loops), fixed_loops, order)
    return enclosed_volume(film) - enclosed_volume(replace(film, loops=loops))
