"""model.glb: what is built, for viewers, renderers and browsers (glTF 2.0, Khronos Group, binary container).

A solid that stands in many places is stored once; each place is a node with its matrix. glTF measures in metres with y
up: one node at the top turns the model's z there. Coordinates are single precision, so they are measured from the
point that the program measures from; `asset.extras.origin` tells it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Any

import numpy as np
import orjson

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.wording import one_line
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.files.write.text import require_finite

# base colour (linear), metallic and roughness factors
FINISHES: dict[str, tuple[tuple[float, float, float], float, float]] = {
    "metal": ((0.55, 0.56, 0.58), 0.85, 0.45),
    "timber": ((0.50, 0.31, 0.15), 0.0, 0.75),
    "fibre": ((0.42, 0.45, 0.36), 0.0, 0.5),
}
# quaternion that turns z to y
Y_UP = (-(0.5**0.5), 0.0, 0.0, 0.5**0.5)
# numbers of the format: component types, targets of buffer views, chunk types
FLOAT, UNSIGNED = 5126, 5125
VERTICES, INDICES = 34962, 34963
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def glb_bytes(layers: Iterable[DrawnLayer], *, name: str, version: str, origin: Origin = NOWHERE) -> bytes:
    """The solids of layers as a binary glTF file.

    Parameters
    ----------
    layers : iterable of DrawnLayer
        Their `repeated` and their `bodies`; curves and points are left out, and layers without solids.
    name, version : str
        Of the project and of the program.
    origin : (3,)
        Point of the drawing that coordinates are measured from, m.

    Returns
    -------
    bytes
        The same for the same input.
    """
    file = _Gltf()
    for layer in layers:
        file.add(layer)
    return file.encoded(one_line(name), one_line(version), origin)


class _Gltf:
    """A file being filled."""

    def __init__(self) -> None:
        self.nodes: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.layers: list[int] = []
        self.materials: list[str] = []
        self.accessors: list[dict[str, Any]] = []
        # one buffer for all positions, one for all indices
        self.parts: tuple[list[bytes], list[bytes]] = ([], [])
        self.sizes = [0, 0]

    def add(self, layer: DrawnLayer) -> None:
        """A layer's solids, as children of a node of its name."""
        children = []
        for body in layer.bodies:
            mesh = self._mesh(body.name, body.vertices, body.triangles, body.finish)
            children.append(self._node(name=body.name, mesh=mesh, extras={"id": body.name, **body.text}))
        for solid in layer.repeated:
            require_finite(solid.origins, solid.axes)
            mesh = self._mesh(solid.name, solid.vertices, solid.triangles, solid.finish)
            self.meshes[mesh]["extras"] = {"id": solid.name, **solid.text}
            matrices = np.zeros((len(solid.origins), 4, 4))
            matrices[:, :3, :3], matrices[:, 3, :3], matrices[:, 3, 3] = solid.axes, solid.origins, 1.0
            for label, matrix in zip(solid.labels, matrices.reshape(-1, 16).tolist(), strict=True):
                children.append(self._node(name=f"{solid.name} {label}", mesh=mesh, matrix=matrix))
        if children:
            self.layers.append(self._node(name=layer.name, children=children))

    def _node(self, **content: Any) -> int:
        self.nodes.append(content)
        return len(self.nodes) - 1

    def _mesh(self, name: str, vertices: Floats, triangles: Integers, finish: str) -> int:
        require_finite(vertices)
        single = vertices.astype("<f4")
        ends = {"min": single.min(axis=0).tolist(), "max": single.max(axis=0).tolist()}
        position = self._accessor(0, single.tobytes(), FLOAT, len(single), "VEC3", **ends)
        index = self._accessor(1, triangles.astype("<u4").tobytes(), UNSIGNED, triangles.size, "SCALAR")
        if finish not in self.materials:
            self.materials.append(finish)
        material = self.materials.index(finish)
        primitive = {"attributes": {"POSITION": position}, "indices": index, "material": material}
        self.meshes.append({"name": name, "primitives": [primitive]})
        return len(self.meshes) - 1

    def _accessor(self, view: int, data: bytes, component: int, count: int, kind: str, **ends: Any) -> int:
        content = {"bufferView": view, "byteOffset": self.sizes[view], "componentType": component, "count": count}
        self.accessors.append(content | {"type": kind} | ends)
        self.parts[view].append(data)
        self.sizes[view] += len(data)
        return len(self.accessors) - 1

    def encoded(self, name: str, version: str, origin: Origin) -> bytes:
        """The file's bytes."""
        content: dict[str, Any] = {
            "asset": {
                "version": "2.0",
                "generator": f"lamella {version}",
                "extras": {"project": name, "origin": list(origin)},
            },
            "scene": 0,
        }
        top: dict[str, Any] = {"name": name, "rotation": Y_UP}
        if self.layers:
            top["children"] = self.layers
            content |= self._geometry()
        content |= {"scenes": [{"nodes": [len(self.nodes)]}], "nodes": [*self.nodes, top]}
        chunks = _chunk(JSON_CHUNK, orjson.dumps(content), b" ")
        if self.layers:
            chunks += _chunk(BINARY_CHUNK, b"".join(self.parts[0] + self.parts[1]), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def _geometry(self) -> dict[str, Any]:
        first, second = self.sizes
        return {
            "meshes": self.meshes,
            "materials": [_material(finish) for finish in self.materials],
            "accessors": self.accessors,
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": first, "target": VERTICES},
                {"buffer": 0, "byteOffset": first, "byteLength": second, "target": INDICES},
            ],
            "buffers": [{"byteLength": first + second}],
        }


def _material(finish: str) -> dict[str, Any]:
    colour, metallic, roughness = FINISHES[finish]
    surface = {"baseColorFactor": [*colour, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
    return {"name": finish, "pbrMetallicRoughness": surface}


def _chunk(kind: int, data: bytes, filler: bytes) -> bytes:
    """A chunk of the container: its length is a multiple of four."""
    data += filler * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data
