"""Places that warnings about strips speak of."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.stages.lamellas.warnings import LAYER_SHARE
from lamella.strip.lamellas import Lamellas
from lamella.view.scene.scene import Mark

MARKS_MAX = 20
"""Places of a warning: who has seen these knows what is meant."""


def lamella_marks(lamellas: Lamellas) -> Iterator[Mark]:
    """The worst place of each lamella that is overstressed, or whose layers are bent, the worst lamella first."""
    yield from _worst("overstressed", lamellas, lamellas.utilisation, 1.0)
    yield from _worst("layers_bent", lamellas, lamellas.layer / lamellas.material.strength, LAYER_SHARE)


def _worst(key: str, lamellas: Lamellas, values: Floats, limit: float) -> Iterator[Mark]:
    network = lamellas.network
    if not len(network.ids):
        return
    most = np.maximum.reduceat(values, network.sample_offsets[:-1])
    over = np.flatnonzero(most > limit)
    chosen = over[np.argsort(-most[over], kind="stable")][:MARKS_MAX]
    if not len(chosen):
        return
    first, end = network.sample_offsets[chosen], network.sample_offsets[chosen + 1]
    places = [int(a + np.argmax(values[a:b])) for a, b in zip(first.tolist(), end.tolist(), strict=True)]
    yield Mark(key, network.sample_points[places], tuple(network.ids[k] for k in chosen.tolist()))
