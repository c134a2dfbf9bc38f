"""Lines of progress while something takes long."""

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
