"""What drives a net: moments in its joints, or what people do on site."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import Field, model_validator

from lamella.base.number_lists import Refusal
from lamella.base.wording import shown
from lamella.project.values import Name, Point, Points, Table, length, number

ANGLES = "angles"
MOST_CABLES, MOST_DRIVEN_PLACES = 50, 1000


def check_points(points: Sequence[object] | None, least: int, key: str) -> None:
    """Refuse too few and too many points.

    Raises
    ------
    Refusal
    """
    if points is not None and not least <= len(points) <= MOST_DRIVEN_PLACES:
        raise Refusal(f"{len(points)} points are given", f"give {least} to {MOST_DRIVEN_PLACES} points [x, y, z]", key)


class DrivingCableTable(Table):
    """A cable that is shortened, with its stretch."""

    between: Points = number("Its two ends, each at the nearest node: [[x, y, z], [x, y, z]].", "m")
    by: float = length("By which it is shortened at the end of the way.", examples=[0.5])
    diameter: float = length("Of its strand.", default=0.012)

    @model_validator(mode="after")
    def _two(self) -> DrivingCableTable:
        if len(self.between) != 2:
            raise Refusal(f"{len(self.between)} points are given, a cable has two ends", "give two points", "between")
        return self


class LiftTable(Table):
    """Nodes that a crane lifts; the net weighs, and lies on a floor."""

    at: Points = number("Points, each of the nearest node.", "m")
    by: float = length("How far they are lifted.", examples=[1.0])

    @model_validator(mode="after")
    def _some(self) -> LiftTable:
        check_points(self.at, 1, "at")
        return self


class RadiusTable(Table):
    """A ring of nodes whose radius is changed; it may go along its axis."""

    boundary: Name | None = Field(
        default=None, max_length=100, description="Name of the boundary whose nodes it is.", examples=["upper"]
    )
    through: Point | None = number(
        "Or a point: the closed line of diagonals through the nearest node.", "m", default=None
    )
    factor: float = number("Radius at the end over that at the beginning.", "", gt=0, le=10, examples=[0.9])

    @model_validator(mode="after")
    def _one(self) -> RadiusTable:
        if (self.boundary is None) == (self.through is None):
            raise Refusal("one of boundary and through names the ring", "give one of them", "boundary")
        return self


class MovedSupportsTable(Table):
    """Supports that are moved towards their centre."""

    at: Points = number("Points, each of the nearest node.", "m")
    by: float = length("How far each of them is moved.", examples=[0.3])

    @model_validator(mode="after")
    def _some(self) -> MovedSupportsTable:
        check_points(self.at, 2, "at")
        return self


class AngleRangeTable(Table):
    """A net to be used as a mechanism: driven by its easiest motion from one angle of a joint to another."""

    least: float = number("Angle of the joint at the beginning, from A to B.", "deg", gt=0, lt=180, examples=[60.0])
    most: float = number("At the end.", "deg", gt=0, lt=180, examples=[120.0])
    at: Point | None = number(
        "The joint nearest to this point; when not given the one that turns most.", "m", default=None
    )

    @model_validator(mode="after")
    def _range(self) -> AngleRangeTable:
        if not self.least < self.most:
            raise Refusal(f"{self.most:g} deg is not above least = {self.least:g} deg", "exchange them", "most")
        return self


class DriverTable(Table):
    """What drives the net, one of its keys; without one moments in the joints."""

    cable: Annotated[tuple[DrivingCableTable, ...], Field(strict=False)] | None = Field(
        default=None,
        max_length=MOST_CABLES,
        description="A cable that is shortened between two nodes, {between, by, diameter}, or a list of several.",
    )
    lift: LiftTable | None = Field(default=None, description="Nodes lifted by a crane, {at, by}.")
    radius: RadiusTable | None = Field(
        default=None, description="A ring whose radius is changed, {boundary or through, factor}."
    )
    supports: MovedSupportsTable | None = Field(default=None, description="Supports moved together, {at, by}.")
    angles: AngleRangeTable | None = Field(
        default=None, description="The net as a mechanism between two angles of a joint, {least, most, at}."
    )

    @model_validator(mode="before")
    @classmethod
    def _form(cls, value: Any) -> Any:
        if value == ANGLES:
            return {}
        if not isinstance(value, dict):
            raise Refusal(
                f"{shown(value)} drives no net",
                'write "angles", or a table such as {cable = {between = [[0, 0, 0], [2, 0, 0]], by = 0.5}}',
            )
        given = [key for key in value if value[key] is not None]
        if len(given) > 1:
            raise Refusal(f"{' and '.join(sorted(given))} are given", "keep one of them", sorted(given)[1])
        if isinstance(value.get("cable"), dict):
            return value | {"cable": (value["cable"],)}
        return value

    @property
    def kind(self) -> str:
        """The key that is given; "" where there is none."""
        return next((key for key, value in self if value is not None), "")
