"""Closing a net by a small change of its boundary: what the paper's designers did by hand.

The net of a film closes where every transition of its isothermic coordinates is whole in cells, umbilics on nodes
included. Both follow the boundary smoothly, so Gauss-Newton's method finds the boundary: the smallest change, in units
of what each parameter is allowed, that makes the misses nought. The spacing of the lattice is one of the unknowns.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import lsq_linear
from scipy.spatial import cKDTree

from lamella.errors import InputError
from lamella.network.cell_map import CellMap
from lamella.network.element_network import choose_lattice
from lamella.network.gluing import integrate
from lamella.network.holonomy import around_vertex, holonomies
from lamella.network.isothermic import Isothermic
from lamella.network.net_mesh import make_net_mesh
from lamella.network.shift_rates import jacobi_fields, shift_rates
from lamella.network.whole_shifts import nearest_whole
from lamella.surface.boundary.curve import Loop
from lamella.surface.boundary.freedom import Freedom
from lamella.surface.boundary.tables import boundary_loops
from lamella.surface.element.placing import rim_parameters
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.found.film import Film
from lamella.surface.found.find import find_film, notes_on
from lamella.surface.found.loop_path import BreakError, along_loops
from lamella.surface.found.newton import Equilibrium
from lamella.surface.points import Complexes, Floats
from lamella.surface.umbilic import refuse_umbilic

if TYPE_CHECKING:
    from lamella.project import FormFoundTable

Progress = Callable[[str], None]

# cells: misses below it end the search; a tenth of what counts as closed
CLOSED = 1e-4
# tolerance of the film on which the boundary is looked for, before the one that was asked for
COARSE = 2e-2
MOST_STEPS, MOST_POLISHING, MOST_HALVINGS = 14, 5, 5
# of the film's size: what the boundary moves in a step, at most
LONGEST = 0.04
# range of the logarithm of the lattice's spacing
SPACING = 0.1
# difference of shares for the loops' movement
SHARE = 1e-5
# how much more a miss of a cell weighs than a full range
WEIGHT = 1e4
SAMPLES = 2000


@dataclass(frozen=True)
class Adjusted:
    """A boundary whose film has a net that closes.

    Attributes
    ----------
    table : FormFoundTable
        The changed boundary and H.
    surface : ElementSurface
    step : float
        Spacing l0 of the lattice, sqrt(m).
    figures : dict
        What was done, for the summary.
    """

    table: FormFoundTable
    surface: ElementSurface
    step: float
    figures: dict[str, Any]


@dataclass(frozen=True)
class _State:
    """A film at some shares of the parameters, with its coordinates."""

    shares: Floats
    equilibrium: Equilibrium
    surface: ElementSurface
    umbilics: Umbilics
    iso: Isothermic

    def misses(self, step: float) -> tuple[Complexes, Complexes]:
        """Shifts in cells, and what they lack to the nearest whole ones, (t,)."""
        shifts = CellMap.of(self.iso, self.origin, step).shifts
        return shifts, nearest_whole(self.iso, shifts, singular_nodes=True) - shifts

    @property
    def origin(self) -> complex:
        """w of the first odd umbilic, which is on the lattice; 0 without one."""
        return complex((self._origin_row @ self._shifts).item()) if len(self.iso.odd) else 0j

    @property
    def _shifts(self) -> Complexes:
        return np.array([piece.shift for piece in self.iso.transitions], complex)

    @property
    def _origin_row(self) -> Floats:
        """The first odd umbilic's w is this row times the shifts: the fixed point of going around it."""
        iso = self.iso
        if not len(iso.odd):
            return np.zeros(len(iso.transitions))
        _, factors = around_vertex(iso.mesh, iso.transitions, iso.across, int(iso.odd[0]))
        return np.asarray(factors / 2)

    def cell_rates(self, rates: Complexes, step: float) -> Complexes:
        """Change of the shifts in cells, (t, p), from that of the shifts in sqrt(m)."""
        signs = np.array([piece.sign for piece in self.iso.transitions])
        return np.asarray((rates + np.outer(signs - 1, self._origin_row @ rates)) * (1 + 1j) / step)


