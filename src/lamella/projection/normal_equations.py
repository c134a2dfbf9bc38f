"""J^T J of many constraints on one fixed pattern: indices are worked out once, then only numbers move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.sparse import Backend, SymmetricPattern
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Layout


@dataclass(frozen=True)
class Linearised:
    """A constraint at one place.

    Attributes
    ----------
    residual : (p, m)
    jacobian : (p, k, m)
        By its k local unknowns; items last, since all work runs over them.
    """

    residual: Floats
    jacobian: Floats


@dataclass(frozen=True)
class _Part:
    unknowns: Integers  # (k, m)
    first: int  # of its pairs among all pairs


@dataclass(frozen=True)
class NormalEquations:
    """Assembles sums of squares of constraints, w^2 |f|^2, to second order (Gauss-Newton).

    Attributes
    ----------
    layout : Layout
    pattern : SymmetricPattern
    """

    layout: Layout
    pattern: SymmetricPattern
    _parts: tuple[_Part, ...] = field(repr=False)
    _cache: dict[int, tuple[Floats, Floats]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, layout: Layout, constraints: Sequence[Constraint], backend: Backend | None = None) -> NormalEquations:
        """Work out the pattern of constraints that will come in this order."""
        parts, first = [], 0
        for constraint in constraints:
            local = [layout.unknowns(slot) for slot in constraint.slots()]
            unknowns = np.ascontiguousarray(np.concatenate(local, 1).T)
            parts.append(_Part(unknowns, first))
            k, m = unknowns.shape
            first += k * (k + 1) // 2 * m
        # millions: 32 bits are enough and halve the memory
        one, other = np.empty((2, first), np.int32)
        for part in parts:
            k, m = part.unknowns.shape
            a, b = np.tril_indices(k)
            here = slice(part.first, part.first + len(a) * m)
            one[here].reshape(len(a), m)[:] = part.unknowns[a]
            other[here].reshape(len(a), m)[:] = part.unknowns[b]
        pattern = SymmetricPattern.from_pairs(one, other, layout.size, backend=backend)
        return cls(layout, pattern, tuple(parts))

    def arguments(self, part: int, constraint: Constraint, vector: Floats) -> list[Floats]:
        """Arguments of a constraint, (m, d) each."""
        flat, start, found = self._parts[part].unknowns, 0, []
        for slot in constraint.slots():
            size = 1 if slot.component is not None else self.layout.shapes[slot.block][1]
            found.append(vector[flat[start : start + size].T])
            start += size
        return found

    def residuals(self, constraints: Sequence[Constraint], vector: Floats) -> list[Floats]:
        """Residuals (p, m) of all constraints."""
        return [
            np.ascontiguousarray(constraint.residual(*self.arguments(part, constraint, vector)).T)
            for part, constraint in enumerate(constraints)
        ]

    def linearise(self, constraints: Sequence[Constraint], vector: Floats) -> list[Linearised]:
        """Residuals and derivatives of all constraints."""
        found = []
        for part, constraint in enumerate(constraints):
            arguments = self.arguments(part, constraint, vector)
            residual = np.ascontiguousarray(constraint.residual(*arguments).T)
            if constraint.linear and part in self._cache:
                jacobian = self._cache[part][0]
            else:
                by_argument = constraint.jacobian(*arguments)
                jacobian = np.concatenate([np.moveaxis(j, 0, 2) for j in by_argument], 1)
            found.append(Linearised(residual, jacobian))
        return found

    def assemble(
        self, constraints: Sequence[Constraint], linearised: Sequence[Linearised], weights: Sequence[float]
    ) -> tuple[Floats, Floats]:
        """Entries of the sum of w^2 J^T J, see `SymmetricPattern`, and the vector of the sum of w^2 J^T f."""
        values = np.zeros(len(self.pattern.rows))
        right = np.zeros(self.layout.size)
        for part, (constraint, at, weight) in enumerate(zip(constraints, linearised, weights, strict=True)):
            if weight == 0 or not at.residual.size:
                continue
            plan = self._parts[part]
            if not constraint.linear:
                values += self.pattern.assemble(_products(at.jacobian, weight), first=plan.first)
            else:
                if part not in self._cache:
                    entries = self.pattern.assemble(_products(at.jacobian), first=plan.first)
                    self._cache[part] = (at.jacobian, entries)
                values += weight**2 * self._cache[part][1]
            gradient = np.einsum("pkm,pm->km", at.jacobian, at.residual)
            right += weight**2 * np.bincount(plan.unknowns.ravel(), gradient.ravel(), self.layout.size)
        return values, right

    def second_order(
        self,
        constraints: Sequence[Constraint],
        linearised: Sequence[Linearised],
        weights: Sequence[float],
        vector: Floats,
    ) -> Floats:
        """Entries of the sum of w^2 f H, which Gauss and Newton leave out and Newton adds to J^T J.

        H is the second derivative, constant for each item: column by column the change of J over a unit step.
        """
        values = np.zeros(len(self.pattern.rows))
        for part, (constraint, at, weight) in enumerate(zip(constraints, linearised, weights, strict=True)):
            if weight == 0 or constraint.linear or not at.residual.size:
                continue
            arguments = self.arguments(part, constraint, vector)
            k, row = at.jacobian.shape[1], 0
            blocks = np.empty((k * (k + 1) // 2, at.residual.shape[1]))
            i = 0
            for number, argument in enumerate(arguments):
                for component in range(argument.shape[1]):
                    moved = argument.copy()
                    moved[:, component] += 1
                    jacobian = constraint.jacobian(*arguments[:number], moved, *arguments[number + 1 :])
                    there = np.concatenate([np.moveaxis(j, 0, 2) for j in jacobian], 1)[:, : i + 1]
                    blocks[row : row + i + 1] = np.einsum("pm,pkm->km", at.residual, there - at.jacobian[:, : i + 1])
                    row, i = row + i + 1, i + 1
            values += self.pattern.assemble(weight**2 * blocks, first=self._parts[part].first)
        return values

    def change(self, linearised: Sequence[Linearised], step: Floats) -> list[Floats]:
        """J d of all constraints, (p, m) each."""
        return [
            np.einsum("pkm,km->pm", at.jacobian, step[part.unknowns])
            for part, at in zip(self._parts, linearised, strict=True)
        ]


def _products(jacobian: Floats, weight: float = 1.0) -> Floats:
    """Lower triangles of w^2 J^T J item by item, (k (k + 1) / 2, m)."""
    p, k, m = jacobian.shape
    products = np.empty((k * (k + 1) // 2, m))
    row = 0
    for i in range(k):
        block = products[row : row + i + 1]
        np.multiply(jacobian[0, i], jacobian[0, : i + 1], out=block)
        for equation in range(1, p):
            block += jacobian[equation, i] * jacobian[equation, : i + 1]
        row += i + 1
    if weight != 1:
        products *= weight**2
    return products
