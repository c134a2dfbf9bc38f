"""Form finding: from boundary loops to the surface of constant mean curvature between them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from lamella.errors import InputError
from lamella.surface.element.surface import ElementSurface
from lamella.surface.found.adapting import deviation_of, refined_sizes
from lamella.surface.found.chart import Chart, make_chart
from lamella.surface.found.continuation import SLENDER, BreakError, FoldError, along_boundary, along_volume, renewed
from lamella.surface.found.film import Film, Loop, harmonic_over_itself
from lamella.surface.found.limits import refuse_impossible
from lamella.surface.found.meshing import least_angle, start_film, straightened, with_sizes
from lamella.surface.found.newton import Equilibrium, NoFilmError, find_equilibrium
from lamella.surface.found.stability import Stability, stability_of
from lamella.surface.points import Floats

if TYPE_CHECKING:
    from lamella.project import FormFoundTable

Progress = Callable[[str], None]

MOST_ROUNDS = 8
# at the limit of nodes another round is worth its time while it lowers the deviation by more than this
SLOW = 0.7
# of the curvature scale: a film that is off by more is none to speak of
WRONG = 0.1
# Newton steps from the harmonic start before a path is taken
DIRECT_STEPS = 12
# times that elements are made anew on the way to a film
AREA_ROUNDS = 4


def _silent(message: str) -> None:
    """Tell nobody."""


@dataclass(frozen=True)
class Found:
    """A film and how it was found.

    Attributes
    ----------
    equilibrium : Equilibrium
        On the final elements.
    stability : Stability
    deviation : float
        Largest |H - H0| at the check points, over the curvature scale.
    scale : float
        Curvature scale, 1/m.
    start_steps : int
        Newton steps from the harmonic start, or on the whole path where one was followed.
    followed : bool
        Whether a path was followed.
    """

    equilibrium: Equilibrium
    stability: Stability
    deviation: float
    scale: float
    start_steps: int
    followed: bool

    def surface(self, kind: str, notes: tuple[str, ...] = (), **figures: Any) -> ElementSurface:
        """The surface as later stages see it, with further figures for the summary."""
        film = self.equilibrium.film
        known = {
            "stability": self.stability.verdict,
            "jacobi_eigenvalue": self.stability.lowest,
            "negative_eigenvalues": self.stability.negative,
            "order": film.connectivity.basis.order,
            "surface_nodes": film.connectivity.node_count,
            "elements": len(film.connectivity.elements),
            "newton_steps": self.start_steps,
            "continuation": self.followed,
            "curvature_scale": self.scale,
            "mean_curvature_deviation": self.deviation,
            "volume": enclosed_volume(film),
        }
        rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
        return ElementSurface(
            kind, self.equilibrium.mean_curvature, film.connectivity, film.nodes, rim_loop, known | figures, notes
        )


def enclosed_volume(film: Film) -> float:
    """Volume between a film and lids over its loops, m^3, see `ElementSurface.volume`."""
    rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    return ElementSurface("", 0.0, film.connectivity, film.nodes, rim_loop).volume()


def surface_of_table(table: FormFoundTable, folder: Path, progress: Progress = _silent) -> ElementSurface:
    """The surface of a project's table.

    Parameters
    ----------
    table : FormFoundTable
    folder : Path
        Where relative paths of boundary files begin.
    progress : callable

    Raises
    ------
    InputError
    """
    from lamella.surface.boundary import boundary_loops

    loops = boundary_loops(table, folder)
    found = find_film(
        loops,
        table.mean_curvature or 0.0,
        volume=table.volume,
        order=table.order,
        tolerance=table.tolerance,
        branch=table.branch,
        most_nodes=table.most_nodes,
        progress=progress,
    )
    return found.surface("form-found", notes_on(found), tolerance=table.tolerance)


def notes_on(found: Found) -> tuple[str, ...]:
    """What a user should know about a film before building it."""
    notes = []
    verdict = found.stability
    if verdict.verdict == "unstable":
        notes.append(
            f"the surface is unstable as a film (lowest Jacobi eigenvalue {verdict.lowest:.4g} 1/m2, "
            f"{verdict.negative} negative): a soap film would leave it; a stiff lamella net does not"
        )
    elif verdict.verdict == "fold":
        notes.append(
            f"the surface is at the fold of its family (lowest Jacobi eigenvalue {verdict.lowest:.2g} 1/m2): a "
            "slightly different boundary may have no surface at all"
        )
    return tuple(notes)


def find_film(
    loops: tuple[Loop, ...],
    mean_curvature: float = 0.0,
    *,
    volume: float | None = None,
    order: int = 4,
    tolerance: float = 5e-3,
    branch: Literal["stable", "unstable"] = "stable",
    most_nodes: int = 100_000,
    progress: Progress = _silent,
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
    held = not any(loop.slides for loop in loops)
    if volume is not None and not held:
        raise InputError(
            f"volume = {volume:g} m3 is given, and parts of the boundary slide: their lids would slide with them",
            "give mean_curvature instead of volume",
            "surface.volume",
        )
    if held and volume is None:
        refuse_impossible(loops, mean_curvature)
    start = _Start(make_chart(loops), loops, order, held, progress)
    first, steps, followed = start.film_of(mean_curvature if volume is None else 0.0)
    if volume is not None:
        first, more = _inflated(first, volume, progress)
        steps, followed = steps + more, True
    if branch == "unstable":
        first, more = _other_branch(first, progress)
        steps, followed = steps + more, True
    told = f"  {'path' if followed else 'Newton'}: {steps} steps"
    progress(told + (" on the whole path" if followed else " from the harmonic start"))

    def settled(film: Film) -> Equilibrium:
        if volume is not None:
            missing = volume - enclosed_volume(film)
            return find_equilibrium(film, first.mean_curvature, volume=missing, stable=False, detail=progress)
        return find_equilibrium(film, mean_curvature, stable=branch == "stable", detail=progress)

    found = adapted(first, settled, tolerance, most_nodes, steps, followed, progress)
    verdict = found.stability
    if volume is None and verdict.verdict != "fold" and (verdict.negative > 0) != (branch == "unstable"):
        raise InputError(
            f"the surface found is {verdict.verdict} ({verdict.negative} negative eigenvalues), not {branch} as asked",
            f'write branch = "{verdict.verdict}" to take it',
            "surface.branch",
        )
    return found


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
    here = first
    shortfall = f"it was not reached in {MOST_ROUNDS} rounds of refinement"
    best: tuple[float, Equilibrium] | None = None
    for round_ in range(MOST_ROUNDS):
        try:
            here = settled(straightened(here.film))
        except NoFilmError as error:
            shortfall = f"on finer elements Newton's method fails ({error})"
            if best is None:
                raise InputError(
                    f"the surface found on coarse elements breaks on finer ones: {error}",
                    "make the boundary less bent, or allow a larger tolerance",
                    "surface",
                ) from None
            break
        deviation = deviation_of(here.film, here.mean_curvature)
        progress(
            f"  {here.film.connectivity.node_count:,} nodes: |H - H0| up to {deviation.largest:.1e} of the curvature "
            f"scale {deviation.scale:.3g} 1/m"
        )
        gain = deviation.largest / best[0] if best else 0.0
        if best is None or deviation.largest < best[0]:
            best = (deviation.largest, here)
        if deviation.largest <= tolerance:
            shortfall = ""
            break
        size, allowed = refined_sizes(here.film, deviation, tolerance, most_nodes, coarsen=round_ < 2)
        if not allowed and here.film.connectivity.node_count > 0.7 * most_nodes and gain > SLOW:
            shortfall = f"elements as small as that asks for would need more than most_nodes = {most_nodes:,} nodes"
            break
        try:
            here = settled(with_sizes(here.film, size))
        except NoFilmError as error:
            progress(f"    on finer elements: {error}")
            try:
                here = settled(straightened(renewed(here.film, 0.6)))
            except NoFilmError as again:
                shortfall = f"on finer elements Newton's method fails ({again})"
                break
    assert best is not None
    here = best[1]
    deviation = deviation_of(here.film, here.mean_curvature)
    if shortfall:
        raise InputError(
            f"H is off by up to {deviation.largest:.2g} of the curvature scale {deviation.scale:.3g} 1/m, more than "
            f"tolerance = {tolerance:g}, {_place(here.film, deviation.of_element)}: {shortfall}",
            f"write tolerance = {_rounded_up(deviation.largest):g}, raise most_nodes, or make the boundary smoother "
            "there"
            if deviation.largest < WRONG
            else "make the boundary less bent or less narrow there, or raise most_nodes",
            "surface.tolerance",
        )
    return Found(
        here,
        stability_of(here.film, here.mean_curvature),
        deviation.largest,
        deviation.scale,
        steps,
        followed,
    )


def _place(film: Film, off: Floats) -> str:
    """Where the worst element is."""
    x, y, z = film.nodes[film.connectivity.faces[off.argmax()]].mean(0)
    return f"near ({x:.4g}, {y:.4g}, {z:.4g}) m"


def _rounded_up(value: float) -> float:
    """The next number of one digit that leaves some room."""
    power = 10.0 ** np.floor(np.log10(1.2 * value))
    return float(np.ceil(1.2 * value / power) * power)


@dataclass(frozen=True)
class _Start:
    """Ways to a first film on coarse elements, the shortest one first."""

    chart: Chart
    loops: tuple[Loop, ...]
    order: int
    held: bool
    progress: Progress

    def film_of(self, mean_curvature: float) -> tuple[Equilibrium, int, bool]:
        """A stable film, the Newton steps it took, and whether a path was followed."""
        here = self._direct(mean_curvature)
        if here:
            return here, here.steps, False
        steps = DIRECT_STEPS
        if not mean_curvature:
            here, more = self._by_hand()
            return here, steps + more, True
        calm = self._direct(0.0)
        here, more = (calm, calm.steps) if calm else self._by_hand()
        try:
            reached = along_volume(here, mean_curvature, self.progress)
        except FoldError as fold:
            raise InputError(
                f"mean_curvature = {mean_curvature:.6g} 1/m: no stable surface in this boundary bends that much; "
                f"followed from H = 0 the films turn back at H = {fold.mean_curvature:.6g} 1/m ({fold.steps} Newton "
                "steps)",
                f"choose a mean_curvature below {abs(fold.mean_curvature):.4g} 1/m in size, or give a volume instead",
                "surface.mean_curvature",
            ) from None
        except NoFilmError as error:
            raise InputError(
                f"mean_curvature = {mean_curvature:.6g} 1/m: no surface was found; {error}",
                "choose a smaller mean_curvature, or give a volume instead",
                "surface.mean_curvature",
            ) from None
        return reached.equilibrium, steps + more + reached.steps, True

    def _direct(self, mean_curvature: float) -> Equilibrium | None:
        """Newton from the harmonic surface."""
        try:
            film = harmonic_over_itself(start_film(self.chart, self.loops, self.order))
        except NoFilmError as error:
            self.progress(f"    no harmonic start: {error}")
            return None
        try:
            self.progress(
                f"  start: harmonic over a {self.chart.kind}, {film.connectivity.node_count:,} nodes of order "
                f"{self.order}"
            )
            return find_equilibrium(film, mean_curvature, most_steps=DIRECT_STEPS, detail=self.progress)
        except NoFilmError as error:
            self.progress(f"    from the harmonic start: {error}")
        if not mean_curvature:
            return None
        try:
            # blown up to about the wanted curvature first
            film = harmonic_over_itself(film, mean_curvature)
            return find_equilibrium(film, mean_curvature, most_steps=DIRECT_STEPS, detail=self.progress)
        except NoFilmError as error:
            self.progress(f"    from a start with pressure: {error}")
            return None

    def _by_hand(self) -> tuple[Equilibrium, int]:
        """A minimal film: with elements made anew on the way, by lowering the area first, or from flat loops."""
        steps = 0
        for rounds in (0, 20):
            try:
                film = harmonic_over_itself(start_film(self.chart, self.loops, self.order, rounds, 0.7))
                for _ in range(AREA_ROUNDS):
                    try:
                        here = find_equilibrium(film, 0.0, most_steps=DIRECT_STEPS, detail=self.progress)
                        return here, steps + here.steps
                    except NoFilmError as error:
                        steps += DIRECT_STEPS
                        self.progress(f"    {error}; elements are made anew")
                        film = harmonic_over_itself(renewed(error.last or film, 0.7))
            except NoFilmError as error:
                self.progress(f"    {error}")
        if not self.held:
            raise InputError(
                "no film was found between the loops that are held and those that slide",
                "hold the sliding parts, or begin with a shape nearer to the film",
                "surface.boundary",
            )
        try:
            reached = along_boundary(self.chart, self.loops, self.order, self.progress)
        except BreakError as error:
            raise InputError(
                f"no film was found in this boundary: followed from flat loops to the given ones the films break at "
                f"{error.share:.3g} of the way, after {steps + error.steps} Newton steps ({error})",
                "bring the loops closer together, or make them less bent",
                "surface.boundary",
            ) from None
        return reached.equilibrium, steps + reached.steps


def _inflated(start: Equilibrium, volume: float, progress: Progress) -> tuple[Equilibrium, int]:
    """The film of an enclosed volume, in steps from a minimal one."""
    begin = enclosed_volume(start.film)
    step = whole = volume - begin
    here, steps, done = start, 0, 0.0
    while abs(whole - done) > 1e-12 * max(abs(whole), 1e-300):
        part = step if abs(step) < abs(whole - done) else whole - done
        try:
            new = find_equilibrium(here.film, here.mean_curvature, volume=part, stable=False, most_steps=12)
        except NoFilmError as error:
            steps, step = steps + 12, step / 2
            if abs(step) < abs(whole) / 500:
                raise InputError(
                    f"volume = {volume:.6g} m3: no surface was found; followed from the film of {begin:.5g} m3 they "
                    f"break at {begin + done:.5g} m3, H = {here.mean_curvature:.5g} 1/m ({error})",
                    "choose a volume nearer to that of the film without pressure",
                    "surface.volume",
                ) from None
            continue
        done, steps = done + part, steps + new.steps
        film = new.film
        if least_angle(film).min() < SLENDER:
            # what cannot be made anew may still go on as it is
            with suppress(NoFilmError):
                film = renewed(film)
        here = replace(new, film=film)
        progress(f"    volume {begin + done:.5g} m3: H = {new.mean_curvature:.6g} 1/m ({new.steps} steps)")
    return here, steps


def _other_branch(start: Equilibrium, progress: Progress) -> tuple[Equilibrium, int]:
    """The unstable film of the same mean curvature."""
    target = start.mean_curvature
    # towards larger |H|, where a bubble turns back; without pressure towards less volume, where a neck gets thin
    first = -np.sign(target) or -np.sign(enclosed_volume(start.film)) or 1.0
    reasons = []
    for sign in (float(first), -float(first)):
        try:
            reached = along_volume(start, target, progress, sign=sign, unstable=True)
        except (NoFilmError, FoldError) as error:
            reasons.append(str(error))
            continue
        return reached.equilibrium, reached.steps
    raise InputError(
        f"no unstable surface of mean curvature {target:.5g} 1/m was found from the stable one ({'; '.join(reasons)})",
        'leave branch out, or write branch = "stable"',
        "surface.branch",
    )
