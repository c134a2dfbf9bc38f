"""Progress on a terminal: lines, and a bar where the share that is done is known."""

from __future__ import annotations

import sys

from lamella.base.progress import Level, Report
from lamella.base.wording import readable

BAR_WIDTH = 24
"""Characters of a bar."""


class Screen:
    """Prints reports to standard error.

    Parameters
    ----------
    verbose : bool
        Print details too; otherwise they only move the bar.

    Notes
    -----
    The bar is drawn on terminals alone: in a file or a pipe each line stays.
    """

    def __init__(self, *, verbose: bool) -> None:
        self._verbose, self._drawn = verbose, 0
        self._draws = sys.stderr.isatty()

    def __call__(self, report: Report) -> None:
        """Print a report."""
        if self._verbose or report.level < Level.DETAIL:
            self.clear()
            print(readable(str(report)), file=sys.stderr, flush=True)
        if self._draws and report.fraction is not None:
            self._bar(report.fraction)

    def clear(self) -> None:
        """Remove the bar, before other lines are printed."""
        if self._drawn:
            print(f"\r{self._drawn * ' '}\r", end="", file=sys.stderr, flush=True)
            self._drawn = 0

    def _bar(self, fraction: float) -> None:
        done = min(max(round(BAR_WIDTH * fraction), 0), BAR_WIDTH)
        line = f"  [{done * '#'}{(BAR_WIDTH - done) * '.'}] {min(max(fraction, 0.0), 1.0):4.0%}"
        print(f"\r{line}", end="", file=sys.stderr, flush=True)
        self._drawn = len(line)
