"""One design at work: the project's text and its history, what was computed of it, and who wants to know."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from lamella.base.errors import InputError
from lamella.interactive.edits import Design, edited
from lamella.interactive.fields import fields_of
from lamella.interactive.frame import Frame
from lamella.interactive.history import History
from lamella.interactive.project_file import ProjectFile, unmarked_text
from lamella.interactive.project_folder import new_name, refuse_outside
from lamella.interactive.run_child import RunChild
from lamella.project.read import line_of
from lamella.stages.results import Results

# of the surface while nothing is drawn yet, m
UNKNOWN_SIZE = 10.0


@dataclass(frozen=True)
class Shown:
    """A frame with the text it is of."""

    number: int
    revision: int
    text: str
    frame: Frame
    seconds: float


@dataclass(frozen=True)
class Problem:
    """Why there is nothing new to show: of the text, or of the surface it asks for."""

    message: str
    remedy: str
    where: str
    line: int

    @classmethod
    def of(cls, error: InputError, text: str) -> Problem:
        """Of an error, with the line of its key."""
        key = error.where.rpartition(": ")[2]
        line = line_of(text, key) if key else 0
        place = error.where.partition(": ")[0].rpartition(":")[2]
        return cls(error.message, error.remedy, key, line or (int(place) if place.isdigit() else 0))

    def record(self) -> dict[str, Any]:
        """For the page."""
        return {"message": self.message, "remedy": self.remedy, "where": self.where, "line": self.line}


@dataclass(frozen=True)
class Numbers:
    """How often parts of a session have changed: who has seen these numbers has seen all."""

    state: int = 0
    frame: int = 0
    pinned: int = 0
    status: int = 0


class Session:
    """A design that pages share.

    All that is public takes the lock; `changed` is notified whenever `numbers` grow.

    Parameters
    ----------
    path : Path
        Of the project file.
    text : str, optional
        Of a project that is not saved yet.
    """

    def __init__(self, path: Path, text: str | None = None) -> None:
        self.changed = threading.Condition(threading.RLock())
        self.file = ProjectFile(path, is_new=text is not None)
        self.history = History(self.file.saved if text is None else text)  # type: ignore[arg-type]
        self.left = self.file.kept()
        self.numbers = Numbers()
        self.revision = 0
        self.draft: str | None = None
        self.design: Design | None = None
        self.problem: Problem | None = None
        self.refused: Problem | None = None
        self.shown: Shown | None = None
        self.before: Mapping[str, float] = {}
        self.last_exact: Shown | None = None
        self.pinned: Shown | None = None
        self.results: Results | None = None
        self.busy: tuple[str, float | None] | None = None
        self.run: RunChild | None = None
        self.closing = False
        self._taken(self.history.text)

    @property
    def folder(self) -> Path:
        """The project's."""
        return self.file.path.parent

    @property
    def text(self) -> str:
        """Of the project, with what is being dragged."""
        return self.history.text if self.draft is None else self.draft

    # ---------------------------------------------------------------------------------------- what pages do

    def edit(self, edit: Mapping[str, Any], *, draft: bool = False) -> None:
        """Change the text; while something is dragged it goes into the history only when it is let go.

        Parameters
        ----------
        edit : mapping
            See `lamella.interactive.edits.edited`.
        draft : bool
            Whether the change is one of a drag that goes on.

        Raises
        ------
        InputError
            The edit cannot be: the text is as it was.
        """
        with self.changed:
            design = self._design_of(self.history.text)
            text = edited(design, edit)
            # what a value may not be is refused before it is written
            self._design_of(text)
            self._go(text, draft=draft)

    def write(self, text: str) -> None:
        """Put in a text as it was typed, with whatever is wrong with it."""
        with self.changed:
            if "\r\n" in self.history.text:
                text = text.replace("\r\n", "\n").replace("\n", "\r\n")
            self._go(text)

    def undo(self, *, redo: bool = False) -> None:
        """Back or forth by one text."""
        with self.changed:
            self.draft = None
            self.history.redo() if redo else self.history.undo()
            self._changed_text()

    def drop_draft(self) -> None:
        """What is being dragged goes back to where it was."""
        with self.changed:
            if self.draft is not None:
                self.draft = None
                self._changed_text()

    def save(self, name: str | None = None, *, anyway: bool = False) -> None:
        """Write the project file, or one of another name beside it.

        Raises
        ------
        InputError
        """
        with self.changed:
            if name is not None and name != self.file.path.name:
                path = new_name(name, self.folder)
                if path.exists() and not anyway:
                    raise InputError(f"{path.name} is there already", "choose another name, or save anyway", "changed")
                self.file.autosave.unlink(missing_ok=True)
                self.file = ProjectFile(path, is_new=True)
            self.file.save(self.history.text, anyway=anyway or name is not None)
            self.left = None
            self._grow(state=1)

    def restore(self, *, drop: bool = False) -> None:
        """Take over what an earlier session left unsaved, or forget it."""
        with self.changed:
            left, self.left = self.left, None
            if left is not None and not drop:
                self._go(left)
            else:
                self.file.keep(self.history.text)
                self._grow(state=1)

    def pin(self, what: str) -> None:
        """Keep the present state to compare with, "drop" it, or go "back" to it."""
        with self.changed:
            if what == "back" and self.pinned is not None:
                self._go(self.pinned.text)
            else:
                self.pinned = None if what == "drop" else self.last_exact or self.shown
                self._grow(pinned=1, state=1)

    def start_run(self) -> None:
        """Save, and run the project as a process of its own.

        Raises
        ------
        InputError
        """
        with self.changed:
            if self.run is not None and self.run.is_running:
                raise InputError("a run is going on already", "wait for it, or cancel it")
            self._design_of(self.history.text)
            self.save()
            self.run = RunChild(self.file.path, self.told)
            self._grow(status=1)

    def cancel_run(self) -> None:
        """End the run."""
        with self.changed:
            if self.run is not None:
                self.run.cancel()

    # ---------------------------------------------------------------------------------------- what is computed

    def told(self) -> None:
        """Something beside text and frames has changed."""
        with self.changed:
            self._grow(status=1)

    def put_busy(self, revision: int, text: str | None, fraction: float | None = None) -> None:
        """What is being computed of a revision; None: nothing."""
        with self.changed:
            if text is None or revision == self.revision:
                self.busy = None if text is None else (text, fraction)
                self._grow(status=1)

    def put_frame(self, revision: int, text: str, frame: Frame, seconds: float, results: Results | None) -> None:
        """A frame that was computed."""
        with self.changed:
            self.shown = Shown(self.numbers.frame + 1, revision, text, frame, seconds)
            if results is not None:
                self.results = results
                if self.last_exact is not None and self.last_exact.text != text:
                    self.before = self.last_exact.frame.figures
                self.last_exact = self.shown
            if revision == self.revision:
                self.problem = None
            self._grow(frame=1, status=1, state=1 if results is not None else 0)

    def put_problem(self, revision: int, error: InputError) -> None:
        """Why there is no frame of a revision."""
        with self.changed:
            if revision == self.revision:
                self.problem = Problem.of(error, self.text)
                self._grow(status=1)

    def close(self) -> None:
        """End all that goes on."""
        with self.changed:
            self.closing = True
            run = self.run
            self._grow(status=1)
        if run is not None:
            run.close()

    # ---------------------------------------------------------------------------------------- what pages are told

    def state(self) -> dict[str, Any]:
        """The text and what follows from it, for the page."""
        with self.changed:
            design, size = self.design, UNKNOWN_SIZE if self.shown is None else self.shown.frame.size
            fields = fields_of(design.project, design.values, design.handles, size) if design else []
            return {
                "type": "state",
                "revision": self.revision,
                "text": unmarked_text(self.text),
                "is_draft": self.draft is not None,
                "file": self.file.path.name,
                "name": design.project.name if design else self.file.path.stem,
                "kind": design.project.surface.kind if design else "",
                "saved": self.history.text == self.file.saved,
                "can_undo": self.history.can_undo,
                "can_redo": self.history.can_redo,
                "left": self.left is not None,
                "handles": [handle.record() for handle in design.handles] if design else [],
                "loops": _loops(design),
                "fields": fields,
                "before": dict(self.before),
                "pinned": None if self.pinned is None else dict(self.pinned.frame.figures),
            }

    def status(self) -> dict[str, Any]:
        """What goes on, for the page."""
        with self.changed:
            return {
                "type": "status",
                "revision": self.revision,
                "busy": None if self.busy is None else {"text": self.busy[0], "fraction": self.busy[1]},
                "problem": None if self.problem is None else self.problem.record(),
                "run": None if self.run is None else self.run.record(),
                "closing": self.closing,
            }

    # ---------------------------------------------------------------------------------------- inside

    def _design_of(self, text: str) -> Design:
        design = Design.of(unmarked_text(text), self.file.path)
        refuse_outside(design.project, self.folder)
        return design

    def _go(self, text: str, *, draft: bool = False) -> None:
        if draft:
            self.draft = text
        else:
            self.draft = None
            self.history.put(text)
        self._changed_text()

    def _changed_text(self) -> None:
        self.revision += 1
        self._taken(self.text)
        if self.draft is None and self.left is None:
            self.file.keep(self.history.text)
        self._grow(state=1, status=1)

    def _taken(self, text: str) -> None:
        """What the text means, or what is wrong with it: what it meant before stays."""
        try:
            self.design = self._design_of(text)
        except InputError as error:
            self.problem = Problem.of(error, unmarked_text(text))
        else:
            self.problem = None

    def _grow(self, **by: int) -> None:
        self.numbers = replace(self.numbers, **{name: getattr(self.numbers, name) + more for name, more in by.items()})
        self.changed.notify_all()


def _loops(design: Design | None) -> list[dict[str, Any]]:
    """Names of the loops, and how their handles are joined, for the page."""
    if design is None:
        return []
    return [
        {
            "name": loop.name,
            "shape": next(key for key in ("points", "circle", "file", "part") if getattr(loop, key) is not None),
            "interpolation": loop.interpolation,
        }
        for loop in getattr(design.project.surface, "boundary", ())
    ]
