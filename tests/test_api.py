"""API pages: every public name is listed and on the page that is made from the docstrings."""

from __future__ import annotations

import re
import runpy
from html import unescape
from pathlib import Path
from typing import Any

import pytest

DOCS = Path(__file__).parents[1] / "docs"


@pytest.fixture(scope="module")
def api() -> dict[str, Any]:
    return runpy.run_path(str(DOCS / "build_api.py"))


def test_every_public_name_has_a_topic(api: dict[str, Any]) -> None:
    listed = [name for names in api["TOPICS"].values() for name in names]
    assert sorted(listed) == sorted(api["public_names"]())


def test_the_list_is_of_the_present_code(api: dict[str, Any]) -> None:
    assert (DOCS / "api.md").read_text("utf-8") == api["listing"]()


def test_the_page_has_every_public_name(api: dict[str, Any], tmp_path: Path) -> None:
    pytest.importorskip("pdoc")
    page = unescape(api["build"](tmp_path).read_text("utf-8"))
    places = set(re.findall(r'id="([\w.]+)"', page))
    assert set(api["public_names"]()) <= places
    # methods and attributes, with their units
    assert {"Network.strips", "Shown.plot", "Result.allclose", "Network.node_points", "Lamellas.parts"} <= places
    assert "Positions (m) and unit surface normals." in page
    # examples as they are run
    assert page.count(">>> ") > 100 or page.count("&gt;&gt;&gt;") > 100
