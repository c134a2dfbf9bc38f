"""Opening a DXF drawing: whatever is wrong with it ends in one message."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lamella.base.errors import InputError
from lamella.base.wording import cut

SAVE_AGAIN = "open it in CAD, run its AUDIT or RECOVER command and save it again"


def open_dxf(path: Path, where: str) -> Any:
    """The drawing of a file, as the library's recovering reader has it, which decodes its names too.

    Raises
    ------
    InputError
        No DXF file, or a damaged one.
    """
    from ezdxf import recover

    if b"ENTITIES" not in path.read_bytes():
        # the recovering reader makes an empty drawing of anything
        raise InputError(f"{path} cannot be read as DXF: it has no section ENTITIES", SAVE_AGAIN, where)
    with dxf_damage(str(path), where):
        return recover.readfile(path)[0]


@contextlib.contextmanager
def dxf_damage(about: str, where: str) -> Iterator[None]:
    """Turn whatever the DXF library raises on damaged content into one `InputError`.

    The library checks little of what it reads: wrong group codes, numbers and structures come out as errors of any
    kind (KeyError, IndexError, RuntimeError, OverflowError, ...), at loading or when an entity is looked at.

    Parameters
    ----------
    about : str
        What is being read: the file, or an entity of it.
    where : str
        Key for messages.
    """
    try:
        yield
    except (InputError, MemoryError):
        raise
    except Exception as error:
        reason = cut(str(error) or type(error).__name__, 120)
        raise InputError(f"{about} cannot be read as DXF: {reason}", SAVE_AGAIN, where) from None
