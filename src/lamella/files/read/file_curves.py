"""What a curve file holds, whatever its format."""

from __future__ import annotations

import unicodedata
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lamella.base.errors import InputError
from lamella.surface.boundary.pieces import Pieces

MOST_NESTED, MOST_INSTANCES, MOST_CURVES = 16, 20_000, 100_000
"""Blocks within blocks, block instances and curves of a file: more are a mistake, and would take for ever."""


@dataclass(frozen=True, eq=False)
class FileCurve:
    """A curve as a file holds it.

    Attributes
    ----------
    layer : str
        Full name of its layer; "" where the format has none.
    ids : tuple of str
        What it answers to: object name, handle; the first one is unique in the file where it can be.
    kind : str
        In the format's words.
    pieces : Pieces
        In the file's unit.
    hidden : str
        Why it is not seen, "its layer is frozen"; "": it is seen.
    edge : bool
        Whether it is the edge of a surface or solid, which is meant only when named.
    """

    layer: str
    ids: tuple[str, ...]
    kind: str
    pieces: Pieces
    hidden: str = ""
    edge: bool = False

    def closed(self, limit: float) -> bool:
        """Whether it ends within that of where it begins."""
        gap = np.linalg.norm(self.pieces.ends[-1] - self.pieces.starts[0])
        return bool(gap <= limit) and self.pieces.extent > 2 * limit

    def on(self, layer: str) -> bool:
        """Whether a layer's name, or the last part of its full name, is meant; without regard to case."""
        full = _bare(self.layer)
        return _bare(layer) in (full, full.rpartition("::")[2])

    def answers_to(self, name: str) -> bool:
        """Whether an id is meant."""
        return _bare(name) in (_bare(word) for word in self.ids)

    def begins_with(self, name: str) -> bool:
        """Whether an id begins like this."""
        return any(_bare(word).startswith(_bare(name)) for word in self.ids)


@dataclass(frozen=True, eq=False)
class CurveFile:
    """What a file holds.

    Attributes
    ----------
    curves : tuple of FileCurve
    metres_per_unit : float or None
        As the file says; None: it does not.
    tolerance : float or None
        Within which its curves are meant to meet, in its unit; None: it does not say.
    others : mapping of str to int
        What else it holds, by its name in the trade ("3DFACE", "paper space curve"), with counts.
    """

    curves: tuple[FileCurve, ...]
    metres_per_unit: float | None
    tolerance: float | None = None
    others: Mapping[str, int] = field(default_factory=Counter[str])


class Gathering:
    """What has been found in a file so far.

    Attributes
    ----------
    curves : list of FileCurve
    others : Counter of str
        As in `CurveFile`.
    """

    def __init__(self, path: Path, where: str) -> None:
        self.path, self.where = path, where
        self.curves: list[FileCurve] = []
        self.others: Counter[str] = Counter()
        self._instances = 0

    def put(self, curve: FileCurve) -> None:
        """Add a curve; one with impossible numbers is only counted.

        Raises
        ------
        InputError
            There are `MOST_CURVES` already.
        """
        if not curve.pieces.sound:
            self.others["curve with impossible numbers"] += 1
            return
        if len(self.curves) >= MOST_CURVES:
            raise self._too_many(f"{MOST_CURVES:,} curves")
        self.curves.append(curve)

    def count_instance(self) -> None:
        """Count an instance of a block.

        Raises
        ------
        InputError
            There are `MOST_INSTANCES` already.
        """
        self._instances += 1
        if self._instances > MOST_INSTANCES:
            raise self._too_many(f"{MOST_INSTANCES:,} block instances")

    def _too_many(self, limit: str) -> InputError:
        return InputError(f"{self.path} holds more than {limit}", "save the boundary alone", self.where)


def _bare(name: str) -> str:
    """A name as it is compared: without case, letters with accents in one form."""
    return unicodedata.normalize("NFC", name).casefold().strip()
