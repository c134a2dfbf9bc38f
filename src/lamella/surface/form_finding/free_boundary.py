"""Boundary loops of films that slide: where the film has them now."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.surface.element.placing import rim_parameters
from lamella.surface.form_finding.film import Film, Loop, NoFilmError, Slide

# points of an edge at which its arc length is taken, and Gauss points between two of them
SLIDE_PIECES, GAUSS = 8, 6
# of its first length: a sliding loop shorter than that is about to vanish
SHRUNK = 0.02


@dataclass(frozen=True)
class FreeRim:
    """A loop whose sliding parts are the edges of a film, the parameter running evenly along them.

    A parameter that ran unevenly from edge to edge would roughen the elements made on it.

    Attributes
    ----------
    loop : Loop
        The loop it came from, which still holds the other parts.
    length : float
        m.
    """

    loop: Loop
    length: float
    _starts: Floats
    _spans: Floats
    _nodes: Floats
    _shares: Floats
    _basis: Floats

    @property
    def name(self) -> str:
        """Name in the project."""
        return self.loop.name

    @property
    def corners(self) -> Floats:
        """Parameters of the corners, sorted."""
        return self.loop.corners

    @property
    def smooth(self) -> Booleans:
        """Which corners are none to the eye, see `lamella.surface.boundary.curve.Loop`."""
        return self.loop.smooth

    @property
    def slides(self) -> Sequence[Slide]:
        """Parts that are free to slide."""
        return self.loop.slides

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""
        t = np.asarray(t, float) % 1
        points = self.loop.at(t)
        sliding = np.zeros(len(t), bool)
        for slide in self.slides:
            sliding |= within(t, slide.start, slide.end)
        edge = np.searchsorted(self._starts, t[sliding], side="right") - 1
        arc = np.clip(((t[sliding] - self._starts[edge]) % 1) / self._spans[edge], 0, 1)
        share = (arc[:, None] ** np.arange(SLIDE_PIECES + 1) * self._shares[edge]).sum(1)
        powers = np.vander(share, len(self._basis), increasing=True) @ self._basis
        points[sliding] = np.einsum("nk,nkc->nc", powers, self._nodes[edge])
        return points


def within(t: Floats, start: float, end: float) -> Booleans:
    """Which parameters (n,) are inside a part of a loop, its ends left out unless it is the whole loop."""
    along, span = (t - start) % 1, end - start
    return np.asarray((along > 1e-9) & (along < span - 1e-9)) if span < 1 else np.ones(len(t), bool)


def settled_rims(film: Film) -> Film:
    """The same film with its sliding loops where it has them now."""
    if not any(loop.slides for loop in film.loops):
        return film
    parameter = film.mesh.parameter.copy()
    loops = tuple(_slid(film, k, parameter) if loop.slides else loop for k, loop in enumerate(film.loops))
    return replace(film, mesh=replace(film.mesh, parameter=parameter), loops=loops)


def _slid(film: Film, index: int, parameter: Floats) -> FreeRim:
    """A film's rim along one of its loops; `parameter` (v,) of its vertices is made even along sliding parts."""
    loop = film.loops[index]
    rim_nodes = film.connectivity.rim_nodes
    mine = film.mesh.loop[rim_nodes[:, 0]] == index
    t = rim_parameters(film.connectivity, film.mesh.parameter)[mine][:, [0, -1]]
    span = (t[:, 1] - t[:, 0] + 0.5) % 1 - 0.5
    ends = rim_nodes[mine][:, [0, -1]]
    # edges run with or against the parameter, as the surface lies to their left
    ahead = (span > 0)[:, None]
    nodes = np.where(ahead[..., None], film.nodes[rim_nodes[mine]], film.nodes[rim_nodes[mine]][:, ::-1])
    ends = np.where(ahead, ends, ends[:, ::-1])
    start, span = np.where(ahead[:, 0], t[:, 0], t[:, 1]), np.abs(span)
    p = film.connectivity.basis.order
    basis: Floats = np.asarray(np.linalg.inv(np.vander(np.linspace(0, 1, p + 1), increasing=True)), np.float64)
    length, shares = _arc_lengths(nodes, basis)
    for slide in loop.slides:
        moves = np.flatnonzero(within((start + span / 2) % 1, slide.start, slide.end))
        moves = moves[np.argsort((start[moves] - slide.start) % 1)]
        whole = slide.end - slide.start
        even = length[moves] / length[moves].sum() * whole
        first = start[moves[0]] if whole >= 1 else slide.start
        span[moves] = even
        start[moves] = (first + np.cumsum(even) - even) % 1
        # a held end keeps its parameter
        later = moves if whole >= 1 else moves[1:]
        parameter[ends[later, 0]] = start[later]
    order = np.argsort(start)
    held = loop.loop if isinstance(loop, FreeRim) else loop
    if length.sum() < SHRUNK * held.length:
        raise NoFilmError(f"the sliding rim {loop.name!r} shrinks away", film)
    return FreeRim(held, float(length.sum()), start[order], span[order], nodes[order], shares[order], basis)


def _arc_lengths(nodes: Floats, basis: Floats) -> tuple[Floats, Floats]:
    """Lengths of edges with nodes (b, p + 1, 3), and their parameters as polynomials of the arc length fraction."""
    gauss, weight = np.polynomial.legendre.leggauss(GAUSS)
    places = ((np.arange(SLIDE_PIECES)[:, None] + (gauss + 1) / 2) / SLIDE_PIECES).ravel()
    p = len(basis) - 1
    slopes = np.zeros((len(places), p + 1))
    slopes[:, 1:] = np.arange(1, p + 1) * np.vander(places, p, increasing=True)
    speed = np.linalg.norm(np.matmul(slopes @ basis, nodes), axis=2).reshape(len(nodes), SLIDE_PIECES, GAUSS)
    arc = np.cumsum((speed * weight).sum(2) / (2 * SLIDE_PIECES), axis=1)
    length = arc[:, -1]
    fraction = np.column_stack([np.zeros(len(nodes)), arc / length[:, None]])
    powers = fraction[:, :, None] ** np.arange(SLIDE_PIECES + 1)
    wanted = np.broadcast_to(np.linspace(0, 1, SLIDE_PIECES + 1)[:, None], (len(nodes), SLIDE_PIECES + 1, 1))
    shares: Floats = np.asarray(np.linalg.solve(powers, wanted)[..., 0], np.float64)
    return np.asarray(length, np.float64), shares
