"""Telling a single file that this program wrote from others, by what stands in its first bytes."""

from __future__ import annotations

import os
import zlib
from pathlib import Path

HEAD_BYTES = 65_536
PNG = b"\x89PNG\r\n\x1a\n"
_HEADER_CHUNK = 25
_SIGNED = b"tEXtSoftware\0lamella"


def is_ours(path: Path) -> bool:
    """Whether a result of `lamella optimise` may take a path: nothing is there, or an earlier result.

    Other programs write a head of their own, so that a result that was opened and saved there is not one any more.
    """
    if not os.path.lexists(path):
        return True
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    if not head:
        return True
    match path.suffix.lower():
        case ".obj":
            return head.startswith(b"# lamella ")
        case ".ply":
            return b", lamella " in head.partition(b"end_header")[0]
        case ".3dm":
            return head.startswith(b"3D Geometry File Format") and _utf16("lamella ") in head
        case ".json":
            return head.startswith(b'{"lamella":"') or b'"schema": "lamella/optimise/' in head[:80]
        case ".png":
            return head.startswith(PNG) and _SIGNED in head[: len(PNG) + _HEADER_CHUNK + 64]
    return False


def signed_png(picture: bytes) -> bytes:
    """A picture with the program's name in its first text."""
    start = len(PNG) + _HEADER_CHUNK
    chunk = (len(_SIGNED) - 4).to_bytes(4, "big") + _SIGNED + zlib.crc32(_SIGNED).to_bytes(4, "big")
    return picture[:start] + chunk + picture[start:]


def _utf16(text: str) -> bytes:
    return text.encode("utf-16-le")
