"""The file of a study: what is refused, with the key and the number."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from lamella.base.errors import InputError
from lamella.studies.tables import VARIANTS_MAX, VariableTable, parse_study, read_study

HEIGHT = {"key": "lamella.height", "range": [0.05, 0.1]}
MASS = {"figure": "fabrication.mass"}


def _study(**more: Any) -> dict[str, Any]:
    return {"project": "roof.toml", "variable": [HEIGHT]} | more


@pytest.mark.parametrize(
    ("values", "key", "number"),
    [
        ({"variable": [HEIGHT]}, "project", ""),
        ({"project": "roof.txt", "variable": [HEIGHT]}, "project", "roof.txt"),
        (_study(variabel=[HEIGHT]), "variabel", "variable"),
        (_study(variable=[]), "variable", ""),
        (_study(variable=HEIGHT), "variable", ""),
        (_study(variable=[HEIGHT, HEIGHT]), "variable", "lamella.height"),
        (_study(variable=[{"key": "lamella.height"}]), "variable[0]", ""),
        (_study(variable=[HEIGHT | {"values": [0.1]}]), "variable[0]", ""),
        (_study(variable=[HEIGHT | {"range": [0.1, 0.1]}]), "variable[0].range", "0.1"),
        (_study(variable=[HEIGHT | {"range": [0.1, float("nan")]}]), "variable[0].range", "nan"),
        (_study(variable=[{"key": "lamella.height", "values": [1, 1]}]), "variable[0].values", ""),
        (_study(variable=[HEIGHT | {"loop": "rim"}]), "variable[0]", ""),
        (_study(variable=[{"key": "a", "values": []}]), "variable[0].values", "1000"),
        (_study(variable=[{"key": "a", "values": [[1, 2]]}]), "variable[0].values", "[1, 2]"),
        (_study(variable=[{"key": "a", "range": [0.5]}]), "variable[0].range", "0.5"),
        (_study(variable=[{"key": "a", "range": "a"}]), "variable[0].range", "a"),
        ({"project": "roof.toml"}, "variable", "[[variable]]"),
        (_study(variable=[{"loop": "rim", "range": [0.9, 1.1]}]), "variable[0]", ""),
        (_study(variable=[{"loop": "rim", "freedom": "scale", "range": [0.0, 1.1]}]), "variable[0]", "0"),
        (_study(variable=[{"loop": "rim", "freedom": "skew", "range": [0.0, 1.1]}]), "variable[0].freedom", "skew"),
        (_study(variable=[{"loop": "rim", "freedom": "wave", "wave": 5, "range": [0, 1]}]), "variable[0].wave", "5"),
        (_study(variable=[{"key": "network.cells", "whole": True, "range": [5.2, 5.8]}]), "variable[0].range", ""),
        (_study(sampler={"kind": "random"}), "sampler.kind", "random"),
        (_study(sampler={"count": 0}), "sampler.count", "0"),
        (_study(sampler={"count": 10**5 + 1}), "sampler.count", f"{10**5}"),
        (_study(variable=[HEIGHT, HEIGHT | {"name": "b"}], sampler={"count": 400}), "sampler.count", "160,000"),
        (_study(constraint=[{"figure": "fabrication.mass"}]), "constraint[0]", ""),
        (_study(constraint=[MASS | {"at_least": 2.0, "at_most": 1.0}]), "constraint[0].at_least", "2"),
        (_study(optimise={}), "objective", ""),
        (_study(objective=[MASS, MASS], optimise={"method": "gradient"}), "optimise.method", "2"),
        (_study(objective=[MASS], optimise={"start": [0.2]}), "optimise.start", "0.2"),
        (_study(objective=[MASS], optimise={"start": [0.06, 0.07]}), "optimise.start", "2"),
    ],
)
def test_what_is_refused(values: dict[str, Any], key: str, number: str) -> None:
    with pytest.raises(InputError) as refusal:
        parse_study(values, source="study.toml")
    error = refusal.value
    assert error.where == f"study.toml: {key}"
    assert number in f"{error.message} {error.remedy}"
    assert error.remedy


@pytest.mark.parametrize("content", [b"\xff\xfe", b"project = ", b"", 2_000_000 * b"#", b"a = [" * 2000])
def test_a_file_that_is_no_study(content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_bytes(content)
    with pytest.raises(InputError) as refusal:
        read_study(file)
    assert "study.toml" in str(refusal.value)
    with pytest.raises(InputError):
        read_study(tmp_path / "other.toml")


def test_columns_tell_freedoms_apart() -> None:
    wave = {"loop": "rim", "freedom": "wave", "range": [-1.0, 1.0]}
    variables = [
        wave,
        wave | {"phase": "sin"},
        wave | {"wave": 2},
        wave | {"axis": "x"},
        wave | {"loop": ["rim", "eye"]},
    ]
    columns = [VariableTable.model_validate(one).column for one in variables]
    assert len(set(columns)) == len(columns)
    assert VARIANTS_MAX >= 10_000
