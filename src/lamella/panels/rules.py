"""What panels are to be like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from lamella.base.errors import InputError
from lamella.base.wording import shown

ABOVE_LIMIT = ("triangles", "single-curved", "cold-bent")


@dataclass(frozen=True)
class PanelRules:
    """What panels are to be like.

    Attributes
    ----------
    kind : "planar" or "single-curved"
        Plates between the net's nodes, or plates that run over several quads and are bent along the sides between them.
    on : "diagonals" or "cells"
        Through every second node, along the diagonals of the net's cells, or the cells themselves.
    along : 1 or 2
        The principal direction that single-curved panels run along, 1 that of the larger principal curvature.
    offset : float
        From the surface along its normals, m; negative against them.
    gap : float
        Between neighbouring panels, m.
    limit : float
        Distance between a panel's highest and lowest corner up to which it is made flat, m.
    above_limit : "triangles", "single-curved", "cold-bent"
        What is made of panels beyond that.
    """

    kind: Literal["planar", "single-curved"] = "planar"
    on: Literal["diagonals", "cells"] = "diagonals"
    along: Literal[1, 2] = 1
    offset: float = 0.0
    gap: float = 0.01
    limit: float = 0.003
    above_limit: Literal["triangles", "single-curved", "cold-bent"] = "triangles"

    def __post_init__(self) -> None:
        choices = (
            ("kind", self.kind, ("planar", "single-curved")),
            ("on", self.on, ("diagonals", "cells")),
            ("along", self.along, (1, 2)),
            ("above_limit", self.above_limit, ABOVE_LIMIT),
        )
        for name, value, known in choices:
            if value not in known:
                raise InputError(
                    f"{name} = {shown(value)} is unknown", f"write one of {', '.join(map(shown, known))}", name
                )
        for name, measure in (("gap", self.gap), ("limit", self.limit)):
            if not 0 <= measure < float("inf"):
                raise InputError(f"{name} = {measure:g} m is no measure", "write 0 m or more", name)
        if not abs(self.offset) < float("inf"):
            raise InputError(f"offset = {self.offset:g} m is no measure", "write a finite number", "offset")
