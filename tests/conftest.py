"""Shared by all tests: surfaces at parameters drawn afresh, and runs written to temporary folders."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

from command.command_line import UNDULOID
from lamella import (
    Catenoid,
    Cylinder,
    Enneper,
    Helicoid,
    Memory,
    Nodoid,
    Results,
    Scherk,
    Unduloid,
    compute,
    parse_project,
    read_project,
    write,
)
from lamella.surface.closed_forms.closed_form import ClosedForm

# the same draws at every run: a change is judged by what it changes
settings.register_profile("same", derandomize=True)
settings.load_profile("same")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of a test marked few(n) n cases run in `make test`, evenly spread; the others are slow ones."""
    cases: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("few"):
            cases.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for several in cases.values():
        marker = several[0].get_closest_marker("few")
        assert marker is not None
        kept = {k * len(several) // marker.args[0] for k in range(marker.args[0])}
        for number, item in enumerate(several):
            if number not in kept:
                item.add_marker(pytest.mark.slow)


EXAMPLES = Path(__file__).parents[1] / "examples"
KINDS = ("unduloid", "nodoid", "catenoid", "cylinder", "helicoid", "enneper", "enneper3", "scherk")


MEMORY = Memory()
"""Of examples: what is computed up to a stage is not computed again for a later one."""


@cache
def run_of_example(name: str, until: str | None = None) -> Results:
    """An example's run, computed once for all tests of a process."""
    return compute(read_project(EXAMPLES / f"{name}.toml"), until=until, folder=EXAMPLES, memory=MEMORY)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a project p.toml."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.toml").write_text(UNDULOID)
    return tmp_path


def draw_surface(kind: str, rng: np.random.Generator) -> ClosedForm:
    """A surface of a kind at random parameters and of random size."""
    size = 10 ** rng.uniform(-0.5, 1.0)
    if kind == "unduloid":
        neck, bulge = size, size * 10 ** rng.uniform(0.02, 1.0)
        return Unduloid(neck, bulge, _range(rng, 1.5 * (neck + bulge)))
    if kind == "nodoid":
        neck, bulge = size, size * (1 + 10 ** rng.uniform(-0.5, 1.0))
        fold = Nodoid(neck, bulge, (-1e-9, 1e-9)).fold
        return Nodoid(neck, bulge, _range(rng, 0.98 * fold))
    if kind == "catenoid":
        return Catenoid(size, _range(rng, 1.5 * size))
    if kind == "cylinder":
        return Cylinder(size, _range(rng, 2 * size))
    if kind == "helicoid":
        inner = size * rng.uniform(0, 0.5)
        pitch = size * rng.uniform(1.5, 6) * rng.choice([-1, 1])
        return Helicoid(pitch, inner, inner + size * rng.uniform(0.5, 2), rng.uniform(0.5, 2))
    if kind.startswith("enneper"):
        order = int(rng.integers(3, 6)) if kind == "enneper3" else 2
        return Enneper(order, rng.uniform(0.5, 1.2), size)
    return Scherk(rng.uniform(0.6, 1.5), size)


def _range(rng: np.random.Generator, reach: float) -> tuple[float, float]:
    """z0 < z1 at least a quarter of the reach apart."""
    low = rng.uniform(-1, 0.5)
    return reach * low, reach * rng.uniform(low + 0.5, 1)


def draw_places(surface: ClosedForm, rng: np.random.Generator, count: int = 40) -> np.ndarray:
    """Random places well inside a surface, away from a singular node."""
    where, _ = surface.places(15, 15)
    inner = where[rng.integers(0, len(where), 4 * count)] * 0.9
    return inner[np.abs(inner) > 0.1][:count]


@pytest.fixture
def run(tmp_path: Path) -> Callable[..., Path]:
    """Run a project given as keyword tables; returns the folder written."""

    def run(until: str = "fabrication", **tables: Any) -> Path:
        folder = tmp_path / f"run{len(list(tmp_path.iterdir()))}"
        write(compute(parse_project({"name": "test"} | tables), until=until), folder)
        return folder

    return run


def load(folder: Path, name: str) -> Any:
    """A JSON file of a run."""
    return json.loads((folder / name).read_bytes())
