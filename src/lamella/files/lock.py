"""A lock on a folder that is being filled, which the system lets go of when its holder dies, however it dies.

POSIX locks the folder itself, and the lock follows it when it is renamed. Windows locks no folders; there the holder
keeps a file in it open, which nobody can rename or remove as long as it is, nor the folder.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

if sys.platform != "win32":
    import fcntl


def lock_folder(folder: Path, mark: Path, *, wait: bool = True) -> int | None:
    """Lock a folder.

    Parameters
    ----------
    folder : Path
        The folder.
    mark : Path
        The file in it that is kept open on Windows.
    wait : bool, optional
        Whether the lock is one's own, of a folder just made: waits for another holder to let go, and makes the mark on
        Windows. Otherwise only what is free is locked.

    Returns
    -------
    int or None
        To be given to `unlock_folder`; None if the folder is locked by another, gone, or cannot be locked at
        all (some network file systems).
    """
    if on_windows():
        return _opened(mark, make=wait)
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


def let_go_to_move(lock: int | None) -> int | None:
    """Let go of a lock where it is in the way of renaming or removing the folder; returns what is left of it."""
    if not on_windows():
        return lock
    unlock_folder(lock)
    return None


def on_windows() -> bool:
    """Whether the system locks no folders, and renames nothing that is open."""
    return os.name == "nt"


def _opened(mark: Path, *, make: bool) -> int | None:
    try:
        if not make:
            # to its own name: changes nothing, and fails for a file that is open
            os.rename(mark, mark)
        return os.open(mark, os.O_RDWR | (os.O_CREAT if make else 0))
    except OSError:
        return None
