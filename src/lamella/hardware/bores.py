"""Holes through the layers of lamellas, where something is bolted."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.part import Part, Parts
from lamella.strip.lamellas import Lamellas


@dataclass(frozen=True, eq=False)
class Bores:
    """Holes through all layers of lamellas, across the centre line.

    Attributes
    ----------
    lamellas : (b,) int
    arclengths : (b,)
        Along the centre line, m; beyond its ends too.
    heights : (b,)
        Over it, m.
    diameters : (b,)
        m.
    """

    lamellas: Integers
    arclengths: Floats
    heights: Floats
    diameters: Floats

    @classmethod
    def of(cls, several: list[Bores]) -> Bores:
        """All holes of several lists."""
        empty = np.empty(0)
        return cls(
            np.concatenate([np.empty(0, np.int64), *(bores.lamellas for bores in several)]),
            np.concatenate([empty, *(bores.arclengths for bores in several)]),
            np.concatenate([empty, *(bores.heights for bores in several)]),
            np.concatenate([empty, *(bores.diameters for bores in several)]),
        )


def layer_stations(lamellas: Lamellas, lamella: int, row: int, arclengths: Floats) -> Floats:
    """Stations on a layer's flat strip beside places of the centre line, m; beyond its ends it goes on evenly."""
    network = lamellas.network
    span = slice(int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1]))
    known, stations = network.sample_arclengths[span], lamellas.layers.stations[row, span]
    beyond = arclengths - np.clip(arclengths, known[0], known[-1])
    return np.asarray(np.interp(arclengths, known, stations) + beyond)


def drilled(parts: Parts, lamellas: Lamellas, bores: Bores) -> Parts:
    """Parts with the holes that lie on them."""
    order = np.argsort(bores.lamellas, kind="stable")
    starts = np.searchsorted(bores.lamellas[order], np.arange(len(lamellas.network.ids) + 1))
    return replace(
        parts,
        parts=tuple(
            _drilled(part, lamellas, bores, order[starts[part.lamella] : starts[part.lamella + 1]])
            for part in parts.parts
        ),
    )


def _drilled(part: Part, lamellas: Lamellas, bores: Bores, some: Integers) -> Part:
    # layers that are alike have the same stations
    stations = layer_stations(lamellas, part.lamella, max(part.layer - 1, 0), bores.arclengths[some])
    reach = bores.diameters[some] / 2
    on_it = (stations - reach > part.start) & (stations + reach < part.end)
    return part.drilled(np.column_stack([stations, bores.heights[some], bores.diameters[some]])[on_it])
