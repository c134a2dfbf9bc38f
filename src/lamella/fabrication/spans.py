"""Flat strips from end to end, before they are cut into pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.fabrication.layer_strips import LayerStrip
from lamella.fabrication.rules import Rules
from lamella.fabrication.splitting import bounds_between

SQUARE = np.full((2, 2), np.nan)
"""Ends of a strip that are perpendicular to it."""


@dataclass(frozen=True)
class Span:
    """A strip from end to end.

    Attributes
    ----------
    strip : LayerStrip
    family : str
    start, end : float
        Stations of its ends, m.
    stations : (n,)
        Of its nodes, m.
    crossing : (n,) bool
        Whether they have slots.
    shifts : (n, layers)
        From the stations to the slots' axes, m.
    width : (n,)
        Of the slots, m.
    trims : (2, 2)
        Of its start and of its end the stations of the corners at the -n and at the +n edge, m; NaN where it is not
        trimmed to an edge beam.
    """

    strip: LayerStrip
    family: str
    start: float
    end: float
    stations: Floats
    crossing: Booleans
    shifts: Floats
    width: Floats
    trims: Floats

    @classmethod
    def of(
        cls,
        strip: LayerStrip,
        family: str,
        closed: bool,
        crossing: Booleans,
        hub: Booleans,
        rules: Rules,
        trims: Floats = SQUARE,
    ) -> Span:
        """Of a strip whose nodes are crossings, or hubs, (n,) each; `trims` as the attribute."""
        stations, shifts, width = strip.stations, strip.shifts, strip.slot_width
        if closed:
            # the ring opens in the middle of its last cell, so that no slot lies at the cut
            half = 0.5 * float(stations[-1] - stations[-2])
            start, end = float(stations[0]) - half, float(stations[-1]) - half
            return cls(strip, family, start, end, stations[:-1], crossing[:-1], shifts[:-1], width[:-1], SQUARE)
        # little beyond the rim, lest strips meet their neighbours out there, unless the last slot asks for more
        at, room = stations[crossing], np.maximum(rules.end_distance, 1.5 * width[crossing] / rules.edge_scale)
        first = np.min(np.append(at + shifts[crossing, 0] - room, stations[0] - rules.rim_overhang))
        last = np.max(np.append(at + shifts[crossing, -1] + room, stations[-1] + rules.rim_overhang))
        start = float(stations[0] + rules.hub_radius if hub[0] else first)
        end = float(stations[-1] - rules.hub_radius if hub[-1] else last)
        # at a beam the corner that lies farther out
        at_beam = ~np.isnan(trims[:, 0])
        start = float(trims[0].min()) if at_beam[0] else start
        end = float(trims[1].max()) if at_beam[1] else end
        return cls(strip, family, start, end, stations, crossing, shifts, width, trims)

    @property
    def length(self) -> float:
        """From end to end, m."""
        return self.end - self.start

    def bounds(self, reach: float = 0.0) -> Floats:
        """Stations of its ends and of where it may be cut, m; `reach` is the least distance from a cut to a slot."""
        if not reach:
            return bounds_between(self.start, self.end, self.stations)
        slots = np.sort((self.stations[:, None] + self.shifts)[self.crossing].ravel())
        return bounds_between(self.start, self.end, self.stations, slots, reach)

    def borders(self, cells: Integers) -> Floats:
        """Stations in the middle of some cells, by the number of the node before, m."""
        inside = cells[cells < len(self.stations) - 1]
        middles = 0.5 * (self.stations[inside] + self.stations[inside + 1])
        return np.asarray(middles[(middles > self.start) & (middles < self.end)])
