"""Whole numbers of cells for the pieces of a cut, such that a net can go on across all of them.

A net closes where w goes over into +-w + whole cells on every loop of the surface, and umbilics are nodes where going
around them is a half turn about a lattice point: shifts even. Neither depends on how the surface was cut; nor does the
least energy of a correction with given shifts, by which one set of whole numbers is nearer than another. Rounding the
pieces one by one would depend on the cut: they are sums of each other's.

Which whole numbers are nearest in that energy is the closest vector problem of a lattice (U. Fincke, M. Pohst, Improved
methods for calculating vectors of short length in a lattice, Mathematics of Computation 44 (1985) 463-471); D. Bommer,
H. Zimmer, L. Kobbelt (Mixed-integer quadrangulation, ACM Transactions on Graphics 28 (2009) 77) round greedily, one
number after the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.network.isothermic.holonomy import around_vertex, fixed_point_factors, vertex_relations
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.lattice_origin import MIDDLE

# of the sum of all squared rates: what is reached more slowly is not
UNREACHED = 1e-9
# partial sums looked at, at most: near the closest vector the first ones are good ones
MOST_SUMS = 100_000


@dataclass(frozen=True)
class IntegerTransitions:
    """The lattice of shifts (in cells) with which a net closes and its umbilics of odd order are nodes.

    Attributes
    ----------
    offset : (t,) complex
        Whole shifts to begin from.
    basis : (d, t) int
        Of the shifts of t pieces less the offset, the same for their real and imaginary parts; where the net's lattice
        hangs (`fixed_point_factors`) does not change.
    energy : (d, d)
        Of corrections along the basis.
    """

    offset: Complexes
    basis: Integers
    energy: Floats

    @classmethod
    def of(cls, iso: Isothermic, gram: Floats) -> IntegerTransitions:
        """All whole shifts of a surface's coordinates.

        Parameters
        ----------
        iso : Isothermic
        gram : (t, t)
            Energy of corrections, per pair of shifts: `Isothermic.gram`, or `Isothermic.dirichlet`.
        """
        conditions = [*vertex_relations(iso.mesh, iso.transitions, iso.across, iso.odd).values()]
        origin = fixed_point_factors(iso)
        if origin.any():
            conditions.append(np.rint(2 * origin).astype(np.int64))
        # what turns w at a corner of the rim is no joint
        stubs = np.array([piece.stub for piece in iso.transitions], bool)
        conditions += list(np.eye(len(stubs), dtype=np.int64)[stubs])
        basis = _kernel(len(iso.transitions), conditions)
        for vertex in iso.odd.tolist():
            _, factors = around_vertex(iso.mesh, iso.transitions, iso.across, vertex)
            basis = _even(basis, factors)
        turning = np.array([piece.sign < 0 for piece in iso.transitions], bool) & ~stubs
        # twice the middle of a cell, where w turns around no umbilic of the net
        offset = np.where(turning, 0 if len(iso.odd) else 2 * MIDDLE, 0)
        return cls(offset.astype(complex), *_reduced(basis, gram))

    def coordinates(self, changes: Complexes) -> Complexes:
        """Changes of shifts (t, ...) in the basis, (d, ...)."""
        if not len(self.basis):
            return np.zeros((0, *changes.shape[1:]), complex)
        columns = changes.reshape(len(changes), -1)
        found = np.linalg.lstsq(self.basis.T.astype(complex), columns, rcond=None)[0]
        return np.asarray(found.reshape(-1, *changes.shape[1:]), np.complex128)

    def measured(self, changes: Complexes) -> Complexes:
        """Changes of the shifts (t, ...) as numbers (d, ...) whose sum of squares is their energy."""
        return np.asarray(np.tensordot(np.linalg.cholesky(self.energy).T, self.coordinates(changes), 1), np.complex128)

    def size(self, change: Complexes) -> float:
        """Square root of the energy of a change of shifts (t,), in cells."""
        return float(np.linalg.norm(self.measured(change)))

    def nearest(self, shifts: Complexes, count: int = 1) -> list[Complexes]:
        """The nearest whole shifts to given ones, (t,) each, by the energy of the change, the nearest first."""
        wanted = self.coordinates(shifts - self.offset)
        upper = np.asarray(np.linalg.cholesky(self.energy).T, float)
        one, other = (_closest(upper, part, count) for part in (wanted.real, wanted.imag))
        pairs = sorted((e + f, j, k) for j, (e, _) in enumerate(one) for k, (f, _) in enumerate(other))
        return [self.offset + (one[j][1] + 1j * other[k][1]) @ self.basis for _, j, k in pairs[:count]]

    def easiest(self, shifts: Complexes, rates: Complexes, count: int) -> list[Complexes]:
        """The whole shifts (t,) that parameters reach from given ones with the least sum of squares, to first order.

        Parameters
        ----------
        shifts : (t,) complex
        rates : (t, p) complex
            Change of the shifts with each parameter.
        count : int
            How many, the easiest first.
        """
        d = len(self.basis)
        now, moved = self.coordinates(shifts - self.offset), self.coordinates(rates)
        reach = np.vstack([moved.real, moved.imag])
        axes, rate, _ = np.linalg.svd(reach, full_matrices=True)
        rate = np.append(rate, np.zeros(2 * d - len(rate)))
        # p parameters need not reach everything: what they do not is far away
        root = axes / np.sqrt(rate**2 + max(UNREACHED * (rate**2).sum(), np.finfo(float).tiny))
        short, _ = _reduced(np.eye(2 * d, dtype=np.int64), root @ root.T)
        wanted = np.linalg.solve(short.T.astype(float), np.concatenate([now.real, now.imag]))
        # the energy itself may be too uneven for rounding: its root is not
        _, upper = np.linalg.qr((short @ root).T)
        ways = [x @ short for _, x in _closest(upper, wanted, count)]
        return [self.offset + (x[:d] + 1j * x[d:]) @ self.basis for x in ways]


def _kernel(count: int, conditions: list[Integers]) -> Integers:
    """Basis (d, t) of all whole vectors with condition . vector = 0, by Euclid's algorithm."""
    basis = np.eye(count, dtype=np.int64)
    for condition in conditions:
        while True:
            value = basis @ condition
            left = np.flatnonzero(value)
            if len(left) < 2:
                break
            least = left[np.abs(value[left]).argmin()]
            times = value // value[least]
            times[least] = 0
            basis = basis - np.outer(times, basis[least])
        basis = np.delete(basis, left, 0)
    return basis


