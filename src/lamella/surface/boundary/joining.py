"""Open curves joined end to end: in the order given, or in the order their ends tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.errors import InputError
from lamella.surface.boundary.curve import place
from lamella.surface.boundary.pieces import Pieces, stack

GAP_LIMIT = 1e-6
"""Of the size of all curves together: ends nearer than this are one point."""


def join_in_order(parts: Sequence[Pieces], names: Sequence[str], where: str) -> Pieces:
    """One closed curve of parts that follow each other; ends within `GAP_LIMIT` are moved onto each other.

    Raises
    ------
    InputError
        A gap, with the names of both parts.
    """
    size = stack(parts).extent
    starts = np.array([part.starts[0] for part in parts])
    ends = np.array([part.ends[-1] for part in parts])
    after = np.roll(starts, -1, axis=0)
    gaps = np.linalg.norm(after - ends, axis=1)
    if gaps.max() > GAP_LIMIT * size:
        k = int(np.argmax(gaps > GAP_LIMIT * size))
        following = (k + 1) % len(parts)
        if len(parts) == 1:
            told = f"{names[k]} is not closed: its end {place(ends[k])} is {gaps[k]:.4g} m from its beginning"
        else:
            told = f"{names[k]} ends at {place(ends[k])}, {gaps[k]:.4g} m from where {names[following]} begins"
        raise InputError(
            f"{told}, {place(after[k])} (limit {GAP_LIMIT * size:.2g} m)",
            "join the parts end to end, in order and the last one with the first",
            where,
        )
    meeting = (ends + after) / 2
    return stack([part.from_to(meeting[k - 1], meeting[k]) for k, part in enumerate(parts)])


@dataclass(frozen=True)
class Chain:
    """A closed curve found among open ones.

    Attributes
    ----------
    members : tuple of int
        Indices of the curves, in order.
    pieces : Pieces
    """

    members: tuple[int, ...]
    pieces: Pieces


def find_chains(curves: Sequence[Pieces]) -> list[Chain]:
    """All closed chains of open curves; an end where three or more curves meet belongs to none.

    Parameters
    ----------
    curves : sequence of Pieces
        Each from its start to its end, in any order and direction.
    """
    if not curves:
        return []
    limit = GAP_LIMIT * stack(curves).extent
    # row 2 k is the start of curve k, row 2 k + 1 its end
    ends = np.concatenate([[curve.starts[0], curve.ends[-1]] for curve in curves])
    near = cKDTree(ends).query_ball_point(ends, limit)
    partner = {i: next(j for j in found if j != i) for i, found in enumerate(near) if len(found) == 2}
    chains, used = [], set[int]()
    for first in range(len(curves)):
        members: list[tuple[int, bool]] = []
        at = 2 * first
        while at // 2 not in used and at ^ 1 in partner:
            used.add(at // 2)
            members.append((at // 2, at % 2 == 1))
            at = partner[at ^ 1]
        if not members or at != 2 * first:
            continue
        parts = [curves[k].reversed() if backwards else curves[k] for k, backwards in members]
        pieces = join_in_order(parts, [""] * len(parts), "")
        chains.append(Chain(tuple(k for k, _ in members), pieces))
    return chains
