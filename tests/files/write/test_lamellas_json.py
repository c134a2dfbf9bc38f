"""lamellas.json of nets whose numbers are numpy's."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import orjson

import lamella
from lamella.files.write.lamellas_json import write_lamellas


def test_a_mean_curvature_of_numpy_is_written(tmp_path: Path) -> None:
    # that of a film found for a volume is a sum of arrays
    net = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=6)
    net = replace(net, mean_curvature=np.float64(net.mean_curvature))
    write_lamellas(tmp_path / "lamellas.json", net, net.strips(), name="x", version="0")
    written = orjson.loads((tmp_path / "lamellas.json").read_bytes())
    assert written["development"]["curvature"] == net.mean_curvature
