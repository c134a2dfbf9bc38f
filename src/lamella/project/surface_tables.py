"""The table [surface] of a project file, one for each kind of surface."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from lamella.base.drawing_origin import FAR_SIZES
from lamella.base.limits import LEAST_LENGTH, MOST_LENGTH
from lamella.base.number_lists import Refusal, two_numbers
from lamella.base.wording import rounded, shown
from lamella.project.boundary_tables import BoundaryTable
from lamella.project.values import (
    Point,
    Range,
    Table,
    Unit,
    file_name,
    length,
    list_of_tables,
    number,
)

# of a helicoid: the longer side of its parameter rectangle over the shorter one
MOST_ELONGATED = 10_000
# of Enneper's surface: |g| = radius^(order - 1) on the rim, the metric there is 1 + |g|^2 times that in the middle
MOST_ENNEPER_GROWTH = 100
MOST_LOOPS = 50
MESH_FILES = (".obj", ".off", ".ply", ".stl", ".3dm")


class _WithHeight(Table):
    """Checks of the key `height` of surfaces of revolution."""

    @field_validator("height", mode="before", check_fields=False)
    @classmethod
    def _in_order(cls, value: Any) -> Any:
        z0, z1 = two_numbers(value, "[z0, z1]", "a range of heights")
        if z0 >= z1:
            remedy = f"write [{z1:g}, {z0:g}]" if z0 > z1 else "write two different heights, the lower one first"
            state = "reversed" if z0 > z1 else "empty"
            raise Refusal(f"the range [{z0:g}, {z1:g}] is {state}: z0 has to be below z1", remedy)
        if z1 - z0 < LEAST_LENGTH:
            raise Refusal(f"the range is only {z1 - z0:g} m long (limit {LEAST_LENGTH:g} m)", "lengths are in metres")
        return z0, z1


class UnduloidTable(_WithHeight):
    """Delaunay's unduloid about the z axis: H = 1 / (neck_radius + bulge_radius), normal towards the axis."""

    kind: Literal["unduloid"]
    neck_radius: float = length("Smallest radius, at z = 0.", examples=[1.6])
    bulge_radius: float = length("Largest radius; not below neck_radius.", examples=[2.8])
    height: Range = number(
        "Heights [z0, z1] of the rims, z = 0 at a neck; several periods allowed.", "m", examples=[[-2.0, 3.0]]
    )


class NodoidTable(_WithHeight):
    """Neck branch of a nodoid: H = 1 / (bulge_radius - neck_radius), normal away from the axis at the neck."""

    kind: Literal["nodoid"]
    neck_radius: float = length("Smallest radius, at z = 0.", examples=[3.0])
    bulge_radius: float = length("Largest radius of the whole nodoid; above neck_radius.", examples=[9.0])
    height: Range = number(
        "Heights [z0, z1] of the rims, z = 0 at the neck, |z| below the fold.", "m", examples=[[-1.5, 1.5]]
    )


class CatenoidTable(_WithHeight):
    """Minimal surface of revolution r = c cosh(z / c)."""

    kind: Literal["catenoid"]
    neck_radius: float = length("Radius c at z = 0.", examples=[2.0])
    height: Range = number("Heights [z0, z1] of the rims, z = 0 at the neck.", "m", examples=[[-2.0, 2.5]])

    @model_validator(mode="after")
    def _possible(self) -> CatenoidTable:
        limit = self.neck_radius * math.acosh(max(MOST_LENGTH / self.neck_radius, 1.0))
        for z in self.height:
            if abs(z) > limit:
                raise Refusal(
                    f"at z = {z:g} m a catenoid of neck_radius = {self.neck_radius:g} m is wider than "
                    f"{MOST_LENGTH:g} m (limit |z| <= {limit:.4g} m)",
                    f"keep height within [{-rounded(limit, up=False):g}, {rounded(limit, up=False):g}], or widen the "
                    "neck",
                    "height",
                )
        return self


