"""Figures by their keys, and the clear height under a surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import lamella
from lamella.studies.figures import change_of, figure_at, headroom, table_figures
from lamella.studies.tables import HeadroomTable, VariableTable

SUMMARY: dict[str, Any] = {
    "schema": "x",
    "surface": {"area": 3.0, "kind": "catenoid", "stability": None},
    "network": {"periods": [{"around": "axis", "a_cells": 12.0}], "singular_nodes": []},
    "structure": {"cases": [{"name": "snow", "displacement_max": 0.02}]},
    "erection": None,
    "warnings": ["a", "b"],
    "seconds": {"surface": 1.0},
}


def test_keys_lead_through_tables_and_lists() -> None:
    figures = table_figures(SUMMARY)
    assert figures["surface.area"] == 3.0
    assert figures["warnings"] == 2
    assert not [key for key in figures if key.startswith(("seconds", "schema", "network.periods"))]
    assert figure_at(figures, SUMMARY, "network.periods.0.a_cells") == 12.0
    assert figure_at(figures, SUMMARY, "structure.cases.snow.displacement_max") == 0.02
    # another variant may have them
    assert figure_at(figures, SUMMARY, "structure.cases.wind.displacement_max") is None
    assert figure_at(figures, SUMMARY, "surface.stability") is None
    assert figure_at(figures, SUMMARY, "erection.driver_max") is None
    for key in ("surface.aera", "surface", "structure.cases.snow", "seconds.surface.x"):
        with pytest.raises(KeyError):
            figure_at(figures, SUMMARY, key)


def test_headroom_under_a_helicoid() -> None:
    """Its height at the angle phi is pitch phi / (2 pi); faces are off it by their sag."""
    project = lamella.parse_project(
        {"surface": {"kind": "helicoid", "pitch": 4.0, "inner_radius": 0.5, "outer_radius": 2.0, "turns": 0.9}}
    )
    results = lamella.compute(project, until="surface")
    for radius, phi in ((1.0, 0.4), (1.7, 2.0), (0.6, 4.5)):
        at = [radius * np.cos(phi), radius * np.sin(phi)]
        place = HeadroomTable.model_validate({"name": "stair", "at": at, "ground": -0.5})
        height = headroom(results, place)
        heights = {4.0 * (phi + turn) / (2 * np.pi) + 0.5 for turn in (0.0, -2 * np.pi)}
        assert height is not None
        assert min(abs(height - one) for one in heights) < 2 * results.mesh.sag() + 1e-9
    assert headroom(results, HeadroomTable.model_validate({"name": "outside", "at": [9.0, 0.0]})) is None


def test_change_is_in_parts_of_the_ranges() -> None:
    variables = [
        VariableTable.model_validate({"key": "a", "range": [0.0, 2.0]}),
        VariableTable.model_validate({"key": "b", "range": [0.0, 10.0]}),
        VariableTable.model_validate({"key": "c", "values": ["x", "y"]}),
    ]
    assert change_of(variables, (1.6, 4.0, "x"), (1.0, 0.0, "x")) == pytest.approx(0.5)
    assert change_of(variables, (1.0, 0.0, "y"), (1.0, 0.0, "x")) == 1.0