def adjust_boundary(
    table: FormFoundTable, folder: Path, *, cells: int | None, spacing: float | None, progress: Progress
) -> Adjusted:
    """Change a boundary as little as can be until the net of its film closes, umbilics on nodes.

    Parameters
    ----------
    table : FormFoundTable
        With what may change, see `lamella.surface.boundary.freedom`.
    folder : Path
        Where relative paths of boundary files begin.
    cells, spacing
        See `element_network`.
    progress : callable

    Raises
    ------
    InputError
        There is no such film, nothing may change, or the net does not close within what is allowed.
    """
    freedom = Freedom(table)
    if not freedom.count:
        raise InputError(
            'closing = "adjust", but nothing of the boundary may change',
            "add adjust = {move = 0.3} to a loop given by points or as a circle, or adjust_mean_curvature",
            "surface.boundary",
        )
    search = _Search(table, folder, freedom, progress)
    progress(f"  adjusting {', '.join(freedom.names)}: {freedom.count} parameters")
    state = search.first(max(table.tolerance, COARSE))
    around = holonomies(state.iso)
    step = choose_lattice(state.iso, around, state.umbilics, cells, spacing).step
    before = _worst(state.misses(step)[1])
    state, step = search.descend(state, step)
    state, step = search.polish(state, step)
    final = freedom.changed(state.shares)
    moved = {
        loop.name: _moved(old, new)
        for loop, old, new in zip(
            final.boundary, boundary_loops(table, folder), boundary_loops(final, folder), strict=True
        )
    }
    after = _worst(state.misses(step)[1])
    farthest = max(moved.values())
    figures: dict[str, Any] = {
        "missed_before": before,
        "missed_after": after,
        "moved_max": farthest,
        "moved": moved,
        "mean_curvature_change": (final.mean_curvature or 0.0) - (table.mean_curvature or 0.0),
        "steps": search.steps,
    }
    progress(f"  adjusted: the boundary moved by at most {1000 * farthest:.3g} mm, misses {after:.1e} cells")
    return Adjusted(final, state.surface, step, figures)


