"""network.json of a run, or the COMPAS graph of a network, read back."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import cut, shown
from lamella.network.from_lines import CentreLine, network_of_lines
from lamella.network.network import NODE_KINDS, Network
from lamella.network.pattern import Pattern

SCHEMA = "lamella/network/1"
NETWORK_BYTES_MAX = 500_000_000
"""Bytes; a net of 500,000 nodes has fewer."""


def read_network(path: str | Path) -> Network:
    """The network of a run's network.json, or of a COMPAS graph that `lamella.write_compas` wrote.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Network
        Goes on to `strips` like any other. Its curvatures are those of the written points: off by the fourth power of
        their distance.

    Raises
    ------
    InputError
        The file is no network, or contradicts itself.

    Examples
    --------
    >>> import lamella, tempfile, pathlib
    >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "net.json"
    ...     lamella.write_compas(net, file)
    ...     again = lamella.read_network(file)
    >>> again
    Network(12 cells: 24 lamellas, 144 nodes, 120 faces)
    >>> bool(abs(again.sample_darboux.tg - net.sample_darboux.tg).max() < 1e-3)
    True
    """
    path = Path(path)
    try:
        if path.stat().st_size > NETWORK_BYTES_MAX:
            raise InputError(
                f"{path} has {path.stat().st_size / 1e6:,.0f} MB", f"at most {NETWORK_BYTES_MAX / 1e6:g} MB are read"
            )
        content = orjson.loads(path.read_bytes())
    except OSError as reason:
        raise InputError(f"{path} cannot be read: {reason.strerror}", "name a network.json of a run") from None
    except orjson.JSONDecodeError as reason:
        raise InputError(f"{path} is no JSON: {cut(str(reason), 120)}", "name a network.json of a run") from None
    try:
        return network_of_table(_table_of(content))
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy) from None


def _table_of(content: Any) -> Any:
    """The table of network.json, of a COMPAS graph from its attributes and nodes."""
    if isinstance(content, dict) and str(content.get("dtype", "")).endswith("/Graph"):
        data = content.get("data")
        if isinstance(data, dict) and isinstance(data.get("node"), dict):
            return table_of_graph(data.get("attributes"), data["node"].values())
    return content


def table_of_graph(attributes: Any, nodes: Any) -> Any:
    """The table of network.json from a graph's attributes and those of its nodes, in order."""
    if not isinstance(attributes, Mapping) or "lamellas" not in attributes:
        raise InputError("the graph holds no lamellas", "only graphs that lamella.write_compas wrote are read")
    known = [{"point": [n.get(axis) for axis in "xyz"], **{k: n.get(k) for k in ("normal", "kind")}} for n in nodes]
    return {**attributes, "nodes": known}


def network_of_table(table: Any) -> Network:
    """The network of the content of network.json.

    Raises
    ------
    InputError
    """
    if not isinstance(table, Mapping) or table.get("schema") != SCHEMA:
        found = shown(table.get("schema")) if isinstance(table, Mapping) else "none"
        raise InputError(f"schema = {found}, not {SCHEMA!r}", "name a network.json of a run")
    try:
        nodes = table["nodes"]
        lines = [_line(row, len(nodes)) for row in table["lamellas"]]
        if not lines:
            raise InputError("the network has no lamellas", "name a network.json of a run")
        faces = [[int(node) for node in face] for face in table["faces"]]
        if any(not 0 <= node < len(nodes) for face in faces for node in face):
            raise InputError(f"a face names a node that is not there (there are {len(nodes)})", "write the file anew")
        return network_of_lines(
            lines,
            node_points=_points([node["point"] for node in nodes]),
            node_normals=_points([node["normal"] for node in nodes]),
            node_kinds=np.array([NODE_KINDS.index(node["kind"]) for node in nodes], np.int64),
            faces=faces,
            mean_curvature=float(table["surface"]["mean_curvature"]),
            pattern=Pattern(table.get("kind", "lamellas"), (1, 1), table.get("normal_curvature")),
        )
    except KeyError as missing:
        raise InputError(f"the key {missing} is missing", "write the file anew") from None
    except (TypeError, ValueError) as reason:
        if isinstance(reason, InputError):
            raise
        raise InputError(f"a value is of the wrong kind: {cut(str(reason), 120)}", "write the file anew") from None


def network_of_compas(graph: Any) -> Network:
    """The network of a COMPAS `Graph` in memory, of a file that `lamella.write_compas` wrote.

    Parameters
    ----------
    graph : compas.datastructures.Graph
        Or anything with `attributes`, `nodes` and `node_attributes`.

    Raises
    ------
    InputError
        The graph is not one of a network.

    Examples
    --------
    With COMPAS installed: ``network_of_compas(compas.json_load("net.json"))``; any other graph is refused:

    >>> import lamella, types
    >>> lamella.network_of_compas(types.SimpleNamespace(attributes={}, nodes=list))
    Traceback (most recent call last):
    ...
    lamella.base.errors.InputError: the graph holds no lamellas
      remedy: only graphs that lamella.write_compas wrote are read
    """
    return network_of_table(table_of_graph(graph.attributes, [graph.node_attributes(key) for key in graph.nodes()]))


def _line(row: Any, nodes: int) -> CentreLine:
    line = CentreLine(
        str(row["id"]),
        str(row["family"]),
        bool(row["closed"]),
        _points(row["centreline"]),
        _points(row["normals"]),
        _whole(row["nodes"]),
        _whole(row["node_samples"]),
        np.array(row["node_arclengths"], np.float64),
    )
    q, k = len(line.nodes), len(line.points)
    there = line.node_samples
    if line.family not in ("A", "B") or k < 2 or len(line.normals) != k or q < 2:
        raise InputError(f"lamella {cut(line.id, 40)} contradicts itself", "write the file anew")
    if len(there) != q or line.node_arclengths.shape != (q,) or there[0] != 0 or there[-1] != k - 1:
        raise InputError(f"the nodes of lamella {cut(line.id, 40)} do not reach from end to end", "write the file anew")
    rising = (np.diff(there) > 0).all() and (np.diff(line.node_arclengths) > 0).all()
    if not rising or line.nodes.min() < 0 or line.nodes.max() >= nodes:
        raise InputError(f"the nodes of lamella {cut(line.id, 40)} are not in order", "write the file anew")
    return line


def _points(rows: Any) -> Floats:
    points = np.array(rows, np.float64).reshape(-1, 3)
    if not np.isfinite(points).all():
        raise ValueError("a coordinate that is no finite number")
    return points


def _whole(values: Any) -> Integers:
    whole = np.array(values)
    if whole.dtype.kind != "i" or whole.ndim != 1:
        raise ValueError("whole numbers are expected")
    return whole.astype(np.int64)
