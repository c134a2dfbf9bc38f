"""What every bench has in common: CPU seconds, tables, limits, the lines they print.

A bench is a module of this folder with a function ``tables() -> Iterator[Table]`` and, at its end,
``if __name__ == "__main__": show(tables())``; its name stands in ``MODULES`` of ``page.py``, which writes
docs/benchmarks.md (`make bench`). Seconds are CPU seconds (`cpu_seconds`), of one thread unless a column says
otherwise. Machines differ, so what counts is the ratio of two figures of one run: measure both in turns (`in_turns`),
and state it as a `Limit`.
"""

from __future__ import annotations

import math
import os
import resource
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import get_context
from statistics import median
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from lamella.base import sparse

T = TypeVar("T")

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS")
"""Environment variables that have to be 1: threads that wait for each other would be counted as work."""
Cell = str | int | float | None
Row = Mapping[str, Cell]
"""Cells by the name of their column, which ends with the unit: "nodes", "film, s", "film / factorisations"."""


@dataclass(frozen=True)
class Limit:
    """A figure and what it may be at most.

    Attributes
    ----------
    what : str
        The figure, with its size: "film / factorisations at 9,300 nodes".
    value : float
    at_most : float
    """

    what: str
    value: float
    at_most: float

    @property
    def holds(self) -> bool:
        """Whether it is kept."""
        return self.value <= self.at_most


@dataclass(frozen=True)
class Table:
    """One table of a bench.

    Attributes
    ----------
    title : str
    about : str
        What is measured, on which input, and what its columns mean.
    rows : sequence of Row
        The columns are those of all rows, in the order in which they first come.
    limits : sequence of Limit
    left_out : sequence of str
        What could not be measured here, and why.
    """

    title: str
    about: str
    rows: tuple[Row, ...]
    limits: tuple[Limit, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(dict.fromkeys(name for row in self.rows for name in row))

    def markdown(self) -> str:
        """As a section of a page."""
        lines = [f"## {self.title}", "", self.about, ""]
        if self.rows:
            sides = [_number_column(self.rows, name) for name in self.columns]
            lines += [_line(self.columns), _line(["---:" if right else "---" for right in sides])]
            lines += [_line([written(row.get(name)) for name in self.columns]) for row in self.rows]
            lines.append("")
        if self.limits:
            lines += [_line(("limit", "measured", "at most", "")), _line(("---", "---:", "---:", "---"))]
            lines += [
                _line((limit.what, written(limit.value), written(limit.at_most), "" if limit.holds else "**missed**"))
                for limit in self.limits
            ]
            lines.append("")
        for reason in self.left_out:
            lines += [f"Left out: {reason}", ""]
        return "\n".join(lines)


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _number_column(rows: Iterable[Row], name: str) -> bool:
    return all(not isinstance(row.get(name), str) for row in rows)


def written(cell: Cell) -> str:
    """A cell in three digits."""
    if cell is None:
        return ""
    if isinstance(cell, str):
        return cell
    if isinstance(cell, int) or abs(cell) >= 1000:
        return f"{round(cell):,}"
    if cell == 0 or abs(cell) >= 1e-3:
        return f"{float(f'{cell:.3g}'):.6g}"
    return f"{cell:.1e}"


def show(tables: Iterable[Table]) -> None:
    """Print tables as they come."""
    if any(os.environ.get(name) != "1" for name in THREADS):
        sys.exit(f"set {' '.join(f'{name}=1' for name in THREADS)} (make bench does)")
    for table in tables:
        print(table.markdown(), flush=True)


def cpu_seconds() -> float:
    """CPU seconds of this process so far, all threads, and of its children that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def clocked(work: Callable[[], T]) -> tuple[float, T]:
    """CPU seconds, and what came of it."""
    begin = cpu_seconds()
    result = work()
    return cpu_seconds() - begin, result


def in_turns(works: Mapping[str, Callable[[], Any]], times: int) -> dict[str, float]:
    """Median CPU seconds of each, one after the other, over and over: all meet the same noise."""
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(times):
        for name, work in works.items():
            seconds[name].append(clocked(work)[0])
    return {name: median(values) for name, values in seconds.items()}


def memory_gb() -> float:
    """Largest memory of this process so far, GB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e9


def alone(work: Callable[..., T], *arguments: Any) -> T:
    """Call a function of a module in a process of its own: its memory and its first imports are its own."""
    with ProcessPoolExecutor(1, get_context("spawn")) as process:
        return process.submit(work, *arguments).result()


def exponent(small: tuple[float, float], large: tuple[float, float]) -> float:
    """Of growth, from (size, seconds) to (size, seconds)."""
    return math.log(large[1] / small[1]) / math.log(large[0] / small[0])


@dataclass
class Factorisations:
    """CPU seconds spent in sparse factorisations while `factorisations` is open.

    Attributes
    ----------
    seconds : list of float
        Of each: the numbers, and with the first one of a pattern its ordering and analysis.
    """

    seconds: list[float] = field(default_factory=list)

    @property
    def total(self) -> float:
        """Of all."""
        return sum(self.seconds)


@contextmanager
def factorisations() -> Iterator[Factorisations]:
    """Count them: ``with factorisations() as inside: ...; whole / inside.total``."""
    from lamella.base import sparse

    counted, factor = Factorisations(), sparse.SymmetricPattern.factor

    def timed(pattern: sparse.SymmetricPattern, values: sparse.Floats) -> sparse.Factor:
        seconds, result = clocked(lambda: factor(pattern, values))
        counted.seconds.append(seconds)
        return result

    sparse.SymmetricPattern.factor = timed  # type: ignore[method-assign]
    try:
        yield counted
    finally:
        sparse.SymmetricPattern.factor = factor  # type: ignore[method-assign]
