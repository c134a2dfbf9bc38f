"""Lines of progress while something takes long, and how long it took."""

from __future__ import annotations

import time
from collections.abc import Callable

Progress = Callable[[str], None]
"""Is told what is being done, a line at a time; details are indented by four spaces."""

# s without a line
LONG = 2.0


def silent(message: str) -> None:
    """Tell nobody."""


def patient(progress: Progress) -> Progress:
    """Details, which begin with four spaces, become lines of their own where none was told for two seconds."""
    told = time.monotonic()

    def tell(message: str) -> None:
        nonlocal told
        now = time.monotonic()
        if not message.startswith("    "):
            told = now
        elif now - told > LONG:
            told = now
            message = message[2:]
        progress(message)

    return tell


class Clock:
    """CPU seconds of each stage."""

    def __init__(self, progress: Progress) -> None:
        self.seconds: dict[str, float] = {}
        self.progress, self._start = progress, 0.0

    def start(self, message: str) -> None:
        """Say what begins."""
        self.progress(message)
        self._start = time.process_time()

    def stop(self, stage: str, result: str) -> None:
        """Say what has come out of it."""
        self.seconds[stage] = round(time.process_time() - self._start, 4)
        self.progress(f"  {result} ({self.seconds[stage]:.2f} s)")
