"""How a run grows with the net: CPU seconds, memory and exponents from 1k to 100k nodes, and where the time goes.

Run with ``make bench`` (one thread). Every size runs in a process of its own, so that memory is its own too.
"""

from __future__ import annotations

import itertools
import json
import math
import resource
import subprocess
import sys
import time

# cells around the unduloid of the first example for about 1k, 10k and 100k nodes
CELLS = (26, 84, 269)


def measure(cells: int) -> dict[str, float]:
    """Compute surface, network and lamellas once; seconds and memory."""
    import numpy as np

    from lamella import compute, parse_project
    from lamella.surface.closed_forms.kinds import CLOSED_FORMS

    surface = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4.0, 4.0]}
    project = parse_project({"name": "growth", "surface": surface, "network": {"cells": cells}})
    compute(parse_project({"name": "warm", "surface": surface}), until="lamellas")
    results = compute(project, until="lamellas")
    assert results.network is not None
    where = results.network.sample_where
    # the physical limit: one evaluation of the surface at every sample
    unduloid = CLOSED_FORMS["unduloid"](
        **{key: value for key, value in surface.items() if key != "kind"}  # type: ignore[arg-type]
    )
    start = time.process_time()
    unduloid.at(np.asarray(where))
    limit = time.process_time() - start
    seconds = results.summary["seconds"]
    return {
        "cells": cells,
        "nodes": len(results.network.node_points),
        "samples": len(where),
        "seconds": sum(seconds.values()),
        **seconds,
        "surface evaluation": limit,
        "GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
    }


def main() -> None:
    """Print a line a size, and the exponents between sizes."""
    if len(sys.argv) > 1:
        print(json.dumps(measure(int(sys.argv[1]))))
        return
    rows = []
    for cells in CELLS:
        done = subprocess.run([sys.executable, __file__, str(cells)], capture_output=True, text=True, check=True)
        rows.append(json.loads(done.stdout))
        row = rows[-1]
        print(
            f"{row['cells']:4d} cells {row['nodes']:8,} nodes {row['samples']:10,} samples: "
            f"{row['seconds']:6.2f} s CPU "
            f"(surface {row['surface']:.2f}, network {row['network']:.2f}, lamellas {row['lamellas']:.2f}), "
            f"{row['seconds'] / row['surface evaluation']:.1f} x one evaluation of the surface, {row['GB']:.2f} GB"
        )
    for one, other in itertools.pairwise(rows):
        growth = math.log(other["seconds"] / one["seconds"])
        by_nodes = growth / math.log(other["nodes"] / one["nodes"])
        by_samples = growth / math.log(other["samples"] / one["samples"])
        print(
            f"{one['nodes']:,} to {other['nodes']:,} nodes: exponent {by_nodes:.2f} by nodes, "
            f"{by_samples:.2f} by samples "
            "(above 20,000 nodes a cell has 8 of them instead of 16)"
        )


if __name__ == "__main__":
    main()
