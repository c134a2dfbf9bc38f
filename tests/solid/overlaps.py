"""Solids of a structure that overlap, found by a solid-geometry library of its own (manifold3d)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import manifold3d
import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.part import Parts
from lamella.hardware.item import Item
from lamella.solid.extrusion import item_solids
from lamella.solid.solid import Solid
from lamella.solid.strip import layer_rows, strip_solid
from lamella.strip.lamellas import Lamellas

# m: how far around a place solids are looked at
AROUND = 0.06
# mm3: what flat triangles on twisted faces make of two that touch
TOUCHING = 0.1


def manifold(solid: Solid) -> manifold3d.Manifold:
    """The library's own solid; it refuses a mesh that is not closed."""
    made = manifold3d.Manifold(manifold3d.Mesh64(solid.vertices, solid.triangles.astype(np.uint64)))
    assert made.status() == manifold3d.Error.NoError
    return made


class Structure:
    """All strips and pieces of hardware of a structure."""

    def __init__(self, lamellas: Lamellas, parts: Parts, items: tuple[Item, ...], step: float = 0.003) -> None:
        self.names: list[str] = []
        self.solids: list[Solid] = []
        self._fine: dict[int, Callable[[], Solid]] = {}
        for part in parts.parts:
            for row in layer_rows(part, lamellas):
                self._fine[len(self.names)] = partial(strip_solid, part, lamellas, row, step=step)
                # for its bounds
                self._add(f"{part.id} layer {row}", strip_solid(part, lamellas, row, step=0.05))
        for item in items:
            for label, solid in item_solids(item):
                self._add(f"{item.id} {label}", solid)
        self.low = np.array([solid.vertices.min(axis=0) for solid in self.solids])
        self.high = np.array([solid.vertices.max(axis=0) for solid in self.solids])
        self._made: dict[int, manifold3d.Manifold] = {}

    def _add(self, name: str, solid: Solid) -> None:
        self.names.append(name)
        self.solids.append(solid)

    def of(self, start: str) -> list[int]:
        """Numbers of the solids whose names begin so."""
        return [k for k, name in enumerate(self.names) if name.startswith(start)]

    def solid(self, number: int) -> manifold3d.Manifold:
        """The library's solid of a number."""
        if number not in self._made:
            made = self._fine[number]() if number in self._fine else self.solids[number]
            self._made[number] = manifold(made)
        return self._made[number]

    def overlaps(self, place: Floats) -> list[tuple[str, str, float]]:
        """Pairs that overlap around a place, and by what volume, mm3."""
        near = np.flatnonzero(((self.low < place + AROUND) & (self.high > place - AROUND)).all(axis=1)).tolist()
        box = manifold3d.Manifold.cube((4 * AROUND,) * 3, True).translate(tuple(place.tolist()))
        cut = [self.solid(k) ^ box for k in near]
        found = []
        for a in range(len(near)):
            for b in range(a + 1, len(near)):
                volume = 1e9 * (cut[a] ^ cut[b]).volume()
                if volume > TOUCHING:
                    found.append((self.names[near[a]], self.names[near[b]], volume))
        return found

    def places(self, count: int, seed: int = 0) -> Floats:
        """Middles of some pieces of hardware."""
        pieces = np.array([k for k, name in enumerate(self.names) if " layer " not in name])
        chosen = np.random.default_rng(seed).permutation(pieces)[:count]
        return (self.low[chosen] + self.high[chosen]) / 2
