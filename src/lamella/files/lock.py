"""A lock on a folder that the system lets go of when its holder dies, however it dies."""

from __future__ import annotations

import os
import sys
from pathlib import Path

if sys.platform != "win32":
    import fcntl


def lock_folder(folder: Path, *, wait: bool = True) -> int | None:
    """Lock a folder; the lock follows it when it is renamed.

    Parameters
    ----------
    folder : Path
        The folder.
    wait : bool, optional
        Whether to wait for another holder to let go.

    Returns
    -------
    int or None
        To be given to `unlock_folder`; None if the folder is locked by another, gone, or cannot be locked at
        all (Windows, some network file systems).
    """
    if sys.platform == "win32":
        return None
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def unlock_folder(lock: int | None) -> None:
    """Let go of a lock."""
    if lock is not None:
        os.close(lock)
