"""The benches and the page of the slowest tests: what they list is there. Nothing is timed here."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BENCHES = ROOT / "benchmarks"
SHARED = {"bench", "page"}


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> object:
    monkeypatch.syspath_prepend(str(BENCHES))
    import bench

    yield bench
    for name in SHARED & set(sys.modules):
        del sys.modules[name]


def test_every_bench_is_on_the_page(bench: object) -> None:
    import page  # type: ignore[import-not-found]

    files = {path.stem for path in BENCHES.glob("*.py")} - SHARED
    assert set(page.MODULES) == files
    for name in page.MODULES:
        defined = {
            node.name
            for node in ast.parse((BENCHES / f"{name}.py").read_text("utf-8")).body
            if isinstance(node, ast.FunctionDef)
        }
        assert "tables" in defined, name


def test_a_table_as_it_is_printed(bench: object) -> None:
    Limit, Table = bench.Limit, bench.Table  # type: ignore[attr-defined]
    rows = ({"what": "film", "nodes": 12_345, "s": 0.012345}, {"what": "net", "nodes": None, "s": 2.0e-5, "ratio": 3.0})
    table = Table("Title", "About.", rows, (Limit("a", 1.0, 2.0), Limit("b", 3.0, 2.0)), ("no peer",))
    assert table.columns == ("what", "nodes", "s", "ratio")
    assert table.markdown().splitlines() == [
        "## Title",
        "",
        "About.",
        "",
        "| what | nodes | s | ratio |",
        "| --- | ---: | ---: | ---: |",
        "| film | 12,345 | 0.0123 |  |",
        "| net |  | 2.0e-05 | 3 |",
        "",
        "| limit | measured | at most |  |",
        "| --- | ---: | ---: | --- |",
        "| a | 1 | 2 |  |",
        "| b | 3 | 2 | **missed** |",
        "",
        "Left out: no peer",
    ]


def test_a_page_keeps_the_parts_of_other_benches(bench: object) -> None:
    import page  # type: ignore[import-not-found]

    text = page.HEAD + "".join(
        page.BEGIN.format(name) + f"{name}\n" + page.END.format(name) for name in ("film", "peers")
    )
    assert set(page.sections(text)) == {"film", "peers"}
    assert "film\n" in page.sections(text)["film"]


def test_slowest_tests_are_there_and_say_what_they_prove() -> None:
    import slowest  # type: ignore[import-not-found]

    if not slowest.PAGE.exists():
        pytest.skip("make slowest writes the page")
    rows = re.findall(r"^\| `([^`]+)` \| \d+ \| [\d.]+ \| (.*) \|$", slowest.PAGE.read_text("utf-8"), re.M)
    assert len(rows) == slowest.COUNT
    for name, proves in rows:
        file, *path = name.split("::")
        body: list[ast.stmt] = ast.parse((ROOT / file).read_text("utf-8")).body
        for one in path:
            node = next(item for item in body if isinstance(item, ast.FunctionDef | ast.ClassDef) and item.name == one)
            body = node.body
        said = " ".join((ast.get_docstring(node) or "").partition("\n\n")[0].split())
        assert said, name
        assert said == proves, name
