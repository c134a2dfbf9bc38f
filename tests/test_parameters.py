"""Geometry knows no project file: its errors name parameters, and stages say which keys these were read from."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest

import lamella
from lamella import InputError, parse_project
from lamella.base.message import Message
from lamella.base.units import METRES, PROJECT_UNITS
from lamella.project.tables import FURTHER_TABLES, SURFACE_TABLES
from lamella.project.values import Unit
from lamella.stages.keys import key_of, keys, with_keys

PACKAGE = Path(lamella.__file__).parent
GEOMETRY = (
    "base",
    "surface",
    "network",
    "strip",
    "fabrication",
    "hardware",
    "solid",
    "panels",
    "structure",
    "projection",
    "files",
)
KEYS = {table: set(model.model_fields) for table, model in FURTHER_TABLES.items()}
KEYS["surface"] = {key for model in SURFACE_TABLES.values() for key in model.model_fields}
KEY = re.compile(
    r"(?<![.\w])(?:" + "|".join(rf"{table}\.(?:{'|'.join(sorted(names))})" for table, names in KEYS.items()) + r")\b"
)


def strings(tree: ast.AST) -> Iterator[ast.Constant]:
    """Text of a module, literal parts of f-strings among it, but for docstrings."""
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node


def named_keys(text: str) -> list[str]:
    """Keys of a project that a module names."""
    return [found for node in strings(ast.parse(text)) for found in KEY.findall(str(node.value))]


def test_no_text_of_geometry_names_a_key() -> None:
    paths = [path for room in GEOMETRY for path in sorted((PACKAGE / room).rglob("*.py"))]
    assert len(paths) > 200
    named = {str(path.relative_to(PACKAGE)): named_keys(path.read_text("utf-8")) for path in paths}
    assert {path: found for path, found in named.items() if found} == {}


def test_a_key_in_a_text_is_found() -> None:
    found = named_keys('raise InputError("x", f"write network.cells = {n}", "surface.neck_radius")')
    assert sorted(found) == [
        "network.cells",
        "surface.neck_radius",
    ]
    assert named_keys('"""surface.height"""\nload("lamella.surface.boundary")') == []


@pytest.mark.parametrize(
    ("surface", "parameter"),
    [
        (lambda: lamella.Unduloid(3.0, 1.0, (0.0, 1.0)), "neck_radius"),
        (lambda: lamella.Unduloid(-3.0, 1.0, (0.0, 1.0)), "neck_radius"),
        (lambda: lamella.Nodoid(1.0, 2.0, (0.0, 9.0)), "height"),
        (lambda: lamella.Catenoid(1.0, (1.0, 0.0)), "height"),
        (lambda: lamella.Helicoid(5.0, 3.0, 1.0, 0.5), "inner_radius"),
        (lambda: lamella.Scherk(1.6), "extent"),
        (lambda: lamella.Enneper(1, 0.9), "order"),
        (lambda: lamella.Section(height=0.001, thickness=0.002), "thickness"),
    ],
)
def test_a_refusal_names_the_parameter_and_no_key(surface: Any, parameter: str) -> None:
    with pytest.raises(InputError) as refused:
        surface()
    assert refused.value.where == parameter
    assert not KEY.search(str(refused.value))


def test_a_project_is_told_the_key() -> None:
    values = {"kind": "unduloid", "neck_radius": 3.0, "bulge_radius": 1.0, "height": [0.0, 1.0]}
    with pytest.raises(InputError) as refused:
        lamella.make_surface(parse_project({"surface": values}))
    assert refused.value.where == "surface.neck_radius"


def test_keys_of_parameters() -> None:
    assert key_of("cells", "network") == "network.cells"
    assert key_of("loops[1].circle", "surface", loops="surface.boundary") == "surface.boundary[1].circle"
    assert key_of("section.height", "x", section="lamella") == "lamella.height"
    assert key_of("", "network") == "network"
    with pytest.raises(InputError) as refused, keys("network"):
        raise InputError("2 cells", "write 3", "cells")
    assert (refused.value.message, refused.value.remedy, refused.value.where) == ("2 cells", "write 3", "network.cells")


def test_keys_in_warnings() -> None:
    warning = with_keys(Message("x", "a smaller tolerance does, and tolerance = 0"), "surface.tolerance")
    assert warning == "a smaller surface.tolerance does, and tolerance = 0"
    assert warning.key == "x"
    assert with_keys("a material as stiff, or material = 2", "lamella.material =") == (
        "a material as stiff, or lamella.material = 2"
    )


def test_units_of_a_project_are_those_that_readers_know() -> None:
    assert get_args(Unit) == PROJECT_UNITS
    assert set(PROJECT_UNITS) <= set(METRES)
