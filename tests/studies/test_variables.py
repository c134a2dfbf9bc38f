"""Variables in the values of a project: by path, by name in a list, as freedoms of loops."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.project.read import parse_project
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.studies.tables import VariableTable
from lamella.studies.variables import changed_values, present_value

CIRCLE = {"name": "rim", "circle": {"center": [1.0, 2.0, 0.5], "radius": 2.0}}
POINTS = {
    "name": "eye",
    "points": [[2.0, 2.0, 1.0], [1.5, 2.6, 1.1], [0.8, 2.3, 1.0], [0.6, 1.7, 0.9], [1.2, 1.4, 1.0], [1.8, 1.5, 1.1]],
}
FILM = {"surface": {"kind": "form-found", "boundary": [CIRCLE, POINTS]}, "lamella": {"height": 0.08}}


def _changed(value: Any, values: dict[str, Any] = FILM, folder: Path = Path(), **table: Any) -> dict[str, Any]:
    table = table if "values" in table else table | {"range": [-10.0, 10.0]}
    if table.get("freedom") == "scale":
        table |= {"range": [0.1, 10.0]}
    return changed_values(values, [VariableTable.model_validate(table)], [value], folder)


def _points(values: dict[str, Any], loop: int, folder: Path = Path()) -> Any:
    loops = boundary_loops(parse_project(values).surface, folder)  # type: ignore[arg-type]
    return loops[loop].at(np.arange(200) / 200)


def test_keys_reach_numbers_by_number_and_by_name() -> None:
    before = repr(FILM)
    for key in ("surface.boundary.0.circle.radius", "surface.boundary.rim.circle.radius"):
        assert _changed(1.5, key=key)["surface"]["boundary"][0]["circle"]["radius"] == 1.5
        assert present_value(FILM, key) == 2.0
    assert _changed(7.0, key="surface.boundary.eye.points.2.2")["surface"]["boundary"][1]["points"][2][2] == 7.0
    assert _changed(0.002, key="lamella.thickness")["lamella"] == {"height": 0.08, "thickness": 0.002}
    assert _changed("S355", key="lamella.material", values=FILM)["lamella"]["material"] == "S355"
    assert _changed(12, key="network.cells")["network"] == {"cells": 12}
    assert present_value(FILM, "network.cells") is None
    # nothing of what was given is changed
    assert repr(FILM) == before


@pytest.mark.parametrize(
    ("key", "number"),
    [("surface.boundary.2.name", "2"), ("surface.boundary.oculus.name", "oculus"), ("lamella.height.x", "0.08")],
)
def test_a_key_that_leads_nowhere(key: str, number: str) -> None:
    with pytest.raises(InputError) as refusal:
        _changed(1.0, key=key)
    assert refusal.value.where == "variable.key"
    assert number in refusal.value.message


def test_freedoms_of_a_loop_of_points_and_of_a_circle() -> None:
    for number, loop in enumerate(("rim", "eye")):
        points = _points(FILM, number)
        moved = _points(_changed(0.3, loop=loop, freedom="move", axis="x"), number)
        np.testing.assert_allclose(moved, points + np.array([0.3, 0, 0]), atol=1e-12)
        larger = _points(_changed(1.2, loop=loop, freedom="scale"), number)
        middle = (larger - 1.2 * points)[0] / -0.2
        np.testing.assert_allclose(larger - middle, 1.2 * (points - middle), atol=1e-12)
        tilted = _points(_changed(90.0, loop=loop, freedom="tilt", axis="x"), number)
        # y goes to z, z to -y, about the middle
        np.testing.assert_allclose(tilted[:, 2] - tilted[:, 2].mean(), points[:, 1] - points[:, 1].mean(), atol=1e-12)
    both = _changed(0.5, loop=["rim", "eye"], freedom="move")
    np.testing.assert_allclose(_points(both, 0)[:, 2], 1.0, atol=1e-12)
    np.testing.assert_allclose(_points(both, 1), _points(FILM, 1) + np.array([0, 0, 0.5]), atol=1e-12)


def test_a_wave_along_points() -> None:
    """Of cos 2 pi k t at the k-th of n points: 0.2 cos(4 pi k / 6) upwards."""
    waved = _changed(0.2, loop="eye", freedom="wave", wave=2)["surface"]["boundary"][1]["points"]
    rise = np.array(waved)[:, 2] - np.array(POINTS["points"])[:, 2]
    np.testing.assert_allclose(rise, 0.2 * np.cos(4 * np.pi * np.arange(6) / 6), atol=1e-12)


def test_a_wave_along_a_curve_of_parts() -> None:
    square = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]
    parts = [{"points": [square[k], square[(k + 1) % 4]]} for k in range(4)]
    film = {"surface": {"kind": "form-found", "boundary": [{"name": "rim", "part": parts}]}}
    waved = _points(_changed(0.3, values=film, loop="rim", freedom="wave", wave=1), 0)
    t = np.arange(200) / 200
    np.testing.assert_allclose(waved[:, 2], 0.3 * np.cos(2 * np.pi * t), atol=5e-3)
    assert waved[:, 2].max() == pytest.approx(0.3, abs=1e-6)


@pytest.mark.parametrize(
    ("values", "table", "key"),
    [
        (FILM, {"loop": "door", "freedom": "move"}, "variable.loop"),
        (FILM, {"loop": "rim", "freedom": "wave"}, "variable.freedom"),
        (
            {"surface": {"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]}},
            {"loop": "rim", "freedom": "move"},
            "variable.loop",
        ),
    ],
)
def test_freedoms_that_are_not_there(values: dict[str, Any], table: dict[str, Any], key: str) -> None:
    with pytest.raises(InputError) as refusal:
        _changed(1.0, values=values, **table)
    assert refusal.value.where == key
    assert refusal.value.remedy
