"""What is known of the panels on a net."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.message import Message
from lamella.base.result import Shown
from lamella.panels.flatness import Planes
from lamella.panels.polygons import Polygons
from lamella.panels.rules import PanelRules

LAID = ("inside", "rim", "umbilic")
INSIDE, RIM, UMBILIC = range(3)
"""Where a panel lies: whole, cut by a rim, with a singular node as a corner or in its middle."""

MADE = ("flat", "single-curved", "cold-bent")
FLAT, SINGLE_CURVED, COLD_BENT = range(3)


@dataclass(frozen=True, eq=False, repr=False)
class Panels(Shown):
    """The panels on a net: as the net divides its surface, and the plates they are made of.

    Attributes
    ----------
    rules : PanelRules
    points : (n, 3)
        The net's nodes, moved along the normals by the offset, m.
    planned : Polygons
        Panels over these nodes.
    laid : (p,) int
        Index into `LAID`.
    planes : Planes
        Of the planned panels, m.
    over : (p,) bool
        Beyond the limit out of plane.
    plates : Polygons
        What is cut: a panel each, or triangles, or runs of several panels.
    owners : (q,) int
        The panel each plate is made for; of a run the first.
    ids : tuple of str
        Of the plates: "P1", the triangles "P7.1", "P7.2", runs "S1".
    made : (q,) int
        Index into `MADE`.
    radii : (q,)
        Least bending radius, m; infinite for flat plates, nan for those bent cold.
    outlines : (e, 2)
        Corners of the flat plates, less half a gap on all sides, m.
    corners : (e, 3)
        The same in space, m.
    angles, kinks : (e,)
        At the corners, and across the side that begins there; degrees, see `lamella.panels.angles`.
    areas : (q,)
        Of the flat plates, m2.
    kinds : (q,) int
        Plates of one kind are cut alike.
    left_out : (l, 3)
        Places of those that the gap leaves nothing of, m.
    notes : tuple of Message
        What `warnings` returns.
    """

    rules: PanelRules
    points: Floats
    planned: Polygons
    laid: Integers
    planes: Planes
    over: Booleans
    plates: Polygons
    owners: Integers
    ids: tuple[str, ...]
    made: Integers
    radii: Floats
    outlines: Floats
    corners: Floats
    angles: Floats
    kinks: Floats
    areas: Floats
    kinds: Integers
    left_out: Floats
    notes: tuple[Message, ...] = ()

    def _line(self) -> str:
        return (
            f"{len(self.ids)} plates of {self.different} kinds, {self.areas.sum():.4g} m2, out of plane up to "
            f"{1000 * self.planes.out_of_plane.max(initial=0):.3g} mm"
        )

    @property
    def quantities(self) -> Integers:
        """Plates of each kind, (k,)."""
        return np.bincount(self.kinds, minlength=self.different)

    @property
    def first_of_kind(self) -> Integers:
        """The first plate of each kind, (k,), which stands for all of it."""
        return np.unique(self.kinds, return_index=True)[1]

    @property
    def different(self) -> int:
        """Number of kinds."""
        return int(self.kinds.max(initial=-1)) + 1

    def warnings(self) -> tuple[Message, ...]:
        """What a user should know before ordering them."""
        return self.notes

    def describe(self) -> dict[str, Any]:
        """Figures, as in summary.json."""
        planes, inside = self.planes, self.laid == INSIDE
        # of the cells of lamellas, which are all warped by nearly the same; quads of principal lines are not warped
        cells = inside & (self.rules.on == "cells") & np.isfinite(planes.warps)
        warps = planes.warps[cells]
        kinks = np.abs(self.kinks[np.isfinite(self.kinks)])
        return {
            "count": len(self.ids),
            "different": self.different,
            "planned": len(self.planned),
            "out_of_plane_max_mm": 1000 * float(planes.out_of_plane.max(initial=0)),
            "out_of_plane_median_mm": 1000 * float(np.median(planes.out_of_plane)) if len(self.planned) else 0.0,
            "over_limit": int(self.over.sum()),
            "warp_mean_mm": 1000 * float(warps.mean()) if len(warps) else None,
            "warp_max_mm": 1000 * float(warps.max()) if len(warps) else None,
            "warp_min_mm": 1000 * float(warps.min()) if len(warps) else None,
            "kink_max_deg": float(kinks.max()) if len(kinks) else 0.0,
            "area": float(self.areas.sum()),
            "left_out": len(self.left_out),
        }
