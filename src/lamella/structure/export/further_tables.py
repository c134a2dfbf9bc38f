"""What is looked at besides the cases: .csv tables, and their pages of the workbook."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from lamella.base.result import Lean
from lamella.files.write.table import write_table
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.analysis.compared_case import ComparedCase
from lamella.structure.analysis.driven import Driven
from lamella.structure.analysis.envelope import Envelope
from lamella.structure.analysis.failure import Failure
from lamella.structure.export import further_rows as rows
from lamella.structure.export.result_rows import Row

Page = tuple[str, tuple[str, ...], Iterable[Row]]
"""Name, header and rows."""


@dataclass(frozen=True)
class FurtherTables(Lean):
    """Tables of what is there.

    Attributes
    ----------
    analysis : Analysis
    failures : tuple of Failure
    driven : Driven or None
    sensitivity, variants : tuple of ComparedCase
    """

    analysis: Analysis
    failures: tuple[Failure, ...] = ()
    driven: Driven | None = None
    sensitivity: tuple[ComparedCase, ...] = ()
    variants: tuple[ComparedCase, ...] = ()

    @cached_property
    def envelope(self) -> Envelope:
        """Of all cases."""
        return rows.envelope_of(self.analysis.cases)

    def files(self) -> Iterator[Page]:
        """Tables that are files of their own."""
        yield "envelope", rows.ENVELOPE, rows.envelope_rows(self.analysis.model, self.envelope)
        if self.failures or self.driven is not None:
            yield "paths", rows.PATHS, rows.path_rows(self.failures, self.driven)
        yield from self._shared()

    def pages(self) -> Iterator[Page]:
        """Pages of the workbook."""
        yield "envelope", rows.GOVERNING, rows.governing_rows(self.analysis.model, self.envelope)
        yield from self._shared()

    def _shared(self) -> Iterator[Page]:
        if self.failures:
            yield "failure", rows.FAILURE, rows.failure_rows(self.failures)
        if self.analysis.stages:
            yield "construction", rows.CONSTRUCTION, rows.construction_rows(self.analysis.stages)
        for name, cases in (("sensitivity", self.sensitivity), ("variants", self.variants)):
            if cases:
                yield name, rows.COMPARED, rows.compared_rows(cases)


def write_page(path: Path, page: Page, *, name: str, version: str) -> None:
    """Write one table.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    _, header, of = page
    write_table(path, header, of, name=name, version=version)
