"""lamellas.json: curvatures and stresses along every lamella, and its developed node marks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import orjson
from numpy.typing import NDArray

from lamella.base.arrays import Floats
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.text import require_finite
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

SCHEMA = "lamella/lamellas/1"

# lengths to a nanometre in a kilometre and better; what is computed from them needs no more than single precision
GEOMETRY_DIGITS = 13
# 1/m or m: columns that are nothing but rounding are not written to digits of that
LEAST = 1e-12


@dataclass(frozen=True)
class Column:
    """A list along a lamella, one number a sample of network.json.

    Attributes
    ----------
    key, unit, meaning : str
    values : callable
        Those of all samples, (k,), of a network and its lamellas.
    digits : int, optional
        They are written to so many digits of the largest one; in single precision, seven digits of each, when not
        given.
    """

    key: str
    unit: str
    meaning: str
    values: Callable[[Network, Lamellas], Floats]
    digits: int | None = None

    def written(self, network: Network, lamellas: Lamellas) -> NDArray[np.floating[Any]]:
        """The values as the file has them, (k,)."""
        values = self.values(network, lamellas)
        require_finite(values)
        if self.digits is None:
            return values.astype(np.float32)
        largest = max(float(np.abs(values).max(initial=0.0)), LEAST)
        return np.round(values, self.digits - 1 - int(np.floor(np.log10(largest))))


COLUMNS = (
    Column("arclength", "m", "from the lamella's start", lambda net, strips: net.sample_arclengths, GEOMETRY_DIGITS),
    Column("normal_curvature", "1/m", "kn, with sign", lambda net, strips: net.sample_darboux.kn, GEOMETRY_DIGITS),
    Column("geodesic_curvature", "1/m", "kg, with sign", lambda net, strips: net.sample_darboux.kg, GEOMETRY_DIGITS),
    Column("geodesic_torsion", "1/m", "tg, with sign", lambda net, strips: net.sample_darboux.tg, GEOMETRY_DIGITS),
    Column("stress_bending", "Pa", "magnitude, about the weak axis", lambda net, strips: strips.bending),
    Column("stress_torsion", "Pa", "magnitude", lambda net, strips: strips.torsion),
    Column("stress_helix_edge", "Pa", "at the edges, tension > 0", lambda net, strips: strips.helix_edge),
    Column("stress_helix_centre", "Pa", "on the centre line, tension > 0", lambda net, strips: strips.helix_centre),
    Column("stress_restraint", "Pa", "tension from marks at the arc length", lambda net, strips: strips.restraint),
    Column("stress_layer", "Pa", "strong-axis bending of the outermost layers", lambda net, strips: strips.layer),
    Column("von_mises", "Pa", "all stresses together", lambda net, strips: strips.von_mises),
    Column("utilisation", "", "that over the strength", lambda net, strips: strips.utilisation),
    Column(
        "sideways_curvature_slope",
        "1/m2",
        "how the normal curvature changes to the left (u = n x t): a layer at d has kn + d times this",
        lambda net, strips: net.sample_slopes,
    ),
    Column(
        "planarity",
        "",
        "of the strip's quad from this sample to the next; 0 at the end",
        lambda net, strips: strips.planarity,
    ),
)
"""What lamellas.json holds along every lamella; its schema is made from this too."""


def write_lamellas(path: Path, network: Network, lamellas: Lamellas, *, name: str, version: str) -> None:
    """Write lamellas.json: lengths in m, curvatures in 1/m, stresses in Pa, one list item a sample.

    Parameters
    ----------
    path : Path
    network : Network
    lamellas : Lamellas
    name, version : str
        Of the project and of the program.
    """
    require_finite(lamellas.stop_stations, lamellas.layers.distances, lamellas.layers.bow)
    head = {
        "schema": SCHEMA,
        "version": version,
        "name": one_line(name),
        "units": {"length": "m", "curvature": "1/m", "stress": "Pa"},
        "section": lamellas.section.record,
        "development": {"curvature": float(network.normal_curvature)},
    }
    write_whole(path, _parts(orjson.dumps(head)[:-1], network, lamellas))


def _parts(head: bytes, network: Network, lamellas: Lamellas) -> Iterator[bytes]:
    """The file, a lamella at a time: as a whole it may be larger than all that it is made from."""
    along = {column.key: column.written(network, lamellas) for column in COLUMNS}
    samples, stops = network.sample_offsets.tolist(), network.stop_offsets.tolist()
    yield head + b',"lamellas":['
    for i, lamella in enumerate(network.ids):
        sample, stop = slice(samples[i], samples[i + 1]), slice(stops[i], stops[i + 1])
        content = {
            "id": lamella,
            "family": str(network.families[i]),
            "developed_length": float(lamellas.developed_lengths[i]),
            "nodes": network.stop_nodes[stop],
            "node_stations": lamellas.stop_stations[stop],
            "node_utilisation_net_section": lamellas.net_utilisation[stop],
            "layer_node_stations": np.ascontiguousarray(lamellas.layer_stations[:, stop]),
            "layers": _layers(lamellas, sample),
        } | {key: values[sample] for key, values in along.items()}
        yield (b"," if i else b"") + orjson.dumps(content, option=orjson.OPT_SERIALIZE_NUMPY)
    yield b"]}"


def lamellas_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of lamellas.json."""
    number, text = {"type": "number"}, {"type": "string"}
    numbers = {"type": "array", "items": number}
    along = {
        column.key: numbers | {"description": f"{column.meaning} [{column.unit}]" if column.unit else column.meaning}
        for column in COLUMNS
    }
    layer = {
        "type": "object",
        "properties": {"offset": number, "distance": numbers, "flat_curvature": numbers},
        "required": ["offset"],
        "additionalProperties": False,
    }
    lamella = {
        "id": text,
        "family": {"enum": ["A", "B"]},
        "developed_length": number | {"description": "of the flat centre line, first to last node [m]"},
        "nodes": {"type": "array", "items": {"type": "integer"}},
        "node_stations": numbers | {"description": "where nodes are marked on the flat strip, from its first one [m]"},
        "node_utilisation_net_section": numbers
        | {"description": "of the half height left at the node's slots; 0 where there is none"},
        "layer_node_stations": {"type": "array", "items": numbers, "description": "node marks of each layer [m]"},
        "layers": {"type": "array", "items": layer, "description": "from the right layer to the left one"},
        **along,
    }
    properties = {
        "schema": {"const": SCHEMA},
        "version": text,
        "name": text,
        "units": {"type": "object", "additionalProperties": text},
        "section": {"type": "object"},
        "development": {
            "type": "object",
            "properties": {"curvature": number | {"description": "of the flat strips [1/m]"}},
            "required": ["curvature"],
        },
        "lamellas": {
            "type": "array",
            "items": {
                "type": "object",
                "properties": lamella,
                "required": list(lamella),
                "additionalProperties": False,
            },
        },
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": SCHEMA,
        "title": "lamella lamellas.json",
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _layers(lamellas: Lamellas, samples: slice) -> list[dict[str, Any]]:
    """Of each layer, from the right one to the left one, what is not alike along all of them."""
    layers, way = lamellas.layers, lamellas.section.layer_curves
    reported: list[dict[str, Any]] = [{"offset": d} for d in lamellas.section.layer_offsets.tolist()]
    for row, one in enumerate(reported):
        if way == "lamella":
            one["distance"] = layers.distances[row, samples]
        if way == "cut":
            one["flat_curvature"] = layers.bow[row, samples]
    return reported
