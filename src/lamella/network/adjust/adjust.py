"""Closing a net by a small change of its boundary: what the paper's designers did by hand.

The net of a film closes where every transition of its isothermic coordinates is whole in cells, umbilics on nodes
included. Both follow the boundary smoothly, so Gauss-Newton's method finds the boundary: the smallest change, in units
of what each parameter is allowed, that makes the misses nought. The spacing of the lattice is one of the unknowns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Complexes, Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, patient, silent
from lamella.base.wording import counted, rounded
from lamella.network.adjust.adjustable_films import Films, FollowError
from lamella.network.adjust.aim import Aim, LostError, StuckError, worst
from lamella.network.adjust.film_net import FilmNet
from lamella.network.adjust.least_change import SPACING, LeastChange
from lamella.network.adjust.strip_limit import MostUsed, StripLimit
from lamella.network.density_request import DensityRequest
from lamella.network.elements.closing_steps import CLOSES
from lamella.network.elements.element_network import plan_net
from lamella.network.elements.lattice import Lattice, choose_lattice
from lamella.network.isothermic.between_umbilics import between_umbilics, keeps_apart
from lamella.network.isothermic.holonomy import around_holes, holonomies
from lamella.network.isothermic.match_transitions import TransitionMatcher
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.boundary.adjustable_film import AdjustableFilm
from lamella.surface.boundary.curve import Loop, farthest_move
from lamella.surface.boundary.freedom import Freedom, refuse_fixed
from lamella.surface.element.surface import ElementSurface

# cells: misses below it end the search; a tenth of what counts as closed
CLOSED = 1e-4
# cells: with misses below it, half of what counts as closed, the search ends too where it leads no further
NEARLY = CLOSES / 2
# tolerances of the film on which the boundary is looked for, until misses are below so many cells, and of the final
# one, unless a finer one was asked for: a coarser one's periods are off by more than the misses that end the search
COARSE_TOLERANCE, COARSE_CLOSED = 2e-2, 2e-3
ADJUSTING_TOLERANCE = 5e-3
ADJUSTING_STEPS_MAX, MOST_POLISHING, ADJUSTING_HALVINGS_MAX = 20, 6, 5
# elements made anew for the final film, at most
REFINEMENTS_MAX = 3
# steps towards all the whole numbers that are tried
MOST_IN_ALL = 50
# cells: with misses below it the boundary is next to one whose net closes
NEXT_TO_CLOSED = 0.1
# of the misses left by a step: with more, the next step's rates are found anew and not carried on
CARRIED = 0.5
# of the film's size: what the boundary moves in a step, at most
BOUNDARY_MOVE_MAX = 0.04
# whole numbers that ask for the smallest changes, were there no limits to them; of these are tried, with the limits
MOST_LOOKED_AT, INTEGERS_TRIED_MAX = 60, 8
# of those that were set aside the nearest ones are gone on with, at most so many
RETURNED_TO_MAX = 3
# a whole step has to take this part of the misses away at least
LEAST_GAIN = 0.1
# of an umbilic's distance from the rim: what a step leaves of it at least, to first order. Where umbilics come or go
# there are other whole numbers to be reached
RIM_DISTANCE_KEPT = 0.3
# limits this many times as large are looked for, at most, where the given ones do not do; in so many halvings, from so
# many of the places reached, and tried with more than what suffices to first order: steps are few where room is left
REACHED_LIMITS_MAX, REACH_HALVINGS, MOST_WIDER, WIDER = 8.0, 6, 2, 1.5
# cells: misses that small change what is offered by less than what is added to it
OFFERED_SHARE = 2e-3
# of the misses: what first order leaves at most where it says that they vanish; and times the limits: what takes more
# to first order is not tried. The film's own bending has come to 1.3 times the first order, either way
UNDONE, HOPELESS = 0.02, 3.0
# the same at a place with misses of up to so many cells and that part of the limits used: first order is nearer there
NEAR_CLOSED, MOSTLY, STOPPED = 0.3, 0.9, 1.5
# rounds in which limits are drawn in, by a little more than a curve goes beyond them
LIMITS_TIGHTENED_MAX, TIGHTENED = 4, 1e-3
# of a limit: what takes as much has reached it
AT_LIMIT = 1.0 - 1e-3
MOVED_SAMPLES = 2000
# steps towards less used strips, and rounds of them with the film made anew between; of the limit: what is aimed at;
# shares of the way there that are tried where the whole is beyond what may change; and of it: what first order may miss
EASING_STEPS_MAX, EASING_ROUNDS_MAX, EASED = 16, 3, 0.99
EASING_SHARES, EASING_MISSED = (1.0, 0.5, 0.25, 0.1), 1e-3


@dataclass(frozen=True)
class Adjusted:
    """A boundary whose film has a net that closes.

    Attributes
    ----------
    film : AdjustableFilm
        The changed boundary and H.
    surface : ElementSurface
    step : float
        Spacing l0 of the lattice, sqrt(m).
    figures : dict
        What was done, for the summary.
    """

    film: AdjustableFilm
    surface: ElementSurface
    step: float
    figures: dict[str, Any]


def adjust_boundary(
    film: AdjustableFilm,
    *,
    cells: int | None = None,
    spacing: float | None = None,
    pattern: Pattern = LAMELLAS,
    limit: StripLimit | None = None,
    progress: Progress = silent,
) -> Adjusted:
    """Change a boundary as little as can be until the net of its film closes, umbilics on nodes.

    With a limit to the utilisation of strips until they keep it as well.

    Parameters
    ----------
    film : AdjustableFilm
        With what may change, see `lamella.surface.boundary.freedom`.
    cells, spacing, pattern
        See `element_network`.
    limit : StripLimit, optional
    progress : callable

    Raises
    ------
    InputError
        There is no such film, nothing may change, or the net does not close, or its strips do not keep their limit,
        within what is allowed.
    """
    freedom = Freedom(film)
    refuse_fixed(freedom)
    progress = patient(progress)
    films = Films(freedom, pattern, progress)
    progress(Report.step(f"adjusting {', '.join(freedom.names)}: {freedom.count} parameters"))
    first = films.first(COARSE_TOLERANCE)
    names = tuple(curve.name for curve in film.curves)
    around = holonomies(first.iso)
    lattice = choose_lattice(
        first.iso, around, DensityRequest.of(cells, spacing), pattern=pattern, names=names, seams=False
    )
    before = worst(first.whole.nearest(first.cells(lattice.step))[0] - first.cells(lattice.step))
    search = _Search(films, progress, limit)
    state, step, after = search.closed(first, lattice)
    final = freedom.changed(state.shares)
    moved = {name: _moved(old, new) for name, old, new in zip(names, film.loops(), final.loops(), strict=True)}
    farthest = max(moved.values())
    figures: dict[str, Any] = {
        "missed_before": before,
        "missed_after": after,
        "moved_max": farthest,
        "moved": moved,
        "mean_curvature_change": float(state.surface.mean_curvature - first.surface.mean_curvature),
        "steps": search.steps,
    }
    progress(Report.step(f"adjusted: the boundary moved by at most {1000 * farthest:.3g} mm, misses {after:.1e} cells"))
    return Adjusted(final, films.finished(state), step, figures)


class _Search:
    """Gauss-Newton's method on one boundary."""

    def __init__(self, films: Films, progress: Progress, limit: StripLimit | None = None) -> None:
        self.films, self.progress, self.limit = films, progress, limit
        self.steps = 0
        # of the limits of what may change: 1, but where it is looked for how much would do
        self.reach = 1.0
        # what each linear limit is multiplied by, for the curves themselves to keep what was asked for
        self.tight = np.ones(len(films.freedom.limits))

    def closed(self, first: FilmNet, lattice: Lattice) -> tuple[FilmNet, float, float]:
        """The net that closes, with the spacing of its lattice, sqrt(m), and what it still misses, cells.

        The whole numbers that promise the smallest change are tried first; the next ones where these are not reached.
        """
        lost: list[LostError] = []
        waiting: list[Aim] = []
        ways, beyond = self._ways(first, lattice)
        for way in ways:
            if lost:
                self.progress(Report.step(f"{lost[-1]}: other whole numbers of cells"))
            try:
                return self.finished(self.descend(way, hasty=True))
            except StuckError as error:
                lost.append(error)
                waiting.append(error.aim)
            except LostError as error:
                lost.append(error)
        for aim in sorted(waiting, key=lambda one: one.size)[:RETURNED_TO_MAX]:
            self.progress(
                Report.step(f"{lost[-1]}: back to those that were left with {worst(aim.residuals):.2g} cells")
            )
            try:
                return self.finished(self.descend(aim))
            except LostError as error:
                lost.append(error)
        lost += beyond
        nearest = min(lost, key=lambda one: one.missed)
        message = (
            f"the net could not be closed within what the boundary may change: {nearest} "
            f"({counted(len(ways), 'way')} tried in {counted(self.steps, 'step')})"
        )
        enough = self._enough([one.aim for one in lost])
        raise InputError(
            message,
            (f"write {enough}" if enough else "allow more change (adjust of the loops, adjust_mean_curvature)")
            + ', choose other cells, or closing = "open"',
            "film",
        )

    def _ways(self, first: FilmNet, lattice: Lattice) -> tuple[list[Aim], list[LostError]]:
        """Whole shifts to be tried, and those that take far more than what may change."""
        aims = [Aim(first, whole, lattice.step) for whole in self._targets(first, lattice)]
        reaches = [self._least_reach(aim, UNDONE) for aim in aims]
        reported = ", ".join(
            f"{reach:.2g}" if reach < np.inf else f"over {2 * REACHED_LIMITS_MAX:g}" for reach in reaches
        )
        self.progress(
            Report.step(f"whole numbers of cells take, to first order, {reported} times what the boundary may change")
        )
        why = f"to first order over {HOPELESS:g} times what the boundary may change is needed"
        far = [reach > HOPELESS for reach in reaches]
        ways = [aim for aim, is_far in zip(aims, far, strict=True) if not is_far]
        return ways, [LostError(aim, why) for aim, is_far in zip(aims, far, strict=True) if is_far]

    def _enough(self, aims: list[Aim]) -> str:
        """What is written to allow a change with which the net closes, found by going there; empty: not found."""
        used = self.films.freedom.used
        wanted = [
            (reach, aim)
            for aim in aims
            # others were not stopped by their limits
            if (reach := self._least_reach(aim, LEAST_GAIN)) <= REACHED_LIMITS_MAX
            and (reach > 1 or used(aim.net.shares) > AT_LIMIT)
        ]
        # to first order tells most where little is missed
        for reach, aim in sorted(wanted, key=lambda one: one[0] * (1 + worst(one[1].residuals)))[:MOST_WIDER]:
            self.reach, self.steps = reach * WIDER, 0
            self.progress(Report.step(f"how much change would do: with {self.reach:.2g} times as much"))
            try:
                there = self.descend(aim, goal=OFFERED_SHARE)
            except LostError:
                continue
            return self.films.freedom.enough(there.net.shares)
        return ""

    def _least_reach(self, aim: Aim, left: float) -> float:
        """By what the limits have to be multiplied for all but a share of the misses to vanish to first order."""
        if worst(aim.residuals) < CLOSED:
            # what is left are the film's own errors
            return 1.0
        sensitivities, reach = self._rates_of(aim), self.reach

        def reaches(log: float) -> bool:
            self.reach = float(np.exp(log))
            change = self._solved(aim.net, sensitivities, aim.residuals)[0]
            return aim.net.whole.size(aim.residuals - sensitivities @ change) < left * aim.size

        low, high = 0.0, float(np.log(2 * REACHED_LIMITS_MAX))
        try:
            if reaches(low):
                return 1.0
            if not reaches(high):
                return np.inf
            for _ in range(REACH_HALVINGS):
                middle = (low + high) / 2
                low, high = (low, middle) if reaches(middle) else (middle, high)
        finally:
            self.reach = reach
        return float(np.exp(high))

    def _rates_of(self, aim: Aim) -> Complexes:
        """The rates that were carried on, else those of the net itself."""
        return aim.sensitivities if aim.sensitivities is not None else self.films.cell_sensitivities(aim.net, aim.step)

    def _targets(self, net: FilmNet, lattice: Lattice) -> list[Complexes]:
        """Whole shifts (t,) in the order of the change they ask for, to first order."""
        step = lattice.step
        shifts, sensitivities = net.cells(step), self.films.cell_sensitivities(net, step)
        counted = self._counted(net, shifts, lattice)
        easy = net.whole.easiest(shifts, sensitivities * np.append(np.ones(len(net.shares)), SPACING), MOST_LOOKED_AT)
        # where the boundary may hardly change, only another spacing is easy: other cells than were asked for
        near = net.whole.nearest(shifts, INTEGERS_TRIED_MAX)
        near += [whole for whole in easy if not any(np.array_equal(whole, one) for one in near)]
        near = [whole for whole in near if self._counted(net, whole, lattice) == counted] or near
        # two umbilics cannot meet in one node
        factors = between_umbilics(net.iso)
        near = [whole for whole in near if keeps_apart(factors, shifts, whole)] or near
        least = [LeastChange.of(net, sensitivities, whole - shifts).least_cost for whole in near]
        cost: list[tuple[float, int]] = []
        for k in np.argsort(least, kind="stable").tolist():
            # with the limits it costs no less than without
            if len(cost) >= INTEGERS_TRIED_MAX and least[k] > cost[INTEGERS_TRIED_MAX - 1][0]:
                break
            cost = sorted([*cost, (self._solved(net, sensitivities, near[k] - shifts)[1], k)])
        return [near[k] for _, k in cost[:INTEGERS_TRIED_MAX]]

    def _counted(self, net: FilmNet, shifts: Complexes, lattice: Lattice) -> int:
        """Cells on a loop around the first hole; 0: no cells are counted there."""
        for sign, factors in around_holes(net.iso)[:1]:
            w = net.pattern.isothermic(np.array([factors @ shifts]), 1.0)[0] * net.pattern.factor
            count = int(np.rint(max(abs(w.real), abs(w.imag))))
            if sign == 1 and abs(count - lattice.cells) <= 1:
                return count
        return 0

    def descend(self, aim: Aim, *, hasty: bool = False, goal: float = COARSE_CLOSED) -> Aim:
        """Steps on the coarse film, until misses are below a goal, cells; in haste, until one leaves most of them
        or a second one is refused."""
        self._tell(aim)
        refused = 0
        for _ in range(ADJUSTING_STEPS_MAX):
            if worst(aim.residuals) < goal:
                return aim
            if self.steps >= MOST_IN_ALL:
                raise LostError(aim, f"not reached in {MOST_IN_ALL} steps")
            self.steps += 1
            before = aim.size
            try:
                aim, reason = self._step(aim)
            except LostError:
                # the film's own errors may be all that is left
                if worst(aim.residuals) < NEARLY:
                    return aim
                raise
            self._tell(aim)
            if reason and worst(aim.residuals) < NEARLY:
                return aim
            if hasty and self._is_stopped(aim):
                raise LostError(aim, "the boundary may not change by more")
            refused += bool(reason)
            if reason and hasty and (aim.size > CARRIED * before or refused > 1):
                raise StuckError(aim, reason)
        raise LostError(aim, f"not reached in {ADJUSTING_STEPS_MAX} steps")

    def _is_stopped(self, aim: Aim) -> bool:
        """Whether first order says that the limits are far from enough, by rates that need not be found anew."""
        if (
            aim.sensitivities is None
            or worst(aim.residuals) > NEAR_CLOSED
            or self.films.freedom.used(aim.net.shares) < MOSTLY
        ):
            return False
        return self._least_reach(aim, UNDONE) > STOPPED

    def _step(self, aim: Aim) -> tuple[Aim, str]:
        """A net nearer to its whole shifts, and why the whole step there was refused, if it was."""
        if aim.sensitivities is not None:
            try:
                return self._moved(aim, aim.sensitivities, 1)
            except LostError:
                self.progress(Report.detail("the rates carried on do not lead on"))
        return self._moved(aim, self.films.cell_sensitivities(aim.net, aim.step), ADJUSTING_HALVINGS_MAX)

    def _moved(self, aim: Aim, sensitivities: Complexes, halvings: int) -> tuple[Aim, str]:
        """See `_step`, with given rates and so many tries."""
        net = aim.net
        # next to a boundary whose net closes the nearest such one: what the film is not linear in stays least
        near = net.shares if worst(aim.residuals) < NEXT_TO_CLOSED else None
        change = self._allowed(net, sensitivities, aim.residuals, near)
        if net.whole.size(aim.residuals - sensitivities @ change) > (1 - LEAST_GAIN) * aim.size:
            beyond = self._solved(net, sensitivities, aim.residuals, kept=-np.inf)[0]
            held = net.whole.size(aim.residuals - sensitivities @ beyond) > (1 - LEAST_GAIN) * aim.size
            raise LostError(aim, "the boundary may not change by more" if held else "umbilics would leave at the rim")
        change = self._shortened(net, change)
        # the least boundary that closes the net may be far from this one: then the nearest, and less and less of it
        nearest = self._shortened(net, self._allowed(net, sensitivities, aim.residuals, net.shares))
        parts = 0.5 ** np.arange(halvings - 1)
        moves = [change, *np.outer(parts if net.shares.any() else parts / 2, nearest)]
        reason = ""
        for move in moves[:halvings]:
            if (self.films.freedom.over(net.shares + move[:-1]) > self.reach).any():
                reason = "the boundary may not change by more"
                continue
            share = float(np.linalg.norm(move) / np.linalg.norm(change))
            self.progress(
                Report.detail(
                    f"following the film over {'a whole' if f'{share:.2g}' == '1' else f'{share:.2g} of a'} step"
                    + (f" ({reason})" if reason else "")
                )
            )
            try:
                there = self._carried(aim, self.films.moved(net, net.shares + move[:-1]), sensitivities, move)
            except FollowError as error:
                reason = str(error)
                continue
            expected = 1 - LEAST_GAIN * min(share, 1.0)
            if there.size < expected * aim.size or worst(there.residuals) < 10 * CLOSED:
                # where the whole step was refused what is linear reaches less far
                carried = there.size < CARRIED * aim.size and not reason
                return (there if carried else replace(there, sensitivities=None)), reason
            reason = "the misses grow"
        raise LostError(aim, reason)

    def _carried(self, aim: Aim, net: FilmNet, sensitivities: Complexes, move: Floats) -> Aim:
        """The same whole shifts on another net, with the rates carried on.

        Broyden's update: of all rates that explain the misses found there, those least different from the old ones
        (C. G. Broyden, Math. Comp. 19 (1965) 577).
        """
        left = aim.residuals - sensitivities @ move
        step = float(aim.step * np.exp(move[-1]))
        spacing = net.whole.offset - net.cells(step)
        if net.kept is aim.net.kept:
            # the pieces of the cut are the same ones
            there = Aim(net, aim.whole, step)
            expected, found = left, np.column_stack([sensitivities[:, :-1], spacing])
        else:
            matcher = TransitionMatcher(aim.net.iso, net.iso, net.whole)
            whole = matcher.match(left, net.cells(step))
            if whole is None:
                raise FollowError("the net changes too much in a step")
            there = Aim(net, whole, step)
            carried = net.whole.basis.T @ matcher.coordinates(np.column_stack([sensitivities[:, :-1], left]))
            expected, found = carried[:, -1], np.column_stack([carried[:, :-1], spacing])
        if move.any():
            scaled = move / np.append(np.ones(len(move) - 1), SPACING**2)
            found = found - np.outer(there.residuals - expected, scaled) / (scaled @ move)
        return replace(there, sensitivities=found)

    def finished(self, aim: Aim) -> tuple[FilmNet, float, float]:
        """The final film, the spacing of its lattice, sqrt(m), and what its net misses, cells."""
        aim = self.polish(aim)
        for _ in range(EASING_ROUNDS_MAX):
            eased = self.eased(aim)
            if eased is aim:
                return aim.net, aim.step, worst(aim.residuals)
            aim = self.polish(eased)
        raise LostError(aim, "strips are used more on the finer surface")

    def eased(self, aim: Aim) -> Aim:
        """A boundary as near as can be with which strips keep their limit, and the net closes still."""
        limit, least = self.limit, np.inf
        if limit is None:
            return aim
        for _ in range(EASING_STEPS_MAX):
            surface = aim.net.surface
            plan = plan_net(surface, step=aim.step, cells=1, pattern=aim.net.pattern, seams=False)
            network = plan.traced(closing="round", minimum_length=limit.minimum_length).network
            most = MostUsed.of(network, surface, limit)
            self.progress(Report.step(f"strips are used up to {most.largest:.3f} of their strength"))
            if most.largest <= limit.most:
                return aim
            least = min(least, most.largest)
            self.steps += 1
            eased = self._eased_once(aim, most, limit)
            if eased is None:
                raise self._beyond_limit(least, limit, self.films.freedom.used(aim.net.shares) > AT_LIMIT)
            aim = self._polished(eased)
            self._tell(aim)
        raise self._beyond_limit(least, limit, False)

    def _eased_once(self, aim: Aim, most: MostUsed, limit: StripLimit) -> Aim | None:
        """A step towards the limit, to first order; None: there is none within what may change."""
        net = aim.net
        sensitivities = self.films.cell_sensitivities(net, aim.step)
        rates = most.rates(net.surface, *self.films.moves(net), limit)
        for share in EASING_SHARES:
            level = most.largest - share * (most.largest - EASED * limit.most)
            planes = rates, level - most.use + rates @ net.shares
            change = self._allowed(net, sensitivities, aim.residuals, planes=planes)
            missed = (most.use + rates @ change[:-1]).max() - level
            if missed <= EASING_MISSED * level:
                break
        else:
            return None
        change = self._shortened(net, change)
        reason = ""
        for part in 0.5 ** np.arange(ADJUSTING_HALVINGS_MAX):
            try:
                there = self.films.moved(net, net.shares + part * change[:-1])
                return self._carried(aim, there, sensitivities, part * change)
            except FollowError as error:
                reason = str(error)
        raise LostError(aim, reason)

    def _beyond_limit(self, least: float, limit: StripLimit, at_limit: bool) -> InputError:
        why = (
            "the boundary may not change by more" if at_limit else "no small change of the boundary eases them further"
        )
        more = "allow more change (adjust of the loops, adjust_mean_curvature), " if at_limit else ""
        return InputError(
            f"no boundary was found whose net closes with strips of a utilisation of {limit.most:g}: the least is "
            f"{least:.3g}, in {counted(self.steps, 'step')}; {why}",
            f"{more}take thinner strips (their bending and torsion are in proportion to the thickness) or lower ones "
            f"(the helix stress goes with the square of the height), or allow a utilisation of "
            f"{rounded(least, up=True):g}",
            "limit",
        )

    def polish(self, aim: Aim) -> Aim:
        """The film as fine as was asked for, from the elements at hand: its own misses are a little different ones."""
        tolerance = min(self.films.freedom.film.tolerance, ADJUSTING_TOLERANCE)
        for _ in range(REFINEMENTS_MAX):
            self.progress(Report.detail("the film as fine as asked for"))
            try:
                if aim.net.film.request.tolerance > tolerance or aim.net.film.deviation.largest > tolerance:
                    aim = self._on(aim, self.films.refined(aim.net, tolerance))
                    self._tell(aim)
                aim = self._polished(aim)
                # what the net will miss is told by coordinates that keep nothing
                aim = self._on(aim, self.films.anew(aim.net))
            except FollowError as error:
                raise LostError(aim, str(error)) from None
            if worst(aim.residuals) < CLOSED and aim.net.film.deviation.largest <= tolerance:
                break
        if worst(aim.residuals) > 0.9 * CLOSES:
            raise LostError(aim, "the finer surface does not follow")
        return aim

    def _on(self, aim: Aim, net: FilmNet) -> Aim:
        """The same whole shifts on another net of the same boundary."""
        return self._carried(aim, net, self._rates_of(aim), np.zeros(len(net.shares) + 1))

    def _polished(self, aim: Aim) -> Aim:
        """Steps on the final elements, until misses are below `CLOSED` or what is left are the film's own errors."""
        for _ in range(MOST_POLISHING):
            if worst(aim.residuals) < CLOSED:
                break
            fresh = aim.sensitivities is None
            try:
                there, _ = self._step(aim)
            except LostError:
                break
            self.steps += 1
            self._tell(there)
            if there.size < CARRIED * aim.size:
                aim = there
            elif fresh:
                return min(aim, there, key=lambda one: worst(one.residuals))
            else:
                aim = replace(aim, sensitivities=None)
        return aim

    def _solved(
        self,
        net: FilmNet,
        cell_sensitivities: Complexes,
        residuals: Complexes,
        near: Floats | None = None,
        kept: float = RIM_DISTANCE_KEPT,
        planes: tuple[Floats, Floats] | None = None,
    ) -> tuple[Floats, float]:
        """Change of the shares and of the logarithm of the spacing that undoes misses, and what it costs.

        Umbilics keep a share of their distance from the rim; shares x stay where normals x <= bounds of further planes.
        """
        change = LeastChange.of(net, cell_sensitivities, residuals, near)
        limits = self.films.freedom.limits * (self.tight / self.reach)[:, None, None]
        normals, bounds = self.films.umbilics_inside(net, kept)
        if planes is not None:
            normals, bounds = np.vstack([normals, planes[0]]), np.concatenate([bounds, planes[1]])
        return change.within(limits, (normals, bounds))

    def _allowed(
        self,
        net: FilmNet,
        cell_sensitivities: Complexes,
        residuals: Complexes,
        near: Floats | None = None,
        planes: tuple[Floats, Floats] | None = None,
    ) -> Floats:
        """The same change within what limits mean: linear ones are drawn in where a curve goes further than they."""
        for _ in range(LIMITS_TIGHTENED_MAX):
            change, _ = self._solved(net, cell_sensitivities, residuals, near, planes=planes)
            over = self.films.freedom.over(net.shares + change[:-1]) / self.reach
            if over.max(initial=0.0) <= 1:
                break
            self.tight = self.tight * np.maximum(1.0, over * (1 + TIGHTENED))
        return change

    def _shortened(self, net: FilmNet, change: Floats) -> Floats:
        """A change no longer than the linear picture bears."""
        far = farthest_move(self.films.loops(net.shares), self.films.loops(net.shares + change[:-1]))
        return np.asarray(change * min(1.0, BOUNDARY_MOVE_MAX * net.film.equilibrium.film.size / max(far, 1e-300)))

    def _tell(self, aim: Aim) -> None:
        self.progress(
            Report.step(
                f"{self.steps} steps: misses up to {worst(aim.residuals):.2e} cells, parameters up to "
                f"{100 * self.films.freedom.used(aim.net.shares):.0f} % of what they may change"
            )
        )


def _moved(old: Loop, new: Loop) -> float:
    """Largest distance of a changed loop from the old one, m."""
    t = np.arange(MOVED_SAMPLES) / MOVED_SAMPLES
    distance, _ = cKDTree(old.at(t)).query(new.at(t))
    return float(np.max(distance))
