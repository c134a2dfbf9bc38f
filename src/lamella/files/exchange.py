"""Two folders change names in one step, where the system can do that."""

from __future__ import annotations

import ctypes
import errno
import os
import sys
from pathlib import Path

AT_FDCWD = -100
RENAME_EXCHANGE = 2  # linux/fs.h
RENAME_SWAP = 2  # sys/stdio.h of macOS

_UNSUPPORTED = {errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP}


def exchange(one: Path, other: Path) -> bool:
    """Give two folders each other's name, atomically.

    Returns
    -------
    bool
        False if system or file system cannot do it; nothing has been changed then.

    Raises
    ------
    OSError
        If it failed for another reason, one of the two missing for instance.
    """
    source, destination = os.fsencode(one), os.fsencode(other)
    try:
        if sys.platform == "linux":
            libc = ctypes.CDLL(None, use_errno=True)
            failed = libc.renameat2(AT_FDCWD, source, AT_FDCWD, destination, ctypes.c_uint(RENAME_EXCHANGE))
        elif sys.platform == "darwin":
            libc = ctypes.CDLL(None, use_errno=True)
            failed = libc.renamex_np(source, destination, ctypes.c_uint(RENAME_SWAP))
        else:
            return False
    except AttributeError:  # a C library older than the system call
        return False
    if not failed:
        return True
    code = ctypes.get_errno()
    if code in _UNSUPPORTED:
        return False
    raise OSError(code, os.strerror(code), str(one), None, str(other))
