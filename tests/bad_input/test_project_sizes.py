"""Nets too large or too fine to be made: refused before any work, with the limit."""

from __future__ import annotations

import contextlib
import re
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from lamella import InputError, make_surface, read_project
from lamella.command.main import main
from lamella.network.density_request import BYTES_FIXED, BYTES_PER_NODE
from lamella.network.lattice.density import choose_density
from lamella.stages.pattern_of_table import pattern_of
from lamella.surface.closed_forms.closed_form import ClosedForm

from .projects import UNDULOID, surface


@pytest.mark.parametrize("cells", [1_000, 100_000, 10**9, 10**12])
def test_absurd_counts_are_refused_before_any_work(refused: Callable[..., str], cells: int) -> None:
    tracemalloc.start()
    told = refused(
        f"{UNDULOID}[network]\ncells = {cells}\n",
        "network.cells",
        cells,
        500000,
        at="p.toml:8",
    )
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6
    nodes, memory = re.search(r"about ([\d,.e+]+) nodes and take about ([\d,.e+]+) GB", told).groups()  # type: ignore[union-attr]
    assert float(nodes.replace(",", "")) == pytest.approx(0.7589 * cells**2, rel=0.05)
    assert float(memory.replace(",", "")) == pytest.approx(
        (BYTES_FIXED + BYTES_PER_NODE * float(nodes.replace(",", ""))) / 1e9, rel=0.01, abs=0.51
    )
    most = int(re.search(r"remedy: at most (\d+) cells fit", told)[1])  # type: ignore[index]
    assert most == pytest.approx(811, rel=0.02)


def test_the_limit_named_is_the_limit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = tmp_path / "p.toml"
    for key, value in (("cells", "5000"), ("spacing", "0.001")):
        capsys.readouterr()
        project.write_text(f"{UNDULOID}[network]\n{key} = {value}\n")
        assert main(["check", str(project)]) == 2
        named = float(re.search(r"remedy: .*?at (?:most|least) ([\d.]+)", capsys.readouterr().err)[1])  # type: ignore[index]
        for given, code in (
            (named * (0.99 if key == "cells" else 1.01), 0),
            (named * (1.03 if key == "cells" else 0.97), 2),
        ):
            project.write_text(f"{UNDULOID}[network]\n{key} = {int(given) if key == 'cells' else given}\n")
            assert main(["check", str(project)]) == code, (key, given, capsys.readouterr().err)


@pytest.mark.parametrize("kind", ["unduloid", "cylinder"])
def test_very_long_ranges_are_refused_with_an_estimate(refused: Callable[..., str], kind: str) -> None:
    refused(surface(kind, height="[0, 1e6]"), "network.cells", 500000)


def test_a_surface_that_runs_to_infinity(refused: Callable[..., str]) -> None:
    """Arc lengths that cannot be measured are refused, not told wrong."""
    refused(
        surface("scherk", extent="1.57079632"),
        "network.cells",
        "extent",
    )


@pytest.mark.parametrize(
    "text",
    [
        surface("unduloid", height="[0, 500]") + "[network]\nspacing = 2.0\n",
        surface("catenoid", neck_radius="3.0", height="[0, 0.125]") + "[network]\nspacing = 1.0\n",
    ],
    ids=["long", "narrow"],
)
def test_spacing_on_long_and_narrow_surfaces(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str) -> None:
    (tmp_path / "p.toml").write_text(text)
    assert main(["check", str(tmp_path / "p.toml")]) in (0, 2)
    project = read_project(tmp_path / "p.toml")
    tracemalloc.start()
    # the density alone
    with contextlib.suppress(InputError):
        closed, table = make_surface(project), project.network
        assert isinstance(closed, ClosedForm)
        choose_density(closed, cells=table.cells, spacing=table.spacing, pattern=pattern_of(table))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6
