"""A .3dm file being filled: units, text, layers, attributes whose ids follow from names, meshes, curves."""

from __future__ import annotations

import base64
import uuid
from collections.abc import Mapping

import numpy as np
import rhino3dm
from numpy.typing import NDArray

from lamella.surface.mesh import SurfaceMesh
from lamella.wording import one_line

Floats = NDArray[np.float64]

TOLERANCE = 1e-5
"""m; what Rhino joins within: far above rounding, far below what can be built."""


class RhinoFile:
    """An empty model in metres, with project and version as text.

    Parameters
    ----------
    kind : str
        Name of the file, which its ids depend on.
    name, version : str
        Of the project and of the program; kept as document text ``lamella\\project``, ``lamella\\version``.
    """

    def __init__(self, kind: str, name: str, version: str) -> None:
        self.name, self.version = name, version
        self._names = uuid.uuid5(uuid.NAMESPACE_URL, f"lamella/{kind}")
        self.file = rhino3dm.File3dm()
        self.layers: dict[str, int] = {}
        self.file.ApplicationName = "lamella"
        self.file.ApplicationDetails = f"lamella {one_line(version)}, project {one_line(name)}"
        # openNURBS stamps the time, and on Windows the user's name, into a file of revision 0 only.
        self.file.Revision = 1
        self.say(project=name, version=version)
        settings = self.file.Settings
        settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
        settings.PageUnitSystem = rhino3dm.UnitSystem.Millimeters
        settings.ModelAbsoluteTolerance = TOLERANCE

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
        for x, y, z in surface.points.tolist():
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


def nurbs_curve(degree: int, knots: Floats, controls: Floats) -> rhino3dm.NurbsCurve:
    """A curve from its control points (n, 3) and all but the first and the last of its knots.

    openNURBS leaves those two out, which no basis function needs.
    """
    points = [rhino3dm.Point3d(x, y, z) for x, y, z in controls.tolist()]
    curve = rhino3dm.NurbsCurve.Create(False, degree, points)
    inner = curve.Knots
    for k, knot in enumerate(knots.tolist()):
        inner[k] = knot
    return curve
