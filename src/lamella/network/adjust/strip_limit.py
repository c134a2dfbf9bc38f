"""A limit to the utilisation of strips while a boundary is adjusted, to first order.

A limit to the stresses of bending, twist and helix is one to |kg| and |tg| of the lamellas, and so to the curvature of
the film. Where strips are used most, their use at the same places of the elements is followed through the Jacobi field
of each parameter: it moves the nodes, curvatures are found anew, and the difference gives the rate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats
from lamella.network.network import Network
from lamella.surface.darboux import lamella_darboux
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface

# of the film's size: how far its nodes are moved for a difference quotient
USE_STEP = 1e-4
# places that are followed, and of the largest use: less is not followed
MOST_FOLLOWED, LEAST_FOLLOWED = 200, 0.75


@dataclass(frozen=True)
class StripLimit:
    """What strips may be used.

    Attributes
    ----------
    most : float
        Largest utilisation.
    on_net : callable
        Utilisation of strips at the samples of a net, (k,).
    of : callable
        That of kg and tg, 1/m, each (n,), of one strip alone.
    minimum_length : float
        Shorter lamellas, in cells, are left out.
    """

    most: float
    on_net: Callable[[Network], Floats]
    of: Callable[[Floats, Floats], Floats]
    minimum_length: float


@dataclass(frozen=True)
class MostUsed:
    """Where strips are used most.

    Attributes
    ----------
    largest : float
        Utilisation.
    places : Places
        Of n samples, at most one of each family in an element.
    families : (n,) str
    use : (n,)
        Their utilisation.
    """

    largest: float
    places: Places
    families: NDArray[np.str_]
    use: Floats

    @classmethod
    def of(cls, network: Network, surface: ElementSurface, limit: StripLimit) -> MostUsed:
        """Of a net on a surface."""
        use = limit.on_net(network)
        largest = float(use.max())
        some = np.flatnonzero(use > LEAST_FOLLOWED * largest)
        some = some[np.argsort(-use[some], kind="stable")]
        lamella = np.searchsorted(network.sample_offsets, some, side="right") - 1
        families = network.families[lamella]
        places, _ = surface.closest(network.sample_points[some])
        # the most used one of each family in an element
        _, first = np.unique(2 * places.element + (families == "A"), return_index=True)
        kept = np.sort(first)[:MOST_FOLLOWED]
        return cls(largest, places[kept], families[kept], use[some][kept])

    def rates(self, surface: ElementSurface, moves: Floats, curvature_rates: Floats, limit: StripLimit) -> Floats:
        """Change of the utilisation at the places with each of p parameters, (n, p).

        Parameters
        ----------
        surface : ElementSurface
            The one that they are of.
        moves : (p, m, 3)
            How the nodes move with each parameter, m.
        curvature_rates : (p,)
            How H changes, 1/m.
        limit : StripLimit
        """
        here = self.alone(surface, limit)
        size = float(np.ptp(surface.nodes, axis=0).max())
        rates = np.empty((len(self.use), len(moves)))
        for number, (move, rate) in enumerate(zip(moves, curvature_rates, strict=True)):
            step = USE_STEP * size / max(float(np.abs(move).max()), USE_STEP * size)
            there = replace(
                surface, nodes=surface.nodes + step * move, mean_curvature=surface.mean_curvature + step * float(rate)
            )
            rates[:, number] = (self.alone(there, limit) - here) / step
        # what other layers and levels add changes alike
        return np.asarray(rates * (self.use / np.maximum(here, 1e-3 * self.use))[:, None])

    def alone(self, surface: ElementSurface, limit: StripLimit) -> Floats:
        """Utilisation of one strip of the family at each place of a surface, (n,)."""
        points = surface.at(self.places)
        # kn = H along both diagonals of the principal directions; tg > 0 on A
        unit = np.conj(points.deviator) / np.maximum(np.abs(points.deviator), np.finfo(float).tiny)
        heading = np.sqrt(np.where(self.families == "A", -1j, 1j) * unit)
        _, kg, tg = lamella_darboux(points, heading)
        return limit.of(kg, tg)
