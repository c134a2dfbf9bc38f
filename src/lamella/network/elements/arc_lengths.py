"""Arc lengths along lamellas on elements.

The speed along a lamella jumps a little where it goes over from one element to the next, and is analytic in between:
pieces that end there as well as at stops need few points of a series each.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.blocks import blocks
from lamella.base.vectors import lengths
from lamella.network.arc_length import ArcLengths
from lamella.network.elements.segments import ElementSegments
from lamella.surface.element.places import Places

# points of a part's series to begin with and to settle for, and the share that its last two terms may have
SEGMENT_POINTS, SETTLE, SEGMENT_TAIL = 6, 24, 1e-5
# of a segment: a part is longer
SEGMENT_PART_MIN = 1e-6


class ElementArcs:
    """Arc length along every segment, and the parameters that divide it evenly.

    Parameters
    ----------
    segments : ElementSegments

    Attributes
    ----------
    length : (s,)
        m.
    """

    def __init__(self, segments: ElementSegments) -> None:
        count = len(segments.owner)
        segment, sigma = segments.passages()
        inside = (sigma > SEGMENT_PART_MIN) & (sigma < 1 - SEGMENT_PART_MIN)
        segment, begin = np.r_[np.arange(count), segment[inside]], np.r_[np.zeros(count), sigma[inside]]
        order = np.lexsort((begin, segment))
        self._parts = _Parts(segments, segment[order], begin[order])
        self._arcs = ArcLengths(self._parts, SEGMENT_TAIL, SETTLE, SEGMENT_POINTS)
        self.length: Floats = np.bincount(self._parts.owner, self._arcs.length, count).astype(np.float64)
        self._first = np.searchsorted(self._parts.owner, np.arange(count + 1))
        self._before = np.cumsum(self._arcs.length) - self._arcs.length

    def parameter(self, segment: Integers, fraction: Floats) -> tuple[Floats, Places]:
        """sigma where the given fractions of the segments' arc lengths are reached, (k,), and places near by."""
        sigma = np.empty(len(segment))
        near = Places(np.empty(len(segment), np.int64), np.empty((len(segment), 2)))
        for block in blocks(len(segment)):
            part, share = self._shares(segment[block], fraction[block])
            sigma[block] = self._parts.sigma(part, share)
            near.element[block], near.local[block] = self._parts.near(part, share)
        return np.where(fraction == 1, 1.0, np.where(fraction == 0, 0.0, sigma)), near

    def _shares(self, segment: Integers, fraction: Floats) -> tuple[Integers, Floats]:
        """Parts in which fractions of the segments' arc lengths are reached, and at what shares of them."""
        goal = self._before[self._first[segment]] + fraction * self.length[segment]
        part = np.searchsorted(self._before, goal, side="right") - 1
        part = np.clip(part, self._first[segment], self._first[segment + 1] - 1)
        return part, self._arcs.parameter(part, np.clip((goal - self._before[part]) / self._arcs.length[part], 0, 1))


class _Parts:
    """Parts of segments, in their order."""

    def __init__(self, segments: ElementSegments, owner: Integers, begin: Floats) -> None:
        self._segments, self.owner, self._begin = segments, owner, begin
        end = np.where(np.r_[owner[1:] != owner[:-1], True], 1.0, np.r_[begin[1:], 1.0])
        self._reach = end - begin
        # where the parts are, as powers of the share: from the places at which the speed is measured first
        self._element, self._powers = np.full(len(owner), -1), np.zeros((SEGMENT_POINTS, len(owner), 2))

    def sigma(self, part: Integers, share: Floats) -> Floats:
        """The segments' parameters at shares of parts, arrays of equal shape."""
        return np.asarray(self._begin[part] + share * self._reach[part])

    def speed(self, part: Integers, share: Floats) -> Floats:
        """Arc length per share, m, at shares (p,) of parts (s,), shape (s, p)."""
        every = np.repeat(part, len(share))
        spots = self._segments.spots(self.owner[every], self.sigma(every, np.tile(share, len(part))))
        order = np.argsort(self._segments.element(spots)[len(share) // 2 :: len(share)], kind="stable")
        part = part[order]
        spots = spots[(order[:, None] * len(share) + np.arange(len(share))).ravel()]
        places, _, velocity = self._segments.velocity(spots)
        if len(share) == SEGMENT_POINTS:
            element, local = places.element.reshape(-1, SEGMENT_POINTS), places.local.reshape(-1, SEGMENT_POINTS, 2)
            # -1: not all in one element
            self._element[part] = np.where((element == element[:, :1]).all(1), element[:, 0], -1)
            powers = np.linalg.inv(np.vander(share, increasing=True))
            self._powers[:, part] = np.tensordot(powers, local, (1, 1))
        speed = np.empty((len(part), len(share)))
        speed[order] = lengths(velocity).reshape(speed.shape) * self._reach[part, None]
        return speed

    def near(self, part: Integers, share: Floats) -> tuple[Integers, Floats]:
        """Elements and local coordinates near to shares of parts, arrays of equal shape."""
        local = np.zeros((len(part), 2))
        for power in self._powers[::-1]:
            local *= share[:, None]
            local += power.take(part, 0)
        # what lies beyond an edge would be looked for on the other side of a cut
        np.maximum(local, 0, out=local)
        local /= np.maximum(local[:, :1] + local[:, 1:], 1)
        return self._element[part], local
