"""Lines of progress while something takes long."""

from __future__ import annotations

import time
from collections.abc import Callable

# s without a line
LONG = 2.0


def patient(progress: Callable[[str], None]) -> Callable[[str], None]:
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
