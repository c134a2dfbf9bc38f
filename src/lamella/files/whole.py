"""Writing one file whole or not at all."""

from __future__ import annotations

import os
import secrets
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Write a file that appears complete or not at all; an older file of that name stays until then.

    Parameters
    ----------
    path : Path
        Where to write; its folder must exist.
    content : bytes
        All of the file.

    Raises
    ------
    OSError
        If the content could not be written in full (disk full, size limit, missing rights).
    """
    part = path.with_name(f".{secrets.token_hex(6)}.part")
    try:
        part.write_bytes(content)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
