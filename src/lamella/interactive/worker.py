"""Computes frames of the newest text, in a thread of its own: newest wins, what is out of date is given up."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from lamella.base.errors import InputError
from lamella.base.progress import Cancelled, Level, Progress, Report, cancelled_by
from lamella.interactive.edits import Design
from lamella.interactive.exact_frame import exact_frame, exact_results
from lamella.interactive.frame import Frame
from lamella.interactive.one_at_a_time import computing
from lamella.interactive.session import Session
from lamella.interactive.warm_frame import WarmFrames
from lamella.stages.memory import Memory

# s that a frame of a drag may take before a newer one is begun instead: films found anew take about one
PATIENCE = 1.5


class Worker:
    """The thread; it ends with its session.

    A text that is being dragged has a coarse frame. One that was let go has a coarse frame at once and then the exact
    one, which is given up as soon as the text changes.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._warm, self._memory = WarmFrames(), Memory()
        self._thread = threading.Thread(target=self._work, name="lamella frames", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def join(self, seconds: float) -> bool:
        """Wait for the end; whether it came."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def _work(self) -> None:
        session, done = self.session, -1
        while True:
            with session.changed:
                session.changed.wait_for(partial(self._has_work, done))
                if session.closing:
                    return
                revision, design, draft = session.revision, session.design, session.draft is not None
                wrong = session.problem is not None
            done = revision
            # what is wrong with the text itself is told already
            if design is not None and not wrong:
                self._frames(revision, design, draft)

    def _has_work(self, done: int) -> bool:
        return self.session.closing or self.session.revision != done

    def _frames(self, revision: int, design: Design, draft: bool) -> None:
        session = self.session
        try:
            with computing:
                self._compute(revision, design, draft)
        except Cancelled:
            return
        except InputError as error:
            session.put_problem(revision, error)
        except MemoryError:
            session.put_problem(revision, InputError("not enough memory", "choose fewer cells"))
        except Exception as error:
            # a page must not stand still for ever: what a program's fault is, is told too
            session.put_problem(revision, InputError(f"{type(error).__name__}: {error}", "go back by one step"))
            raise
        finally:
            session.put_busy(revision, None)

    def _compute(self, revision: int, design: Design, draft: bool) -> None:
        closing = None
        if draft or self._warm.serves(design.project):
            closing = self._coarse(revision, design, draft).details
        if not draft:
            self._exact(revision, design, closing)

    def _coarse(self, revision: int, design: Design, draft: bool) -> Frame:
        begun = time.monotonic()
        progress = self._reporting(revision, lambda: time.monotonic() - begun > PATIENCE, draft)
        if self._warm.serves(design.project):
            frame = self._warm.frame(design.project, self.session.folder, progress)
        else:
            folder = self.session.folder
            exact = exact_frame(exact_results(design.project, folder, self._memory, progress, parts=False))
            # without the parts, which come when it is let go
            frame = replace(exact, level="coarse")
        self.session.put_frame(revision, design.text, frame, time.monotonic() - begun, None)
        return frame

    def _exact(self, revision: int, design: Design, closing: Mapping[str, Any] | None) -> None:
        begun = time.monotonic()
        progress = self._reporting(revision, lambda: True)
        results = exact_results(design.project, self.session.folder, self._memory, progress)
        frame = exact_frame(results, closing)
        self.session.put_frame(revision, design.text, frame, time.monotonic() - begun, results)

    def _reporting(self, revision: int, may_end: Callable[[], bool], draft: bool = False) -> Progress:
        session = self.session

        def is_cancelled() -> bool:
            return session.closing or (session.revision != revision and may_end())

        def told(report: Report) -> None:
            if report.refusal is not None:
                # while something is dragged nobody waits for a remedy
                if draft:
                    raise report.refusal
                session.put_problem(revision, report.refusal)
            if report.level < Level.DETAIL:
                session.put_busy(revision, report.text, report.fraction)

        return cancelled_by(told, is_cancelled)
