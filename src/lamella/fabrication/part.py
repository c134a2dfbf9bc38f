"""The flat parts of a structure as records."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.message import Message
from lamella.base.onward import onward
from lamella.base.result import Shown
from lamella.base.wording import counted
from lamella.fabrication.axis import Axis
from lamella.fabrication.flat import circle, extents

if TYPE_CHECKING:
    from lamella.fabrication.sheet import Nesting


# points an arc whose bounds and distances are taken from them
BOUND_POINTS = 33


@dataclass(frozen=True, eq=False, repr=False)
class Part(Shown):
    """One flat strip to be cut, or one piece of a lamella that had to be split.

    Stations run along the developed centre line from the lamella's first node, in m. The part's own drawing frame is
    that of its `Axis`: origin in the centre line's middle, x along it and y towards +n. Seen so, face up, the strip
    shows the side that looks to the right of its direction, -u.

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
        Of the developed centre line, 1/m, > 0 where it bends towards +n; of a layer cut to its own outline that of the
        others, which it is near to.
    axis : Axis
        The developed centre line from the strip's start to its end.
    layer : int
        Number of the layer, 1 for the one farthest to the right; 0 where one part stands for all layers.
    side : str
        On which side of the centre line the layer lies: R and L of two, M the middle one of three, RR and LL the outer
        ones of four; empty where `layer` is 0.
    distance : float
        Of the layer from the centre line, m, > 0 to the left; where it varies, its mean. 0 where `layer` is.
    nodes : (n,)
        Stations of the part's nodes, m; a hub's node lies beyond the end.
    slots : (k,)
        Ascending stations of the slots' axes, m.
    slot_width : float
        m.
    slot_play : float
        How far the slots' feet lie beyond the centre line, m.
    slots_left_out : int
        Slots that are not cut because they would come too close to each other or to an end.
    outline : (v, 3)
        x, y in m and bulge, see `lamella.fabrication.axis.outline`.
    area : float
        Of the outline without its holes, m2.
    mass : float
        Of one piece, kg.
    holes : (b, 3)
        Round holes: station, height over the centre line and diameter, m.
    corners : (2, 2)
        Of the start and of the end the stations of the corners at the -n and at the +n edge, m: equal but at edge
        beams, where strips are cut obliquely.
    first_node : int
        Number of the first of its nodes among those of its lamella.

    Examples
    --------
    >>> import lamella
    >>> part = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips().parts().parts[0]
    >>> print(part.id, len(part.slots), f"{part.area:.3f} m2")
    A1 16 0.847 m2
    """

    id: str
    lamella: int
    family: str
    quantity: int
    height: float
    thickness: float
    curvature: float
    axis: Axis
    layer: int
    side: str
    distance: float
    nodes: Floats
    slots: Floats
    slot_width: float
    slots_left_out: int
    outline: Floats
    area: float
    mass: float
    slot_play: float = 0.0
    holes: Floats = field(default_factory=lambda: np.empty((0, 3)))
    corners: Floats = field(default_factory=lambda: np.empty((0, 2)))
    first_node: int = 0

    def _line(self) -> str:
        return f"{self.label}: {self.length:.4g} m, {counted(len(self.slots), 'slot')}, {self.mass:.4g} kg"

    @property
    def start(self) -> float:
        """Station of the strip's start, m."""
        return float(self.axis.knots[0])

    @property
    def end(self) -> float:
        """Station of the strip's end, m."""
        return float(self.axis.knots[-1])

    @property
    def label(self) -> str:
        """What is engraved: the id, and the side where the part is one of several layers."""
        return f"{self.id} {self.side}" if self.side else self.id

    @property
    def length(self) -> float:
        """Length of the centre line from end to end, m."""
        return self.end - self.start

    @property
    def from_above(self) -> bool:
        """Whether slots begin at the +n edge."""
        return self.family == "A"

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, y and greatest x, y in the part's own frame, m."""
        if not self.axis.is_arc:
            fine = np.linspace(self.axis.knots[:-1], self.axis.knots[1:], BOUND_POINTS).ravel()
            edges = self.place(fine, np.array([[-0.5], [0.5]]) * self.height).reshape(-1, 2)
            (left, low), (right, high) = edges.min(axis=0).tolist(), edges.max(axis=0).tolist()
            return left, low, right, high
        half_width, rise = extents(self.length, self.height, self.curvature)
        low, high = -0.5 * self.height, float(rise)
        if self.curvature < 0:
            low, high = -high, -low
        return -float(half_width), low, float(half_width), high

    def place(self, stations: Floats, heights: Floats | float) -> Floats:
        """Points of the strip in the part's own frame, (..., 2), m; see `Axis.develop`."""
        return self.axis.develop(stations, heights)

    def drilled(self, holes: Floats) -> Part:
        """The part with further holes, (b, 3) as `holes`."""
        if not len(holes):
            return self
        every = np.concatenate([self.holes, holes])
        every = every[np.lexsort((every[:, 1], every[:, 0]))]
        area = self.area - float(np.pi / 4 * np.sum(holes[:, 2] ** 2))
        return replace(self, holes=every, area=area, mass=self.mass * area / self.area)

    def hole_outlines(self) -> tuple[Floats, ...]:
        """Closed outlines of the holes in the part's own frame, (2, 3) as `outline`: two half circles each."""
        centres = self.place(self.holes[:, 0], self.holes[:, 1])
        return tuple(circle(d, (x, y)) for (x, y), d in zip(centres.tolist(), self.holes[:, 2].tolist(), strict=True))

    @cached_property
    def bow(self) -> float:
        """How far the centre line leaves the arc of the part's `curvature` laid best on it, m."""
        if self.axis.is_arc:
            return 0.0
        fine = np.linspace(self.axis.knots[:-1], self.axis.knots[1:], BOUND_POINTS).ravel()
        arc = Axis.arc(self.start, self.end, self.curvature)
        off = self.place(fine, 0.0) - arc.develop(fine, 0.0)
        # along the arc points may be shifted
        heading = arc.heading(fine)
        across = off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)
        return float(np.abs(across).max())


