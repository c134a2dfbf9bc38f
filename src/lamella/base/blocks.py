"""Long arrays worked on a block at a time, so that what comes up on the way stays in the processor's cache."""

from __future__ import annotations

from collections.abc import Iterator

BLOCK = 8000


def blocks(count: int, size: int = BLOCK) -> Iterator[slice]:
    """Slices of `size` that cover so many rows."""
    for start in range(0, count, size):
        yield slice(start, min(start + size, count))
