"""CPU seconds of each stage, with what begins and what came out of it."""

from __future__ import annotations

import time

from lamella.base.progress import Progress, Report, in_stage


class Clock:
    """The time of the stages of one computation.

    Attributes
    ----------
    seconds : dict
        CPU seconds by stage.
    progress : callable
        Receives what begins and what came out of it.
    """

    def __init__(self, progress: Progress) -> None:
        self.seconds: dict[str, float] = {}
        self._receiver = self.progress = progress
        self._start = 0.0

    def start(self, stage: str, text: str) -> None:
        """A stage begins; reports until it ends are its own."""
        self.progress = in_stage(self._receiver, stage)
        self.progress(Report.heading(f"{stage}: {text}"))
        self._start = time.process_time()

    def stop(self, stage: str, result: str) -> None:
        """A stage has ended with this result."""
        self.seconds[stage] = round(time.process_time() - self._start, 4)
        self.progress(Report.step(f"{result} ({self.seconds[stage]:.2f} s)"))
        self.progress = self._receiver
