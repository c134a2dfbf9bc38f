"""model.ifc: what is built as IFC 4 elements, for the models of other planners (ISO 16739-1:2018).

A layer of a lamella is an IfcMember, a plate an IfcPlate, a bolt, nut or screw an IfcMechanicalFastener; what is
repeated is stored once and mapped to its places. Written with ifcopenshell, an extra: `pip install lamella[ifc]`.
Curvature, twist and residual stress have no place in IFC: they stay in lamellas.json.
"""

from __future__ import annotations

import uuid
from collections.abc import Iterable, Mapping
from typing import Any

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.errors import InputError
from lamella.base.wording import one_line
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.files.write.text import require_finite

# class and predefined type by kind of hardware; others are accessories
FASTENERS = {"bolt": "BOLT", "screw": "SCREW", "nut": "USERDEFINED", "anchor": "ANCHORBOLT"}
PLATES = ("washer", "key", "cross plate", "clamp", "splice", "hub plate", "hub fin", "end plate", "base plate")
MEMBERS = ("cable", "turnbuckle", "edge beam")


def ifc_bytes(layers: Iterable[DrawnLayer], *, name: str, version: str, origin: Origin = NOWHERE) -> bytes:
    """The solids of layers as an IFC file.

    Parameters
    ----------
    layers : iterable of DrawnLayer
        Their `bodies` and `repeated`.
    name, version : str
        Of the project and of the program.
    origin : (3,)
        Where the site lies in the drawing, m.

    Returns
    -------
    bytes
        The same for the same input: ids follow from names, and the header has no time.

    Raises
    ------
    InputError
        ifcopenshell is not installed.
    """
    require_ifcopenshell()
    import ifcopenshell

    model = _Model(ifcopenshell.file(schema="IFC4"), one_line(name), origin)
    for layer in layers:
        model.add(layer)
    model.close()
    header = model.file.header
    header.file_name.name, header.file_name.time_stamp = "model.ifc", "1970-01-01T00:00:00"
    header.file_name.originating_system = f"lamella {one_line(version)}"
    header.file_name.preprocessor_version = ""
    text: str = model.file.to_string()
    return text.encode()


def require_ifcopenshell() -> None:
    """Refuse to write IFC where its library is not installed.

    Raises
    ------
    InputError
    """
    try:
        import ifcopenshell
    except ImportError:
        raise InputError(
            "model.ifc needs the library ifcopenshell, which is not installed",
            "install it (pip install lamella[ifc]), or leave out ifc = true",
            "ifc",
        ) from None
    del ifcopenshell


