"""The flat strips of lamellas before they are cut: stations of nodes and slots of every layer, and how it is bent.

Layers that are alike are one strip, cut as often as there are layers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.fabrication.axis import Axis
from lamella.fabrication.oblique import Oblique
from lamella.fabrication.rules import clear_hub
from lamella.network.network import SINGULAR, Network
from lamella.strip.lamellas import Lamellas, crossings
from lamella.strip.layers import SIDES

# samples a piece of centre line that is cut as one arc: its direction is off by d tg'' s^2 / 8, next to nothing
STATION_STRIDE = 4
# m
LEAST_ARC = 1e-6


@dataclass(frozen=True)
class LayerStrip:
    """One layer of one lamella, flat, or all of its layers where they are alike.

    Attributes
    ----------
    name : str
        Of its parts.
    lamella : int
    layer : int
        From 1; 0 where it stands for all.
    side : str
        See `lamella.fabrication.part.Part.side`.
    distance : float
        Mean distance from the centre line, m, > 0 to the left.
    stations : (n,)
        Of its nodes, m.
    shifts : (n, layers)
        From these to the slots', ascending, m.
    slot_width : (n,)
        m.
    curvature : float
        1/m, of the flat centre line.
    knots : (k,)
        Stations between which the strip has a curvature beside that, m.
    bow : (k - 1,)
        That curvature, 1/m.
    """

    name: str
    lamella: int
    layer: int
    side: str
    distance: float
    stations: Floats
    shifts: Floats
    slot_width: Floats
    curvature: float
    knots: Floats
    bow: Floats

    def axis(self, start: float, end: float) -> Axis:
        """The centre line between two stations."""
        if not self.bow.any():
            return Axis.arc(start, end, self.curvature)
        inner = self.knots[1:-1]
        inside = (inner > start) & (inner < end)
        knots = np.concatenate(([start], inner[inside], [end]))
        middles = 0.5 * (knots[1:] + knots[:-1])
        piece = np.clip(np.searchsorted(self.knots, middles, side="right") - 1, 0, len(self.bow) - 1)
        return Axis.of(knots, self.curvature + self.bow[piece])


@dataclass(frozen=True)
class LayerStrips:
    """The strips of all lamellas.

    Attributes
    ----------
    network : Network
    lamellas : Lamellas
    oblique : Oblique
    stations : (r, q)
        Of the nodes, a row a layer; one row where layers are alike.
    shifts : (r, q, layers)
        From these to the slots'.
    slot_width : (q,)
        m.
    """

    network: Network
    lamellas: Lamellas
    oblique: Oblique
    stations: Floats
    shifts: Floats
    slot_width: Floats

    @classmethod
    def of(cls, network: Network, lamellas: Lamellas, slot_width: float, *, own: bool = False) -> LayerStrips:
        """The strips of lamellas whose slots are `slot_width` (m) wide where they cross at a right angle.

        `own` makes every layer a strip of its own.
        """
        section, layers = lamellas.section, lamellas.layers
        oblique = Oblique.of(network)
        stations = lamellas.stop_stations[None]
        if (own or section.own_parts or not oblique.right) and section.layers > 1:
            at = crossings(network)[network.stop_nodes]
            off = [np.where(at, oblique.shift(d), 0.0) for d in section.layer_offsets.tolist()]
            stations = layers.stop_stations + np.stack(off)
        shifts = layers.slot_shifts
        if shifts is None:
            equal = oblique.stretch[:, None] * section.layer_offsets
            shifts = np.broadcast_to(equal, (len(stations), *equal.shape))
        return cls(network, lamellas, oblique, stations, shifts, oblique.width(slot_width, section.thickness))

    @property
    def kinds(self) -> int:
        """Strips of a lamella that differ."""
        return len(self.stations)

    @property
    def reach(self) -> float:
        """From a centre line to the outermost layer, m."""
        return float(np.abs(self.lamellas.section.layer_offsets).max())

    def of_lamella(self, index: int) -> Iterator[LayerStrip]:
        """The strips of a lamella."""
        network, layers, section = self.network, self.lamellas.layers, self.lamellas.section
        stops = slice(int(network.stop_offsets[index]), int(network.stop_offsets[index + 1]))
        samples = slice(int(network.sample_offsets[index]), int(network.sample_offsets[index + 1]))
        curvatures = self.lamellas.cut_curvatures
        for row in range(self.kinds):
            number = row + 1 if self.kinds > 1 else 0
            knots, bow = _arcs(layers.stations[row, samples], layers.bow[row, samples])
            yield LayerStrip(
                network.ids[index] + (f"-{number}" if number else ""),
                index,
                number,
                SIDES[section.layers][row] if number else "",
                float(section.layer_offsets[row]) if number else 0.0,
                self.stations[row, stops],
                self.shifts[row, stops],
                self.slot_width[stops],
                float(curvatures[index]),
                knots,
                bow,
            )

    @property
    def bow(self) -> float:
        """How far a cut outline leaves that of plain strips at most, m: from the chord between its ends."""
        layers = self.lamellas.layers
        if not layers.bow.any():
            return 0.0
        most = 0.0
        for first, last in zip(self.network.sample_offsets[:-1], self.network.sample_offsets[1:], strict=True):
            s, bend = layers.stations[:, first:last], layers.bow[:, first:last]
            step = np.diff(s, axis=1)
            turn = _sum((bend[:, 1:] + bend[:, :-1]) / 2 * step)
            off = _sum((turn[:, 1:] + turn[:, :-1]) / 2 * step)
            off -= off[:, -1:] * (s - s[:, :1]) / (s[:, -1:] - s[:, :1])
            most = max(most, float(np.abs(off).max()))
        return most

    def first_slot(self, crossing: Booleans) -> float:
        """Least distance along a strip from a singular node to the next slot's axis, m; infinite if there is none."""
        network = self.network
        same = network.stop_owner[1:] == network.stop_owner[:-1]
        singular = network.node_kinds[network.stop_nodes] == SINGULAR
        slots = crossing[network.stop_nodes]
        ahead = same & singular[:-1] & slots[1:]
        behind = same & slots[:-1] & singular[1:]
        step = np.diff(self.stations)
        near = np.where(ahead, step + self.shifts[:, 1:, 0], np.inf)
        far = np.where(behind, step - self.shifts[:, :-1, -1], np.inf)
        return float(min(near.min(initial=np.inf), far.min(initial=np.inf)))

    def clear_hub(self, rays: int) -> float:
        """Distance from a singular node at which strips of neighbouring rays are clear of each other, m."""
        section = self.lamellas.section
        if section.layer_curves != "lamella" or rays <= 2:
            return clear_hub(rays, section.layers, section.offset, section.thickness)
        network = self.network
        layers = self.lamellas.layers
        half = np.where(layers.followed, np.abs(layers.distances).max(axis=0) + section.thickness, np.inf)
        kinds, count = network.node_kinds[network.stop_nodes], np.diff(network.sample_offsets)
        s = network.sample_arclengths
        clear = 0.0
        for end, away in (
            (network.stop_offsets[:-1], s),
            (network.stop_offsets[1:] - 1, np.repeat(network.lengths, count) - s),
        ):
            at_hub = np.repeat(kinds[end] == SINGULAR, count)
            tight = at_hub & (half > away * np.tan(np.pi / rays))
            # a sample on, where there is room
            step = np.max(np.diff(s), initial=0.0)
            clear = max(clear, float(away[tight].max(initial=-step)) + step)
        return clear


def _arcs(stations: Floats, bow: Floats) -> tuple[Floats, Floats]:
    """Knots (k,) every few samples, and the mean curvature in between (k - 1,)."""
    turn = _sum((bow[1:] + bow[:-1]) / 2 * np.diff(stations))
    kept = np.unique(np.append(np.arange(0, len(stations), STATION_STRIDE), len(stations) - 1))
    # in a stub between two stops next to each other samples all but coincide
    kept = kept[np.append(True, np.diff(stations[kept]) > LEAST_ARC)]
    knots = stations[kept]
    return knots, np.diff(turn[kept]) / np.diff(knots)


def _sum(values: Floats) -> Floats:
    """Running sums along the last axis, from 0."""
    return np.concatenate((np.zeros((*values.shape[:-1], 1)), np.cumsum(values, axis=-1)), axis=-1)
