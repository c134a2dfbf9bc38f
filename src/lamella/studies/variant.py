"""One variant of a study: a project with its variables set, computed on whatever machine has the time."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import orjson

from lamella.base.errors import InputError
from lamella.project.read import parse_project
from lamella.stages.computation import compute
from lamella.stages.memory import Memory
from lamella.stages.results import Results
from lamella.studies.figures import headroom
from lamella.studies.tables import HeadroomTable, StudyTable
from lamella.studies.variables import changed_values
from lamella.studies.view import view_of

DONE, REFUSED, FAILED = "done", "refused", "failed"
"""What becomes of a variant: computed; refused with a reason, for good; or lost with its machine, to be tried again."""


@dataclass(frozen=True)
class Base:
    """What all variants of a study share; it goes to each worker once.

    Attributes
    ----------
    values : dict
        Of the project, as TOML holds them.
    files : dict
        Contents of the files that the project names, by their names: workers need no folder of ours.
    study : StudyTable
    """

    values: dict[str, Any]
    files: dict[str, bytes]
    study: StudyTable


@dataclass(frozen=True)
class Outcome:
    """What a worker returns.

    Attributes
    ----------
    status : str
        "done" or "refused".
    reason, remedy : str
        Why it was refused.
    values : dict
        Of the project, with the variables set; all defaults filled in where it was computed.
    summary : dict or None
        The content of summary.json, without times.
    headrooms : dict
        Clear heights by name, m or None.
    view : bytes
        What the page draws, see `lamella.studies.view`.
    seconds : float
        CPU seconds.
    """

    status: str
    reason: str
    remedy: str
    values: dict[str, Any]
    summary: dict[str, Any] | None
    headrooms: dict[str, float | None]
    view: bytes
    seconds: float


_memory = Memory()
"""Of this process: variants that differ in a strip's height share their film."""


def compute_variant(base: Base, chosen: tuple[Any, ...]) -> Outcome:
    """Compute a variant.

    What earlier variants have left in the process's memory shortens the work and does not change its result.

    Parameters
    ----------
    base : Base
    chosen : tuple
        A value for each variable.
    """
    start = time.process_time()
    values = dict(base.values)
    with tempfile.TemporaryDirectory(prefix="lamella-study-") as name:
        folder = Path(name)
        for file, content in base.files.items():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_bytes(content)
        try:
            values = changed_values(base.values, base.study.variable, chosen, folder)
            project = parse_project(values)
            results = compute(project, until=base.study.until, folder=folder, memory=_memory)
        except InputError as error:
            where = f"{error.where}: " if error.where else ""
            reason = f"{where}{error.message}".replace(str(folder) + os.sep, "")
            return Outcome(REFUSED, reason, error.remedy, values, None, {}, b"", time.process_time() - start)
        headrooms = {place.name: headroom(results, place) for place in base.study.headroom}
        return _outcome(results, headrooms, base.study.headroom, start)


def _outcome(
    results: Results,
    headrooms: Mapping[str, float | None],
    places: tuple[HeadroomTable, ...],
    start: float,
) -> Outcome:
    # times differ from run to run, and tables of the same study must not
    summary = {key: value for key, value in results.summary.items() if key != "seconds"}
    plain = orjson.loads(orjson.dumps(summary, option=orjson.OPT_SERIALIZE_NUMPY))
    filled = results.project.model_dump(mode="json", exclude_none=True)
    seconds = time.process_time() - start
    return Outcome(DONE, "", "", filled, plain, dict(headrooms), view_of(results), seconds)
