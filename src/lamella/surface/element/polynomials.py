"""Polynomials on elements, evaluated at places in bulk.

At the places of one element its polynomials are one product of matrices, their coefficients times the monomials there.
Places of the same element are therefore taken together, in groups of equal size.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.blocks import blocks
from lamella.surface.element.lagrange import Lagrange
from lamella.surface.element.places import Places

# places of an element in one product: more gain nothing, and the last group of each element is filled up to as many
MOST_TOGETHER = 16


@dataclass(frozen=True)
class Polynomials:
    """c polynomials on each of m elements.

    Attributes
    ----------
    basis : Lagrange
        Of their order.
    coefficients : (m, c, k)
        Of the monomials x^i y^j, in the order of `Lagrange.monomials`.
    """

    basis: Lagrange
    coefficients: Floats

    @classmethod
    def through(cls, basis: Lagrange, values: Floats) -> Polynomials:
        """The polynomials with nodal values (m, k, c)."""
        return cls(basis, np.tensordot(values, basis.to_monomials, (1, 1)))

    def __getitem__(self, index: slice) -> Polynomials:
        """Some of the c polynomials."""
        return Polynomials(self.basis, np.ascontiguousarray(self.coefficients[:, index]))

    @cached_property
    def _with_slopes(self) -> Floats:
        """Coefficients (m, 3 c, k) of the polynomials and of their derivatives by x and y."""
        slopes = (np.tensordot(self.coefficients, self.basis.derivative(*d), (2, 1)) for d in ((1, 0), (0, 1)))
        return np.concatenate([self.coefficients, *slopes], 1)

    def values(self, where: Places) -> Floats:
        """Values at n places, (c, n)."""
        return self._at(self.coefficients, where)

    def jet(self, where: Places) -> Floats:
        """Values and derivatives by x and y at n places, (3, c, n)."""
        return self._at(self._with_slopes, where).reshape(3, self.coefficients.shape[1], len(where))

    def everywhere(self, local: Floats, x_order: int = 0, y_order: int = 0) -> Floats:
        """Values or derivatives at the same local coordinates (q, 2) of every element, element by element, (c, m q)."""
        table = self.basis.derivative(x_order, y_order).T @ self.basis.monomials(local)
        values = np.tensordot(self.coefficients, table, (2, 0))
        return values.transpose(1, 0, 2).reshape(values.shape[1], -1)

    def _at(self, coefficients: Floats, where: Places) -> Floats:
        """Values of polynomials with coefficients (m, r, k) at n places, (r, n)."""
        result = np.empty((coefficients.shape[1], len(where)))
        for block in blocks(len(where)):
            owner, place, size = _groups(where.element[block])
            local = np.zeros((len(owner) * size, 2))
            local[place] = where.local[block]
            monomials = self.basis.monomials(local)
            there = monomials.reshape(len(monomials), len(owner), size).transpose(1, 0, 2)
            values = np.empty((len(result), len(owner), size))
            np.matmul(coefficients.take(owner, 0), there, out=values.transpose(1, 0, 2))
            result[:, block] = values.reshape(len(result), -1).take(place, 1)
        return result


def _groups(element: Integers) -> tuple[Integers, Integers, int]:
    """Places in elements (n,) by groups of one element each.

    Returns
    -------
    owner : (g,) int
        Element of each group.
    place : (n,) int
        Number of each place among those of all groups.
    size : int
        Places a group, some of which stay empty.
    """
    order = element.argsort(kind="stable")
    ranked = element.take(order)
    new = np.ones(len(ranked), bool)
    np.not_equal(ranked[1:], ranked[:-1], out=new[1:])
    first = np.flatnonzero(new)
    number = np.diff(first, append=len(ranked))
    # the largest power of two that an element fills on average
    size = min(1 << ((len(ranked) // len(first)).bit_length() - 1), MOST_TOGETHER)
    groups = -(-number // size)
    place = np.empty(len(ranked), np.int64)
    place[order] = np.arange(len(ranked)) + np.repeat(size * (np.cumsum(groups) - groups) - first, number)
    return np.repeat(ranked[first], groups), place, size
