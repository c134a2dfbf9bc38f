"""The tables [[surface.boundary]] of a project file: boundary curves, and where they slide."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from lamella.base.limits import MOST_MOVE, MOST_SCALE, MOST_TILT, MOST_WAVES
from lamella.base.number_lists import Refusal
from lamella.base.units import METRES
from lamella.project.edge_beam_table import EdgeBeamTable
from lamella.project.values import (
    Direction,
    Name,
    Point,
    Points,
    Shift,
    Table,
    Triple,
    Unit,
    file_name,
    length,
    list_of_tables,
    number,
)

CURVE_FILES = (".3dm", ".dxf", ".json")
CURVE_PARTS_MAX = 200


class CircleTable(Table):
    """A circle, counter-clockwise about its normal."""

    center: Point = number("Centre [x, y, z].", "m", examples=[[0.0, 0.0, 2.0]])
    radius: float = length("Radius.", examples=[1.3])
    normal: Direction = number("Normal of the circle's plane.", "", default=(0.0, 0.0, 1.0))


class SlideTable(Table):
    """A curve that may slide and is met at 90 degrees: on a plane (point, normal) or up a wall (direction)."""

    point: Point | None = number("A point of the plane the curve lies and slides on.", "m", default=None)
    normal: Direction | None = number("Normal of that plane.", "", default=None)
    direction: Direction | None = number(
        "Direction of the line every point of the curve slides along: that of the wall above it.", "", default=None
    )

    @model_validator(mode="after")
    def _possible(self) -> SlideTable:
        if (self.direction is None) == (self.point is None) or (self.point is None) != (self.normal is None):
            given = ", ".join(key for key in ("point", "normal", "direction") if getattr(self, key) is not None)
            raise Refusal(
                f"{given or 'nothing'} is given: has to be point and normal, or direction",
                "write slide = {point = [0, 0, 0], normal = [0, 0, 1]} or slide = {direction = [0, 0, 1]}",
            )
        return self


class ArcTable(Table):
    """An arc of a circle through three points."""

    start: Point = number("Where the arc begins.", "m", examples=[[0.0, 0.0, 0.0]])
    middle: Point = number("A point on the way.", "m", examples=[[1.0, 1.0, 0.0]])
    end: Point = number("Where the arc ends.", "m", examples=[[2.0, 0.0, 0.0]])


def _with_interpolation(values: Any) -> Any:
    """Points are splined where nothing else is said; circles, arcs and files have no such key."""
    if isinstance(values, dict) and "points" in values and "interpolation" not in values:
        return values | {"interpolation": "spline"}
    return values


Interpolation = Literal["spline", "polyline"]
_INTERPOLATION = (
    'How points are joined: "spline" (quintic through 7 points and more, cubic through fewer) or "polyline", whose '
    'corners are kept; "spline" when not given.'
)


class PartTable(Table):
    """A part of a loop, from its first to its last point; parts join end to end, the last one with the first."""

    points: Points | None = number(
        "Points [x, y, z]; two make a straight part.", "m", default=None, examples=[[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]]]
    )
    interpolation: Interpolation | None = Field(default=None, description=_INTERPOLATION)
    arc: ArcTable | None = Field(default=None, description="An arc {start, middle, end} instead of points.")
    slide: SlideTable | None = Field(default=None, description="Where this part may slide; fixed when not given.")

    _default = model_validator(mode="before")(_with_interpolation)

    @model_validator(mode="after")
    def _possible(self) -> PartTable:
        if (self.points is None) == (self.arc is None):
            given = "points and arc are both given" if self.points else "a part needs points or arc"
            raise Refusal(given, "write points = [[x, y, z], ...] or arc = {start = .., middle = .., end = ..}")
        if self.arc is not None and self.interpolation is not None:
            raise Refusal("an arc has no interpolation", "leave interpolation out", "interpolation")
        return self


class AdjustTable(Table):
    """How far a loop may be changed for a net that closes (network.closing = "adjust"); what is not given is held.

    Where no loop has this table, and surface.adjust_mean_curvature is not given, loops of points and circles may change
    by a twentieth of their size, and only curves of files and parts are held.
    """

    move: float = number("Shift of the loop, at most.", "m", ge=0, le=MOST_MOVE, default=0.0, examples=[0.3])
    scale: float = number(
        "Change of size, as a share of it, at most.", "", ge=0, le=MOST_SCALE, default=0.0, examples=[0.05]
    )
    tilt: float = number(
        "Turn of the loop about any axis, at most.", "degrees", ge=0, le=MOST_TILT, default=0.0, examples=[5.0]
    )
    points: float = number(
        "Shift of any point of the curve, at most, by all waves along the loop together: of its points, or by arc "
        "length.",
        "m",
        ge=0,
        le=MOST_MOVE,
        default=0.0,
        examples=[0.3],
    )
    keep_height: bool = Field(
        default=False, description="Shifts of loop and points in x and y only: supports stay on their ground."
    )

    @model_validator(mode="after")
    def _possible(self) -> AdjustTable:
        if self.keep_height and (self.scale or self.tilt):
            raise Refusal(
                "scale and tilt change heights, which keep_height holds",
                "leave scale and tilt out, or keep_height",
                "keep_height",
            )
        return self


class PlaceTable(Table):
    """Where a curve is put: turned and scaled about its middle, the centroid of its length, then shifted and waved."""

    shift: Shift = number("Shift [x, y, z].", "m", default=(0.0, 0.0, 0.0), examples=[[0.5, 0.0, 0.0]])
    scale: float = number("Size over that in the file.", "", gt=0, le=1e6, default=1.0, examples=[1.05])
    turn: Shift = number(
        "Turn, as a vector along its axis, counter-clockwise.",
        "degrees",
        default=(0.0, 0.0, 0.0),
        examples=[[0.0, 0.0, 15.0]],
    )
    waves: Points = number(
        "Shifts [x, y, z] in waves along the curve, by the fraction t of its length: an even one, then of cos and sin "
        "of 2 pi t, 4 pi t, ...; up to four waves.",
        "m",
        default=(),
        examples=[[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]]],
    )

    @field_validator("waves", mode="after")
    @classmethod
    def _whole(cls, waves: tuple[tuple[float, float, float], ...]) -> tuple[tuple[float, float, float], ...]:
        if len(waves) > 2 * MOST_WAVES + 1 or (waves and len(waves) % 2 == 0):
            raise Refusal(
                f"{len(waves)} shifts: has to be an odd number up to {2 * MOST_WAVES + 1}",
                "write an even shift and two for each wave",
            )
        return waves


_SHAPES = ("points", "circle", "file", "part")


class BoundaryTable(Table):
    """A closed boundary curve: one of points, circle, file or part. The first is the outer loop, the others are holes.

    The surface's normal follows the outer loop by the right-hand rule.
    """

    name: Name = Field(
        default="", max_length=100, description='Name in messages and files; "outer", "hole 1", ... when not given.'
    )
    points: Points | None = number(
        "Points [x, y, z] of the curve, the first not repeated.",
        "m",
        default=None,
        examples=[[[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [4.0, 4.0, 0.0], [0.0, 4.0, 1.0]]],
    )
    interpolation: Interpolation | None = Field(
        default=None,
        description=_INTERPOLATION
        + ' Polylines of a .dxf or .3dm too: there "spline" keeps true corners, and when not given a polyline of many '
        "vertices that turn little is taken as a smooth curve.",
    )
    corner_radius: float | None = length(
        "Corners are rounded by fillets of this least radius of curvature (between straight sides; in m whatever the "
        "unit). Curvature rises and falls smoothly along them, so they begin 1.3 times as far from the corner as an "
        "arc would: at 2.2 radii where the sides meet at 60 degrees, 1.3 at 90, 0.75 at 120. Corners are kept when not "
        "given, always where a part slides, and where they turn by less than 2 degrees.",
        default=None,
        examples=[0.4],
    )
    circle: CircleTable | None = Field(default=None, description="A circle {center, radius, normal}.")
    file: Annotated[str | None, file_name(CURVE_FILES)] = Field(
        default=None,
        max_length=1000,
        description="Curve file (.3dm, .dxf or .json), relative to the project file.",
        examples=["curves.3dm"],
    )
    layer: str | None = Field(
        default=None, max_length=300, description="Layer of the curve in the file.", examples=["boundary"]
    )
    id: str | None = Field(
        default=None,
        max_length=300,
        description="Object name or id (.3dm), handle (.dxf) or name (.json) of the curve in the file.",
        examples=["oculus"],
    )
    unit: Unit | None = Field(
        default=None,
        description="Unit of the file, the one in its header when not given; or of points, circle and part, m when not "
        "given.",
        examples=["mm"],
    )
    part: Annotated[tuple[PartTable, ...], Field(strict=False)] | None = Field(
        default=None,
        description="Tables [[surface.boundary.part]] joined end to end.",
        json_schema_extra={"minItems": 1, "maxItems": CURVE_PARTS_MAX},
    )
    place: PlaceTable | None = Field(
        default=None, description="Where a curve given by circle, file or part is put; as it is given when not given."
    )
    slide: SlideTable | None = Field(default=None, description="Where the loop may slide; fixed when not given.")
    adjust: AdjustTable | None = Field(
        default=None, description='How far the loop may be changed where network.closing = "adjust".'
    )

    edge_beam: EdgeBeamTable | Literal[False] | None = Field(
        default=None,
        description="An edge beam of its own instead of the table [edge_beam], or false: none along this loop.",
    )

    _default = model_validator(mode="before")(_with_interpolation)

    @field_validator("part", mode="before")
    @classmethod
    def _parts(cls, value: Any) -> Any:
        return list_of_tables(value, "surface.boundary.part", CURVE_PARTS_MAX)

    @model_validator(mode="after")
    def _possible(self) -> BoundaryTable:
        given = [key for key in _SHAPES if getattr(self, key) is not None]
        if len(given) != 1:
            reported = f"{' and '.join(given)} are given" if given else "no curve is given"
            remedy = f"keep one of {', '.join(given)}" if given else "add one of them"
            raise Refusal(f"{reported}: has to be one of {', '.join(_SHAPES)}", remedy)
        if self.interpolation is not None and self.points is None:
            if self.file is None:
                raise Refusal("interpolation goes with points", "leave interpolation out", "interpolation")
            if self.file.lower().endswith(".json"):
                raise Refusal(
                    "interpolation goes with points of this table: each curve of a .json says its own",
                    f'write "interpolation": "{self.interpolation}" beside the points in the file',
                    "interpolation",
                )
        splined = self.points is not None and self.interpolation == "spline"
        if self.corner_radius is not None and (self.circle is not None or splined):
            raise Refusal(
                f"corner_radius goes with corners: a {'spline' if splined else 'circle'} has none",
                'write interpolation = "polyline"' if splined else "leave corner_radius out",
                "corner_radius",
            )
        for key in ("layer", "id"):
            if getattr(self, key) is not None and self.file is None:
                raise Refusal(f"{key} goes with file", f"leave {key} out", key)
        slides = self.slide is not None or any(part.slide is not None for part in self.part or ())
        if slides:
            for key in ("adjust", "place"):
                if getattr(self, key) is not None:
                    reported = "adjusted" if key == "adjust" else "placed"
                    raise Refusal(f"a loop that slides cannot be {reported}", f"hold the loop, or leave {key} out", key)
        if self.place is not None and self.points is not None:
            raise Refusal("place goes with circle, file or part, not with points", "change points themselves", "place")
        if self.slide is not None and self.part is not None:
            raise Refusal("a loop of parts slides by its parts", "move slide into the parts that slide", "slide")
        return self

    def in_metres(self) -> BoundaryTable:
        """The same curve with points, circle, parts and sliding planes in metres; of a file as it is."""
        if self.unit is None or self.file is not None:
            return self
        scale = METRES[self.unit]
        ring = self.circle and self.circle.model_copy(update={"radius": self.circle.radius * scale})
        table = self.model_copy(update={"circle": ring, "unit": None})
        return table._with_points(lambda point: (point[0] * scale, point[1] * scale, point[2] * scale))

    def measured_from(self, origin: Triple) -> BoundaryTable:
        """The same curve with points, circle, parts and sliding planes measured from a point; of a file as it is."""
        if not any(origin):
            return self
        x, y, z = origin
        return self._with_points(lambda point: (point[0] - x, point[1] - y, point[2] - z))

    def _with_points(self, change: Callable[[Triple], Triple]) -> BoundaryTable:
        """The curve with each of its points changed; shifts and directions stay."""
        changed = {
            "points": self.points and tuple(map(change, self.points)),
            "circle": _with_keys(self.circle, ("center",), change),
            "slide": _with_keys(self.slide, ("point",), change),
            "part": self.part and tuple(_part_with(part, change) for part in self.part),
        }
        return self.model_copy(update=changed)


def _with_keys(table: Any, keys: tuple[str, ...], change: Callable[[Triple], Triple]) -> Any:
    """A table with the points of some of its keys changed; None stays None."""
    if table is None:
        return None
    given = {key: getattr(table, key) for key in keys}
    return table.model_copy(update={key: change(point) for key, point in given.items() if point is not None})


def _part_with(part: PartTable, change: Callable[[Triple], Triple]) -> PartTable:
    changed = {
        "points": part.points and tuple(map(change, part.points)),
        "arc": _with_keys(part.arc, ("start", "middle", "end"), change),
        "slide": _with_keys(part.slide, ("point",), change),
    }
    return part.model_copy(update=changed)
