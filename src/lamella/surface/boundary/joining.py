"""Open curves joined end to end: in the order given, or in the order their ends tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
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
            reported = f"{names[k]} is not closed: its end {place(ends[k])} is {gaps[k]:.4g} m from its beginning"
        else:
            reported = f"{names[k]} ends at {place(ends[k])}, {gaps[k]:.4g} m from where {names[following]} begins"
        raise InputError(
            f"{reported}, {place(after[k])} (limit {GAP_LIMIT * size:.2g} m)",
            "join the parts end to end, in order and the last one with the first",
            where,
        )
    return stack(_met(parts, closed=True))


@dataclass(frozen=True, eq=False)
class Chain:
    """Curves that follow one another.

    Attributes
    ----------
    members : tuple of int
        Indices of the curves, in order.
    pieces : Pieces
        Their curve, its ends moved onto each other.
    gaps : (members,) or (members - 1,)
        Distances that were closed between them; of a closed chain also that of the last one from the first.
    """

    members: tuple[int, ...]
    pieces: Pieces
    gaps: Floats

    @property
    def closed(self) -> bool:
        """Whether the last one joins the first."""
        return len(self.gaps) == len(self.members)


def find_chains(curves: Sequence[Pieces], limit: float) -> list[Chain]:
    """Closed and open chains of open curves; an end where three or more curves meet joins none.

    Parameters
    ----------
    curves : sequence of Pieces
        Each from its start to its end, in any order and direction; none shorter than the limit.
    limit : float
        Ends nearer than this are one point.

    Returns
    -------
    list of Chain
        Each curve in one of them, in the order of their first curves; an open one may be a single curve.
    """
    if not curves:
        return []
    partner = _partners(curves, limit)
    # open chains begin at an end without partner, closed ones anywhere
    starts = [end for end in range(2 * len(curves)) if end not in partner]
    chains, used = [], set[int]()
    for first in [*starts, *range(0, 2 * len(curves), 2)]:
        members: list[tuple[int, bool]] = []
        at = first
        while at // 2 not in used:
            used.add(at // 2)
            members.append((at // 2, at % 2 == 1))
            if at ^ 1 not in partner:
                break
            at = partner[at ^ 1]
        if not members:
            continue
        parts = [curves[k].reversed() if backwards else curves[k] for k, backwards in members]
        closed = partner.get(first) is not None and partner[first] // 2 == members[-1][0]
        chains.append(_chain(tuple(k for k, _ in members), parts, closed))
    return sorted(chains, key=lambda chain: min(chain.members))


def _partners(curves: Sequence[Pieces], limit: float) -> dict[int, int]:
    """For each end that meets just one other, that one; end 2 k is the start of curve k, 2 k + 1 its end."""
    ends = _ends(curves)
    near = cKDTree(ends).query_ball_point(ends, limit)
    return {i: next(j for j in found if j != i) for i, found in enumerate(near) if len(found) == 2}


def _ends(curves: Sequence[Pieces]) -> Floats:
    return np.concatenate([[curve.starts[0], curve.ends[-1]] for curve in curves])


def crowded_end(curves: Sequence[Pieces], limit: float) -> tuple[int, Floats] | None:
    """How many ends meet, and where (3,), at a place of three or more; None: there is no such place."""
    if not curves:
        return None
    ends = _ends(curves)
    near = cKDTree(ends).query_ball_point(ends, limit)
    for i, found in enumerate(near):
        if len(found) > 2:
            return len(found), ends[i]
    return None


def _chain(members: tuple[int, ...], parts: Sequence[Pieces], closed: bool) -> Chain:
    starts = np.array([part.starts[0] for part in parts])
    ends = np.array([part.ends[-1] for part in parts])
    gaps = np.linalg.norm(np.roll(starts, -1, axis=0) - ends, axis=1)
    return Chain(members, stack(_met(parts, closed)), gaps if closed else gaps[:-1])


def _met(parts: Sequence[Pieces], closed: bool) -> list[Pieces]:
    """Parts whose ends are moved onto the middle of the gaps between them."""
    starts = np.array([part.starts[0] for part in parts])
    ends = np.array([part.ends[-1] for part in parts])
    meeting = (ends + np.roll(starts, -1, axis=0)) / 2
    if closed:
        begin, end = np.roll(meeting, 1, axis=0), meeting
    else:
        begin, end = np.vstack([starts[:1], meeting[:-1]]), np.vstack([meeting[:-1], ends[-1:]])
    return [part.from_to(a, b) for part, a, b in zip(parts, begin, end, strict=True)]


@dataclass(frozen=True, eq=False)
class NearlyClosed:
    """A chain that would be closed but for gaps.

    Attributes
    ----------
    members : tuple of int
        Indices of the open chains, in order.
    length : float
        Of the chains together, in the file's unit.
    gap : float
        The widest.
    between : (2, 3)
        The ends at the widest gap.
    """

    members: tuple[int, ...]
    length: float
    gap: float
    between: Floats


def nearly_closed(chains: Sequence[Pieces], lengths: Sequence[float], share: float) -> list[NearlyClosed]:
    """Which open chains would be closed if gaps of up to a share of their own length were.

    Each end is taken to its nearest neighbour, if that is mutual.

    Parameters
    ----------
    chains : sequence of Pieces
    lengths : sequence of float
        Of the chains.
    share : float
    """
    if not chains:
        return []
    ends = _ends(chains)
    distance, nearest = cKDTree(ends).query(ends, k=2)
    other = np.where(nearest[:, 0] == np.arange(len(ends)), nearest[:, 1], nearest[:, 0])
    partner = {i: int(j) for i, j in enumerate(other) if other[j] == i}
    found, used = [], set[int]()
    for first in range(len(chains)):
        members, at, gaps = [], 2 * first, list[tuple[float, int]]()
        while at // 2 not in used and at ^ 1 in partner:
            used.add(at // 2)
            members.append(at // 2)
            gaps.append((float(distance[at ^ 1].max()), at ^ 1))
            at = partner[at ^ 1]
        if not members or at != 2 * first:
            continue
        length = float(sum(lengths[k] for k in members))
        gap, end = max(gaps)
        if gap <= share * length:
            found.append(NearlyClosed(tuple(members), length, gap, ends[[end, partner[end]]]))
    return found
