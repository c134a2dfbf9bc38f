"""One picture of a design: what the page draws, and the figures beside it, in one binary message."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import orjson
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.view.scene.encode import encode_scene
from lamella.view.scene.scene import Scene

# of arrays in a message, so that the page reads them where they are
_ALIGNED = 4
_TYPES = {"f": "float32", "i": "uint32", "u": "uint8"}
# arrays that a page or a program compares with a run's
SENT = ("nodes",)


@dataclass(frozen=True)
class Frame:
    """What is drawn.

    Attributes
    ----------
    level : "coarse" or "exact"
        Of coarse elements, with lines instead of a net; or what a run of the same text computes.
    arrays : mapping
        By name: "vertices" (n, 3), "faces" (f, 3); "lines" (k, 3), "line_starts" (c + 1,), "line_families" (c,): 0 A,
        1 B, "line_values" (k,): utilisation; "nodes" (q, 3). Lengths in m, from `origin`.
    figures : mapping
        By key; of a coarse frame those that cost nothing, some of them estimates.
    shown : Scene
        What the view draws.
    details : mapping
        "umbilics", "apart", "misses", "warnings": lists of tables, for JSON.
    origin : (x, y, z)
        Point of the drawing that points are measured from, m.
    """

    level: Literal["coarse", "exact"]
    arrays: Mapping[str, NDArray[Any]]
    figures: Mapping[str, float]
    shown: Scene
    details: Mapping[str, Any] = field(default_factory=dict)
    origin: Origin = NOWHERE

    @property
    def size(self) -> float:
        """Diagonal of the surface's bounding box, m."""
        return float(np.linalg.norm(np.ptp(self.arrays["vertices"], axis=0)))

    def message(self, kind: str, number: int, more: Mapping[str, Any]) -> bytes:
        """The message of a frame.

        Four bytes tell the length of a head in JSON, little-endian; behind the head stand the arrays one after the
        other, where the head's "arrays" says: "name": [type, shape, first byte behind the head]. The array "scene" are
        the bytes of `lamella.view.scene.encode`; of the frame's own arrays the nodes go with it.

        Parameters
        ----------
        kind : str
            The head's "type".
        number : int
            What the page acknowledges.
        more : mapping
            What else stands in the head.
        """
        table, parts, at = {}, [], 0
        scene = np.frombuffer(encode_scene(self.shown), np.uint8)
        for name, values in {
            **{name: self.arrays[name] for name in SENT if name in self.arrays},
            "scene": scene,
        }.items():
            kind_of = _TYPES[values.dtype.kind]
            block = np.ascontiguousarray(values, dtype=np.dtype(kind_of).newbyteorder("<")).tobytes()
            table[name] = [kind_of, list(values.shape), at]
            padding = -len(block) % _ALIGNED
            parts += [block, b"\0" * padding]
            at += len(block) + padding
        head = orjson.dumps(
            {
                "type": kind,
                "number": number,
                "level": self.level,
                "figures": dict(self.figures),
                "details": dict(self.details),
                "origin": list(self.origin),
                "size": self.size,
                "arrays": table,
                **more,
            }
        )
        head += b" " * (-(len(head) + 4) % _ALIGNED)
        return b"".join([struct.pack("<I", len(head)), head, *parts])


def triangles(faces: Integers) -> Integers:
    """Triangles (t, 3) of the faces (f, 4) of a `SurfaceMesh`."""
    quads = faces[faces[:, 3] != faces[:, 2]]
    return np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])


def line_arrays(points: Floats, offsets: Integers, families: NDArray[np.str_], values: Floats) -> dict[str, Any]:
    """Arrays of a frame for lines, see `Frame`."""
    return {
        "lines": points,
        "line_starts": offsets,
        "line_families": families == "B",
        "line_values": values,
    }
