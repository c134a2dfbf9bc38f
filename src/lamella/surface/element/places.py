"""Places on a surface of curved elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.result import Result
from lamella.base.wording import counted


@dataclass(frozen=True, eq=False, repr=False)
class Places(Result):
    """Places in bulk.

    Attributes
    ----------
    element : (n,) int
    local : (n, 2)
        Local coordinates (x, y) in the triangle x, y >= 0, x + y <= 1.

    Examples
    --------
    >>> import lamella
    >>> places = lamella.Places.everywhere(2, [[0.25, 0.25], [0.5, 0.25]])
    >>> places, places.element
    (Places(4 places), array([0, 0, 1, 1]))
    """

    element: Integers
    local: Floats

    def _line(self) -> str:
        return counted(len(self), "place")

    def __len__(self) -> int:
        return len(self.element)

    def __getitem__(self, index: Integers | Booleans | slice) -> Places:
        return Places(self.element[index], self.local[index])

    @classmethod
    def everywhere(cls, elements: int, local: Floats) -> Places:
        """The same local coordinates (q, 2) in every one of so many elements, element by element."""
        return cls(np.repeat(np.arange(elements), len(local)), np.tile(local, (elements, 1)))
