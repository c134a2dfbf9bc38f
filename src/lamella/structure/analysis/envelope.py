"""The smallest and the largest of all cases at every place of the strips, and which case that is of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Result
from lamella.structure.analysis.case_result import CaseResult

TIE_DIGITS = 9
"""Of the largest by size: values that differ by less are alike, and the first case counts."""


@dataclass(frozen=True)
class Extreme:
    """The smallest or largest of all cases.

    Attributes
    ----------
    values, cases : (r, ...)
        What it is, and the number of its case.
    """

    values: Floats
    cases: Integers


@dataclass(frozen=True, repr=False, eq=False)
class Envelope(Result):
    """Of the elements of lamellas at both ends, and of the network's nodes.

    Attributes
    ----------
    names : tuple of str
        Of the cases.
    least, most : Extreme
        Section forces (m, 2, 6): N, Vy, Vz, Mx, My, Mz, N and N m.
    von_mises, utilisation : Extreme
        (m, 2), Pa and share of the strength.
    deflection : Extreme
        Of the nodes from the state without loads, m, (n,).
    """

    names: tuple[str, ...]
    least: Extreme
    most: Extreme
    von_mises: Extreme
    utilisation: Extreme
    deflection: Extreme

    def _line(self) -> str:
        place = np.unravel_index(self.utilisation.values.argmax(), self.utilisation.values.shape)
        most, governs = self.utilisation.values[place], self.names[self.utilisation.cases[place]]
        return f"of {len(self.names)} cases, utilisation up to {most:.2f} by {governs!r}"

    @classmethod
    def of(cls, cases: Sequence[CaseResult], forces: Callable[[CaseResult], Floats]) -> Envelope:
        """Of cases of one model.

        Parameters
        ----------
        cases : sequence of CaseResult
        forces : callable
            Section forces of a case, (m, 2, 6), see `lamella.structure.export.result_rows.EndForces`.
        """
        m, n = len(cases[0].model.lines.length), cases[0].model.nodes
        low, high = _Running((m, 2, 6), sign=-1), _Running((m, 2, 6))
        stress, use, far = _Running((m, 2)), _Running((m, 2)), _Running((n,))
        for k, case in enumerate(cases):
            of_case = forces(case)[:m]
            low.add(k, of_case)
            high.add(k, of_case)
            stress.add(k, case.use.von_mises)
            use.add(k, case.use.utilisation)
            by = case.displacements - case.rest.displacements[:n]
            far.add(k, np.linalg.norm(by, axis=1))
        names = tuple(case.name for case in cases)
        return cls(names, *(one.found() for one in (low, high, stress, use, far)))


class _Running:
    """The largest so far, or the smallest (sign -1)."""

    def __init__(self, shape: tuple[int, ...], sign: int = 1) -> None:
        self._sign, self._values = sign, np.full(shape, -np.inf)
        self._cases: Integers = np.zeros(shape, np.int64)

    def add(self, case: int, values: Floats) -> None:
        signed = self._sign * values
        grain = 10.0**-TIE_DIGITS * np.abs(values).max(initial=0.0)
        more = signed > self._values + grain
        self._values = np.where(more, signed, self._values)
        self._cases = np.where(more, case, self._cases)

    def found(self) -> Extreme:
        return Extreme(self._sign * self._values + 0.0, self._cases)
