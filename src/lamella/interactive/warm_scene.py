"""What the view shows while something is dragged: surface, lines, umbilics, and why the net closes or not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.elements.level_lines import LevelLines
from lamella.network.network import FAMILIES
from lamella.stages.network.scene import NODE_STYLES, PALETTE
from lamella.stages.surface.scene import VEIL
from lamella.view.scene.layer import LinesLayer, MeshLayer, PointsLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, Quantity, magnitude
from lamella.view.scene.scene import Labels, Shown

# cells: less is not worth a label
SHOWN_MISS = 5e-3


def surface_layer(positions: Floats, normals: Floats, faces: Integers, *, alone: bool) -> MeshLayer:
    """The surface, of the name that a run's has."""
    return MeshLayer(
        name="surface",
        label="Surface",
        groups=("Surface",),
        material="surface",
        opacity=1.0 if alone else VEIL,
        palette="Surface",
        positions=positions,
        normals=normals,
        faces=faces,
    )


def line_layers(lines: LevelLines, utilisation: Floats | None) -> Iterator[LinesLayer]:
    """The net's lines, of the names that centre lines have."""
    counts, starts = np.diff(lines.offsets), lines.offsets[:-1]
    for family in FAMILIES:
        own = np.flatnonzero(lines.families == family)
        if not len(own):
            continue
        offsets = np.concatenate([[0], np.cumsum(counts[own])])
        points = np.arange(offsets[-1]) + np.repeat(starts[own] - offsets[:-1], counts[own])
        quantities: tuple[Quantity, ...] = ()
        if utilisation is not None:
            high = min(1.0, float(utilisation.max(initial=0.0)))
            quantities = (magnitude("utilisation", "Utilisation", "of strength", utilisation[points], high),)
        yield LinesLayer(
            name=f"lines {family}",
            label=f"Lines {family}",
            groups=(family,),
            colour=FAMILY_COLOURS[family],
            quantities=quantities,
            quantity="utilisation" if quantities else "layer",
            palette=PALETTE,
            positions=lines.points[points],
            offsets=offsets,
            width=2.5,
        )


def closing_shown(details: Mapping[str, Any]) -> Iterator[Shown]:
    """Umbilics, with the numbers of cells between them; misses at their places."""
    umbilics = [row["point"] for row in details.get("umbilics", ())]
    if umbilics:
        colour, size, least = NODE_STYLES["singular"]
        yield PointsLayer(
            name="umbilics",
            label="Umbilics",
            groups=("Nodes",),
            colour=colour,
            positions=np.array(umbilics),
            size=size,
            least=least,
        )
    yield from closing_labels(details)


def closing_labels(details: Mapping[str, Any]) -> Iterator[Labels]:
    """The texts alone."""
    rows = [
        *((_between(row), f"{row['a']:.2f} × {row['b']:.2f} cells") for row in details.get("apart", ())),
        *((row["place"], f"off by {row['off']:.2g}") for row in details.get("misses", ()) if _is_shown(row)),
    ]
    if rows:
        places, texts = zip(*rows, strict=True)
        yield Labels("closing", "Cells between umbilics, misses", np.array(places, float), tuple(texts), True)


def _between(row: Mapping[str, Any]) -> Sequence[float]:
    middle: list[float] = ((np.array(row["from"]) + np.array(row["to"])) / 2).tolist()
    return middle


def _is_shown(row: Mapping[str, Any]) -> bool:
    return row["place"] is not None and row["off"] > SHOWN_MISS
