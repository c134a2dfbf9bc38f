"""network.json, nodes.csv: read back, and against the schema."""

from __future__ import annotations

import csv
import dataclasses
import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from files.write.test_samples import cylinder_net
from lamella.files.write.network_json import network_bytes, network_schema, write_network
from lamella.files.write.nodes_csv import write_nodes_csv
from lamella.network.network import NODE_KINDS

VALIDATOR = jsonschema.Draft202012Validator(network_schema())


def written() -> dict[str, Any]:
    network, _ = cylinder_net()
    result: dict[str, Any] = json.loads(network_bytes(network, name="Pavillon «Ü»", version="1.2.3"))
    return result


def test_schema_is_a_schema_and_accepts_what_is_written() -> None:
    jsonschema.Draft202012Validator.check_schema(network_schema())
    VALIDATOR.validate(written())


def test_schema_accepts_the_file_of_the_design() -> None:
    ends = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0]]
    up = [0, 0, 1]
    lines = [
        [[x, 0, 0] for x in (-1, -0.5, 0, 0.5, 1)],
        [[0, y, 0] for y in (-1, -0.5, 0, 0.5, 1)],
    ]
    VALIDATOR.validate(
        {
            "schema": "lamella/network/1",
            "version": "0",
            "units": "m",
            "name": "x",
            "surface": {"mean_curvature": 0},
            "nodes": [{"point": [0, 0, 0], "normal": up, "kind": "regular"}]
            + [{"point": end, "normal": up, "kind": "boundary"} for end in ends],
            "lamellas": [
                {
                    "id": f"{family}1",
                    "family": family,
                    "closed": False,
                    "centreline": line,
                    "normals": [up] * 5,
                    "nodes": nodes,
                    "node_samples": [0, 2, 4],
                    "node_arclengths": [0, 1, 2],
                }
                for family, line, nodes in zip("AB", lines, ([1, 0, 2], [3, 0, 4]), strict=True)
            ],
            "faces": [],
        }
    )


def break_key(data: dict[str, Any]) -> None:
    data["extra"] = 1


def break_kind(data: dict[str, Any]) -> None:
    data["nodes"][0]["kind"] = "inner"


def break_family(data: dict[str, Any]) -> None:
    data["lamellas"][0]["family"] = "B"


def break_number(data: dict[str, Any]) -> None:
    data["lamellas"][0]["centreline"][3][1] = None


def break_index(data: dict[str, Any]) -> None:
    data["lamellas"][0]["nodes"][0] = 0.5


def break_face(data: dict[str, Any]) -> None:
    data["faces"][0] = [0, 1]


def break_units(data: dict[str, Any]) -> None:
    data["units"] = "mm"


def break_missing(data: dict[str, Any]) -> None:
    del data["surface"]["mean_curvature"]


@pytest.mark.parametrize(
    "breaking",
    [
        break_key,
        break_kind,
        break_family,
        break_number,
        break_index,
        break_face,
        break_units,
        break_missing,
    ],
)
def test_schema_refuses_what_is_broken(breaking: Any) -> None:
    data = written()
    breaking(data)
    with pytest.raises(jsonschema.ValidationError):
        VALIDATOR.validate(data)


def test_everything_reads_back_to_the_last_bit(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    network = dataclasses.replace(network, closed=np.arange(len(network.ids)) == 2)
    write_network(tmp_path / "network.json", network, name='a "b"\n{},{ "c"', version="1.2.3")
    text = (tmp_path / "network.json").read_text("utf-8")
    data = json.loads(text)
    assert list(data) == ["schema", "version", "units", "name", "surface", "nodes", "lamellas", "faces"]
    assert (data["schema"], data["version"], data["units"]) == ("lamella/network/1", "1.2.3", "m")
    assert data["name"] == 'a "b" {},{ "c"'
    assert data["surface"] == {"mean_curvature": network.mean_curvature}
    assert np.array_equal([node["point"] for node in data["nodes"]], network.node_points)
    assert np.array_equal([node["normal"] for node in data["nodes"]], network.node_normals)
    assert [node["kind"] for node in data["nodes"]] == [NODE_KINDS[k] for k in network.node_kinds]
    lamellas = data["lamellas"]
    assert tuple(lamella["id"] for lamella in lamellas) == network.ids
    assert [lamella["family"] for lamella in lamellas] == network.families.tolist()
    assert [lamella["closed"] for lamella in lamellas] == network.closed.tolist()
    for key, array in {
        "centreline": network.sample_points,
        "normals": network.sample_normals,
        "nodes": network.stop_nodes,
        "node_samples": network.stop_samples,
        "node_arclengths": network.stop_arclengths,
    }.items():
        assert np.array_equal(np.concatenate([lamella[key] for lamella in lamellas]), array)
        assert len(lamellas[1][key]) == len(array) // len(lamellas)
    assert np.array_equal(np.concatenate(data["faces"]), network.face_nodes)
    assert [len(face) for face in data["faces"]] == np.diff(network.face_offsets).tolist()
    assert text.count("\n") > len(data["nodes"]) + len(lamellas) + len(data["faces"])


def test_a_number_that_is_not_finite_is_not_written(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    network.sample_points[7, 1] = np.nan
    with pytest.raises(ValueError, match="row 7"):
        write_network(tmp_path / "network.json", network, name="x", version="1")
    assert list(tmp_path.iterdir()) == []


def test_nodes_csv(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    write_nodes_csv(tmp_path / "nodes.csv", network, name="two\nlines", version="1.2.3")
    head, *lines = (tmp_path / "nodes.csv").read_text("utf-8").splitlines()
    assert head == "# lamella 1.2.3 · project two lines"
    table = list(csv.DictReader(lines))
    assert [int(row["index"]) for row in table] == list(range(len(network.node_points)))
    assert [row["kind"] for row in table] == [NODE_KINDS[k] for k in network.node_kinds]
    points = [[float(row[key]) for key in ("x_m", "y_m", "z_m")] for row in table]
    normals = [[float(row[key]) for key in ("nx", "ny", "nz")] for row in table]
    assert np.array_equal(points, network.node_points)
    assert np.array_equal(normals, network.node_normals)
    # Node 8 lies on row 1, column 2 of 6: on A3 and on the B that started one column further, B4.
    assert table[8]["lamellas"] == "A3 B4"
    assert [float(s) for s in table[8]["arclengths_m"].split()] == [network.stop_arclengths[1]] * 2


def test_nodes_csv_of_a_node_without_lamella(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    network = dataclasses.replace(
        network,
        node_points=np.vstack((network.node_points, [1.0, 2.0, 3.0])),
        node_normals=np.vstack((network.node_normals, [0.0, 0.0, 1.0])),
        node_kinds=np.append(network.node_kinds, 2),
    )
    write_nodes_csv(tmp_path / "nodes.csv", network, name="x", version="1")
    last = (tmp_path / "nodes.csv").read_text("utf-8").splitlines()[-1]
    assert last == f"{len(network.node_points) - 1},singular,1.0,2.0,3.0,0.0,0.0,1.0,,"
