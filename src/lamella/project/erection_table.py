"""The table [erection]: the flat state of a net, and its way to the designed shape."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, field_serializer, model_validator

from lamella.base.number_lists import Refusal
from lamella.project.driver_table import ANGLES, DriverTable, check_points
from lamella.project.lifting_table import LiftingTable
from lamella.project.values import Points, Table, number


def _or_angles(schema: dict[str, Any]) -> None:
    """The text "angles", or the table."""
    table = schema.pop("$ref")
    schema |= {"anyOf": [{"const": ANGLES}, {"$ref": table}], "default": ANGLES}


class ErectionTable(Table):
    """The net laid flat with its joints free, and driven from there to its designed shape. Without it neither is."""

    states: int = number("States of the way, its ends counted.", "", ge=2, le=1000, default=20)
    elements: int = number("Beam elements of each cell edge.", "", ge=1, le=16, default=2)
    driver: DriverTable = Field(
        default=DriverTable(),
        description='"angles": moments in the joints, each in proportion to what the joint has to turn; or what '
        "people do on site, a table with one of {cable, lift, radius, supports}; or {angles}, the net used as a "
        "mechanism.",
        json_schema_extra=_or_angles,
    )
    start: Literal["flat", "designed"] | None = Field(
        default=None,
        description='What a driver on site begins with: the "flat" net, or the "designed" shape with its joints let '
        "go, held by the driver alone; a radius when not given the designed shape, all others the flat net.",
    )
    side: Literal["designed", "other"] = Field(
        default="designed",
        description="To which side a driver on site lets the net leave its plane where it may go to either one.",
    )
    gravity: bool | None = Field(
        default=None,
        description="Whether the net weighs on the way, and lies on a floor without friction; when not given it does "
        "where it is lifted.",
    )
    props: Points | None = number(
        "Points, each of the nearest node, that props raise on the way from where they lie to their designed height.",
        "m",
        default=None,
    )

    lifting: LiftingTable | None = Field(
        default=None,
        description=" ".join((LiftingTable.__doc__ or "").split()),
        examples=[{"points": [2, 3, 4]}],
    )

    @field_serializer("driver", mode="plain")
    def _driver(self, value: DriverTable) -> object:
        return value.model_dump(exclude_none=True) if value.kind else ANGLES

    @model_validator(mode="after")
    def _possible(self) -> ErectionTable:
        if self.driver.lift is not None and self.gravity is False:
            raise Refusal("a net without weight is lifted as a whole", "leave gravity out", "gravity")
        check_points(self.props, 1, "props")
        if self.driver.angles is not None:
            for key in ("start", "gravity", "props"):
                if getattr(self, key):
                    raise Refusal(f"{key} does not go with a mechanism", f"leave {key} out", key)
        if not (self.driver.kind or self.on_ground) and self.start is not None:
            raise Refusal('the driver "angles" leads from flat to designed', "leave start out", "start")
        return self

    @property
    def on_ground(self) -> bool:
        """Whether the net weighs or is propped on its way."""
        weighs = self.driver.lift is not None if self.gravity is None else self.gravity
        return bool(weighs or self.props)

    @property
    def weighs(self) -> bool:
        """Whether the net has a weight on its way."""
        return self.driver.lift is not None if self.gravity is None else self.gravity
