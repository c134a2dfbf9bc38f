"""The table [panels]: flat panels on the diagonals of a net."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lamella.project.values import Table, number


class PanelsTable(Table):
    """Panels through the net's own nodes. Without this table there are none."""

    kind: Literal["planar", "single-curved"] = Field(
        default="planar",
        description='"planar": a plate for each panel; "single-curved": plates that run over all quads along one '
        "principal direction and are bent along the sides between them.",
    )
    on: Literal["diagonals", "cells"] = Field(
        default="diagonals",
        description='"diagonals": quads through every second node, whose sides are principal directions: planar but '
        'for terms of fourth order; "cells": the cells of the lamellas, which are all warped by nearly the same, for '
        "membranes and plates bent cold. In a principal net both are its cells.",
    )
    along: Literal[1, 2] = Field(
        default=1,
        description="The principal direction that single-curved plates run along: 1 that of the larger principal "
        "curvature, 2 the other.",
    )
    offset: float | None = number(
        "Distance from the surface along its normals, negative to their other side; the height of the lamellas when "
        "not given.",
        "m",
        ge=-1e6,
        le=1e6,
        default=None,
        examples=[0.1],
    )
    gap: float = number("Between neighbouring panels.", "m", ge=0, le=1e3, default=0.01)
    limit_mm: float = number(
        "Distance between a panel's highest and lowest corner, seen from its plane, up to which it is cut flat.",
        "mm",
        ge=0,
        le=1e6,
        default=3.0,
    )
    above_limit: Literal["triangles", "single-curved", "cold-bent"] | None = Field(
        default=None,
        description='What is made of panels beyond that: "triangles"; "single-curved": pieces of cylinders through '
        'four corners; "cold-bent": plates with the true lengths of the sides, pulled into place at a corner. '
        'Those with other than four corners become triangles. "triangles" when not given, for cells "cold-bent".',
    )

    def filled(self, height: float) -> PanelsTable:
        """The table with those values that follow from others, and from the height of the lamellas, m."""
        offset = height if self.offset is None else self.offset
        above = self.above_limit or ("cold-bent" if self.on == "cells" else "triangles")
        return self.model_copy(update={"offset": offset, "above_limit": above})
