"""Where boundary curves touch or cross themselves or each other, in space.

Curves are cut into arcs that turn little, so that each lies within a known distance of its chord. Pairs of arcs are
ruled out by their boxes, by the distance of their chords, and on one loop by how much the curve turns from one arc to
the other: a stretch that comes back to a point turns by pi at least (Fenchel: a closed curve turns by 2 pi, the corner
where the stretch closes by no more than pi). What is left is halved until the chords decide.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.boundary.curve import Loop, angle_between
from lamella.surface.boundary.pieces import Pieces, stack

# radians an arc may turn
_LITTLE = 0.3
# radians; below pi by enough that a stretch turning less cannot come near itself: its chord is a third of it or more
_RETURNING = 0.75 * math.pi
# of a loop's size: arcs on both sides of a sharp corner are compared down to this length, nearer the corner their
# distance is that corner's angle times theirs
_NEAR_CORNER = 1e-3
# of the arc's height over its chord: the bound holds for arcs that bend one way
_SAFETY = 1.5
# pairs handled at once, so that memory stays small
_BATCH = 1_000_000
# pairs kept at a halving: only curves that run beside each other for long have more, and the nearest will do
_MOST_PAIRS = 100_000


@dataclass(frozen=True)
class Touch:
    """Two places of boundary curves that are nearer than allowed.

    Attributes
    ----------
    loops : (int, int)
        The loops; the same one twice where it touches itself.
    points : (2, 3)
        m.
    arcs : (float, float)
        Arc length of each place along its loop, m.
    distance : float
        m.
    """

    loops: tuple[int, int]
    points: Floats
    arcs: tuple[float, float]
    distance: float


@dataclass(frozen=True)
class _Arcs:
    """Arcs of all loops: loop, piece and range of s of each; ends in space; turn; turn run up at both ends."""

    loop: Integers
    piece: Integers
    start: Floats
    stop: Floats
    points: Floats  # (n, 2, 3)
    turn: Floats
    turned: Floats  # (n, 2)

    def take(self, which: Integers | Booleans) -> _Arcs:
        return _Arcs(*(getattr(self, name)[which] for name in _ARC_FIELDS))

    @property
    def chord(self) -> Floats:
        return np.asarray(np.linalg.norm(self.points[:, 1] - self.points[:, 0], axis=-1))

    @property
    def height(self) -> Floats:
        """Bound of the distance of the arc from its chord."""
        return np.asarray(_SAFETY * self.chord / 2 * np.tan(np.minimum(self.turn, 3.0) / 2))


_ARC_FIELDS = ("loop", "piece", "start", "stop", "points", "turn", "turned")


class _Curves:
    """All loops as one list of pieces."""

    def __init__(self, loops: Sequence[Loop]) -> None:
        self.loops = loops
        self.origin = loops[0].course.origin
        self.pieces: Pieces = stack(
            [loop.course.pieces.transformed(1.0, loop.course.origin - self.origin) for loop in loops]
        )
        counts = np.array([loop.course.pieces.count for loop in loops])
        self.first = np.concatenate([[0], np.cumsum(counts)])
        self.loop = np.repeat(np.arange(len(loops)), counts)
        self.next = np.arange(1, self.first[-1] + 1)
        self.next[self.first[1:] - 1] = self.first[:-1]
        self.sizes = np.array([loop.size for loop in loops])
        self.total = np.zeros(len(loops))

    def along(self, piece: Integers, s: Floats) -> tuple[Floats, Floats]:
        position, first, _ = self.pieces.evaluate(piece, s)
        return position, first / np.linalg.norm(first, axis=-1, keepdims=True)

    def halved(self, arcs: _Arcs) -> _Arcs:
        """First all first halves, then all second ones."""
        middle = (arcs.start + arcs.stop) / 2
        (_, before), (point, tangent), (_, behind) = (
            self.along(arcs.piece, s) for s in (arcs.start, middle, arcs.stop)
        )
        turn0, turn1 = (
            self._turn(arcs.piece, arcs.start, before, middle, tangent),
            self._turn(arcs.piece, middle, tangent, arcs.stop, behind),
        )
        return _Arcs(
            np.tile(arcs.loop, 2),
            np.tile(arcs.piece, 2),
            np.concatenate([arcs.start, middle]),
            np.concatenate([middle, arcs.stop]),
            np.concatenate([np.stack([arcs.points[:, 0], point], 1), np.stack([point, arcs.points[:, 1]], 1)]),
            np.concatenate([turn0, turn1]),
            np.concatenate(
                [
                    np.stack([arcs.turned[:, 0], arcs.turned[:, 0] + turn0], 1),
                    np.stack([arcs.turned[:, 1] - turn1, arcs.turned[:, 1]], 1),
                ]
            ),
        )

    def _turn(self, piece: Integers, start: Floats, t0: Floats, stop: Floats, t1: Floats) -> Floats:
        """Turn of the tangent over an arc, by way of its middle."""
        middle = self.along(piece, (start + stop) / 2)[1]
        return angle_between(t0, middle) + angle_between(middle, t1)

    def arcs(self) -> _Arcs:
        """Cells of the arc length, halved until each turns little, in order along the loops."""
        piece = np.concatenate([self.first[k] + loop.course.cell_piece for k, loop in enumerate(self.loops)])
        start = np.concatenate([loop.course.cell_start for loop in self.loops])
        stop = np.concatenate([loop.course.cell_stop for loop in self.loops])
        for halving in range(30):
            (_, t0), (_, t1) = self.along(piece, start), self.along(piece, stop)
            much = self._turn(piece, start, t0, stop, t1) > _LITTLE
            if not much.any() or halving == 29:
                break
            middle = (start[much] + stop[much]) / 2
            piece = np.concatenate([piece, piece[much]])
            start, stop = np.concatenate([start, middle]), np.concatenate([stop, stop[much]])
            stop[: len(much)][much] = middle
        order = np.lexsort((start, piece))
        piece, start, stop = piece[order], start[order], stop[order]
        (x0, t0), (x1, t1) = self.along(piece, start), self.along(piece, stop)
        turn = self._turn(piece, start, t0, stop, t1)
        loop = self.loop[piece]
        after = np.arange(1, len(piece) + 1)
        last = np.append(np.flatnonzero(np.diff(loop)), len(loop) - 1)
        first = np.append(0, last[:-1] + 1)
        after[last] = first
        corner = angle_between(t1, t0[after])
        run = np.cumsum(turn + corner)
        before = run - turn - corner
        offset = before[first][loop]
        self.total = run[last] - before[first]
        turned = np.stack([before - offset, before - offset + turn], axis=1)
        return _Arcs(loop, piece, start, stop, np.stack([x0, x1], 1), turn, turned)

    def adjacent(self, a: _Arcs, b: _Arcs) -> Booleans:
        """Whether b begins where a ends, on one loop."""
        same = (a.piece == b.piece) & (a.stop == b.start)
        return np.asarray(same | ((a.stop == 1) & (b.start == 0) & (self.next[a.piece] == b.piece)))


def closest_touch(loops: Sequence[Loop], limit: float) -> Touch | None:
    """A place where loops come nearer than a share of their size; on one loop, places that are no neighbours.

    Parameters
    ----------
    loops : sequence of Loop
    limit : float
        Least distance, as a share of the size of the larger loop of a pair.

    Returns
    -------
    Touch or None
    """
    curves = _Curves(loops)
    arcs = curves.arcs()
    first, second = _pairs(curves, arcs, limit)
    a, b = arcs.take(first), arcs.take(second)
    while len(a.loop):
        apart, u, v = segment_distance(a.points, b.points)
        slack = a.height + b.height
        size = np.maximum(curves.sizes[a.loop], curves.sizes[b.loop])
        joined, joined_back = curves.adjacent(a, b), curves.adjacent(b, a)
        neighbours = joined | joined_back
        close = apart - slack <= limit * size
        decided = ~neighbours & (slack <= 0.1 * limit * size)
        touching = np.flatnonzero(decided & (apart <= limit * size))
        if len(touching):
            k = touching[np.argmin(apart[touching])]
            return _touch(curves, a.take(np.array([k])), b.take(np.array([k])), u[k], v[k])
        near_corner = neighbours & (np.maximum(a.chord, b.chord) < _NEAR_CORNER * size)
        kept = np.flatnonzero(close & ~decided & ~near_corner)
        if 4 * len(kept) > _MOST_PAIRS:
            kept = kept[np.argsort((apart - slack)[kept], kind="stable")[: _MOST_PAIRS // 4]]
        a, b = curves.halved(a.take(kept)), curves.halved(b.take(kept))
        n = len(kept)
        i = np.tile(np.arange(2 * n), 2)
        j = np.concatenate([np.arange(2 * n), np.roll(np.arange(2 * n), n)])
        a, b = a.take(i), b.take(j)
        far = _cannot_meet(curves, a, b)
        a, b = a.take(~far), b.take(~far)
    return None


def _touch(curves: _Curves, a: _Arcs, b: _Arcs, u: float, v: float) -> Touch:
    places, lengths = [], []
    for arc, share in ((a, u), (b, v)):
        s = arc.start + share * (arc.stop - arc.start)
        loop = int(arc.loop[0])
        places.append(curves.along(arc.piece, s)[0][0] + curves.origin)
        lengths.append(float(curves.loops[loop].course.arc_at(arc.piece - curves.first[loop], s)[0]))
    points = np.array(places)
    apart = float(np.linalg.norm(points[1] - points[0]))
    return Touch((int(a.loop[0]), int(b.loop[0])), points, (lengths[0], lengths[1]), apart)


def _cannot_meet(curves: _Curves, a: _Arcs, b: _Arcs) -> Booleans:
    """Whether the stretch from one arc to the other, on one loop, turns too little to come back."""
    swap = (a.turned[:, 0] > b.turned[:, 0])[:, None]
    low, high = np.where(swap, b.turned, a.turned), np.where(swap, a.turned, b.turned)
    inner = high[:, 1] - low[:, 0]
    outer = curves.total[a.loop] - (high[:, 0] - low[:, 1])
    return np.asarray((a.loop == b.loop) & (np.minimum(inner, outer) < _RETURNING))


def _pairs(curves: _Curves, arcs: _Arcs, limit: float) -> tuple[Integers, Integers]:
    """Pairs of arcs whose boxes overlap and which can meet: a sweep along the longest axis."""
    reach = (arcs.height + limit * curves.sizes.max())[:, None]
    low, high = arcs.points.min(axis=1) - reach, arcs.points.max(axis=1) + reach
    axis = int(np.argmax(high.max(axis=0) - low.min(axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    low, high = low[order], high[order]
    last = np.searchsorted(low[:, axis], high[:, axis], side="right")
    counts = last - np.arange(len(order)) - 1
    found: list[tuple[Integers, Integers]] = []
    begin = 0
    while begin < len(order):
        # as many rows as fit a batch, one at least
        fit = int(np.searchsorted(np.cumsum(counts[begin:]), _BATCH, side="right"))
        rows = np.arange(begin, min(begin + max(fit, 1), len(order)))
        begin = int(rows[-1]) + 1
        n = counts[rows]
        i = np.repeat(rows, n)
        j = i + 1 + np.arange(len(i)) - np.repeat(np.cumsum(n) - n, n)
        for other in range(3):
            if other != axis:
                both = (low[i, other] <= high[j, other]) & (low[j, other] <= high[i, other])
                i, j = i[both], j[both]
        first, second = np.minimum(order[i], order[j]), np.maximum(order[i], order[j])
        meet = ~_cannot_meet(curves, arcs.take(first), arcs.take(second))
        found.append((first[meet], second[meet]))
    return np.concatenate([f for f, _ in found]), np.concatenate([s for _, s in found])


def segment_distance(p: Floats, q: Floats) -> tuple[Floats, Floats, Floats]:
    """Closest places of pairs of straight segments.

    Parameters
    ----------
    p, q : (n, 2, 3)
        Both ends of each segment, m.

    Returns
    -------
    distance, u, v : (n,)
        m, and the places as fractions of the two segments.
    """
    d, e, w = p[:, 1] - p[:, 0], q[:, 1] - q[:, 0], p[:, 0] - q[:, 0]
    dd, ee, de = (np.einsum("ni,ni->n", x, y) for x, y in ((d, d), (e, e), (d, e)))
    dw, ew = np.einsum("ni,ni->n", d, w), np.einsum("ni,ni->n", e, w)
    tiny = 1e-300
    one, zero = np.ones_like(dd), np.zeros_like(dd)
    determinant = dd * ee - de**2
    skew = np.maximum(determinant, tiny)
    inner = np.clip((de * ew - ee * dw) / skew, 0, 1)
    # an end of one segment with its foot on the other, or both feet inside
    u = np.stack(
        [zero, one, np.clip(-dw / np.maximum(dd, tiny), 0, 1), np.clip((de - dw) / np.maximum(dd, tiny), 0, 1), inner]
    )
    v = np.stack(
        [np.clip(ew / np.maximum(ee, tiny), 0, 1), np.clip((ew + de) / np.maximum(ee, tiny), 0, 1), zero, one, zero]
    )
    v[4] = np.clip((ew + inner * de) / np.maximum(ee, tiny), 0, 1)
    between = w[None] + u[..., None] * d[None] - v[..., None] * e[None]
    apart = np.linalg.norm(between, axis=-1)
    best = np.argmin(apart, axis=0)
    k = np.arange(len(best))
    return apart[best, k], u[best, k], v[best, k]
