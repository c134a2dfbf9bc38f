"""Films of a boundary that may change, each with its net, and how the nets change with the boundary."""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, as_details, silent
from lamella.network.adjust.film_net import FilmNet
from lamella.network.adjust.transition_sensitivities import (
    Sensitivities,
    curvature_rates_of_volume,
    jacobi_fields,
    transition_sensitivities,
)
from lamella.network.pattern import Pattern
from lamella.surface.boundary.curve import Loop
from lamella.surface.boundary.freedom import Freedom
from lamella.surface.element.placing import rim_parameters
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.followed_film import FilmRequest, FollowedFilm
from lamella.surface.form_finding.kept_elements import Boundary
from lamella.surface.umbilic import refuse_umbilic

# difference of shares for the loops' movement
SHARE = 1e-5


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
        self._loops: dict[bytes, tuple[Loop, ...]] = {}
        self._sensitivities: WeakKeyDictionary[FilmNet, Sensitivities] = WeakKeyDictionary()
        self._moves: WeakKeyDictionary[FilmNet, tuple[Floats, Floats]] = WeakKeyDictionary()

    def loops(self, shares: Floats) -> tuple[Loop, ...]:
        """The boundary at some shares."""
        key = shares.tobytes()
        if key not in self._loops:
            self._loops[key] = self.freedom.changed(shares).loops()
        return self._loops[key]

    def first(self, tolerance: float) -> FilmNet:
        """The film of the sketch, to a tolerance."""
        film, still = self.freedom.film, np.zeros(self.freedom.count)
        request = FilmRequest(film.order, tolerance, film.branch, film.most_nodes)
        found = FollowedFilm.first(self._boundary(still), request, origin=film.origin, progress=self._progress)
        net = FilmNet.of(still, found, self.pattern)
        refuse_umbilic(net.surface)
        return net

    def moved(self, net: FilmNet, shares: Floats) -> FilmNet:
        """The film followed to other shares; its umbilics stay as many, of the same orders.

        Raises
        ------
        FollowError
        """
        boundary = self._boundary(shares, net.film.equilibrium.mean_curvature)
        try:
            there = net.film.moved(boundary, progress=self._progress)
        except InputError as error:
            raise FollowError(str(error)) from None
        return self._checked(net, net.moved(shares, there))

    def refined(self, net: FilmNet, tolerance: float) -> FilmNet:
        """The same film to another tolerance, from the elements at hand.

        Raises
        ------
        FollowError
        """
        try:
            there = net.film.refined(tolerance, progress=self._progress)
        except InputError as error:
            raise FollowError(str(error)) from None
        return self._checked(net, FilmNet.of(net.shares, there, self.pattern))

    def _boundary(self, shares: Floats, mean_curvature: float = 0.0) -> Boundary:
        """What the film of some shares is found from; with a volume a mean curvature (1/m) to start from."""
        changed = self.freedom.changed(shares)
        h = changed.mean_curvature if changed.mean_curvature is not None else mean_curvature
        return Boundary(self.loops(shares), h, changed.volume)

    def anew(self, net: FilmNet) -> FilmNet:
        """The same film with coordinates from nothing, as those of its final net.

        Raises
        ------
        FollowError
        """
        return self._checked(net, FilmNet.of(net.shares, net.film, self.pattern))

    def finished(self, net: FilmNet) -> ElementSurface:
        """The film as later stages see it, with its notes and figures."""
        surface = net.film.assessed
        return replace(surface, figures=surface.figures | {"tolerance": self.freedom.film.tolerance})

    def _checked(self, net: FilmNet, there: FilmNet) -> FilmNet:
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

    def moves(self, net: FilmNet) -> tuple[Floats, Floats]:
        """How the film's nodes move with each parameter, (p, n, 3), m, and how H changes, (p,), 1/m."""
        self._found(net)
        return self._moves[net]

    def _found(self, net: FilmNet) -> Sensitivities:
        if net not in self._sensitivities:
            film, h = net.film.equilibrium.film, net.surface.mean_curvature
            rim = self.rim_shifts(film, net.shares)
            curvature = self.freedom.curvature_sensitivities()
            if self.freedom.film.volume is not None:
                curvature = curvature_rates_of_volume(film, h, rim)
            fields = jacobi_fields(film, h, rim, curvature)
            self._moves[net] = fields[..., None] * film.directions(), curvature
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
