"""Writing files whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterable, Mapping
from pathlib import Path

from lamella.base.errors import InputError


def write_whole(path: Path, content: bytes | Iterable[bytes]) -> None:
    """Write a file that appears complete or not at all; an older file of that name stays until then.

    Parameters
    ----------
    path : Path
        Where to write; its folder must exist.
    content : bytes or iterable of bytes
        All of the file, or its parts one after the other, which are made as they are written.

    Raises
    ------
    OSError
        If the content could not be written in full (disk full, size limit, missing rights).
    """
    write_all_whole({path: content})


def write_all_whole(files: Mapping[Path, bytes | Iterable[bytes]]) -> None:
    """The same for several files: none appears before all are on the disk."""
    parts = {path: path.with_name(f".{secrets.token_hex(6)}.part") for path in files}
    try:
        for path, content in files.items():
            with parts[path].open("wb") as file:
                file.writelines((content,) if isinstance(content, bytes) else content)
        for path, part in parts.items():
            os.replace(part, path)
    except BaseException:
        for part in parts.values():
            part.unlink(missing_ok=True)
        raise


def write_new_whole(files: Mapping[Path, bytes], remedy: str) -> None:
    """Write files that are not there yet; all of them, or none.

    Parameters
    ----------
    files : Path to bytes
        Written in this order.
    remedy : str
        Of the error about a file that is there.

    Raises
    ------
    InputError
        One of them is there already, even as a link that leads nowhere. It is as it was.
    OSError
        As `write_whole`.
    """
    made: list[Path] = []
    try:
        for path in files:
            if os.path.lexists(path):
                raise FileExistsError(path)
        for path, content in files.items():
            _write_new(path, content)
            made.append(path)
    except BaseException as error:
        for path in made:
            path.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            taken = error.filename or error.args[0]
            raise InputError(f"{taken} is there already", remedy) from None
        raise


def _write_new(path: Path, content: bytes) -> None:
    part = path.with_name(f".{secrets.token_hex(6)}.part")
    try:
        part.write_bytes(content)
        try:
            # unlike a change of name, a second name never takes the place of a file that came meanwhile
            os.link(part, path)
        except FileExistsError:
            raise FileExistsError(path) from None
        except OSError:
            # no second names on this file system
            with path.open("xb") as file:
                file.write(content)
    finally:
        part.unlink(missing_ok=True)