def _even(basis: Integers, factors: Integers) -> Integers:
    """Basis of those vectors of a lattice for which factors . vector is even."""
    odd = np.flatnonzero(basis @ factors % 2)
    result = basis.copy()
    if len(odd):
        result[odd] += basis[odd[0]]
    return result


def _reduced(basis: Integers, gram: Floats) -> tuple[Integers, Floats]:
    """A basis of the same lattice with vectors as short as pairs can make each other, and their energies."""
    while True:
        energy = basis @ gram @ basis.T
        square = np.diagonal(energy)
        times = np.rint(energy / square) if len(basis) else energy
        np.fill_diagonal(times, 0)
        gain = 2 * times * energy - times**2 * square
        if not len(basis) or not gain.max() > 1e-9 * square.max():
            return basis, energy
        one, other = np.unravel_index(gain.argmax(), gain.shape)
        basis = basis.copy()
        basis[one] -= int(times[one, other]) * basis[other]


def _closest(upper: Floats, wanted: Floats, count: int) -> list[tuple[float, Integers]]:
    """The whole vectors (d,) of least |upper (x - wanted)|^2, upper triangular, with these, the least first.

    Fincke and Pohst, Math. Comp. 44 (1985) 463: a sum of squares from the last coordinate to the first, each tried from
    the nearest whole number outwards until the sum is larger than what was found.
    """
    d = len(wanted)
    found: list[tuple[float, Integers]] = []
    x = np.zeros(d, np.int64)
    looked_at = 0

    def limit() -> float:
        return found[-1][0] if len(found) == count else np.inf

    def descend(level: int, sum_above: float) -> None:
        nonlocal looked_at
        looked_at += 1
        if level < 0:
            found.append((sum_above, x.copy()))
            found.sort(key=lambda one: one[0])
            del found[count:]
            return
        above = upper[level, level + 1 :] @ (x[level + 1 :] - wanted[level + 1 :])
        middle = wanted[level] - above / upper[level, level]
        nearest = round(middle)
        direction = 1 if middle >= nearest else -1
        for number in range(2 * count + 1000):
            # 0, 1, -1, 2, -2, ... beginning on the side of the middle
            x[level] = nearest + direction * ((number + 1) // 2) * (1 if number % 2 else -1)
            here = sum_above + (upper[level, level] * (x[level] - middle)) ** 2
            if here >= limit() or (found and looked_at > MOST_SUMS):
                return
            descend(level - 1, here)

    descend(d - 1, 0.0)
    return found