@dataclass(frozen=True, eq=False, repr=False)
class Parts(Shown):
    """All parts of a structure.

    Attributes
    ----------
    parts : tuple of Part
        In the lamellas' order, pieces of a split one behind each other.
    warnings : tuple of Message
        What the user should know about them.
    colliding : bool
        Whether strips meet beyond the rim.

    Examples
    --------
    >>> import lamella
    >>> parts = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips().parts()
    >>> parts.parts[0]
    Part(A1: 8.497 m, 16 slots, 10.04 kg)
    >>> print(f"{parts.mass:.1f} kg")
    481.9 kg
    """

    parts: tuple[Part, ...]
    warnings: tuple[Message, ...]
    colliding: bool = False

    def _line(self) -> str:
        return f"{counted(len(self.parts), 'part')}, {counted(self.pieces, 'piece')}, {self.mass:.4g} kg"

    def nest(self, *, sheet: tuple[float, float] = (12.0, 2.0), gap: float = 0.01) -> Nesting:
        """All pieces laid on sheets.

        Parameters
        ----------
        sheet : (float, float)
            Length and width, m; the longer one is laid along x. Best those that the parts were made for
            (`lamellas.parts(sheet=...)`): a piece too long for a smaller one lies alone on a larger sheet, and the
            result says how many there are (`oversize`).
        gap : float
            Between pieces and to the sheet's edge, m.

        Examples
        --------
        >>> import lamella
        >>> parts = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips().parts()
        >>> parts.nest(sheet=(12.0, 1.5))
        Nesting(48 pieces on 4 sheets)
        """
        nesting: Nesting = onward("lamella.fabrication.sheet.nest")(self, sheet=sheet, gap=gap)
        return nesting

    @property
    def mass(self) -> float:
        """Mass of all pieces, kg."""
        return sum(part.quantity * part.mass for part in self.parts)

    @property
    def pieces(self) -> int:
        """Number of pieces to cut."""
        return sum(part.quantity for part in self.parts)
