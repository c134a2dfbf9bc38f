"""lamellas.json: curvatures and stresses along every lamella, and its developed node marks."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.text import require_finite
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

SCHEMA = "lamella/lamellas/1"


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
    along = {
        "arclength": network.sample_arclengths,
        "normal_curvature": network.sample_darboux.kn,
        "geodesic_curvature": network.sample_darboux.kg,
        "geodesic_torsion": network.sample_darboux.tg,
        "stress_bending": lamellas.bending,
        "stress_torsion": lamellas.torsion,
        "stress_helix_edge": lamellas.helix_edge,
        "stress_helix_centre": lamellas.helix_centre,
        "stress_restraint": lamellas.restraint,
        "stress_layer": lamellas.layer,
        "von_mises": lamellas.von_mises,
        "utilisation": lamellas.utilisation,
        "sideways_curvature_slope": network.sample_slopes,
        "planarity": lamellas.planarity,
    }
    require_finite(*along.values(), lamellas.stop_stations, lamellas.layers.distances, lamellas.layers.bow)
    samples, stops = network.sample_offsets.tolist(), network.stop_offsets.tolist()
    content = {
        "schema": SCHEMA,
        "version": version,
        "name": one_line(name),
        "units": {"length": "m", "curvature": "1/m", "stress": "Pa"},
        "section": asdict(lamellas.section),
        "development": {"curvature": network.normal_curvature},
        "lamellas": [
            {
                "id": lamella,
                "family": str(network.families[i]),
                "developed_length": float(lamellas.developed_lengths[i]),
                "nodes": network.stop_nodes[stops[i] : stops[i + 1]],
                "node_stations": lamellas.stop_stations[stops[i] : stops[i + 1]],
                "node_utilisation_net_section": lamellas.net_utilisation[stops[i] : stops[i + 1]],
                "layer_node_stations": np.ascontiguousarray(lamellas.layer_stations[:, stops[i] : stops[i + 1]]),
                "layers": _layers(lamellas, slice(samples[i], samples[i + 1])),
            }
            | {key: values[samples[i] : samples[i + 1]] for key, values in along.items()}
            for i, lamella in enumerate(network.ids)
        ],
    }
    write_whole(path, orjson.dumps(content, option=orjson.OPT_SERIALIZE_NUMPY))


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
