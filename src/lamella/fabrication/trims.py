"""Where the layers of lamellas end at an edge beam: stations of the ends of their lower and upper edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats


@dataclass(frozen=True, eq=False)
class Trims:
    """Ends of the flat strips of all layers.

    Attributes
    ----------
    stations : (m, layers, 2, 2)
        Of each lamella and layer, from the right one on: of its start and of its end the stations of the corners at the
        -n and at the +n edge, m. NaN where it does not end at a beam.
    """

    stations: Floats

    def of(self, lamella: int, layer: int) -> Floats:
        """Of one strip, (2, 2), its layer counted from 1 on."""
        return np.asarray(self.stations[lamella, layer - 1])
