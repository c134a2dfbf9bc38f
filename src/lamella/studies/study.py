"""A study: many variants of a project, computed side by side, their table and the page that shows them."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella.base.byte_order import unmarked
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.result import Result
from lamella.base.wording import counted
from lamella.files.whole import write_whole
from lamella.project.read import parse_project, read_project
from lamella.stages.wanted import wanted_stages
from lamella.studies.engine import Crew, workers
from lamella.studies.folder import Kept, StudyFolder, check_study_folder
from lamella.studies.optimise import search
from lamella.studies.page import page
from lamella.studies.sampling import sampled
from lamella.studies.table import Row, Table, row_of
from lamella.studies.tables import StudyTable, parse_study, read_study
from lamella.studies.variables import changed_values, present_value
from lamella.studies.variant import DONE, FAILED, Base

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DIGITS_LEAST = 4
"""Of the names of variants: 0000, 0001, ..."""


@dataclass(frozen=True, eq=False, repr=False)
class Study(Result):
    r"""The variants of a study.

    Attributes
    ----------
    folder : Path
        What was written: table.csv, study.html, variants/.
    columns : dict
        Values by column of the table, a list each; None where a variant has none.
    best : tuple of str
        Names of the variants that keep all constraints and that no other such one is better than.
    seconds : float
        CPU seconds of the variants that were computed now, on all workers together.
    computed : int
        How many these are; the others were there.
    ended : str
        How a search ended; empty without one.

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> project = '[surface]\nkind = "catenoid"\nneck_radius = 2.0\nheight = [-1.0, 1.0]\n'
    >>> radii = {"key": "surface.neck_radius", "values": [1.5, 2.0, -1.0]}
    >>> with tempfile.TemporaryDirectory() as name:
    ...     folder = pathlib.Path(name)
    ...     _ = (folder / "tube.toml").write_text(project)
    ...     values = {"project": "tube.toml", "until": "surface", "variable": [radii]}
    ...     found = lamella.study(values, folder=folder, out=folder / "study", jobs=1)
    >>> found
    Study(3 variants, 2 of them done, 0 best)
    >>> found.columns["status"], [round(area, 2) for area in found.columns["surface.area"][:2]]
    (['done', 'done', 'refused'], [21.9, 27.33])
    """

    folder: Path
    columns: dict[str, list[Any]]
    best: tuple[str, ...]
    seconds: float = field(compare=False)
    computed: int = field(compare=False)
    ended: str = ""

    def _line(self) -> str:
        done = self.columns["status"].count(DONE)
        total = len(self.columns["id"])
        return f"{counted(total, 'variant')}, {done} of them done, {len(self.best)} best"

    def project(self, name: str) -> Path:
        """The project file of a variant, as `lamella run` takes it."""
        return self.folder / "variants" / name / "project.toml"

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame, where pandas is installed."""
        import pandas

        return pandas.DataFrame(self.columns).set_index("id")

    def plot(self, x: str, y: str, ax: Axes | None = None) -> Axes:
        """Two columns against each other, the best variants marked.

        Parameters
        ----------
        x, y : str
            Columns of numbers.
        ax : matplotlib axes, optional

        Raises
        ------
        InputError
            There is no such column.
        """
        from matplotlib import pyplot

        for name in (x, y):
            if name not in self.columns:
                raise InputError(f"the study has no column {name!r}", "see its columns")
        axes: Axes = pyplot.figure().add_subplot() if ax is None else ax
        best = set(self.best)
        for marked in (False, True):
            chosen = [k for k, name in enumerate(self.columns["id"]) if (name in best) == marked]
            points = [
                (a, b)
                for k in chosen
                if (a := self.columns[x][k]) is not None and (b := self.columns[y][k]) is not None
            ]
            if points:
                axes.plot(*zip(*points, strict=True), "o" if marked else ".", label="best" if marked else "variants")
        axes.set_xlabel(x)
        axes.set_ylabel(y)
        return axes