class _Search:
    """Gauss-Newton's method on one project's boundary."""

    def __init__(self, table: FormFoundTable, folder: Path, freedom: Freedom, progress: Progress) -> None:
        self.table, self.folder, self.freedom, self.progress = table, folder, freedom, progress
        self.steps = 0

    def loops(self, shares: Floats) -> tuple[Loop, ...]:
        return boundary_loops(self.freedom.changed(shares), self.folder)

    def found(self, shares: Floats, tolerance: float) -> _State:
        """The film of some shares from nothing, to a tolerance."""
        table = self.freedom.changed(shares)
        found = find_film(
            boundary_loops(table, self.folder),
            table.mean_curvature or 0.0,
            order=table.order,
            tolerance=tolerance,
            branch=table.branch,
            most_nodes=table.most_nodes,
        )
        surface = found.surface("form-found", notes_on(found), tolerance=table.tolerance)
        return self._state(shares, found.equilibrium, surface)

    def first(self, tolerance: float) -> _State:
        """The film of the sketch."""
        state = self.found(np.zeros(self.freedom.count), tolerance)
        refuse_umbilic(state.surface)
        return state

    def _state(self, shares: Floats, equilibrium: Equilibrium, surface: ElementSurface) -> _State:
        umbilics = surface.umbilics
        mesh = make_net_mesh(surface, umbilics)
        odd = mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)]
        return _State(shares, equilibrium, surface, umbilics, integrate(mesh, odd))

    def moved(self, state: _State, shares: Floats) -> _State:
        """The film followed to other shares; its umbilics stay as many, of the same orders."""
        start = state.shares
        curvature = self.freedom.changed(shares).mean_curvature or 0.0
        try:
            reached = along_loops(
                Equilibrium(state.equilibrium.film, curvature, 0, 0, ()),
                lambda share: self.loops(start + share * (shares - start)),
                0.0,
                self.loops(shares),
                lambda _: None,
                stable=self.table.branch == "stable",
            )
        except BreakError as error:
            raise _StepError(str(error)) from None
        film = reached.equilibrium.film
        rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
        surface = ElementSurface("form-found", curvature, film.connectivity, film.nodes, rim_loop)
        there = self._state(shares, reached.equilibrium, surface)
        if sorted(there.umbilics.orders.tolist()) != sorted(state.umbilics.orders.tolist()):
            raise _StepError("umbilics come or go at the boundary")
        return there

    def descend(self, state: _State, step: float) -> tuple[_State, float]:
        """Steps on the coarse film, each with rates of its own."""
        self._tell(state, step)
        for _ in range(MOST_STEPS):
            shifts, misses = state.misses(step)
            if _worst(misses) < CLOSED:
                return state, step
            shares, log_step = self._target(state, self._cell_rates(state, step, shifts), misses)
            self.steps += 1
            reason = ""
            part = 1.0
            for _ in range(MOST_HALVINGS):
                wanted = state.shares + part * (shares - state.shares)
                try:
                    there = self.moved(state, wanted)
                except _StepError as error:
                    reason, part = str(error), part / 2
                    continue
                new_step = step * np.exp(part * log_step)
                if _worst(there.misses(new_step)[1]) < max(_worst(misses), 10 * CLOSED):
                    state, step = there, new_step
                    break
                reason, part = "the misses grow", part / 2
            else:
                raise self._refusal(_worst(misses), reason)
            self._tell(state, step)
        raise self._refusal(_worst(state.misses(step)[1]), f"not reached in {MOST_STEPS} steps")

    def polish(self, state: _State, step: float) -> tuple[_State, float]:
        """The film as fine as was asked for: its own misses are a little different ones."""
        shares = state.shares
        for _ in range(MOST_POLISHING):
            state = self.found(shares, self.table.tolerance)
            self._tell(state, step)
            shifts, misses = state.misses(step)
            if _worst(misses) < 3 * CLOSED:
                return state, step
            shares, log_step = self._target(state, self._cell_rates(state, step, shifts), misses)
            self.steps += 1
            step *= float(np.exp(log_step))
        raise self._refusal(_worst(misses), "the finer surface does not follow")

    def _cell_rates(self, state: _State, step: float, shifts: Complexes) -> Complexes:
        """Rates of the shifts in cells (t,), (t, p + 1), the logarithm of the spacing last."""
        film = state.equilibrium.film
        rim = self._rim_shifts(film, state.shares)
        curvature = self.freedom.curvature_rates()
        fields = jacobi_fields(film, state.surface.mean_curvature, rim, curvature)
        rates = shift_rates(state.surface, film, state.iso, fields, curvature)
        return np.column_stack([state.cell_rates(rates, step), -shifts])

    def _rim_shifts(self, film: Film, shares: Floats) -> Floats:
        """How the boundary's nodes move with each parameter, (p, n, 3), m."""
        nodes = film.connectivity.rim_nodes
        t = rim_parameters(film.connectivity, film.mesh.parameter)
        of_loop = film.mesh.loop[nodes[:, 0]]
        result = np.zeros((self.freedom.count, len(film.nodes), 3))
        begin = self.loops(shares)
        for number in range(self.freedom.count):
            ahead = shares.copy()
            ahead[number] += SHARE
            for index, (old, new) in enumerate(zip(begin, self.loops(ahead), strict=True)):
                mine = of_loop == index
                result[number, nodes[mine]] = (new.at(t[mine]) - old.at(t[mine])) / SHARE
        return result

    def _target(self, state: _State, cell_rates: Complexes, misses: Complexes) -> tuple[Floats, float]:
        """Shares and change of the logarithm of the spacing that undo the misses, to first order."""
        rates = np.vstack([cell_rates.real, cell_rates.imag])
        rates[:, -1] *= SPACING
        wanted = np.concatenate([misses.real, misses.imag])
        now = np.append(state.shares, 0.0)
        system = np.vstack([WEIGHT * rates, np.eye(len(now))])
        right = np.concatenate([WEIGHT * (wanted + rates @ now), np.zeros(len(now))])
        solved = np.asarray(lsq_linear(system, right, bounds=(-1.0, 1.0), method="bvls").x, float)
        shares = solved[:-1]
        # no longer step than the linear picture bears
        size = state.equilibrium.film.size
        far = max(
            float(np.linalg.norm(new.at(t) - old.at(t), axis=1).max())
            for t in (np.arange(200) / 200,)
            for old, new in zip(self.loops(state.shares), self.loops(shares), strict=True)
        )
        part = min(1.0, LONGEST * size / max(far, 1e-300))
        return state.shares + part * (shares - state.shares), part * SPACING * float(solved[-1])

    def _tell(self, state: _State, step: float) -> None:
        _, misses = state.misses(step)
        self.progress(
            f"  {self.steps} steps: misses up to {_worst(misses):.2e} cells, parameters up to "
            f"{100 * np.abs(state.shares).max(initial=0.0):.0f} % of what they may change"
        )

    def _refusal(self, missed: float, reason: str) -> InputError:
        return InputError(
            f"the net could not be closed within what the boundary may change: misses of up to {missed:.2g} cells are "
            f"left after {self.steps} steps ({reason})",
            'allow more change (adjust of the loops, adjust_mean_curvature), choose other cells, or closing = "open"',
            "network.closing",
        )


class _StepError(ArithmeticError):
    """A step that cannot be taken."""


def _worst(misses: Complexes) -> float:
    return float(max(np.abs(misses.real).max(initial=0.0), np.abs(misses.imag).max(initial=0.0)))


def _moved(old: Loop, new: Loop) -> float:
    """Largest distance of a changed loop from the old one, m."""
    t = np.arange(SAMPLES) / SAMPLES
    distance, _ = cKDTree(old.at(t)).query(new.at(t))
    return float(np.max(distance))
