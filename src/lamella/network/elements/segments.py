"""Pieces of lamella on a surface of elements, between neighbouring stops.

Along a ray the coordinate in cells goes like the distance from the singular node to the power 1 + m/2, so that places
are asked for by a parameter sigma in which they are analytic: the share of a cell is the incomplete beta function with
that power at each singular end, sigma itself where there is none.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import beta, betainc, betaincinv

from lamella.base.arrays import Floats, Integers
from lamella.base.blocks import blocks
from lamella.base.vectors import lengths
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_curves import LevelCurves, passages
from lamella.network.network import A
from lamella.surface.element.places import Places

# of a ray's first cell: a place taken for the singular node's own direction
BESIDE_NODE = 1e-3
# nearer to the node than where chi has risen by this (cells) a ray is led out from it to points at these multiples of
# the parameter, inside the rosette and the first cell
RISEN, LEADING = 0.09, np.array([1.0, 1.5, 2.0, 2.5])


@dataclass(frozen=True)
class Spots:
    """Parameters on segments.

    Attributes
    ----------
    segment : (k,) int
    sigma : (k,)
    link : (k,) int
        Of the tracks.
    ahead : (k,)
        How far along that, cells.
    """

    segment: Integers
    sigma: Floats
    link: Integers
    ahead: Floats

    def __len__(self) -> int:
        return len(self.segment)

    def __getitem__(self, index: Integers | slice) -> Spots:
        return Spots(self.segment[index], self.sigma[index], self.link[index], self.ahead[index])


class ElementSegments:
    """Pieces of lamella between neighbouring stops.

    Parameters
    ----------
    cells : IntegerGridMap
    level_curves : LevelCurves
    chain : (s,) int
        Chain of each.
    tau, reach : (s,)
        Where it begins, and its length, cells.
    zeros : (s, 2) int
        Row of the umbilic in `cells.mesh.umbilics` where it begins and ends, -1: none.
    orders : (z,) int
        Of the umbilics.

    Attributes
    ----------
    cells : IntegerGridMap
    owner : (s,) int
        Chain of each.
    reach : (s,)
        Length of each, cells.
    """

    def __init__(
        self,
        cells: IntegerGridMap,
        level_curves: LevelCurves,
        chain: Integers,
        tau: Floats,
        reach: Floats,
        zeros: Integers,
        orders: Integers,
    ) -> None:
        self.cells, self._level_curves = cells, level_curves
        self.owner, self._tau, self.reach, self._zeros = chain, tau, reach, zeros
        self._is_a = level_curves.family[chain] == A
        self._power = np.where(zeros >= 0, 1 + np.r_[orders, 0][zeros] / 2, 1.0)
        # whether each end is an umbilic
        self._at_zero = np.asarray(zeros >= 0)
        self._singular = np.asarray(self._at_zero.any(1))
        self._bent = (self._power != 1).any(1)
        self._stride = 2 * float(level_curves.tau.max() + level_curves.span.max() + 2)
        self._keys = level_curves.owner * self._stride + level_curves.tau

    def spots(self, segment: Integers, sigma: Floats) -> Spots:
        """Parameters (k,) of segments (k,): sooner if they are in order."""
        t, chain = self._level_curves, self.owner[segment]
        share = np.clip(sigma, 0, 1)
        bent = np.flatnonzero(self._bent[segment])
        share[bent] = betainc(*self._power[segment[bent]].T, share[bent])
        tau = self._tau[segment] + share * self.reach[segment]
        link = np.searchsorted(self._keys, chain * self._stride + np.clip(tau, 0, self._stride - 1), side="right") - 1
        link = np.clip(link, t.first[chain], t.last[chain])
        return Spots(segment, sigma, link, tau - t.tau[link])

    def element(self, spots: Spots) -> Integers:
        """Elements of spots, (k,); next to an element's edge it may be the neighbour."""
        return self._level_curves.element[spots.link]

    def _find(self, spots: Spots, near: Places | None = None) -> tuple[Places, Floats]:
        """Places of spots, and which way the chain's coordinate runs on their sheets, (k,)."""
        t, link, ahead = self._level_curves, spots.link, spots.ahead
        direction = t.direction[link]
        other = t.start[link] + ahead * direction
        level = t.level[link].astype(float)
        is_a = self._is_a[spots.segment]
        target = np.stack([np.where(is_a, other, level), np.where(is_a, level, other)])
        element = t.element[link]
        local = np.empty((len(spots), 2)) if near is None else near.local.copy()
        # where nothing is known that is near: along the link
        alone = slice(None) if near is None else np.flatnonzero(near.element != element)
        link, ahead = link[alone], ahead[alone]
        share = np.clip(ahead / np.maximum(t.span[link], 1e-300), 0, 1)
        begin = t.local_start.take(link, 0)
        local[alone] = begin + share[:, None] * (t.local_end.take(link, 0) - begin)
        places, turn, _ = self.cells.invert(Places(element, local), target)
        return places, turn * direction

    def velocity(self, spots: Spots, near: Places | None = None) -> tuple[Places, Floats, Floats]:
        """Places, positions (k, 3) and their derivatives by sigma (k, 3), m, at spots.

        They are found sooner from places that are near, and element by element.
        """
        places = Places(np.empty(len(spots), np.int64), np.empty((len(spots), 2)))
        position, velocity = np.empty((2, len(spots), 3))
        for block in blocks(len(spots)):
            at, position[block], velocity[block] = self._velocity(spots[block], None if near is None else near[block])
            places.element[block], places.local[block] = at.element, at.local
        self._lead_out(spots, position, velocity)
        return places, position, velocity

    def _velocity(self, spots: Spots, near: Places | None = None) -> tuple[Places, Floats, Floats]:
        segment, sigma = spots.segment, spots.sigma
        # at a singular node chi has no slope: the way out is that of a place just beside it
        some = np.flatnonzero(self._singular[segment])
        first_is, last_is = self._at_zero[segment[some]].T
        beside = sigma.copy()
        beside[some] = np.clip(sigma[some], BESIDE_NODE * first_is, 1 - BESIDE_NODE * last_is)
        moved = np.flatnonzero(beside != sigma)
        places, direction = self._find(self.spots(segment, beside) if len(moved) else spots, near)
        (_, chi_x, chi_y), (position, first, second) = self.cells.jet_and_tangents(places)
        # along the level line, where the other part of chi does not change
        is_a = self._is_a[segment]
        held_x, held_y = (np.where(is_a, slope.imag, -slope.real) for slope in (chi_x, chi_y))
        rate = direction * self.reach[segment] / (chi_x.real * chi_y.imag - chi_x.imag * chi_y.real)
        bent = np.flatnonzero(self._bent[segment])
        p, q = self._power[segment[bent]].T
        rate[bent] *= beside[bent] ** (p - 1) * (1 - beside[bent]) ** (q - 1) / beta(p, q)
        velocity = (rate * held_y)[:, None] * first - (rate * held_x)[:, None] * second
        if len(moved):
            places = Places(places.element.copy(), places.local.copy())
            exact, _ = self._find(spots[moved])
            places.element[moved], places.local[moved] = exact.element, exact.local
            position[moved] = self.cells.tangents(exact)[0]
        return places, position, velocity

    def passages(self) -> tuple[Integers, Floats]:
        """Segments and parameters where they go over from one element to the next, each (k,)."""
        chain, tau = passages(self.cells, self._level_curves)
        starts = self.owner * self._stride + self._tau
        segment = np.searchsorted(starts, chain * self._stride + tau, side="right") - 1
        share = (tau - self._tau[segment]) / self.reach[segment]
        inside = (segment >= 0) & (self.owner[segment] == chain) & (share > 0) & (share < 1)
        segment, sigma = segment[inside], share[inside]
        bent = np.flatnonzero(self._bent[segment])
        sigma[bent] = betaincinv(*self._power[segment[bent]].T, sigma[bent])
        return segment, sigma

    @cached_property
    def _leads(self) -> list[tuple[Integers, Floats, Floats]]:
        """For the segments that begin (end) in singular nodes: their numbers, how far they are led out, as sigma, and
        coefficients (n, 5, 3) of positions as polynomials of the share of that: through the node and places beyond.
        """
        at = np.r_[0.0, LEADING]
        inverse = np.linalg.inv(np.vander(at, increasing=True))
        leads = []
        for side in range(2):
            own = np.flatnonzero(self._at_zero[:, side])
            out = self._out(own, side)
            apart = (out[:, None] * at).ravel()
            ahead = self._velocity(self.spots(np.repeat(own, len(at)), np.abs(side - apart)))[1]
            leads.append((own, out, np.matmul(inverse, ahead.reshape(len(own), len(at), 3))))
        return leads

    def _lead_out(self, spots: Spots, position: Floats, velocity: Floats) -> None:
        """Set positions and velocities (k, 3) of spots next to singular nodes, from the node and places further out.

        chi has next to no slope there, and a zero of higher order is not quite one in numbers: a lamella would pass
        the node by. As a function of sigma a ray is analytic.
        """
        if not self._singular[spots.segment].any():
            return
        power = np.arange(len(LEADING) + 1)
        for side, (own, out, series) in enumerate(self._leads):
            mine = np.flatnonzero(self._at_zero[spots.segment, side])
            row = np.searchsorted(own, spots.segment[mine])
            share = np.abs(side - spots.sigma[mine]) / out[row]
            near = share < 1
            mine, row, share = mine[near], row[near], share[near, None]
            position[mine] = np.einsum("np,npc->nc", share**power, series[row])
            away = np.einsum("np,npc->nc", power[1:] * share ** power[:-1], series[row, 1:])
            velocity[mine] = (1 - 2 * side) * away / out[row, None]

    def _out(self, segment: Integers, side: int) -> Floats:
        """How far segments (k,) are led out from the node at one end, as sigma: inside the node's rosette."""
        out = np.minimum(RISEN ** (1 / self._power[segment, side]), 1 / LEADING[-1])
        away = np.r_[np.zeros(len(out)), out]
        node, beside = np.split(self._velocity(self.spots(np.tile(segment, 2), np.abs(side - away)))[1], 2)
        speed = lengths(beside - node) / out
        return np.asarray(np.minimum(out, self.cells.mesh.radii[self._zeros[segment, side]] / (LEADING[-1] * speed)))
