"""Curves of a net that a table describes, and what is refused of them before anything is looked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import tomli_w

from lamella import InputError, read_project, run
from lamella.stages.pattern_of_table import refuse_lines

RIM = {"kind": "form-found", "boundary": [{"points": [[3, 0, 1], [0, 2, 0], [-3, 0, 1], [0, -2, 0]]}]}
MESH = {"kind": "mesh", "file": "nothing.obj"}


@pytest.mark.parametrize(
    ("surface", "network", "refused"),
    [
        (RIM, {"normal_curvature": 0.1, "every": 2}, True),
        (RIM, {"normal_curvature": 0.0, "every": 2}, False),
        (RIM | {"mean_curvature": 0.1}, {"normal_curvature": 0.1, "every": [2, 1]}, False),
        (RIM | {"mean_curvature": 0.1}, {"normal_curvature": 0.0, "every": [2, 1]}, True),
        (RIM | {"volume": 1.0}, {"normal_curvature": 0.0, "every": 3}, True),
        (RIM, {"normal_curvature": 0.1, "closing": "round"}, True),
        (RIM, {"every": 2, "closing": "round"}, False),
        (MESH, {"normal_curvature": 0.1, "every": 2}, True),
        (MESH, {"normal_curvature": 0.0, "every": 2}, False),
        (MESH | {"mean_curvature": 0.2}, {"normal_curvature": 0.0, "every": 2}, True),
        (MESH | {"mean_curvature": "varying"}, {"kind": "principal", "every": 2}, True),
        (MESH | {"mean_curvature": "varying"}, {"normal_curvature": 0.0}, False),
        ({"kind": "catenoid", "neck_radius": 1, "height": [-1, 1]}, {"normal_curvature": 0.1, "every": 2}, False),
    ],
)
def test_lines_without_a_lattice_are_refused_before_a_surface_is_found(
    tmp_path: Path, surface: dict[str, Any], network: dict[str, Any], refused: bool
) -> None:
    """Nothing is looked for first: neither the surface nor the mesh, which is not there."""
    (tmp_path / "p.toml").write_text(tomli_w.dumps({"surface": surface, "network": network}))
    if not refused:
        refuse_lines(read_project(tmp_path / "p.toml"))
        return
    with pytest.raises(InputError, match=r"lattice|nothing to close") as told:
        run(tmp_path / "p.toml", out=tmp_path / "out")
    key = "every" if "every" in network else "closing"
    line = next(n for n, text in enumerate((tmp_path / "p.toml").read_text().splitlines(), 1) if text.startswith(key))
    assert told.value.where == f"{tmp_path / 'p.toml'}:{line}: network.{key}"
