"""Films of a boundary that may change, each with its net, and how the nets change with the boundary."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.drawing_origin import origin_figure
from lamella.base.progress import Progress, as_details, silent
from lamella.network.adjust.film_net import FilmNet
from lamella.network.adjust.transition_sensitivities import (
    Sensitivities,
    curvature_rates_of_volume,
    jacobi_fields,
    transition_sensitivities,
)
from lamella.network.pattern import Pattern
from lamella.surface.boundary.curve import Loop, farthest_move
from lamella.surface.boundary.freedom import Freedom
from lamella.surface.element.placing import rim_parameters
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.boundary_homotopy import BreakError, along_loops
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.find import find_film, notes_on, remarks_on
from lamella.surface.form_finding.newton import Equilibrium
from lamella.surface.umbilic import refuse_umbilic

# difference of shares for the loops' movement
SHARE = 1e-5
# of the film's size: how far the boundary moves before the film is found anew on its way
FILM_STRIDE = 0.02


class FollowError(ArithmeticError):
    """A net that cannot be followed to other shares."""


class Films:
    """The films of one boundary at any shares of what may change.

    Parameters
    ----------
    freedom : Freedom
        What may change of a film.
    pattern : Pattern
        Which curves the nets have.
    progress : callable
        Is told details while films are found and followed.
    """

    def __init__(self, freedom: Freedom, pattern: Pattern, progress: Progress = silent) -> None:
        self.freedom, self.pattern = freedom, pattern
        self._progress: Progress = as_details(progress)
        self._sensitivities: WeakKeyDictionary[FilmNet, Sensitivities] = WeakKeyDictionary()

    def loops(self, shares: Floats) -> tuple[Loop, ...]:
        """The boundary at some shares."""
        return self.freedom.changed(shares).loops()

    def found(self, shares: Floats, tolerance: float) -> FilmNet:
        """The film of some shares from nothing, to a tolerance."""
        film = self.freedom.changed(shares)
        loops = film.loops()
        found = find_film(
            loops,
            film.mean_curvature or 0.0,
            volume=film.volume,
            order=film.order,
            tolerance=tolerance,
            branch=film.branch,
            most_nodes=film.most_nodes,
            progress=self._progress,
        )
        notes = remarks_on(loops) + notes_on(found, given_curvature=film.volume is None)
        surface = found.surface("form-found", notes, tolerance=film.tolerance, **origin_figure(film.origin))
        return FilmNet.of(shares, found.equilibrium, surface, self.pattern)

    def first(self, tolerance: float) -> FilmNet:
        """The film of the sketch."""
        net = self.found(np.zeros(self.freedom.count), tolerance)
        refuse_umbilic(net.surface)
        return net

    def moved(self, net: FilmNet, shares: Floats) -> FilmNet:
        """The film followed to other shares; its umbilics stay as many, of the same orders."""
        start, changed = net.shares, self.freedom.changed(shares)
        curvature = net.surface.mean_curvature if changed.mean_curvature is None else changed.mean_curvature
        loops = changed.loops()
        far = farthest_move(self.loops(start), loops)
        try:
            reached = along_loops(
                Equilibrium(net.equilibrium.film, curvature, 0, 0, ()),
                lambda share: self.loops(start + share * (shares - start)),
                0.0,
                loops,
                self._progress,
                volume=changed.volume,
                stable=changed.branch == "stable",
                stride=min(1.0, FILM_STRIDE * net.equilibrium.film.size / max(far, 1e-300)),
            )
        except BreakError as error:
            raise FollowError(str(error)) from None
        film, curvature = reached.equilibrium.film, reached.equilibrium.mean_curvature
        rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
        surface = ElementSurface(
            "form-found", curvature, film.connectivity, film.nodes, rim_loop, loop_starts=film.loop_starts()
        )
        there = FilmNet.of(shares, reached.equilibrium, surface, self.pattern)
        if there.orders != net.orders:
            raise FollowError("umbilics come or go at the boundary")
        return there

    def cell_sensitivities(self, net: FilmNet, step: float) -> Complexes:
        """Sensitivities of the shifts in cells, (t, p + 1), the logarithm of the spacing last."""
        return net.cell_sensitivities(self._found(net).shifts, step)

    def umbilics_inside(self, net: FilmNet, kept: float) -> tuple[Floats, Floats]:
        """Normals (z, p) and bounds (z,): umbilics keep that share of their distance from the rim, to first order, at
        shares x with normals x <= bounds; none where the rates of the net were not found."""
        if net not in self._sensitivities:
            return np.zeros((0, self.freedom.count)), np.zeros(0)
        sensitivities = self._sensitivities[net]
        return -sensitivities.depths, (1 - kept) * sensitivities.depth - sensitivities.depths @ net.shares

    def _found(self, net: FilmNet) -> Sensitivities:
        if net not in self._sensitivities:
            film, h = net.equilibrium.film, net.surface.mean_curvature
            rim = self.rim_shifts(film, net.shares)
            curvature = self.freedom.curvature_sensitivities()
            if self.freedom.film.volume is not None:
                curvature = curvature_rates_of_volume(film, h, rim)
            fields = jacobi_fields(film, h, rim, curvature)
            self._sensitivities[net] = transition_sensitivities(net.surface, film, net.iso, fields, rim)
        return self._sensitivities[net]

    def rim_shifts(self, film: Film, shares: Floats) -> Floats:
        """How the boundary's nodes move with each parameter, (p, n, 3), m."""
        nodes = film.connectivity.rim_nodes
        t = rim_parameters(film.connectivity, film.mesh.parameter)
        of_loop = film.mesh.loop[nodes[:, 0]]
        result = np.zeros((self.freedom.count, len(film.nodes), 3))
        begin, curves = self.loops(shares), self.freedom.changed(shares).curves
        here = [loop.at(t[of_loop == index]) for index, loop in enumerate(begin)]
        for number in range(self.freedom.count):
            ahead = shares.copy()
            ahead[number] += SHARE
            moved = self.freedom.changed(ahead)
            for index, curve in enumerate(moved.curves):
                if curve == curves[index]:
                    continue
                mine = of_loop == index
                # so small a change needs no check of its own
                there = curve.loop()
                result[number, nodes[mine]] = (there.at(t[mine]) - here[index]) / SHARE
        return result
