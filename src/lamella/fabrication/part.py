"""The flat parts of a structure as records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.fabrication.flat import develop, extents

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One flat strip to be cut, or one piece of a lamella that had to be split.

    Stations run along the developed centre line from the lamella's first node, in m. The part's own drawing
    frame has its origin at the centre line's middle, x along it and y towards +n.

    Attributes
    ----------
    id : str
        "A1", or "A1.1", "A1.2", ... for the pieces of a split lamella; "A1-1", "A1-2", ... where each layer is a part
        of its own.
    lamella : int
        Index of the lamella in its network.
    family : str
        "A" (slots from the +n edge, above) or "B" (slots from the -n edge, below).
    quantity : int
        Equal pieces to cut: one a layer, or 1 where each layer is a part of its own.
    height, thickness : float
        m.
    curvature : float
        Of the developed centre line, 1/m, > 0 where it bends towards +n.
    start, end : float
        Stations of the strip's ends, m.
    nodes : (n,)
        Stations of the part's nodes, m; a hub's node lies beyond the end.
    slots : (k,)
        Ascending stations of the slots' axes, m.
    slot_width : float
        m.
    slots_left_out : int
        Slots that are not cut because they would come too close to each other or to an end.
    outline : (v, 3)
        x, y in m and bulge, see `lamella.fabrication.flat.outline`.
    area : float
        Of the outline, m2.
    mass : float
        Of one piece, kg.
    """

    id: str
    lamella: int
    family: str
    quantity: int
    height: float
    thickness: float
    curvature: float
    start: float
    end: float
    nodes: Floats
    slots: Floats
    slot_width: float
    slots_left_out: int
    outline: Floats
    area: float
    mass: float

    @property
    def length(self) -> float:
        """Length of the centre line from end to end, m."""
        return self.end - self.start

    @property
    def from_above(self) -> bool:
        """Whether slots begin at the +n edge."""
        return self.family == "A"

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, y and greatest x, y in the part's own frame, m."""
        half_width, rise = extents(self.length, self.height, self.curvature)
        low, high = -0.5 * self.height, float(rise)
        if self.curvature < 0:
            low, high = -high, -low
        return -float(half_width), low, float(half_width), high

    def place(self, stations: Floats, heights: Floats | float) -> Floats:
        """Points of the strip in the part's own frame, (..., 2), m; see `develop`."""
        return develop(stations, heights, self.curvature, 0.5 * (self.start + self.end))


@dataclass(frozen=True)
class Parts:
    """All parts of a structure.

    Attributes
    ----------
    parts : tuple of Part
        In the lamellas' order, pieces of a split one behind each other.
    warnings : tuple of str
        What the user should know about them.
    """

    parts: tuple[Part, ...]
    warnings: tuple[str, ...]

    @property
    def mass(self) -> float:
        """Mass of all pieces, kg."""
        return sum(part.quantity * part.mass for part in self.parts)

    @property
    def pieces(self) -> int:
        """Number of pieces to cut."""
        return sum(part.quantity for part in self.parts)
