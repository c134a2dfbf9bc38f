"""What the view shows of panels: their plates, coloured by how far panels are out of plane."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.panels.bodies import sheet
from lamella.panels.panels import RIM, Panels
from lamella.view.scene.layer import MeshLayer
from lamella.view.scene.quantity import Quantity, magnitude
from lamella.view.scene.scene import Mark, Shown

COLOUR = "#bacdd6"
MM = 1000.0


def panels_scene(panels: Panels) -> Iterator[Shown]:
    """A layer of all plates, and the places of those beyond the limit."""
    at = panels.plates.offsets.tolist()
    sheets = [sheet(panels.corners[at[k] : at[k + 1]], run=one.startswith("S")) for k, one in enumerate(panels.ids)]
    if not sheets:
        return
    sizes = [len(vertices) for vertices, _ in sheets]
    starts = np.cumsum([0, *sizes[:-1]])
    owner = np.repeat(np.arange(len(sheets)), sizes)
    yield MeshLayer(
        name="panels",
        label="Panel",
        groups=("Panels",),
        colour=COLOUR,
        opacity=0.9,
        positions=np.concatenate([vertices for vertices, _ in sheets]),
        faces=np.concatenate([faces + start for (_, faces), start in zip(sheets, starts.tolist(), strict=True)]),
        ids=panels.ids,
        owner=owner,
        quantities=tuple(one.of(owner) for one in _quantities(panels)),
    )
    over = np.flatnonzero(panels.over)
    if len(over):
        ids = tuple(f"P{k + 1}" for k in over.tolist())
        yield Mark("panels_over_limit", panels.planes.origins[over], ids)


def _quantities(panels: Panels) -> Iterator[Quantity]:
    """What plates can be coloured by, a value each."""
    owners = panels.owners
    off = MM * panels.planes.out_of_plane[owners]
    # panels cut by a rim are out of plane by more than all others
    inside = off[panels.laid[owners] != RIM]
    yield magnitude("out_of_plane", "Out of plane", "mm", off, float(inside.max()) if len(inside) else None)
    kinks = np.zeros(len(panels.ids))
    np.maximum.at(kinks, panels.plates.owner, np.nan_to_num(np.abs(panels.kinks)))
    yield magnitude("kink", "Kink to a neighbour, most", "deg", kinks)
    yield magnitude("plate_area", "Area of the plate", "m2", panels.areas)
