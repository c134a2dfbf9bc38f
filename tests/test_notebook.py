"""The notebook of the documentation, executed by a kernel without a screen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("ipykernel")
nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

NOTEBOOK = Path(__file__).parents[1] / "docs" / "notebook.ipynb"


@pytest.fixture(scope="module")
def cells() -> list[Any]:
    page = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(page)
    # written without results: they are the program's, not the page's
    assert not any(cell.get("outputs") for cell in page.cells)
    nbclient.NotebookClient(page, timeout=300, kernel_name="python3").execute()
    return [cell for cell in page.cells if cell.cell_type == "code"]


def shown(cell: Any) -> Any:
    (output,) = cell.outputs
    return output["data"]


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_it_runs_and_shows_what_it_says(cells: list[Any]) -> None:
    for first in ("film\n", "net\n", "strips\n", "parts.nest"):
        (cell,) = (c for c in cells if (c.source + "\n").splitlines(True)[-1].startswith(first))
        assert "<svg" in shown(cell)["text/html"]
        assert "(" in shown(cell)["text/plain"]
    assert shown(cells[1])["text/plain"].startswith("('stable', ")
    (picture,) = (c for c in cells if ".plot(" in c.source)
    assert "image/png" in shown(picture)
    assert shown(cells[-1])["text/plain"] == "True"