def study(
    study: str | Path | Mapping[str, Any],
    *,
    out: str | Path | None = None,
    folder: str | Path | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress = silent,
) -> Study:
    r"""Compute the variants of a study, those that are missing, and write its folder.

    Parameters
    ----------
    study : str, Path or mapping
        Its file; or its values, as a TOML reader gives them.
    out : str or Path, optional
        Folder to write; ``out/<study file's stem>`` when not given. Variants that are there already are kept.
    folder : str or Path, optional
        Where the project's name begins; the study file's folder when not given.
    jobs : int, optional
        Processes; as many as there are cores when not given. Several need Dask, and in a script that it is guarded by
        ``if __name__ == "__main__":``, as all that begins processes; with 1 this process does it.
    scheduler : str, optional
        Address of a Dask scheduler instead.
    progress : callable

    Returns
    -------
    Study

    Raises
    ------
    InputError
        Whatever is wrong with the study, before anything is computed; what is wrong with a variant is in its row.

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> project = '[surface]\nkind = "catenoid"\nneck_radius = 2.0\nheight = [-1.0, 1.0]\n'
    >>> radii = {"key": "surface.neck_radius", "values": [1.5, 2.0, -1.0]}
    >>> with tempfile.TemporaryDirectory() as name:
    ...     folder = pathlib.Path(name)
    ...     _ = (folder / "tube.toml").write_text(project)
    ...     values = {"project": "tube.toml", "until": "surface", "variable": [radii]}
    ...     found = lamella.study(values, folder=folder, out=folder / "study", jobs=1)
    >>> found
    Study(3 variants, 2 of them done, 0 best)
    >>> found.columns["status"], [round(area, 2) for area in found.columns["surface.area"][:2]]
    (['done', 'done', 'refused'], [21.9, 27.33])
    """
    if isinstance(study, Mapping):
        table, source = parse_study(dict(study)), None
        folder = Path(folder or ".")
    else:
        source = Path(study)
        table = read_study(source)
        folder = source.parent if folder is None else Path(folder)
    if jobs is not None and jobs < 1:
        raise InputError(f"{jobs} jobs are too few", "one at least", "--jobs")
    target = Path(out) if out is not None else Path("out") / (source.stem if source else "study")
    check_study_folder(target)
    try:
        work = _Work(table, folder, target, progress)
    except InputError as error:
        # of the study's own keys; what is wrong with the project names its file
        own = error.where.split("[")[0].split(".")[0] in StudyTable.model_fields and source is not None
        raise InputError(error.message, error.remedy, f"{source}: {error.where}" if own else error.where) from None
    with work.store.opened(), ExitStack() as stack:
        work.begin = lambda: stack.enter_context(workers(work.base, jobs=jobs, scheduler=scheduler))
        ended = work.run()
        found = Table(table, tuple(work.rows))
        write_whole(target / "table.csv", found.csv())
        write_whole(target / "study.html", page(found, work.title))
        if source is not None:
            write_whole(target / "study.toml", source.read_bytes())
        work.store.remove_others({row.name for row in found.rows})
    columns = found.columns
    best = tuple(name for name, is_best in zip(columns["id"], columns["best"], strict=True) if is_best)
    return Study(target, columns, best, work.seconds, work.computed, ended)


