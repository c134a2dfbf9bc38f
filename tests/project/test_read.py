"""The project file: whatever it holds, it is read or refused in a few readable words."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lamella import InputError, Project, parse_project, read_project
from lamella.base.progress import silent
from lamella.project.tables import FURTHER_TABLES, MATERIALS, SURFACE_TABLES, project_schema
from lamella.stages.clock import Clock
from lamella.stages.computation import Computation
from lamella.stages.memory import Memory
from lamella.stages.wanted import wanted_stages

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))

NUMBERS = st.one_of(
    st.sampled_from([0, 0.0, -0.0, -1, 1, 1e308, -1e308, 1e200, 1e-300, 5e-324, 10**30, 10**400, math.nan, math.inf]),
    st.integers(-(10**6), 10**12),
    st.floats(),
    st.floats(0.001, 100),
)
JUNK = st.one_of(
    NUMBERS,
    st.text(max_size=20),
    st.booleans(),
    st.lists(NUMBERS, max_size=4),
    st.dictionaries(st.text(max_size=5), NUMBERS, max_size=2),
    st.sampled_from(["x" * 100_000, [[[]]], [{}], "\x1b[31m\n\0", [1.0] * 10_000]),
)


def _value(name: str, field: Any) -> st.SearchStrategy[Any]:
    if name in ("height", "sheet") and "tuple" in str(field.annotation):
        return st.tuples(st.floats(-3, 0), st.floats(0.1, 4)).map(list)
    if name in ("order", "layers", "cells"):
        return st.integers(1, 40)
    if name == "material":
        return st.sampled_from(list(MATERIALS))
    if "Literal" in str(field.annotation):
        return st.sampled_from(field.annotation.__args__)
    return st.floats(0.001, 10)


@st.composite
def projects(draw: st.DrawFn) -> dict[str, Any]:
    """Projects from the schema with one to a few things spoilt."""
    kind = draw(st.sampled_from(list(SURFACE_TABLES)))
    project: dict[str, Any] = {"name": draw(st.text(max_size=30)), "surface": {}}
    for name, field in SURFACE_TABLES[kind].model_fields.items():
        project["surface"][name] = kind if name == "kind" else draw(_value(name, field))
    for table, model in FURTHER_TABLES.items():
        names = draw(st.sets(st.sampled_from(list(model.model_fields)), max_size=3))
        if names:
            project[table] = {name: draw(_value(name, model.model_fields[name])) for name in sorted(names)}
    for _ in range(draw(st.integers(0, 3))):
        table = draw(st.sampled_from([*FURTHER_TABLES, "surface", "materials", ""]))
        target: Any = project.setdefault(table, {}) if table else project
        if not isinstance(target, dict):
            continue
        known = list(target) or ["cells"]
        key = draw(
            st.one_of(st.sampled_from(known), st.text(max_size=12), st.sampled_from(["k" * 5000, "a\nb", "a.b"]))
        )
        if draw(st.integers(0, 3)) == 0:
            target.pop(key, None)
        else:
            target[key] = draw(JUNK)
    return project


def _refuse_at_no_cost(project: Project) -> None:
    """Whatever a run refuses before there is a net."""
    stages, _ = wanted_stages(project, None)
    Computation(project, stages, Path(), Memory(), Clock(silent)).run(stages[0])


def _read_or_refused(project: dict[str, Any]) -> None:
    try:
        _refuse_at_no_cost(parse_project(project, source="p.toml"))
    except InputError as error:
        refusal = error
    else:
        return
    told = str(refusal)
    assert told.startswith("p.toml") or refusal.where, told
    assert "remedy: " in told
    assert len(told.splitlines()) <= 14, told
    assert max(map(len, told.splitlines())) <= 400, told
    assert all(c.isprintable() or c == "\n" for c in told), told


QUIET = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]


@settings(max_examples=150, deadline=None, suppress_health_check=QUIET, derandomize=True)
@given(projects())
def test_any_project_is_read_or_refused_readably(project: dict[str, Any]) -> None:
    _read_or_refused(project)


@pytest.mark.slow
@settings(max_examples=5000, deadline=None, suppress_health_check=QUIET)
@given(projects())
def test_any_project_is_read_or_refused_readably_at_length(project: dict[str, Any]) -> None:
    _read_or_refused(project)


@settings(max_examples=150, deadline=None, suppress_health_check=QUIET, derandomize=True)
@given(st.binary(max_size=200), st.sampled_from(EXAMPLES), st.integers(0, 400), st.booleans())
def test_any_bytes_are_read_or_refused_readably(
    tmp_path: Path, junk: bytes, example: Path, at: int, replace: bool
) -> None:
    content = example.read_bytes()
    path = tmp_path / "p.toml"
    path.write_bytes(content[:at] + junk + content[at + len(junk) * replace :])
    try:
        read_project(path)
    except InputError as error:
        told = str(error)
    else:
        return
    assert told.count("\n") <= 13, told
    assert max(map(len, told.splitlines())) <= 400 + len(str(path)), told


def test_the_defaults() -> None:
    """DESIGN section 7."""
    project = parse_project({"surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 1.0]}})
    assert (project.network.cells, project.network.spacing, project.network.angle) == (24, None, 90)
    assert (project.network.closing, project.network.minimum_length) == ("open", 0.5)
    strip = project.lamella
    assert (strip.height, strip.thickness, strip.layers, strip.offset) == (0.1, 0.0015, 2, 0.025)
    assert (strip.material, strip.marks) == ("1.4301", "arc-length")


def test_the_name_is_the_files_when_not_given(tmp_path: Path) -> None:
    body = "[surface]\nkind = 'cylinder'\nradius = 2\nheight = [0, 1]\n"
    for name in ("", 'name = ""\n', 'name = "  "\n'):
        path = tmp_path / "Kuppel größer.toml"
        path.write_text(name + body, encoding="utf-8")
        assert read_project(path).name == "Kuppel größer"
    path.write_text('name = "given"\n' + body, encoding="utf-8")
    assert read_project(path).name == "given"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_schema_accepts_the_examples_and_refuses_what_the_program_refuses(path: Path) -> None:
    """The JSON schema of a project against the program, on the examples and on copies with a fault."""
    schema = project_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    values = tomllib.loads(path.read_text(encoding="utf-8"))
    validator.validate(values)
    validator.validate(tomllib.loads(read_project(path).to_toml()))
    for table, key, value in (
        ("surface", "kind", "undoloid"),
        ("surface", "unknown", 1),
        ("network", "cells", 2),
        ("network", "cells", 2.5),
        ("lamella", "height", "0.1"),
        ("lamella", "layers", 5),
        ("", "unknown", 1),
    ):
        spoilt = {k: dict(v) if isinstance(v, dict) else v for k, v in values.items()}
        (spoilt.setdefault(table, {}) if table else spoilt)[key] = value
        assert list(validator.iter_errors(spoilt)), (table, key, value)
        with pytest.raises(InputError):
            parse_project(spoilt)


def test_own_materials_come_first_and_carry_their_figures() -> None:
    own = {"density": 1000.0, "youngs_modulus": 1e10, "shear_modulus": 1e9, "strength": 1e7}
    base = {"surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 1.0]}}
    project = parse_project(base | {"lamella": {"material": "S235"}, "materials": {"S235": own}})
    assert project.material().density == 1000
    assert parse_project(base | {"lamella": {"material": "S235"}}).material().density == 7850
    project = parse_project(base | {"lamella": {"material": "a.b c"}, "materials": {"a.b c": own}})
    assert tomllib.loads(project.to_toml())["materials"]["a.b c"]["strength"] == 1e7


def test_lines_of_keys(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    for body, line in (
        ("[surface]\nkind = 'cylinder'\nheight = [0, 1]\n\n# radius = 3\n  radius   =  -1", 6),
        ("[ surface ]\nkind = 'cylinder'\nheight = [\n0,\n1]\n'radius' = -1", 6),
        ("[network]\ncells = 3\n[surface]\nkind = 'cylinder'\nheight = [0, 1]\n\"radius\" = -1", 6),
        ("surface = {kind = 'cylinder', height = [0, 1], radius = -1}", 1),
        ("name = 'x'\nsurface.kind = 'cylinder'\nsurface.height = [0, 1]\nsurface.radius = -1", 4),
    ):
        path.write_text(body)
        with pytest.raises(InputError) as refused:
            read_project(path)
        assert str(refused.value).startswith(f"{path}:{line}: surface.radius: -1 m is out of range")


def test_toml_writer_and_reader_agree_on_odd_names(tmp_path: Path) -> None:
    name = 'a\n"b"\\ \t<script>alert(1)</script> \u2028 日本 😀 \x01'
    values = {"name": name, "surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 1.0]}}
    path = tmp_path / "p.toml"
    path.write_text(tomli_w.dumps(values), encoding="utf-8")
    project = read_project(path)
    assert project.name == 'a "b"\\ <script>alert(1)</script> 日本 😀'
    assert tomllib.loads(project.to_toml())["name"] == project.name
