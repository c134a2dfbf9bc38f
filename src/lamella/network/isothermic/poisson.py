"""The least squares problem of isothermic coordinates: dw as near as can be to sqrt(D) dz."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.result import Lean
from lamella.base.sparse import SymmetricPattern, packed
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.surface.element.geometry import tangents, weighted_dirichlet_blocks
from lamella.surface.element.quadrature import triangle_rule

# of the mean |D|: where it is less the weight does not grow any more. Its square over the rounding of 1e-16 is what
# remains of elements' stiffness against the sum of their rows, which has to be 0
POISSON_SHARE_MIN = 1e-4


@dataclass(frozen=True, eq=False)
class Unknowns(Lean):
    """Which of the elements' own values are one unknown, up to sign and parameters c; the same for all surfaces.

    Attributes
    ----------
    sector : (m, k) int
        Sector of each element's own nodes.
    home : (s,) int
        Unknown of each sector.
    sign : (s,)
    offset : (s, t)
        The value of a sector is sign U + offset c.
    held : dict
        Unknowns that are a row (t,) times c.
    """

    sector: Integers
    home: Integers
    sign: Floats
    offset: Floats
    held: dict[int, Floats]

    @cached_property
    def signs(self) -> Floats:
        """Sign of each element's own values, (m, k)."""
        return np.asarray(self.sign[self.sector])

    @cached_property
    def _numbers(self) -> tuple[Integers, int]:
        count = int(self.home.max()) + 1
        free = np.ones(count, bool)
        free[list(self.held)] = False
        number = np.where(free, np.cumsum(free) - 1, -1)
        return number[self.home[self.sector]], int(free.sum())

    @property
    def number(self) -> Integers:
        """Number of the free unknown of each element's own values, (m, k); -1: held."""
        return self._numbers[0]

    @cached_property
    def pattern(self) -> SymmetricPattern:
        """Pattern of the free unknowns: its analysis serves all surfaces."""
        return SymmetricPattern.from_elements(*self._numbers)

    @cached_property
    def gathering(self) -> csr_matrix:
        """What adds up values of elements' own nodes at the free unknowns, with their signs, (size, m k)."""
        flat = self.number.ravel()
        inside = np.flatnonzero(flat >= 0)
        return csr_matrix((self.signs.ravel()[inside], (flat[inside], inside)), (self.pattern.size, len(flat)))

    @cached_property
    def fixed_rows(self) -> tuple[Integers, Floats]:
        """Elements (f,), and their own values (t, f, k) for 1 of each parameter where the free unknowns are 0.

        Of all other elements these are 0.
        """
        at = np.zeros((int(self.home.max()) + 1, self.offset.shape[1]))
        for index, row in self.held.items():
            at[index] = row
        values = self.signs[..., None] * at[self.home[self.sector]] + self.offset[self.sector]
        moved = np.flatnonzero(values.any((1, 2)))
        return moved, np.ascontiguousarray(values[moved].transpose(2, 0, 1))