class CylinderTable(_WithHeight):
    """Circular cylinder, H = 1 / (2 radius); lamellas are helices at 45 degrees."""

    kind: Literal["cylinder"]
    radius: float = length("Radius.", examples=[2.0])
    height: Range = number("Heights [z0, z1] of the rims.", "m", examples=[[0.0, 4.0]])


class HelicoidTable(Table):
    """Ruled minimal surface; lamellas are its rulings and its helices."""

    kind: Literal["helicoid"]
    pitch: float = number(
        "Rise of a full turn; negative: left-handed.", "m", ge=-MOST_LENGTH, le=MOST_LENGTH, examples=[5.0]
    )
    inner_radius: float = number("Radius of the inner rim.", "m", ge=0, le=MOST_LENGTH, examples=[1.0])
    outer_radius: float = length("Radius of the outer rim; above inner_radius.", examples=[3.2])
    turns: float = number("Number of full turns.", "", ge=0.001, le=1000, examples=[0.5])

    @model_validator(mode="after")
    def _possible(self) -> HelicoidTable:
        if self.inner_radius >= self.outer_radius:
            raise Refusal(
                f"inner_radius = {self.inner_radius:g} m is not below outer_radius = {self.outer_radius:g} m",
                "lower inner_radius, or raise outer_radius",
                "inner_radius",
            )
        if abs(self.pitch) < 1e-6 * self.outer_radius:
            raise Refusal(
                f"pitch = {self.pitch:g} m makes a flat ring (limit {1e-6 * self.outer_radius:g} m for this "
                "outer_radius): on a plane every point is umbilic (all directions bend alike), so no net of lamellas "
                "is singled out",
                "choose a pitch of the size of the radii",
                "pitch",
            )
        # sides of the rectangle of conformal parameters, which the lamellas run along
        c = abs(self.pitch) / (2 * math.pi)
        across = math.asinh(self.outer_radius / c) - math.asinh(self.inner_radius / c)
        along = 2 * math.pi * self.turns
        if along > MOST_ELONGATED * across:
            raise Refusal(
                f"the strip between inner_radius = {self.inner_radius:g} m and outer_radius = {self.outer_radius:g} m "
                f"is too narrow for pitch = {self.pitch:g} m and {self.turns:g} turns: over {MOST_ELONGATED:,} times "
                "as many cells along as across",
                "widen the radii, or lower turns or pitch",
                "outer_radius",
            )
        if across > MOST_ELONGATED * along:
            raise Refusal(
                f"turns = {self.turns:g} makes a sliver: over {MOST_ELONGATED:,} times as many cells across as along",
                "raise turns",
                "turns",
            )
        return self


class EnneperTable(Table):
    """Enneper's minimal surface of any order; order 3 and above has a singular node in the middle."""

    kind: Literal["enneper"]
    order: int = number("2 = classical, 3 = one hexagonal node, n has 2 n rays.", "", ge=2, le=12, default=2)
    radius: float = number("Radius of the parameter disc.", "", ge=0.001, le=5, examples=[0.9])
    scale: float = length("Metres per unit of the parametrisation.", default=1.0, examples=[4.0])

    @model_validator(mode="after")
    def _possible(self) -> EnneperTable:
        limit = MOST_ENNEPER_GROWTH ** (1 / (self.order - 1))
        if self.radius > limit:
            raise Refusal(
                f"radius = {self.radius:g} is out of range: at most {limit:.4g} for order {self.order}, where the "
                f"rim's cells are {MOST_ENNEPER_GROWTH**2:,} times those in the middle",
                f"write radius = {rounded(limit, up=False):g} or less; beyond a radius of about 1 the surface cuts "
                "through itself anyway",
                "radius",
            )
        return self


class ScherkTable(Table):
    """Scherk's minimal surface z = ln(cos y / cos x) over a square."""

    kind: Literal["scherk"]
    extent: float = number(
        "Half side of the square |x|, |y| <= extent in the parametrisation; below pi / 2 = 1.5708.",
        "",
        ge=0.001,
        lt=math.pi / 2,
        examples=[1.25],
    )
    scale: float = length("Metres per unit of the parametrisation.", default=1.0, examples=[3.0])