class _Model:
    """A file being filled."""

    def __init__(self, file: Any, name: str, origin: Origin) -> None:
        self.file, self.name = file, name
        self.materials: dict[str, list[Any]] = {}
        self.elements: list[Any] = []
        make = file.create_entity
        point = make("IfcCartesianPoint", (0.0, 0.0, 0.0))
        self.axes = make("IfcAxis2Placement3D", point)
        self.context = make(
            "IfcGeometricRepresentationContext",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-6,
            WorldCoordinateSystem=self.axes,
        )
        units = [
            make("IfcSIUnit", UnitType=kind, Name=unit, Prefix=prefix)
            for kind, unit, prefix in (
                ("LENGTHUNIT", "METRE", None),
                ("AREAUNIT", "SQUARE_METRE", None),
                ("VOLUMEUNIT", "CUBIC_METRE", None),
                ("PLANEANGLEUNIT", "RADIAN", None),
                ("MASSUNIT", "GRAM", "KILO"),
            )
        ]
        project = self._root(
            "IfcProject",
            name or "lamella",
            RepresentationContexts=[self.context],
            UnitsInContext=make("IfcUnitAssignment", units),
        )
        away = make("IfcAxis2Placement3D", make("IfcCartesianPoint", tuple(map(float, origin))))
        site = self._root("IfcSite", "site", ObjectPlacement=make("IfcLocalPlacement", None, away))
        self.place = make("IfcLocalPlacement", site.ObjectPlacement, self.axes)
        self.building = self._root("IfcBuilding", "structure", ObjectPlacement=self.place)
        for above, below in ((project, site), (site, self.building)):
            self._root("IfcRelAggregates", f"{below.Name} of", RelatingObject=above, RelatedObjects=[below])

    def add(self, layer: DrawnLayer) -> None:
        """The elements of a layer."""
        for body in layer.bodies:
            shape = self._shape(body.vertices, body.triangles)
            self._element("IfcMember", "MEMBER", body.name, shape, {"id": body.name, **body.text})
        for solid in layer.repeated:
            require_finite(solid.origins, solid.axes)
            kind = solid.text.get("kind", layer.name)
            shape = self._shape(solid.vertices, solid.triangles)
            source = self.file.create_entity("IfcRepresentationMap", self.axes, shape)
            for label, origin, axes in zip(solid.labels, solid.origins, solid.axes, strict=True):
                mapped = self._mapped(source, origin, axes)
                text = {"id": solid.name, **solid.text, "place": label}
                self._element(*_kind_of(kind), f"{solid.name} {label}", mapped, text)

    def close(self) -> None:
        """Relations of all elements."""
        if self.elements:
            self._root(
                "IfcRelContainedInSpatialStructure",
                "contents",
                RelatedElements=self.elements,
                RelatingStructure=self.building,
            )
        for name, elements in self.materials.items():
            material = self.file.create_entity("IfcMaterial", name)
            self._root("IfcRelAssociatesMaterial", f"of {name}", RelatedObjects=elements, RelatingMaterial=material)

    def _root(self, kind: str, name: str, **more: Any) -> Any:
        """An entity whose id follows from its class and name."""
        import ifcopenshell.guid

        identity = uuid.uuid5(uuid.NAMESPACE_URL, "\n".join(("lamella/model.ifc", self.name, kind, name)))
        return self.file.create_entity(kind, GlobalId=ifcopenshell.guid.compress(identity.hex), Name=name, **more)

    def _shape(self, vertices: Floats, triangles: Integers) -> Any:
        require_finite(vertices)
        points = self.file.create_entity("IfcCartesianPointList3D", vertices.tolist())
        faces = self.file.create_entity(
            "IfcTriangulatedFaceSet", Coordinates=points, Closed=True, CoordIndex=(triangles + 1).tolist()
        )
        return self.file.create_entity("IfcShapeRepresentation", self.context, "Body", "Tessellation", [faces])

    def _mapped(self, source: Any, origin: Floats, axes: Floats) -> Any:
        make = self.file.create_entity
        x, y, z = (make("IfcDirection", axis) for axis in axes.tolist())
        at = make("IfcCartesianPoint", tuple(origin.tolist()))
        operator = make("IfcCartesianTransformationOperator3D", x, y, at, 1.0, z)
        item = make("IfcMappedItem", source, operator)
        return make("IfcShapeRepresentation", self.context, "Body", "MappedRepresentation", [item])

    def _element(self, kind: str, predefined: str, name: str, shape: Any, text: Mapping[str, str]) -> None:
        make = self.file.create_entity
        more = {"ObjectType": text.get("kind", "part")} if predefined == "USERDEFINED" else {}
        element = self._root(
            kind,
            name,
            Description=text.get("description"),
            ObjectPlacement=make("IfcLocalPlacement", self.place, self.axes),
            Representation=make("IfcProductDefinitionShape", None, None, [shape]),
            Tag=text["id"],
            PredefinedType=predefined,
            **more,
        )
        self.elements.append(element)
        self.materials.setdefault(text.get("material", "unknown"), []).append(element)
        values = [
            make("IfcPropertySingleValue", key, None, _value(self.file, key, value))
            for key, value in text.items()
            if value
        ]
        properties = self._root("IfcPropertySet", f"Lamella_Part {name}", HasProperties=values)
        properties.Name = "Lamella_Part"
        self._root(
            "IfcRelDefinesByProperties",
            f"properties of {name}",
            RelatedObjects=[element],
            RelatingPropertyDefinition=properties,
        )


def _kind_of(kind: str) -> tuple[str, str]:
    """Class and predefined type of a kind of hardware."""
    if kind in FASTENERS:
        return "IfcMechanicalFastener", FASTENERS[kind]
    if kind in PLATES:
        return "IfcPlate", "SHEET"
    if kind in MEMBERS:
        return "IfcMember", "USERDEFINED"
    return "IfcDiscreteAccessory", "USERDEFINED"


def _value(file: Any, key: str, value: str) -> Any:
    """A property with its measure: mass in kg, lengths in m, else a text."""
    if key.endswith("_kg"):
        return file.create_entity("IfcMassMeasure", float(value))
    if key.endswith("_m"):
        return file.create_entity("IfcLengthMeasure", float(value))
    return file.create_entity("IfcLabel", value[:255])