@dataclass(frozen=True)
class Poisson:
    """The least squares problem of fitting dw to the forms, element by element.

    Attributes
    ----------
    form_a, form_b : (m, q) complex
        The forms along both local coordinates at integration points.
    metric : tuple of (m, q)
    area : (m, q)
        Area element over the points' weights, and over the fit's weight.
    x, y : (q, k)
        Derivatives of the basis.
    """

    form_a: Complexes
    form_b: Complexes
    metric: tuple[Floats, Floats, Floats]
    area: Floats
    x: Floats
    y: Floats

    @classmethod
    def of(cls, mesh: IntegrationMesh, sign: Integers) -> Poisson:
        """The problem on a mesh with signs (m,) of the roots, not weighted."""
        basis = mesh.connectivity.basis
        points, weights = triangle_rule(2 * basis.order)
        form_a, form_b, (e, f, g) = _forms(mesh, points)
        form_a, form_b = form_a * sign[:, None], form_b * sign[:, None]
        x, y = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
        area = np.sqrt(np.maximum(e * g - f * f, 1e-12 * e * g)) / weights
        return cls(form_a, form_b, (e, f, g), area, x, y)

    def alike(self, forms: Complexes) -> tuple[Poisson, Integers]:
        """The same with the roots nearer to those of a surface near by, and which were turned, -1, (m,).

        Each element's own branch is that of its middle, and may change while the surface moves.

        Parameters
        ----------
        forms : (2, m, q) complex
            The other surface's forms along both local coordinates.
        """
        same = (self.form_a * forms[0].conj() + self.form_b * forms[1].conj()).real.sum(1)
        turn = np.where(same < 0, -1, 1)
        if (turn > 0).all():
            return self, turn
        turned = replace(self, form_a=self.form_a * turn[:, None], form_b=self.form_b * turn[:, None])
        return turned, turn

    def weighted(self) -> Poisson:
        """The same fit with the weight 1 / |D|^2: what the forms are not closed by stays away from umbilics.

        A plain least squares fit leaves a harmonic error, like r^(1/2) next to a zero of order 1, where w itself goes
        like r^(3/2): however small, it would take half of its rays from a singular node. With the weight the error dies
        out faster than w at zeros of any order.
        """
        e, f, g = self.metric
        a, b = self.form_a, self.form_b
        square = (g * _square(a) - 2 * f * (a * b.conj()).real + e * _square(b)) / (e * g - f * f)
        # |sqrt(D) dz|^2 is 2 |D|
        return replace(self, area=self.area * np.maximum(square / square.mean(), POISSON_SHARE_MIN) ** 2)

    @cached_property
    def blocks(self) -> Floats:
        """Matrices of the elements, (m, k, k)."""
        return weighted_dirichlet_blocks(self.x, self.y, self.metric, self.area)

    @cached_property
    def pull(self) -> Complexes:
        """Right sides of the elements, (m, k)."""
        return self.pull_of(self.form_a, self.form_b)

    def pull_of(self, form_a: Complexes, form_b: Complexes) -> Complexes:
        """Right sides (m, k) of other forms, (m, q) along both local coordinates."""
        e, f, g = self.metric
        a, b = form_a / self.area, form_b / self.area
        return np.asarray((g * a - f * b) @ self.x + (e * b - f * a) @ self.y)

    def solve(self, unknowns: Unknowns) -> tuple[Complexes, Floats]:
        """Least values, and how they change with t parameters c.

        Parameters
        ----------
        unknowns : Unknowns

        Returns
        -------
        base : (m, k) complex
            For c = 0.
        moves : (t, m, k)
            Per c.
        """
        s, number, pattern = unknowns.signs, unknowns.number, unknowns.pattern
        one, other = np.tril_indices(number.shape[1])
        blocks = packed(self.blocks) * (s.take(one, 1) * s.take(other, 1))
        moved, fixed = unknowns.fixed_rows
        # what the held unknowns and the offsets make of c = 1 without the free unknowns
        pulls = np.zeros((*number.shape, 2 + len(fixed)))
        pulls[..., 0], pulls[..., 1] = self.pull.real, self.pull.imag
        for column, part in enumerate(fixed, 2):
            pulls[moved, :, column] = -np.matmul(self.blocks[moved], part[..., None])[..., 0]
        right = unknowns.gathering @ pulls.reshape(number.size, -1)
        solved = pattern.factor(pattern.assemble(blocks)).solve(right)
        padded = np.vstack([solved, np.zeros((1, solved.shape[1]))])[number]
        base = s * (padded[..., 0] + 1j * padded[..., 1])
        moves = np.ascontiguousarray(s * padded[..., 2:].transpose(2, 0, 1))
        moves[:, moved] += fixed
        return np.asarray(base), np.asarray(moves)

    def quadratic(self, base: Complexes, moves: Floats) -> tuple[Floats, Complexes]:
        """Matrix (t, t) and right side (t,) of the parameters' least squares."""
        # constants on an element cost nothing: without them its large weights next to an umbilic magnify no rounding
        base, moves = base - base[:, :1], moves - moves[..., :1]
        stiff = np.matmul(self.blocks, moves[..., None])[..., 0]
        gram = np.einsum("tek,sek->ts", moves, stiff)
        return np.asarray(gram), np.asarray(
            np.einsum("tek,ek->t", moves, self.pull) - np.einsum("tek,ek->t", stiff, base)
        )

    def folds(self, value: Complexes) -> Booleans:
        """Elements (m,) on which coordinates turn over anywhere."""
        w_x, w_y = value @ self.x.T, value @ self.y.T
        return np.asarray((w_x.real * w_y.imag <= w_x.imag * w_y.real).any(1))

    def residual(self, value: Complexes) -> float:
        """Root mean square of dw - sqrt(D) dz over that of sqrt(D) dz."""
        e, f, g = self.metric

        def energy(one: Complexes, other: Complexes) -> float:
            density = g * _square(one) - 2 * f * (one * other.conj()).real + e * _square(other)
            return float((density / self.area).sum())

        miss = energy(value @ self.x.T - self.form_a, value @ self.y.T - self.form_b)
        return float(np.sqrt(miss / energy(self.form_a, self.form_b)))


