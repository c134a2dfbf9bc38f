"""The table erection.lifting: a net, or each of its segments, hung from a crane."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from lamella.base.number_lists import Refusal
from lamella.project.driver_table import check_points
from lamella.project.values import Points, Table, length, number


class LiftingTable(Table):
    """Lifting under its own weight once joints are locked, at two, three or four points from one hook: deflections,
    stresses, forces of slings, and which bracing it needs before."""

    points: Annotated[tuple[int, ...], Field(strict=False)] = number(
        "Numbers of lifting points that are looked at, each from 2 to 4, at nodes around the centre of gravity.",
        "",
        default=(2, 3, 4),
    )
    at: Points | None = number(
        "Or points, each of the nearest node, that the whole net is lifted at.", "m", default=None
    )
    hook: float | None = length(
        "Of the hook over the highest node that is lifted; when not given half the distance of the nodes farthest "
        "apart that it is lifted at.",
        default=None,
    )
    diameter: float = length("Of the slings' strands.", default=0.01)
    limit: float = number(
        "Largest deflection from the designed shape, over the largest extent, that needs no further bracing.",
        "",
        gt=0,
        le=1,
        default=0.02,
    )

    @model_validator(mode="after")
    def _few(self) -> LiftingTable:
        wrong = next((count for count in self.points if not 2 <= count <= 4), None)
        if wrong is not None or not self.points or len(set(self.points)) < len(self.points):
            given = "none" if wrong is None else f"{wrong}"
            raise Refusal(
                f"numbers of lifting points: {given if not self.points or wrong is not None else 'one is there twice'}",
                "give each of 2, 3 and 4 at most once, or other points with at",
                "points",
            )
        check_points(self.at, 2, "at")
        return self
