"""The project file's schema: every key with its unit, default and range."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import tomli_w
from pydantic import Field, ValidationInfo, field_validator, model_validator

from lamella.base.limits import CELLS_MIN, DEFAULT_CELLS, LARGEST_NODE_ANGLE, LEAST_NODE_ANGLE
from lamella.base.material import MATERIALS, Material, find_material
from lamella.base.number_lists import Refusal
from lamella.base.wording import is_byte, shown
from lamella.project.angle_keys import check_angle, with_angle
from lamella.project.boundary_tables import (
    AdjustTable,
    ArcTable,
    BoundaryTable,
    CircleTable,
    PartTable,
    PlaceTable,
    SlideTable,
)
from lamella.project.csv_table import CsvTable
from lamella.project.drawings_table import DrawingsTable
from lamella.project.edge_beam_table import EdgeBeamTable
from lamella.project.erection_table import ErectionTable
from lamella.project.fabrication_table import FabricationTable
from lamella.project.joint_table import CablesTable, JointTable
from lamella.project.list_tables import LIST_TABLES
from lamella.project.load_tables import ACTION_TABLES, CombinationTable, LoadTable, check_actions
from lamella.project.material_table import MaterialTable
from lamella.project.panels_table import PanelsTable
from lamella.project.segments_table import SegmentsTable
from lamella.project.sizing_table import SizingTable
from lamella.project.stock_table import StockTable, check_stock
from lamella.project.structure_analyses_tables import check_construction
from lamella.project.structure_tables import StructureTable, SupportTable, check_list, list_key
from lamella.project.surface_tables import SURFACE_TABLES, FormFoundTable, MeshTable, SurfaceTable
from lamella.project.values import (
    Name,
    Table,
    Unit,
    length,
    number,
)

__all__ = [
    "FURTHER_TABLES",
    "LIST_TABLES",
    "MATERIALS",
    "SURFACE_TABLES",
    "AdjustTable",
    "ArcTable",
    "BoundaryTable",
    "CablesTable",
    "CircleTable",
    "DrawingsTable",
    "EdgeBeamTable",
    "ErectionTable",
    "FabricationTable",
    "FilesTable",
    "FormFoundTable",
    "JointTable",
    "LamellaTable",
    "MaterialTable",
    "MeshTable",
    "NetworkTable",
    "PartTable",
    "PlaceTable",
    "Project",
    "SlideTable",
    "Table",
    "project_schema",
]


# of curves left out; fewer are kept than anybody would build
MOST_LEFT_OUT = 100
_Every = Annotated[int, Field(ge=1, le=MOST_LEFT_OUT)]


class LimitTable(Table):
    """What strips may be used on a boundary that is adjusted."""

    utilisation: float = number(
        "Largest utilisation of the strips, by bending, twist and helix.", "", ge=0.01, le=10.0, examples=[1.0]
    )


class NetworkTable(Table):
    """Which curves the net has, and how dense it is."""

    kind: Literal["lamellas", "principal"] = Field(
        default="lamellas",
        description='"lamellas": the curves strips stand on, straight or with one radius; "principal": principal '
        "lines, for panels that are nearly planar quads. A principal net has no strips: the run ends with the network.",
    )
    cells: int | None = number(
        "Number of A lamellas that cross a loop once around the axis, or that end on the rim of the first hole (B "
        "where these are more); on a simply connected surface, number of cells along its longest principal line (with "
        "several umbilics of odd order: across a disc with as many cells). "
        f"{DEFAULT_CELLS} when spacing is not given either.",
        "",
        ge=CELLS_MIN,
        le=10**12,
        default=None,
        examples=[DEFAULT_CELLS],
    )
    spacing: float | None = length(
        "Wanted median cell edge, instead of cells; the nearest whole number of cells is taken, or a spacing up to a "
        "tenth away with which the net closes and its umbilics are nodes.",
        default=None,
        examples=[0.5],
    )
    every: _Every | Annotated[tuple[_Every, _Every], Field(strict=False)] = Field(
        default=1,
        description="2 keeps every second curve of the net that cells or spacing ask for, 3 every third; [2, 1] every "
        "second one of family A and all of family B. Singular nodes stay nodes. Around a hole cells has to be a "
        "multiple of it.",
        examples=[2, [2, 1]],
    )
    normal_curvature: float | None = number(
        "Normal curvature of all lamellas where it is not to be H: 0 for asymptotic lines. They cross at other angles "
        "than 90 deg then, and where the surface has no such direction there are none. On closed forms of revolution "
        "the net closes around the axis; elsewhere its lines start from even seeds.",
        "1/m",
        ge=-1e6,
        le=1e6,
        default=None,
        examples=[0.0],
    )
    angle: float = number(
        "Angle between the families at the nodes, bisected by the direction of the larger principal curvature. Other "
        "than 90 the surface is found for it, between curves (form-found), with surface.normal_curvature; closing and "
        "limit do not go together with that yet.",
        "deg",
        ge=LEAST_NODE_ANGLE,
        le=LARGEST_NODE_ANGLE,
        default=90.0,
    )
    closing: Literal["open", "round", "adjust"] = Field(
        default="open",
        description="What to do where a net does not close by itself; every net of a closed-form surface closes. With "
        'an angle other than 90 "open" only.',
    )
    limit: LimitTable | None = Field(
        default=None,
        description='With closing = "adjust": what strips may be used, as limit = {utilisation = 1.0}. The nearest '
        "boundary is looked for whose net closes and whose strips keep it. Not with an angle other than 90 yet.",
    )
    minimum_length: float = number(
        "Lamellas shorter than this many median cell edges are left out.", "cells", ge=0, le=100, default=0.5
    )

    @field_validator("every", mode="before")
    @classmethod
    def _counts(cls, value: Any) -> Any:
        counts = value if isinstance(value, list | tuple) else [value]
        remedy = "write a whole number such as 2, or one for each family: [2, 1]"
        if len(counts) not in (1, 2) or any(isinstance(n, bool) or not isinstance(n, int) for n in counts):
            raise Refusal(f"{shown(value)} is not a whole number, or two", remedy)
        if not all(1 <= n <= MOST_LEFT_OUT for n in counts):
            raise Refusal(f"{shown(value)} is out of range: has to be from 1 to {MOST_LEFT_OUT}", remedy)
        return counts[0] if len(set(counts)) == 1 else tuple(counts)

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: Any) -> Any:
        if isinstance(values, dict) and "cells" not in values and "spacing" not in values:
            return values | {"cells": DEFAULT_CELLS}
        return values

    @model_validator(mode="after")
    def _possible(self) -> NetworkTable:
        if self.cells is not None and self.spacing is not None:
            raise Refusal(
                f"cells = {self.cells} and spacing = {self.spacing:g} m are both given", "keep one of them", "spacing"
            )
        if self.kind == "principal" and self.normal_curvature is not None:
            raise Refusal(
                f'normal_curvature = {self.normal_curvature:g} 1/m and kind = "principal" are both given: along '
                "principal lines the normal curvature is the principal one",
                "keep one of them",
                "normal_curvature",
            )
        self._closes()
        return self

    def _closes(self) -> None:
        """Refuse closing and limit where nothing is closed; of them what was given is named, and no way leads back."""
        asked = [key for key, on in (("closing", self.closing != "open"), ("limit", self.limit is not None)) if on]
        both = " and ".join(asked)
        if self.angle != 90 and asked:
            raise Refusal(
                f"angle = {self.angle:g} deg is given with {both}: nets of other angles than 90 deg are not closed yet",
                f"leave {both} out, or write angle = 90",
                "angle",
            )
        if self.limit is not None and (self.closing != "adjust" or self.kind == "principal"):
            reason = f'closing = "{self.closing}"' if self.closing != "adjust" else 'kind = "principal"'
            raise Refusal(
                f"limit changes a boundary for its strips, and {reason} is given",
                "leave limit out"
                if self.normal_curvature is not None
                else 'write closing = "adjust" and a net of lamellas, or leave limit out',
                "limit",
            )
        if self.closing == "adjust" and self.normal_curvature is not None:
            raise Refusal(
                f'closing = "adjust" makes the lattice of a net whole, and lines of normal_curvature = '
                f"{self.normal_curvature:g} 1/m have none on a surface that is found",
                f"leave {both} out, or normal_curvature",
                "closing",
            )


class LamellaTable(Table):
    """Section, material and node marks of the strips."""

    height: float = number("Height of the strip, along the surface normal.", "m", ge=1e-4, le=5, default=0.1)
    thickness: float = number("Thickness of one strip.", "m", ge=1e-6, le=0.5, default=0.0015)
    layers: int = number("Parallel strips of each lamella.", "", ge=1, le=4, default=2)
    offset: float = number("Distance between the middles of neighbouring layers.", "m", gt=0, le=1, default=0.025)
    material: Name = Field(
        default="1.4301",
        max_length=100,
        description=f"One of {', '.join(MATERIALS)}, or a table [materials.NAME] of the project.",
    )
    marks: Literal["arc-length", "relaxed"] = Field(
        default="arc-length",
        description='"arc-length": nodes marked at the 3D arc length, the nodes then hold the strip stretched; '
        '"relaxed": marks lengthened by the integral of h^2 tg^2 / 24, so that the twisted strip carries no tension.',
    )

    layer_lengths: Literal["alike", "own"] = Field(
        default="alike",
        description='"alike": every layer is marked at the node distances of the centre line; "own": each at those of '
        "its own curve to the side, as a part of its own.",
    )
    layer_curves: Literal["offset", "cut", "lamella"] = Field(
        default="offset",
        description='Where layers run, and how they are cut. "offset": at equal distances, all straight or of one '
        "radius; beside the centre line they are bent about their strong axis, which is counted as a stress. "
        '"cut": at equal distances, each with an outline of its own, some millimetres off, free of that stress. '
        '"lamella": on lamella curves of their own, straight or of one radius and free of that stress; offset is then '
        "their mean distance, which goes with the cell edge. The last two make every layer a part of its own length. "
        "With one layer nothing changes.",
    )
    strips: Literal["twisted", "developable"] | None = Field(
        default=None,
        description='"twisted" when not given: strips along the surface normals. "developable": beside them strips '
        "that are bent and not twisted, along the rulings kg n + tg t, with buildable height, stress, planarity, and "
        "which of both is recommended.",
    )

    @model_validator(mode="after")
    def _possible(self) -> LamellaTable:
        if self.thickness >= self.height:
            raise Refusal(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m: the strip stands on "
                "edge, its height is the larger measure",
                f"choose a thickness below {self.height:g} m",
                "thickness",
            )
        if self.layers > 1 and self.offset <= self.thickness:
            raise Refusal(
                f"offset = {self.offset:g} m leaves no gap between layers of thickness {self.thickness:g} m",
                f"choose an offset above {self.thickness:g} m, or layers = 1",
                "offset",
            )
        return self


class FilesTable(Table):
    """What is written."""

    unit: Unit = Field(
        default="m",
        description="Unit of model.3dm and surface.3dm, in their headers and coordinates. Other files are in metres.",
    )

    mesh_tolerance: float = number(
        "Largest distance between the faces of surface.obj and surface.ply and the surface, over the diagonal of its "
        "bounding box. The files say in metres what they keep; it is more where some hundred thousand faces do not do.",
        "",
        ge=1e-6,
        le=0.1,
        default=1e-3,
    )

    csv: CsvTable | None = Field(
        default=None,
        description='Separator and decimal sign of .csv files: {separator = ";", decimal = ","}; a comma and a full '
        "stop when not given.",
    )

    surface_3dm: bool | None = Field(
        default=None,
        description="Whether surface.3dm is written, the NURBS of surfaces of curved triangles. When not given, where "
        "they are at most 10,000 patches (10 MB).",
    )

    solids: bool | None = Field(
        default=None,
        description="Whether model.3dm and model.glb hold the strips as solids with their thickness, slots and holes. "
        "When not given, where [joint] is and they have at most a million triangles (some 60 MB).",
    )

    ifc: bool | None = Field(
        default=None,
        description="Whether model.ifc is written (IFC 4: members, plates, fasteners with properties); it needs the "
        "library ifcopenshell, pip install lamella[ifc].",
    )


# tables that may be left out, in the order of the documentation
FURTHER_TABLES: dict[str, type[Table]] = {
    "network": NetworkTable,
    "lamella": LamellaTable,
    "fabrication": FabricationTable,
    "joint": JointTable,
    "cables": CablesTable,
    "edge_beam": EdgeBeamTable,
    "drawings": DrawingsTable,
    "sizing": SizingTable,
    "segments": SegmentsTable,
    "erection": ErectionTable,
    "structure": StructureTable,
    "panels": PanelsTable,
    "files": FilesTable,
}


class Project(Table):
    """A whole project file.

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project({"surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 3.0]}})
    >>> project.network.cells, project.fabrication.sheet
    (24, (12.0, 2.0))
    """

    name: Name = Field(default="", description="Name of the project; the file's name when not given.", max_length=200)
    surface: Annotated[SurfaceTable, Field(discriminator="kind")]
    network: NetworkTable = NetworkTable()
    lamella: LamellaTable = LamellaTable()
    fabrication: FabricationTable = FabricationTable()
    joint: JointTable | None = Field(default=None, description=(JointTable.__doc__ or "").strip())
    cables: CablesTable | None = Field(default=None, description=(CablesTable.__doc__ or "").strip())
    sizing: SizingTable | None = Field(default=None, description=(SizingTable.__doc__ or "").strip())
    segments: SegmentsTable | None = Field(default=None, description=(SegmentsTable.__doc__ or "").partition("\n")[0])
    stock: Annotated[tuple[StockTable, ...], Field(strict=False)] | None = list_key(StockTable)
    edge_beam: EdgeBeamTable | None = Field(default=None, description=(EdgeBeamTable.__doc__ or "").strip())
    erection: ErectionTable | None = Field(default=None, description=(ErectionTable.__doc__ or "").strip())
    structure: StructureTable | None = Field(default=None, description=(StructureTable.__doc__ or "").strip())
    panels: PanelsTable | None = Field(default=None, description=(PanelsTable.__doc__ or "").strip())
    support: Annotated[tuple[SupportTable, ...], Field(strict=False)] | None = list_key(SupportTable)
    load: Annotated[tuple[LoadTable, ...], Field(strict=False)] | None = list_key(LoadTable)
    combination: Annotated[tuple[CombinationTable, ...], Field(strict=False)] | None = list_key(CombinationTable)
    drawings: DrawingsTable | None = Field(default=None, description=(DrawingsTable.__doc__ or "").strip())
    files: FilesTable = FilesTable()
    materials: dict[Name, MaterialTable] = Field(default={}, description="Materials by name.")

    @field_validator(*LIST_TABLES, mode="before")
    @classmethod
    def _lists(cls, value: Any, info: ValidationInfo) -> Any:
        return check_list(value, str(info.field_name))

    @model_validator(mode="before")
    @classmethod
    def _angled(cls, values: Any) -> Any:
        return with_angle(values)

    @model_validator(mode="before")
    @classmethod
    def _analysed(cls, values: Any) -> Any:
        # what holds it and what acts on it asks for the structure's analysis
        if isinstance(values, dict) and "structure" not in values and set(ACTION_TABLES) & set(values):
            return values | {"structure": {}}
        return values

    @model_validator(mode="after")
    def _possible(self) -> Project:
        check_stock(self.stock or ())
        check_angle(self.surface, self.network.angle, self.network.normal_curvature)
        if self.structure is not None:
            table = self.structure
            check_actions(table, self.load or (), self.combination or ())
            if table.construction is not None:
                check_construction(table.construction, table.joints, table.cables, self.cables is not None)
        if self.joint is not None and self.joint.slot_width is not None and self.fabrication.slot_width is not None:
            raise Refusal(
                f"slot_width is given twice: {self.joint.slot_width:g} m here and {self.fabrication.slot_width:g} m in "
                "[fabrication]",
                "keep one of them",
                "joint.slot_width",
            )
        if self.cables is not None and (self.joint is None or not self.joint.washer):
            raise Refusal(
                "cables are clamped by the bolts of the joints, and there are none",
                "add a table [joint] with washer = true, its default",
                "cables",
            )
        own = any(table.edge_beam for table in getattr(self.surface, "boundary", ()))
        if self.joint is None and (self.edge_beam is not None or own):
            raise Refusal(
                "lamellas are bolted to edge beams with the screws of the joints, and there are none",
                "add a table [joint]",
                "edge_beam",
            )
        return self

    def material(self) -> Material:
        """The material of the lamellas."""
        return find_material(self.lamella.material, self.known_materials())

    def known_materials(self) -> dict[str, Material]:
        """All materials by name, the project's own among them."""
        return MATERIALS | {name: Material(**table.model_dump()) for name, table in self.materials.items()}

    def to_toml(self) -> str:
        """The project with its defaults filled in, as TOML (`Results.project` has those of the pipeline as well)."""
        text = tomli_w.dumps(self.model_dump(mode="json", exclude_none=True))
        # names of files and layers are kept as they are, but what cannot be seen is written as an escape
        return "".join(c if c.isprintable() or c == "\n" or is_byte(c) else f"\\U{ord(c):08X}" for c in text)


def project_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of the project file."""
    schema = Project.model_json_schema()
    # examples of the class are Python
    schema["description"] = schema["description"].partition("\n")[0]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "lamella/project/1",
        "title": "lamella project file",
    } | schema
