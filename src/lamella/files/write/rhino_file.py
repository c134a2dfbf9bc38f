"""A .3dm file being filled: units, text, layers, attributes whose ids follow from names, meshes, curves."""

from __future__ import annotations

import base64
import uuid
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import rhino3dm

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.units import METRES
from lamella.base.wording import one_line
from lamella.files.write.nurbs_objects import nurbs_curve
from lamella.surface.mesh import SurfaceMesh

RHINO_TOLERANCE = 1e-5
"""m; what Rhino joins within: far above rounding, far below what can be built."""


UNITS = {"m": "Meters", "mm": "Millimeters", "cm": "Centimeters", "dm": "Decimeters", "ft": "Feet", "in": "Inches"}
"""Names of openNURBS."""


@dataclass(frozen=True)
class Frame:
    """Coordinates of a file.

    Attributes
    ----------
    unit : str
        One of `lamella.base.units.PROJECT_UNITS`.
    origin : (3,) of float
        Point of the drawing that what is written is measured from, m.
    """

    unit: str = "m"
    origin: Origin = NOWHERE


IN_METRES = Frame()


class RhinoFile:
    """An empty model with project and version as text.

    What is put into it is in metres from the origin; `placed` makes the file's coordinates of it.

    Parameters
    ----------
    kind : str
        Name of the file, which its ids depend on.
    name, version : str
        Of the project and of the program; kept as document text ``lamella\\project``, ``lamella\\version``.
    frame : Frame
        The file's unit, and where in the drawing points are measured from.
    """

    def __init__(self, kind: str, name: str, version: str, frame: Frame = IN_METRES) -> None:
        self.name, self.version = name, version
        self.metres, self._origin = METRES[frame.unit], np.array(frame.origin)
        self._names = uuid.uuid5(uuid.NAMESPACE_URL, f"lamella/{kind}")
        self.file = rhino3dm.File3dm()
        self.layers: dict[str, int] = {}
        self.file.ApplicationName = "lamella"
        self.file.ApplicationDetails = f"lamella {one_line(version)}, project {one_line(name)}"
        # openNURBS stamps the time, and on Windows the user's name, into a file of revision 0 only.
        self.file.Revision = 1
        self.say(project=name, version=version)
        settings = self.file.Settings
        settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, UNITS[frame.unit])
        settings.PageUnitSystem = rhino3dm.UnitSystem.Millimeters
        settings.ModelAbsoluteTolerance = RHINO_TOLERANCE / self.metres

    def placed(self, points: Floats) -> Floats:
        """Points (..., 3) in the file's unit and the drawing's coordinates."""
        return np.asarray((points + self._origin) / self.metres)

    def add_curve(self, degree: int, knots: Floats, controls: Floats, attributes: rhino3dm.ObjectAttributes) -> None:
        """Add a curve by arc length, see `nurbs_curve`, m."""
        self.file.Objects.AddCurve(nurbs_curve(degree, knots / self.metres, self.placed(controls)), attributes)

    def say(self, **text: str) -> None:
        """Put document text ``lamella\\key``."""
        for key, value in text.items():
            self.file.Strings[f"lamella\\{key}"] = one_line(value)

    def identity(self, *names: str) -> uuid.UUID:
        """The same id for the same project and names."""
        return uuid.uuid5(self._names, "\n".join((self.name, *names)))

    def add_layers(self, colours: Mapping[str, tuple[int, int, int]]) -> None:
        """Add layers by name."""
        for name, colour in colours.items():
            layer = rhino3dm.Layer()
            layer.Name = name
            layer.Id = self.identity(name)
            layer.Color = (*colour, 255)
            self.layers[name] = self.file.Layers.Add(layer)

    def attributes(self, layer: str, name: str, **text: str) -> rhino3dm.ObjectAttributes:
        """Attributes of an object on a layer, with user text."""
        attributes = rhino3dm.ObjectAttributes()
        attributes.Id = self.identity(layer, name)
        attributes.Name = one_line(name)
        attributes.LayerIndex = self.layers[layer]
        for key, value in text.items():
            attributes.SetUserString(key, value)
        return attributes

    def add_mesh(self, surface: SurfaceMesh, attributes: rhino3dm.ObjectAttributes) -> None:
        """Add a mesh of triangles and quads in double precision, with its normals."""
        mesh = rhino3dm.Mesh()
        vertices, normals, faces = mesh.Vertices, mesh.Normals, mesh.Faces
        vertices.UseDoublePrecisionVertices = True
        for x, y, z in self.placed(surface.points).tolist():
            vertices.AddPoint3d(x, y, z)
        for x, y, z in surface.normals.tolist():
            normals.Add(x, y, z)
        for a, b, c, d in surface.faces.tolist():
            if c == d:
                faces.AddFace(a, b, c)
            else:
                faces.AddFace(a, b, c, d)
        self.file.Objects.AddMesh(mesh, attributes)

    def encoded(self) -> bytes:
        """The file's bytes."""
        return base64.b64decode(self.file.Encode())
