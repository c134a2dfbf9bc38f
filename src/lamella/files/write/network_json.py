"""network.json: the network for programs of users, schema "lamella/network/1"."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.text import require_finite
from lamella.network.network import NODE_KINDS, Network

SCHEMA = "lamella/network/1"


def network_bytes(network: Network, *, name: str, version: str) -> bytes:
    """Return network.json, see `network_parts`."""
    return b"".join(network_parts(network, name=name, version=version))


def network_parts(network: Network, *, name: str, version: str) -> Iterator[bytes]:
    """network.json part by part, one line a node, a lamella and a face.

    Parameters
    ----------
    network : Network
        What to write; every number must be finite.
    name, version : str
        Of the project and of the program.

    Yields
    ------
    bytes
        JSON in UTF-8; doubles with the shortest digits that read back the same.
    """
    require_finite(
        network.node_points,
        network.node_normals,
        network.sample_points,
        network.sample_normals,
        network.stop_arclengths,
    )
    head: dict[str, Any] = {
        "schema": SCHEMA,
        "version": version,
        "units": "m",
        "name": one_line(name),
        "surface": {"mean_curvature": float(network.mean_curvature)},
    }
    if network.pattern.kind != "lamellas":
        head["kind"] = network.pattern.kind
    if network.pattern.normal_curvature is not None:
        head["normal_curvature"] = network.pattern.normal_curvature
    yield orjson.dumps(head)[:-1] + b',\n"nodes":[\n'
    yield _nodes(network)
    yield b'\n],\n"lamellas":[\n'
    yield from _lamellas(network)
    yield b'\n],\n"faces":[\n'
    yield _faces(network)
    yield b"\n]}\n"


def write_network(path: Path, network: Network, *, name: str, version: str) -> None:
    """Write `network_parts`; OSError if they cannot be written whole."""
    write_whole(path, network_parts(network, name=name, version=version))


def network_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of network.json."""
    text = files("lamella.files").joinpath("network.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def _nodes(network: Network) -> bytes:
    table = zip(
        network.node_points.tolist(),
        network.node_normals.tolist(),
        network.node_kinds.tolist(),
        strict=True,
    )
    nodes = [{"point": point, "normal": normal, "kind": NODE_KINDS[kind]} for point, normal, kind in table]
    return orjson.dumps(nodes)[1:-1].replace(b"},{", b"},\n{")


def _lamellas(network: Network) -> Iterator[bytes]:
    samples, stops = network.sample_offsets.tolist(), network.stop_offsets.tolist()
    for k, identity in enumerate(network.ids):
        sample, stop = slice(samples[k], samples[k + 1]), slice(stops[k], stops[k + 1])
        lamella = {
            "id": identity,
            "family": str(network.families[k]),
            "closed": bool(network.closed[k]),
            "centreline": np.ascontiguousarray(network.sample_points[sample]),
            "normals": np.ascontiguousarray(network.sample_normals[sample]),
            "nodes": network.stop_nodes[stop],
            "node_samples": network.stop_samples[stop],
            "node_arclengths": network.stop_arclengths[stop],
        }
        yield (b",\n" if k else b"") + orjson.dumps(lamella, option=orjson.OPT_SERIALIZE_NUMPY)


def _faces(network: Network) -> bytes:
    nodes, offsets = network.face_nodes.tolist(), network.face_offsets.tolist()
    faces = [nodes[start:end] for start, end in pairwise(offsets)]
    return orjson.dumps(faces)[1:-1].replace(b"],[", b"],\n[")
