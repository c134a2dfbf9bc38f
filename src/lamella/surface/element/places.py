"""Places on a surface of curved elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats


@dataclass(frozen=True)
class Places:
    """Places in bulk.

    Attributes
    ----------
    element : (n,) int
    local : (n, 2)
        Local coordinates (x, y) in the triangle x, y >= 0, x + y <= 1.
    """

    element: NDArray[np.int64]
    local: Floats

    def __len__(self) -> int:
        return len(self.element)

    def __getitem__(self, index: NDArray[np.int64] | NDArray[np.bool_] | slice) -> Places:
        return Places(self.element[index], self.local[index])
