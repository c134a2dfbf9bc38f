"""Outputs of stages that are kept: by the content of what decides them, so that nothing is computed twice."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

from lamella import __version__
from lamella.project.tables import Project

Made = TypeVar("Made")

KEPT = 6
"""Outputs of one stage that are kept, the latest ones: what a designer goes to and fro between."""


class Memory:
    """Outputs of stages by what decides them; pass one to several calls of `lamella.compute`.

    Parameters
    ----------
    follow : bool
        Whether the film of a changed boundary, H or volume, and the isothermic coordinates on it, follow from those
        before (`lamella.follow`), several times sooner: as good to the tolerance, but on other elements than those of a
        film found from nothing, and so other in the last digits. Files of runs never come of it.

    Examples
    --------
    >>> import lamella
    >>> memory = lamella.Memory()
    >>> table = {"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]}
    >>> for cells in (12, 16):
    ...     project = lamella.parse_project({"surface": table, "network": {"cells": cells}})
    ...     results = lamella.compute(project, until="network", memory=memory)
    """

    def __init__(self, *, follow: bool = False) -> None:
        self.follow = follow
        self._made: dict[str, OrderedDict[str, Any]] = {}
        self._last: dict[str, Any] = {}

    def __getstate__(self) -> dict[str, Any]:
        # pickles and copies begin empty: what is kept can be computed again
        return {"follow": self.follow, "_made": {}, "_last": {}}

    def __repr__(self) -> str:
        kept = ", ".join(f"{len(made)} of {name}" for name, made in self._made.items())
        return f"Memory({kept or 'empty'})"

    def remembered(self, name: str, key: str, make: Callable[[], Made]) -> Made:
        """What was made before with that key, or what is made now.

        Parameters
        ----------
        name : str
            Of a stage or a part of its output.
        key : str
            Of all values that decide it.
        make : callable
            Nothing is kept where it raises.
        """
        made = self._made.setdefault(name, OrderedDict())
        if key not in made:
            made[key] = make()
        made.move_to_end(key)
        while len(made) > KEPT:
            made.popitem(last=False)
        kept: Made = made[key]
        return kept

    def followed(self, name: str, advance: Callable[[Made | None], Made]) -> Made:
        """What follows from the last one of a name, and replaces it.

        Parameters
        ----------
        name : str
        advance : callable
            Makes it from the last one, None at first. Where it raises the last one stays.
        """
        made = advance(self._last.get(name))
        self._last[name] = made
        return made


def content_key(project: Project, reads: Iterable[str], needs: Iterable[str], folder: Path) -> str:
    """Hash of the values of some tables or keys, of the files they name, and of the keys of needed outputs.

    Parameters
    ----------
    project : Project
    reads : iterable of str
        Tables or keys: "network", "lamella.height".
    needs : iterable of str
        Keys of the outputs that are used.
    folder : Path
        Where files are looked for.
    """
    whole = project.model_dump(mode="json")
    hashed = hashlib.sha256(__version__.encode())
    for key in reads:
        value: Any = whole
        for name in key.split("."):
            value = value[name]
        hashed.update(repr((key, value)).encode())
        for file in _files(value):
            hashed.update(_content(folder / file))
    for key in needs:
        hashed.update(key.encode())
    return hashed.hexdigest()


def _files(value: Any) -> list[str]:
    """Names of files in a table."""
    if isinstance(value, dict):
        own = [value["file"]] if isinstance(value.get("file"), str) else []
        return own + [name for item in value.values() for name in _files(item)]
    return [name for item in value for name in _files(item)] if isinstance(value, list | tuple) else []


def _content(file: Path) -> bytes:
    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").digest()
    except OSError:
        # whoever reads it says what is wrong
        return b""