def _order() -> Any:
    return number("Order of the surface's elements.", "", ge=2, le=4, default=4)


def _tolerance() -> Any:
    return number(
        "Largest |H - mean_curvature| at the check points, over the surface's curvature scale (root mean square of "
        "sqrt((k1^2 + k2^2) / 2)). Elements are made small enough to keep it: a tenth of it takes about five times the "
        "nodes at order 4.",
        "",
        ge=1e-6,
        le=0.5,
        default=2e-3,
    )


def _most_nodes() -> Any:
    return number(
        "Nodes at most; a surface whose tolerance needs more is refused.", "", ge=500, le=1_000_000, default=100_000
    )


def _origin() -> Any:
    return number(
        "Point of the drawing [x, y, z] that the program measures from. When not given a round point beside the "
        f"drawing where that is more than {FAR_SIZES:g} times its size away (survey coordinates), else the drawing's "
        "own origin. Files, summary and messages are in the drawing's coordinates in any case.",
        "m",
        default=None,
        examples=[[4500000.0, 5300000.0, 0.0]],
    )


class FormFoundTable(Table):
    """Surface of constant mean curvature in a boundary: a soap film (H = 0) or an inflated one."""

    kind: Literal["form-found"]
    mean_curvature: float | None = number(
        "Mean curvature; above 0 the surface bends towards its normal, which follows the outer loop by the right-hand "
        "rule. 0 when volume is not given either.",
        "1/m",
        ge=-1e6,
        le=1e6,
        default=None,
        examples=[0.0],
    )
    volume: float | None = number(
        "Enclosed volume, with lids over the loops, instead of mean_curvature; above 0 on the side the normal points "
        "to: a dome over a counter-clockwise loop. Where parts of a loop slide, each part has a lid of its own: a "
        "vault's volume is between it, the ground and the planes of its arches.",
        "m3",
        ge=-1e12,
        le=1e12,
        default=None,
        examples=[40.0],
    )
    normal_curvature: float | None = number(
        "Normal curvature c of the lamellas, instead of mean_curvature: with network.angle = 2 phi the surface has "
        "cos^2 phi k1 + sin^2 phi k2 = c, for 90 deg mean curvature c. 0, straight strips, when an angle is given "
        "alone.",
        "1/m",
        ge=-1e6,
        le=1e6,
        default=None,
        examples=[0.0],
    )
    order: int = _order()
    tolerance: float = _tolerance()
    branch: Literal["stable", "unstable"] = Field(
        default="stable", description="Which surface, where there are two: the stable film or the unstable one."
    )
    most_nodes: int = _most_nodes()
    origin: Point | None = _origin()
    adjust_mean_curvature: float = number(
        'How far mean_curvature may be changed where network.closing = "adjust".', "1/m", ge=0, le=1e6, default=0.0
    )
    boundary: Annotated[tuple[BoundaryTable, ...], Field(strict=False)] = Field(
        description="Tables [[surface.boundary]]: the outer loop, then the holes.",
        json_schema_extra={"minItems": 1, "maxItems": MOST_LOOPS},
    )

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: Any) -> Any:
        if isinstance(values, dict) and not {"mean_curvature", "volume", "normal_curvature"} & set(values):
            return values | {"mean_curvature": 0.0}
        return values

    @field_validator("boundary", mode="before")
    @classmethod
    def _loops(cls, value: Any) -> Any:
        return list_of_tables(value, "surface.boundary", MOST_LOOPS)

    @field_validator("boundary", mode="after")
    @classmethod
    def _named(cls, loops: tuple[BoundaryTable, ...]) -> tuple[BoundaryTable, ...]:
        names = [loop.name.strip() or (f"hole {k}" if k else "outer") for k, loop in enumerate(loops)]
        for k, name in enumerate(names):
            if name in names[:k]:
                raise Refusal(
                    f"boundary[{names.index(name)}] and boundary[{k}] are both called {shown(name)}",
                    "give each loop a name of its own",
                )
        named = (loop.model_copy(update={"name": name}) for loop, name in zip(loops, names, strict=True))
        return tuple(loop.in_metres() for loop in named)

    @model_validator(mode="after")
    def _possible(self) -> FormFoundTable:
        if self.mean_curvature is not None and self.volume is not None:
            raise Refusal(
                f"mean_curvature = {self.mean_curvature:g} 1/m and volume = {self.volume:g} m3 are both given",
                "keep one of them",
                "volume",
            )
        if self.normal_curvature is not None and (self.volume is not None or self.mean_curvature):
            given = "mean_curvature" if self.volume is None else "volume"
            raise Refusal(
                f"normal_curvature = {self.normal_curvature:g} 1/m and {given} are both given",
                "keep one of them",
                given,
            )
        if self.volume is not None and self.adjust_mean_curvature:
            raise Refusal(
                "adjust_mean_curvature is given with a volume: H follows from the volume",
                "leave adjust_mean_curvature out, or give mean_curvature instead of volume",
                "adjust_mean_curvature",
            )
        if self.volume is not None and self.branch == "unstable":
            raise Refusal(
                'branch = "unstable" is given with a volume: of a given volume the surface is followed, stable or not',
                "leave branch out, or give mean_curvature instead of volume",
                "branch",
            )
        return self


