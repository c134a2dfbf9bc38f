"""Tasks done on two processor cores: this process begins with the first ones, a copy of it with the last ones.

Writers hold Python's lock while they turn numbers into text, so threads would wait for each other. A copy of the
process (fork) shares what has been computed until someone changes it: nothing has to be sent. Where processes cannot be
copied safely (Windows, macOS, programs with threads of their own) tasks are done one after the other.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from pickle import PicklingError
from typing import Any

Task = Callable[[], object]


def run_side_by_side(tasks: Sequence[Task], begun: Callable[[int], None], *, alone: bool = False) -> float:
    """Do all tasks, in any order, each once.

    Parameters
    ----------
    tasks : sequence of callable
        Whatever they return is lost; they must not depend on each other.
    begun : callable
        Receives the number of each task that begins; what it raises ends all work.
    alone : bool
        Whether to do all of them here: where they are too small for a second process.

    Returns
    -------
    float
        CPU seconds of the other process.

    Raises
    ------
    Exception
        The first one of a task, wherever it was raised; no task is under way any more then.
    """
    if alone or not _can_fork():
        for number, task in enumerate(tasks):
            begun(number)
            task()
        return 0.0
    context = multiprocessing.get_context("fork")
    # first task that nobody has begun, and first one of those at the end that somebody has
    left = context.Array("i", [0, len(tasks)])
    here, there = context.Pipe(duplex=False)
    other = context.Process(target=_from_the_end, args=(tasks, left, there, os.getpid()), daemon=True)
    with warnings.catch_warnings():
        # Python's warning of threads counts those of libraries, which tasks leave alone
        warnings.simplefilter("ignore", DeprecationWarning)
        other.start()
    there.close()
    try:
        seconds = _from_the_front(tasks, left, here, begun)
    except BaseException:
        other.kill()
        raise
    finally:
        other.join()
        here.close()
    return seconds


def _can_fork() -> bool:
    cores = len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1
    return cores > 1 and threading.active_count() == 1 and not multiprocessing.current_process().daemon


def _next(left: Any, from_the_end: bool) -> int | None:
    """The next task from either end; None where all are begun."""
    with left.get_lock():
        first, end = left
        if first == end:
            return None
        if from_the_end:
            left[1] = end - 1
            return int(end - 1)
        left[0] = first + 1
        return int(first)


def _from_the_front(tasks: Sequence[Task], left: Any, here: Connection, begun: Callable[[int], None]) -> float:
    """Tasks from the first one on, until the other process has come near; its CPU seconds once it has done its own."""
    seconds = None
    while (number := _next(left, False)) is not None:
        begun(number)
        tasks[number]()
        while seconds is None and here.poll():
            seconds = _news(here, begun)
    while seconds is None:
        seconds = _news(here, begun)
    return seconds


def _news(here: Connection, begun: Callable[[int], None]) -> float | None:
    """What the other process reports: that it begins a task; its CPU seconds at the end; what went wrong."""
    try:
        news = here.recv()
    except EOFError:
        raise RuntimeError("a process that writes files was ended from outside (not enough memory?)") from None
    if isinstance(news, BaseException):
        raise news
    if isinstance(news, float):
        return news
    begun(news)
    return None


def _from_the_end(tasks: Sequence[Task], left: Any, there: Connection, parent: int) -> None:
    """What the other process does."""
    # an interrupt ends the parent, and that this process
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    start = time.process_time()
    try:
        while os.getppid() == parent and (number := _next(left, True)) is not None:
            there.send(number)
            tasks[number]()
        there.send(time.process_time() - start)
    except BaseException as error:
        try:
            there.send(error)
        except (TypeError, AttributeError, PicklingError):
            there.send(RuntimeError(f"{type(error).__name__}: {error}"))
