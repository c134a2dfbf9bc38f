"""The modules of the page: each that is imported is served, and has what is taken from it."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

import pytest

from lamella.interactive.page import ASSET_TYPES, asset

OWN = sorted(path.name for path in Path(str(files("lamella.interactive") / "assets")).iterdir())
IMPORT = re.compile(r'^import \{([^}]*)\} from "\./([\w.]+)";$', re.MULTILINE)


@pytest.mark.parametrize("name", [name for name in OWN if name.endswith(".js")])
def test_imports_are_there(name: str) -> None:
    text = (asset(name) or b"").decode()
    imports = IMPORT.findall(text)
    assert len(imports) == text.count("\nimport ") + text.startswith("import ")
    for names, module in imports:
        there = asset(module)
        assert there is not None, module
        for one in names.split(","):
            assert re.search(
                rf"^export (async )?(function|class|const) {one.strip()}\b", there.decode(), re.MULTILINE
            ), one


def test_the_page_names_files_that_are_there() -> None:
    html = (files("lamella.interactive") / "assets" / "studio.html").read_text("utf-8")
    named = re.findall(r"\{\{base\}\}assets/([\w.]+)", html)
    assert len(named) == 4
    for name in named:
        assert asset(name), name
        assert Path(name).suffix in ASSET_TYPES
    # ids that the modules ask for are those of the page
    ids = set(re.findall(r'\bid="([\w-]+)"', html))
    for name in OWN:
        if name.endswith(".js"):
            asked = set(re.findall(r'byId\("([\w-]+)"\)', (asset(name) or b"").decode()))
            assert asked <= ids, asked - ids