class _Work:
    """A study under way."""

    begin: Callable[[], Crew]

    def __init__(self, table: StudyTable, folder: Path, target: Path, progress: Progress) -> None:
        self.table, self._progress = table, progress
        file = folder / table.project
        project = read_project(file)
        try:
            wanted_stages(project, table.until)
        except InputError as error:
            where = "until" if error.where == "--until" else error.where
            raise InputError(error.message, error.remedy, where) from None
        values = tomllib.loads(unmarked(file.read_bytes()).decode("utf-8"))
        values.setdefault("name", project.name)
        self.title = f"{project.name}: study"
        self.base = Base(values, _named_files(values, file.parent), table)
        self.store = StudyFolder(target, self.base, file.parent)
        self.start = tuple(_start(values, variable) for variable in table.variable)
        self.rows: list[Row] = []
        self.seconds, self.computed = 0.0, 0
        self._check(file.parent)

    @cached_property
    def _crew(self) -> Crew:
        """Workers, begun when the first variant is missing."""
        self._progress(Report.step("beginning workers"))
        return self.begin()

    def _check(self, folder: Path) -> None:
        """Refuse variables that no value would suit: the first and the last of each, the others as they are."""
        for number, variable in enumerate(self.table.variable):
            ends: tuple[Any, ...] = variable.values or variable.range or ()
            errors = []
            for end in (ends[0], ends[-1]):
                value = round(end) if variable.whole else end
                try:
                    parse_project(changed_values(self.base.values, (variable,), (value,), folder))
                except InputError as error:
                    errors.append(error)
            if len(errors) == 2:
                first = errors[0]
                at = f"variable[{number}]"
                if first.where.startswith("variable"):
                    raise InputError(first.message, first.remedy, first.where.replace("variable", at))
                remedy = "write whole = true" if "whole number" in first.message else first.remedy
                raise InputError(f"{first.where}: {first.message}", remedy, f"{at}.key")

    def run(self) -> str:
        """Compute all variants; how a search ended."""
        if self.table.optimise is not None:
            return search(self.table, self.table.optimise, self.start, self.evaluate)
        chosen = sampled(self.table)
        self.evaluate(chosen)
        return ""

    def evaluate(self, chosen: Sequence[tuple[Any, ...]]) -> list[Row]:
        """Rows of variants, those that are missing computed side by side."""
        first = len(self.rows)
        digits = max(DIGITS_LEAST, len(str(first + len(chosen))))
        names = [f"{first + k:0{digits}d}" for k in range(len(chosen))]
        kept: dict[int, Kept] = {}
        for k, (name, one) in enumerate(zip(names, chosen, strict=True)):
            there = self.store.kept(name, one)
            if there is not None and there.status != FAILED:
                kept[k] = there
        missing = [k for k in range(len(chosen)) if k not in kept]
        if kept:
            self._progress(Report.step(f"{counted(len(kept), 'variant')} there already"))
        found = self._crew.outcomes([chosen[k] for k in missing]) if missing else iter(())
        for done, (number, outcome) in enumerate(found, 1):
            k = missing[number]
            self.store.write(names[k], chosen[k], outcome)
            kept[k] = Kept.of(outcome)
            # an objective that names no figure is told at the first variant that has figures
            row_of(self.table, names[k], chosen[k], kept[k], self.start)
            self.seconds += outcome.seconds
            self.computed += 1
            text = f"variant {names[k]}: {outcome.status}" + (f", {outcome.reason}" if outcome.reason else "")
            self._progress(Report.step(text, done / len(missing)))
        rows = [row_of(self.table, names[k], chosen[k], kept[k], self.start) for k in range(len(chosen))]
        self.rows += rows
        return rows


def _start(values: Mapping[str, Any], variable: Any) -> Any:
    """Where a variable begins: what the project has; else the middle of its range, or the first of its values."""
    if variable.freedom is not None:
        first = 1.0 if variable.freedom == "scale" else 0.0
    else:
        first = present_value(values, variable.key)
    if variable.range is None:
        return variable.values[0] if first is None else first
    low, high = variable.range
    number = isinstance(first, int | float) and not isinstance(first, bool)
    return first if number and low <= first <= high else (low + high) / 2


def _named_files(values: Any, folder: Path) -> dict[str, bytes]:
    """Contents of the files that a project names, by the names it has for them."""
    found: dict[str, bytes] = {}
    if isinstance(values, Mapping):
        file = values.get("file")
        if isinstance(file, str) and not Path(file).is_absolute() and ".." not in Path(file).parts:
            try:
                found[file] = (folder / file).read_bytes()
            except OSError:
                # whoever reads it says what is wrong
                return {}
        for item in values.values():
            found |= _named_files(item, folder)
    elif isinstance(values, list | tuple):
        for item in values:
            found |= _named_files(item, folder)
    return found