def _frames(
    mesh: IntegrationMesh, local: Floats
) -> tuple[Complexes, Complexes, tuple[Floats, Floats, Floats], Complexes]:
    """Tangents as complex numbers in the frame along the first one, metric, and D, at local points (m, q)."""
    connectivity = mesh.connectivity
    basis = connectivity.basis
    value, x, y = (basis.basis(local, *d) for d in ((0, 0), (1, 0), (0, 1)))
    a, b = tangents(x, y, mesh.nodes[connectivity.elements])
    # components first: (3, m, q)
    a, b = (np.ascontiguousarray(np.moveaxis(t, 2, 0)) for t in (a, b))
    e, f, g = ((s * t).sum(0) for s, t in ((a, a), (a, b), (b, b)))
    area = np.sqrt(e * g - f * f)
    xx, xy, xz, yy, yz, zz = np.moveaxis(np.matmul(value, mesh.shape[connectivity.elements]), 2, 0)

    def image(t: Floats) -> Floats:
        return np.stack(
            [xx * t[0] + xy * t[1] + xz * t[2], xy * t[0] + yy * t[1] + yz * t[2], xz * t[0] + yz * t[1] + zz * t[2]]
        )

    # in the frame e_u along a, e_v: b = f / sqrt(e) e_u + area / sqrt(e) e_v
    s_a, s_b = image(a), image(b)
    aa, ab, bb = ((s * t).sum(0) for s, t in ((s_a, a), (s_a, b), (s_b, b)))
    uu = aa / e
    uv = (ab - f * uu) / area
    vv = (e * bb - 2 * f * ab + f * f * uu) / area**2
    along = np.sqrt(e) + 0j
    other = (f + 1j * area) / np.sqrt(e)
    return along, other, (e, f, g), (uu - vv) / 2 - 1j * uv


def _square(value: Complexes) -> Floats:
    """|value|^2."""
    return np.asarray(value.real**2 + value.imag**2)


def deviator_root(
    mesh: IntegrationMesh, local: Floats
) -> tuple[Complexes, Complexes, Complexes, tuple[Floats, Floats, Floats]]:
    """sqrt(D), one branch an element, with the tangents and the metric, at local points (m, q)."""
    along, other, metric, deviator = _frames(mesh, np.vstack([local, [[1 / 3, 1 / 3]]]))
    root = np.sqrt(deviator)
    middle = root[:, -1:]
    root = np.where((root * middle.conj()).real < 0, -root, root)
    e, f, g = (part[:, :-1] for part in metric)
    return root[:, :-1], along[:, :-1], other[:, :-1], (e, f, g)


def _forms(mesh: IntegrationMesh, local: Floats) -> tuple[Complexes, Complexes, tuple[Floats, Floats, Floats]]:
    """dw along both local coordinates at local points (m, q), and the metric."""
    root, along, other, metric = deviator_root(mesh, local)
    return root * along, root * other, metric
