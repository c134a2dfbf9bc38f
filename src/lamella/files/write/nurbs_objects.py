"""NURBS curves and surfaces for Rhino's library, handed over as whole arrays.

rhino3dm sets control points and knots one by one from Python, which takes longer than all else about a model. It also
decodes an object from the bytes of an openNURBS archive (opennurbs_archive.h: chunks of type code, length, content and
checksum), and these are arrays as they lie in memory.
"""

from __future__ import annotations

import base64
import struct
import zlib
from functools import cache
from typing import Any

import numpy as np
import rhino3dm

from lamella.base.arrays import Floats

# type codes of the chunks of an object: the object, its class, its content, its end
OBJECT, CLASS, CONTENT, END = 0x00027FFA, 0x0002FFFB, 0x0002FFFC, 0x80027FFF
# classes ON_NurbsCurve and ON_NurbsSurface, and the version of their content that is written here
CURVE_CLASS, SURFACE_CLASS = (
    bytes.fromhex("ddd4d74e47e9d311bfe50010830122f0"),
    bytes.fromhex("ded4d74e47e9d311bfe50010830122f0"),
)
CONTENT_VERSION = b"\x10"
# a bounding box that readers make anew, as openNURBS writes it
NO_BOX = struct.pack("<6d", 1.0, 0.0, 0.0, -1.0, 0.0, 0.0)


def nurbs_curve(degree: int, knots: Floats, controls: Floats) -> rhino3dm.NurbsCurve:
    """A curve from its control points (n, 3) and all but the first and the last of its knots.

    openNURBS leaves those two out, which no basis function needs.
    """
    head = struct.pack("<6i", 3, 0, degree + 1, len(controls), 0, 0)
    return _decoded(CURVE_CLASS, head + NO_BOX + _counted(knots, len(knots)) + _counted(controls, len(controls)))


def nurbs_surface(degrees: tuple[int, int], knots: tuple[Floats, Floats], controls: Floats) -> rhino3dm.NurbsSurface:
    """A surface from its control points (n, m, 3), and all but the first and the last knot of either direction."""
    n, m, _ = controls.shape
    head = struct.pack("<8i", 3, 0, degrees[0] + 1, degrees[1] + 1, n, m, 0, 0)
    numbered = b"".join(_counted(one, len(one)) for one in knots)
    return _decoded(SURFACE_CLASS, head + NO_BOX + numbered + _counted(controls, n * m))


def _counted(numbers: Floats, count: int) -> bytes:
    """An array of doubles after the number of its items."""
    return struct.pack("<i", count) + np.ascontiguousarray(numbers, "<f8").tobytes()


def _decoded(kind: bytes, content: bytes) -> Any:
    """The object of a class with this content."""
    whole = b"".join((_chunk(CLASS, kind), _chunk(CONTENT, CONTENT_VERSION + content), struct.pack("<Iq", END, 0)))
    data = struct.pack("<Iq", OBJECT, len(whole)) + whole
    made = rhino3dm.CommonObject.Decode(_archive() | {"data": base64.b64encode(data).decode()})
    if made is None:
        raise RuntimeError("rhino3dm lays out its objects in a way this program does not know")
    return made


def _chunk(code: int, content: bytes) -> bytes:
    return struct.pack("<Iq", code, len(content) + 4) + content + struct.pack("<I", zlib.crc32(content))


@cache
def _archive() -> dict[str, Any]:
    """What rhino3dm says of the archives of this version."""
    encoded: dict[str, Any] = rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 0, 0)).Encode()
    return encoded
