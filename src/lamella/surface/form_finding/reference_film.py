"""A film whose elements serve the films of other boundaries: what these share is worked out once.

The nodes of a film of another boundary are sought on lines that its boundary alone decides: through the nodes of the
reference, shifted harmonically with the rim, along the reference's own normals. Where they end up then depends on the
boundary and not on the films in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from lamella.base.arrays import Booleans, Floats
from lamella.base.result import Lean
from lamella.base.sparse import Factor, packed
from lamella.surface.boundary.curve import Loop
from lamella.surface.element.geometry import dirichlet_blocks, tangents
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.meshing import least_angle
from lamella.surface.form_finding.variation import Variation


@dataclass(frozen=True, eq=False)
class ReferenceFilm(Lean):
    """A film with the lines along which others are sought.

    Attributes
    ----------
    film : Film
        In equilibrium along the directions.
    loops : tuple of Loop
        Its boundary.
    directions : (n, 3)
        Unit directions of the lines.
    mean_curvature : float
        H, 1/m.
    negative : int
        Negative eigenvalues of its second variation, among shifts that keep the volume where that is given.
    deviation : float
        Of its mean curvature, see `lamella.surface.form_finding.adaptivity.Deviation.weighted`.
    """

    film: Film
    loops: tuple[Loop, ...]
    directions: Floats
    mean_curvature: float
    negative: int
    deviation: float

    @cached_property
    def variation(self) -> Variation:
        """First and second variation along the lines."""
        return Variation(self.film.connectivity, self.directions)

    @cached_property
    def free(self) -> Booleans:
        """Which nodes are not held by the boundary, (n,)."""
        return self.film.unknowns >= 0

    @cached_property
    def least_angle(self) -> float:
        """Smallest angle of an element, deg."""
        return float(least_angle(self.film).min())

    @cached_property
    def _extension(self) -> tuple[Factor, csc_matrix]:
        """Factor of the harmonic extension into the film, and what the rim's shifts pull at it with, (free, n)."""
        connectivity = self.film.connectivity
        basis = connectivity.basis
        points, weights = triangle_rule(2 * basis.order)
        x, y = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
        blocks, _, _ = dirichlet_blocks(x, y, *tangents(x, y, self.film.nodes[connectivity.elements]), weights)
        pattern = connectivity.inner_pattern
        k = connectivity.elements.shape[1]
        row, column = (
            np.broadcast_to(index, blocks.shape).ravel()
            for index in (connectivity.elements[:, :, None], connectivity.elements[:, None, :])
        )
        used = self.free[row] & ~self.free[column]
        size = (int(self.free.sum()), connectivity.node_count)
        rows = connectivity.inner_unknowns[row[used]]
        coupling = csc_matrix((blocks.reshape(-1, k).ravel()[used], (rows, column[used])), size)
        return pattern.factor(pattern.assemble(packed(blocks))), coupling

    def carried(self, rim: Floats) -> Floats:
        """Where the nodes begin (n, 3), m, with the rim's nodes at `rim` (b, order + 1, 3)."""
        rim_nodes = self.film.connectivity.rim_nodes
        shift = np.zeros_like(self.film.nodes)
        shift[rim_nodes] = rim - self.film.nodes[rim_nodes]
        factor, coupling = self._extension
        shift[self.free] = -factor.solve(coupling @ shift)
        return np.asarray(self.film.nodes + shift)
