"""Curves found in a file, and the choice of the one that is meant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.errors import InputError
from lamella.surface.boundary.course import Course
from lamella.surface.boundary.joining import GAP_LIMIT, find_chains
from lamella.surface.boundary.pieces import Pieces
from lamella.wording import cut

_MOST_LISTED = 6
_MOST_WORD = 36


@dataclass(frozen=True, eq=False)
class FileCurve:
    """A curve as a file holds it.

    Attributes
    ----------
    layer : str
        Full name of its layer; "" where the format has none.
    ids : tuple of str
        What it answers to: object name, handle.
    kind : str
        In the format's words.
    pieces : Pieces
        In the file's unit.
    """

    layer: str
    ids: tuple[str, ...]
    kind: str
    pieces: Pieces

    @property
    def closed(self) -> bool:
        """Whether it ends where it begins."""
        gap = np.linalg.norm(self.pieces.ends[-1] - self.pieces.starts[0])
        return bool(gap <= GAP_LIMIT * self.pieces.extent)

    def on(self, layer: str) -> bool:
        """Whether a layer's name, or the last part of its full name, is meant; without regard to case."""
        full = self.layer.lower()
        return layer.lower() in (full, full.rpartition("::")[2])

    def answers_to(self, name: str) -> bool:
        """Whether an id is meant."""
        return name.lower() in (word.lower() for word in self.ids)


@dataclass(frozen=True, eq=False)
class _Candidate:
    told: str
    pieces: Pieces


def choose_loop(curves: Sequence[FileCurve], layer: str | None, name: str | None, where: str, unit: float) -> Pieces:
    """The one closed curve, or closed chain of open curves, with the layer and id asked for.

    Parameters
    ----------
    curves : sequence of FileCurve
        All of a file.
    layer, name : str or None
        Asked for; None: any.
    where : str
        Key for messages.
    unit : float
        Metres per unit of the file.

    Raises
    ------
    InputError
        None or several; what there is is listed.
    """
    asked = " and ".join(
        f"{key} {cut(value, _MOST_WORD)!r}" for key, value in (("layer", layer), ("id", name)) if value is not None
    )
    matching = [
        curve
        for curve in curves
        if (layer is None or curve.on(layer)) and (name is None or curve.answers_to(name)) and curve.pieces.extent > 0
    ]
    closed = [_Candidate(_told(c, unit), _shut(c.pieces)) for c in matching if c.closed]
    opened = [c for c in matching if not c.closed]
    candidates = closed + _chained(opened, unit)
    if len(candidates) == 1:
        return candidates[0].pieces
    if candidates:
        raise InputError(
            f"{len(candidates)} closed curves{' with ' + asked if asked else ''}: "
            + _listed([c.told for c in candidates]),
            "name one of them with layer = ... or id = ...",
            where,
        )
    if matching:
        raise InputError(
            f"no closed curve{' with ' + asked if asked else ''}, and the open ones do not join to one: "
            + _listed([_told(c, unit) for c in matching]),
            f"close it: ends have to meet within {GAP_LIMIT:g} of the size, two at each place",
            where,
        )
    there = _listed([_told(c, unit) for c in curves]) if curves else "it holds no curves"
    missing = f"no curve with {asked}" if asked else "no curve"
    raise InputError(f"{missing}; {there}", "name a closed curve that is there", where)


def _chained(opened: Sequence[FileCurve], unit: float) -> list[_Candidate]:
    found = []
    for layer in sorted({curve.layer for curve in opened}):
        on_it = [curve for curve in opened if curve.layer == layer]
        for chain in find_chains([curve.pieces for curve in on_it]):
            first = on_it[chain.members[0]]
            told = _words(first, f"chain of {len(chain.members)}", chain.pieces, unit, "closed")
            found.append(_Candidate(told, chain.pieces))
    return found


def _shut(pieces: Pieces) -> Pieces:
    meeting = (pieces.starts[0] + pieces.ends[-1]) / 2
    return pieces.from_to(meeting, meeting)


def _told(curve: FileCurve, unit: float) -> str:
    return _words(curve, curve.kind, curve.pieces, unit, "closed" if curve.closed else "open")


def _words(curve: FileCurve, kind: str, pieces: Pieces, unit: float, state: str) -> str:
    name = next((word for word in curve.ids if word), "")
    parts = [f"layer {cut(curve.layer, _MOST_WORD)!r}"] if curve.layer else []
    parts += [f"id {cut(name, _MOST_WORD)!r}"] if name else []
    length = Course(pieces).length * unit if pieces.extent > 0 else 0.0
    return " ".join([*parts, f"({kind}, {length:.4g} m, {state})"])


def _listed(told: Sequence[str]) -> str:
    more = len(told) - _MOST_LISTED
    return "; ".join(told[:_MOST_LISTED]) + (f"; and {more} more" if more > 0 else "")