class MeshTable(Table):
    """The surface of constant mean curvature that a mesh means, its border kept; or the mesh's own surface."""

    kind: Literal["mesh"]
    file: Annotated[str, file_name(MESH_FILES)] = Field(
        max_length=1000,
        description="Mesh of triangles or quads (.obj, .off, .ply, .stl or .3dm), relative to the project file.",
        examples=["surface.obj"],
    )
    unit: Unit | None = Field(
        default=None,
        description="Unit of the file; when not given m, of a .3dm file the one in its header. A file of a size "
        "that no building has is refused where it is not given.",
        examples=["mm"],
    )
    mean_curvature: Literal["fit", "varying"] | float = number(
        'Mean curvature with respect to the mesh\'s normal, or "fit": that of the surface nearest to the mesh. '
        '"varying" keeps the mesh\'s own surface, smooth through its vertices, for nets of a given normal_curvature.',
        "1/m",
        default="fit",
        union_mode="left_to_right",
    )
    corner_angle: float = number(
        "The border has a corner where it turns by more than this.", "deg", gt=0, lt=180, default=40.0
    )
    order: int = _order()
    tolerance: float = _tolerance()
    most_nodes: int = _most_nodes()
    origin: Point | None = _origin()
    deviation: float = number(
        "Largest departure of the mesh from constant mean curvature that is still taken to mean one, over the "
        "curvature scale.",
        "",
        gt=0,
        le=1,
        default=0.1,
    )

    @field_validator("mean_curvature", mode="before")
    @classmethod
    def _fit_or_number(cls, value: Any) -> Any:
        if value in ("fit", "varying"):
            return value
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise Refusal(
                f'{shown(value)} is not "fit", "varying" or a number', 'write "fit", "varying" or a number in 1/m'
            )
        if not abs(value) <= 1e6:
            raise Refusal(f"{shown(value)} 1/m is out of range: has to be from -1e6 to 1e6 1/m", "check the unit")
        return float(value)


SURFACE_TABLES: dict[str, type[Table]] = {
    "unduloid": UnduloidTable,
    "nodoid": NodoidTable,
    "catenoid": CatenoidTable,
    "cylinder": CylinderTable,
    "helicoid": HelicoidTable,
    "enneper": EnneperTable,
    "scherk": ScherkTable,
    "form-found": FormFoundTable,
    "mesh": MeshTable,
}
SurfaceTable = (
    UnduloidTable
    | NodoidTable
    | CatenoidTable
    | CylinderTable
    | HelicoidTable
    | EnneperTable
    | ScherkTable
    | FormFoundTable
    | MeshTable
)
