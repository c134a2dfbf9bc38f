"""nodes.csv: one line a node, for spreadsheets and for setting out on site."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment, dumped, require_finite, rows
from lamella.network.network import NODE_KINDS, Network

HEADER = "index,kind,x_m,y_m,z_m,nx,ny,nz,lamellas,arclengths_m"


def nodes_csv_bytes(network: Network, *, name: str, version: str) -> bytes:
    """Return the table of nodes.

    The first row, after ``#``, names version and project; the second the columns and their units.
    ``lamellas`` lists the ids of the lamellas that stop at the node and ``arclengths_m`` their arc lengths
    there, both with spaces between; a closed lamella stands twice at its first node, with 0 and its length.
    """
    require_finite(network.node_points, network.node_normals, network.stop_arclengths)
    numbers = rows(np.column_stack((network.node_points, network.node_normals)), between=b",")
    coordinates = numbers.decode().splitlines()

    lamella_of_stop = np.repeat(np.arange(len(network.ids)), np.diff(network.stop_offsets))
    by_node = np.argsort(network.stop_nodes, kind="stable")
    owners = [network.ids[k] for k in lamella_of_stop[by_node].tolist()]
    inner = dumped(network.stop_arclengths[by_node]).decode()[1:-1]
    stations = inner.split(",")
    counts = np.bincount(network.stop_nodes, minlength=len(coordinates))
    ends = np.cumsum(counts)

    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", HEADER]
    table = zip(network.node_kinds.tolist(), coordinates, (ends - counts).tolist(), ends.tolist(), strict=True)
    for index, (kind, place, start, end) in enumerate(table):
        stops = f"{' '.join(owners[start:end])},{' '.join(stations[start:end])}"
        lines.append(f"{index},{NODE_KINDS[kind]},{place},{stops}")
    return ("\n".join(lines) + "\n").encode()


def write_nodes_csv(path: Path, network: Network, *, name: str, version: str) -> None:
    """Write `nodes_csv_bytes`; OSError if it cannot be written whole."""
    write_whole(path, nodes_csv_bytes(network, name=name, version=version))
