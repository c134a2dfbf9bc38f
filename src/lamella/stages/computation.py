"""The stages of a project, one after the other, with what each needs at hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lamella import __version__
from lamella.base.drawing_origin import NOWHERE, Origin, drawing_origin, reported_from, with_drawn_points
from lamella.base.message import Message
from lamella.base.progress import Progress, silent
from lamella.base.wording import one_line
from lamella.files.own import SCHEMA
from lamella.project.tables import Project
from lamella.stages import all_stages
from lamella.stages.clock import Clock
from lamella.stages.fabrication.defaults import fill_in
from lamella.stages.figure import evaluate
from lamella.stages.memory import Memory, content_key
from lamella.stages.results import Results
from lamella.stages.stage import Estimate, Stage, Upstream
from lamella.stages.wanted import wanted_stages


def compute(
    project: Project,
    *,
    until: str | None = None,
    folder: str | Path = Path(),
    progress: Progress = silent,
    memory: Memory | None = None,
) -> Results:
    """Run the stages of a project up to `until`, in memory.

    Parameters
    ----------
    project : Project
    until : str, optional
        Last stage; as far as this kind of surface goes when not given.
    folder : str or Path
        Where the files a project names are looked for: the folder of the project file.
    progress : callable
        Receives a `lamella.base.progress.Report` of what is being done; `print` will do.
    memory : Memory, optional
        Outputs of earlier computations; those that nothing has changed are taken from it.

    Raises
    ------
    InputError

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project(
    ...     {"surface": {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}, "network": {"cells": 12}}
    ... )
    >>> results = lamella.compute(project, until="network")
    >>> results.network
    Network(12 cells: 24 lamellas, 144 nodes, 120 faces)
    """
    wanted, messages = wanted_stages(project, until)
    computation = Computation(project, wanted, Path(folder), memory or Memory(), Clock(progress))
    computation.warnings += messages
    computation.run_all(wanted, ends=until is None)
    return computation.results()


class Computation:
    """A computation on its way.

    Parameters
    ----------
    project : Project
    wanted : tuple of Stage
    folder : Path
    memory : Memory
    clock : Clock
    finer : float
        See `Upstream`.
    checked : sequence of Stage, optional
        Stages that are asked what they refuse at no cost, where they are not those that are run.

    Attributes
    ----------
    outputs, figures, warnings
        So far.
    """

    def __init__(
        self,
        project: Project,
        wanted: Sequence[Stage[Any]],
        folder: Path,
        memory: Memory,
        clock: Clock,
        *,
        finer: float = 1.0,
        checked: Sequence[Stage[Any]] | None = None,
    ) -> None:
        self.outputs: dict[str, Any] = {}
        self.figures: dict[str, dict[str, Any]] = {}
        self.warnings: list[Message] = []
        self._given = self._filled = project
        self._wanted, self._folder, self._memory, self._clock = tuple(wanted), folder, memory, clock
        self._keys: dict[str, str] = {}
        self._finer = finer
        self._checking = checked is not None
        self._checked = self._wanted if checked is None else tuple(checked)
        for stage in self._checked:
            stage.check(project, None)

    def upstream(self) -> Upstream:
        """What the next stage is given."""
        names = tuple(stage.name for stage in self._wanted)
        return Upstream(
            self._filled,
            self._folder,
            self.outputs,
            self.figures,
            names,
            self._finer,
            self._memory,
            self._keys,
            self._checking,
        )

    def run_all(self, stages: Sequence[Stage[Any]], *, ends: bool = True) -> None:
        """Run stages one after the other.

        Parameters
        ----------
        stages : sequence of Stage
        ends : bool
            Whether to leave out, with a warning, a stage that there cannot be and those that need it; otherwise it
            raises its error.
        """
        for stage in stages:
            if not self.outputs.keys() >= set(stage.needs):
                continue
            with reported_from(self._origin()):
                end = stage.ends(self.upstream()) if ends and stage.needs else None
            if end:
                self.warnings.append(end)
            else:
                self.run(stage)

    def run(self, stage: Stage[Any], progress: Progress | None = None) -> None:
        """Compute a stage, its figures and its warnings, or take them from the memory.

        Parameters
        ----------
        stage : Stage
        progress : callable, optional
            Receives what the stage reports, where that is not the clock's receiver.
        """
        with reported_from(self._origin()):
            self._run(stage, progress)

    def estimate(self, stage: Stage[Any], progress: Progress) -> Estimate:
        """What can be said of a stage on the surface that is there."""
        with reported_from(self._origin()):
            return stage.estimate(self.upstream(), progress)

    def _origin(self) -> Origin:
        """Point of the drawing that places in messages are measured from."""
        return drawing_origin(self.upstream().surface) if self.outputs else NOWHERE

    def _run(self, stage: Stage[Any], progress: Progress | None) -> None:
        up, clock = self.upstream(), self._clock
        clock.start(stage.name, stage.heading(up))
        reads = stage.reads(self._given, up.wanted)
        needs = [self._keys[name] for name in stage.needs]
        key = content_key(self._given, reads, needs, self._folder)
        out = self._memory.remembered(stage.name, key, lambda: stage.run(up, progress or clock.progress))
        self._keys[stage.name], self.outputs[stage.name] = key, out
        if not stage.needs:
            self._surface_known(out.surface)
        self._filled = stage.filled(self.upstream(), out)
        self.figures[stage.name] = evaluate(stage.figures, out)
        clock.stop(stage.name, stage.result(self.figures[stage.name], out))
        warned_key = content_key(self._given, stage.warned_by(self._given), [key, repr(self._finer)], self._folder)
        with reported_from(self._origin()):
            self.warnings += self._memory.remembered(
                f"warnings of {stage.name}",
                warned_key,
                lambda: tuple(stage.warnings(out, self.upstream(), clock.progress)),
            )

    def _surface_known(self, surface: Any) -> None:
        """Fill in the defaults that follow from it; refuse what can be refused without anything else."""
        self._filled = fill_in(self._given, surface)
        for stage in self._checked:
            stage.check(self._given, surface)

    def results(self) -> Results:
        """What has been computed."""
        content: dict[str, Any] = {"schema": SCHEMA, "version": __version__, "name": self._given.name}
        content |= {stage.name: self.figures.get(stage.name) for stage in all_stages.STAGES}
        content |= {"warnings": self.warnings, "seconds": self._clock.seconds}
        origin = drawing_origin(self.upstream().surface)
        return Results(self._filled, self.outputs, _on_one_line(with_drawn_points(content, origin)), self.upstream())


def _on_one_line(value: Any) -> Any:
    """A table of figures with each text on one line, without control characters: names come from files."""
    if isinstance(value, Message):
        return Message(value.key, one_line(value))
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, Mapping):
        return {key: _on_one_line(item) for key, item in value.items()}
    return [_on_one_line(item) for item in value] if isinstance(value, list | tuple) else value
