"""erection/states.json: a net in every state of its way, schema "lamella/erection/1"."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.arrays import Floats
from lamella.base.wording import one_line
from lamella.erection.erection import Erection
from lamella.erection.samples import sampled
from lamella.erection.state import State
from lamella.files.whole import write_whole
from lamella.files.write.text import require_finite

SCHEMA = "lamella/erection/1"
# decimals of a metre and of unit vectors: a segment of 10 mm is right to a millionth of a millionth
POINT_DECIMALS, NORMAL_DECIMALS = 10, 9


def write_states(path: Path, erection: Erection, origin: Floats, *, name: str, version: str) -> None:
    """Write states.json: lengths in m, angles in degrees, energies in J, the driver in N m.

    Nodes and samples are those of network.json, in its order.

    Parameters
    ----------
    path : Path
    erection : Erection
    origin : (3,)
        What is added to all points, m.
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    write_whole(path, _parts(erection, np.asarray(origin, float), name, version))


def _parts(erection: Erection, origin: Floats, name: str, version: str) -> Iterator[bytes]:
    """The file, a state at a time."""
    head = {"schema": SCHEMA, "version": version, "units": "m", "name": one_line(name)}
    if erection.way is not None:
        head |= {"driver": erection.way.kind, "driver_unit": erection.way.unit, "start": erection.way.start}
    yield orjson.dumps(head)[:-1] + b',"states":[\n'
    for number, state in enumerate(erection.states):
        yield (b",\n" if number else b"") + _state(erection, state, origin)
    yield b"\n]}\n"


def _state(erection: Erection, state: State, origin: Floats) -> bytes:
    model = erection.model
    network = model.lamellas.network
    angles: list[float | None] = [None] * model.nodes
    for node, angle in zip(model.joint_nodes.tolist(), np.round(state.angles, NORMAL_DECIMALS).tolist(), strict=True):
        angles[node] = angle
    points, normals = sampled(model, state.poses)
    require_finite(points, normals)
    points, normals = np.round(points + origin, POINT_DECIMALS), np.round(normals, NORMAL_DECIMALS)
    spans = [slice(first, last) for first, last in pairwise(network.sample_offsets.tolist())]
    content: dict[str, Any] = {
        "share": state.share,
        "energy": state.energy,
        "driver": state.driver,
        "stable": state.stable,
        "stiffness_gap": state.stiffness_gap,
        "nodes": np.round(state.poses.points[: model.nodes] + origin, POINT_DECIMALS),
        "normals": np.ascontiguousarray(np.round(state.poses.frames[: model.nodes, :, 2], NORMAL_DECIMALS)),
        "joint_angles_deg": angles,
        "lamellas": [
            {"id": lamella, "centreline": points[span], "normals": normals[span]}
            for lamella, span in zip(network.ids, spans, strict=True)
        ],
    }
    return orjson.dumps(content, option=orjson.OPT_SERIALIZE_NUMPY)
