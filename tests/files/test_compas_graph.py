"""Networks for COMPAS and back, and network.json read back: the same nets, with the curvatures of their points."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.files.write.network_json import network_bytes


@pytest.fixture(scope="module")
def net() -> lamella.Network:
    return lamella.net(lamella.Unduloid(1.0, 2.0, (-2.0, 3.0)), cells=16)


def written(net: lamella.Network, path: Path) -> Path:
    path.write_bytes(network_bytes(net, name="x", version="0"))
    return path


def same(one: lamella.Network, other: lamella.Network) -> None:
    keys = "node_points node_normals node_kinds ids families closed sample_offsets sample_points sample_normals "
    keys += "stop_offsets stop_nodes stop_samples stop_arclengths face_offsets face_nodes"
    for key in keys.split():
        np.testing.assert_array_equal(getattr(one, key), getattr(other, key), key)
    assert one.mean_curvature == other.mean_curvature


@pytest.mark.parametrize("compas", [False, True])
def test_read_back(net: lamella.Network, compas: bool, tmp_path: Path) -> None:
    path = tmp_path / "n.json"
    if compas:
        lamella.write_compas(net, path, name="x")
    else:
        written(net, path)
    again = lamella.read_network(path)
    same(net, again)
    np.testing.assert_allclose(again.sample_arclengths, net.sample_arclengths, atol=2e-4)
    # the curve between samples is not written: what is missing goes with their distance
    np.testing.assert_allclose(again.sample_tangents, net.sample_tangents, atol=1e-3)
    for ours, theirs, bound in zip(again.sample_darboux, net.sample_darboux, (2e-3, 2e-3, 2e-3), strict=True):
        np.testing.assert_allclose(ours, theirs, atol=bound)
    strips, first = again.strips(), net.strips()
    assert strips.parts().mass == pytest.approx(first.parts().mass, rel=1e-4)
    assert strips.utilisation.max() == pytest.approx(first.utilisation.max(), rel=0.02)


def test_curvatures_of_points_have_a_rate(tmp_path: Path) -> None:
    """Twice the cells, half the distance of samples: the fourth power, or what rounding leaves."""
    worst = []
    for cells in (12, 24):
        net = lamella.net(lamella.Catenoid(2.0, (-1.0, 1.5)), cells=cells)
        again = lamella.read_network(written(net, tmp_path / "n.json"))
        off = np.abs(again.sample_darboux.tg - net.sample_darboux.tg)
        worst.append(float(np.median(off)))
    assert worst[1] < worst[0] / 8


def test_closed_lamellas_and_singular_nodes_come_back(tmp_path: Path) -> None:
    net = lamella.net(lamella.Enneper(3, 0.9, 2.0), cells=8, kind="principal")
    again = lamella.read_network(written(net, tmp_path / "n.json"))
    same(net, again)
    assert again.pattern == net.pattern


class Graph:
    """As much of a COMPAS graph as is used, filled as COMPAS fills it from a file."""

    def __init__(self, data: dict[str, Any]) -> None:
        # keys are written by repr and read by literal_eval
        self.attributes = data["attributes"]
        self.node = {int(key): {**data["default_node_attributes"], **own} for key, own in data["node"].items()}
        self.edge = {int(u): {int(v): own for v, own in near.items()} for u, near in data["edge"].items()}

    def nodes(self) -> list[int]:
        return list(self.node)

    def node_attributes(self, key: int) -> dict[str, Any]:
        return self.node[key]


def test_a_graph_of_compas(net: lamella.Network, tmp_path: Path) -> None:
    """By the data schema of `compas.datastructures.Graph` of COMPAS 2."""
    lamella.write_compas(net, tmp_path / "n.json", name="net")
    content = json.loads((tmp_path / "n.json").read_text())
    assert content["dtype"] == "compas.datastructures/Graph"
    data = content["data"]
    required = {"attributes", "default_node_attributes", "default_edge_attributes", "node", "edge", "max_node"}
    assert set(data) == required
    assert data["max_node"] == len(data["node"]) - 1
    assert all(str(int(key)) == key for key in data["node"])
    graph = Graph(data)
    edges = [own for near in graph.edge.values() for own in near.values()]
    assert len(edges) == len(net.cell_edges)
    assert sum(own["length"] for own in edges) == pytest.approx(net.lengths.sum())
    same(net, lamella.network_of_compas(graph))


def test_meshes_for_compas(net: lamella.Network, tmp_path: Path) -> None:
    lamella.write_compas(net, tmp_path / "m.json", mesh=True)
    data = json.loads((tmp_path / "m.json").read_text())["data"]
    assert len(data["face"]) == len(net.face_offsets) - 1
    assert data["face"]["0"] is not None
    first = [data["vertex"][str(k)] for k in data["face"]["0"]]
    at = net.node_points[net.face_nodes[: net.face_offsets[1]]]
    np.testing.assert_array_equal([[v[axis] for axis in "xyz"] for v in first], at)
    # a mesh of quads comes back as it went
    quads = lamella.quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], [[0, 1, 2, 3]])
    lamella.write_compas(quads, tmp_path / "q.json")
    assert lamella.read_quad_mesh(tmp_path / "q.json").mesh.allclose(quads)
    surface = lamella.Catenoid(2.0, (-1.0, 1.5)).mesh(0.05)
    lamella.write_compas(surface, tmp_path / "s.json")
    data = json.loads((tmp_path / "s.json").read_text())["data"]
    assert len(data["vertex"]) == len(surface.points)
    assert data["vertex"]["0"]["k1"] == surface.k1[0]
    with pytest.raises(InputError, match="Section"):
        lamella.write_compas(lamella.Section(), tmp_path / "no.json")  # type: ignore[arg-type]
    assert not (tmp_path / "no.json").exists()


def broken(net: lamella.Network, change: Any) -> Any:
    table = json.loads(network_bytes(net, name="x", version="0"))
    change(table)
    return table


@pytest.mark.parametrize(
    ("change", "about"),
    [
        (lambda t: t.pop("nodes"), "nodes"),
        (lambda t: t.update(schema="lamella/network/9"), "lamella/network/9"),
        (lambda t: t.update(lamellas=[]), "no lamellas"),
        (lambda t: t["lamellas"][0].update(family="C"), "A1"),
        (lambda t: t["lamellas"][0]["nodes"].pop(), "A1"),
        (lambda t: t["lamellas"][0]["node_arclengths"].reverse(), "A1"),
        (lambda t: t["lamellas"][0]["nodes"].__setitem__(0, 10**6), "A1"),
        (lambda t: t["lamellas"][0]["nodes"].__setitem__(0, 0.5), "whole"),
        (lambda t: t["faces"].append([0, 1, 10**6]), "face"),
        (lambda t: t["nodes"][0].update(point=[0, 0, None]), "finite"),
    ],
)
def test_what_is_no_network(net: lamella.Network, change: Any, about: str, tmp_path: Path) -> None:
    path = tmp_path / "n.json"
    path.write_text(json.dumps(broken(net, change)))
    with pytest.raises(InputError, match=about) as caught:
        lamella.read_network(path)
    assert caught.value.message.startswith(str(path))
    assert caught.value.remedy


def test_files_that_are_not_there_or_no_json(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        lamella.read_network(tmp_path / "none.json")
    (tmp_path / "n.json").write_text("{")
    with pytest.raises(InputError, match="no JSON"):
        lamella.read_network(tmp_path / "n.json")
    (tmp_path / "n.json").write_text('{"dtype": "compas.datastructures/Graph", "data": {"node": {}}}')
    with pytest.raises(InputError, match="no lamellas"):
        lamella.read_network(tmp_path / "n.json")
