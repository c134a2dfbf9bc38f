"""Places for texts that must not cover each other."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats

WAYS = ((1, 0.35), (-1, 0.35), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
"""Where a text may stand beside its point: to the right, to the left, above, below, in the corners."""
BOXES_AT_ONCE = 256


class Places:
    """Boxes on a sheet that are taken, mm."""

    def __init__(self, bounds: tuple[float, float, float, float]) -> None:
        self._bounds = bounds
        self._boxes = np.empty((BOXES_AT_ONCE, 4))
        self._count = 0

    def take(self, left: float, low: float, right: float, high: float) -> None:
        """A box that is taken whatever else there is."""
        if self._count == len(self._boxes):
            self._boxes = np.concatenate([self._boxes, np.empty_like(self._boxes)])
        self._boxes[self._count] = left, low, right, high
        self._count += 1

    def beside(self, point: Floats, width: float, height: float, gap: float) -> tuple[float, float] | None:
        """Lower left corner of the first free box beside a point, which is taken then; None where none is free."""
        x, y = (float(value) for value in point)
        for across, up in WAYS:
            left = x + across * gap - (width if across < 0 else width / 2 if across == 0 else 0.0)
            low = y + up * gap - (height if up < 0 else height / 2 if up < 1 else 0.0)
            if self.free(left, low, left + width, low + height):
                self.take(left, low, left + width, low + height)
                return left, low
        return None

    def free(self, left: float, low: float, right: float, high: float) -> bool:
        """Whether a box lies on the sheet and covers nothing."""
        bounds = self._bounds
        if left < bounds[0] or low < bounds[1] or right > bounds[2] or high > bounds[3]:
            return False
        taken = self._boxes[: self._count]
        apart = (taken[:, 0] >= right) | (taken[:, 2] <= left) | (taken[:, 1] >= high) | (taken[:, 3] <= low)
        return bool(apart.all())


def spread(places: Floats, width: float, low: float, high: float) -> Floats:
    """Ascending places (n,) moved apart to a distance, as little as may be, between two ends; where they fit.

    Least squares: groups of places that would come too near move together (pool adjacent violators).
    """
    if not len(places):
        return places
    targets = places - width * np.arange(len(places))
    groups: list[tuple[float, int]] = []
    for value in targets.tolist():
        groups.append((value, 1))
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (first, a), (second, b) = groups[-2:]
            groups[-2:] = [((a * first + b * second) / (a + b), a + b)]
    moved = np.concatenate([np.full(count, value) for value, count in groups])
    moved = np.clip(moved, low, max(high - width * (len(places) - 1), low))
    return np.asarray(moved + width * np.arange(len(places)))
