"""The table [erection]: the flat state of a net, and its way to the designed shape."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lamella.project.values import Table, number


class ErectionTable(Table):
    """The net laid flat with its joints free, and driven from there to its designed shape. Without it neither is."""

    states: int = number("States of the way, flat and designed counted.", "", ge=2, le=1000, default=20)
    elements: int = number("Beam elements of each cell edge.", "", ge=1, le=16, default=2)
    driver: Literal["angles"] = Field(
        default="angles",
        description='"angles": moments in the joints, each in proportion to what the joint has to turn.',
    )
