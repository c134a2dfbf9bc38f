"""Reports of a computation on its way: what is being done, in which stage, how much of it is done."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum

from lamella.base.errors import InputError

# s without a line
LONGEST_SILENCE = 2.0


class Level(IntEnum):
    """How much a report matters: stages begin and end, steps within them, details of a step (Newton steps, say)."""

    STAGE = 0
    STEP = 1
    DETAIL = 2


@dataclass(frozen=True)
class Report:
    """What is being done, reported before it is done.

    Attributes
    ----------
    text : str
        One line.
    level : Level
    stage : str
        Name of the stage; empty outside of the stages of a project.
    fraction : float or None
        Share of the work under way that is done, 0 to 1, where it is known.
    refusal : InputError or None
        What will be refused, where that is known before a remedy is looked for, which may take seconds.
    """

    text: str
    level: Level = Level.STEP
    stage: str = ""
    fraction: float | None = None
    refusal: InputError | None = None

    @classmethod
    def heading(cls, text: str) -> Report:
        """That a stage begins."""
        return cls(text, Level.STAGE)

    @classmethod
    def step(cls, text: str, fraction: float | None = None) -> Report:
        """Of a step of a stage."""
        return cls(text, Level.STEP, fraction=fraction)

    @classmethod
    def detail(cls, text: str, fraction: float | None = None) -> Report:
        """Of a detail of a step."""
        return cls(text, Level.DETAIL, fraction=fraction)

    @classmethod
    def foreseen(cls, refusal: InputError) -> Report:
        """That something will be refused, and that a remedy is looked for."""
        return cls(f"looking for what there is instead: {refusal.message}", Level.DETAIL, refusal=refusal)

    def __str__(self) -> str:
        """The line on a screen, indented by its level."""
        return 2 * self.level * " " + self.text


Progress = Callable[[Report], None]
"""Receives each report; `print` will do. An exception it raises ends the computation (`cancelled_by`)."""


class Cancelled(Exception):
    """The computation was ended on request; nothing was written."""


def silent(report: Report) -> None:
    """Report to nobody."""


def in_stage(progress: Progress, stage: str) -> Progress:
    """The same receiver; reports carry the stage's name."""
    return lambda report: progress(replace(report, stage=stage))


def as_details(progress: Progress) -> Progress:
    """The same receiver; every report is a detail."""
    return lambda report: progress(replace(report, level=Level.DETAIL))


def cancelled_by(progress: Progress, is_cancelled: Callable[[], bool]) -> Progress:
    """The same receiver, which ends the computation at the next report once it is cancelled.

    Parameters
    ----------
    progress : callable
    is_cancelled : callable
        Asked at each report, between stages and inside them.

    Raises
    ------
    Cancelled
        By the returned receiver.
    """

    def receive(report: Report) -> None:
        if is_cancelled():
            raise Cancelled(f"cancelled at: {report.text}")
        progress(report)

    return receive


def patient(progress: Progress) -> Progress:
    """Details become steps where nothing was reported for two seconds."""
    last = time.monotonic()

    def receive(report: Report) -> None:
        nonlocal last
        now = time.monotonic()
        if report.level < Level.DETAIL:
            last = now
        elif now - last > LONGEST_SILENCE:
            last = now
            report = replace(report, level=Level.STEP)
        progress(report)

    return receive
