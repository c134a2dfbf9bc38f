"""Writing files whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
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
    write_all_whole({path: content})


def write_all_whole(files: Mapping[Path, bytes]) -> None:
    """The same for several files: none appears before all are on the disk."""
    parts = {path: path.with_name(f".{secrets.token_hex(6)}.part") for path in files}
    try:
        for path, content in files.items():
            parts[path].write_bytes(content)
        for path, part in parts.items():
            os.replace(part, path)
    except BaseException:
        for part in parts.values():
            part.unlink(missing_ok=True)
        raise
