"""study.html in headless Chromium: every variant is drawn, ranges narrow the choice, a net is shown and turned."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import lamella
from view.browser import Browser

pytestmark = pytest.mark.slow

CANVAS = "document.getElementById('view')"
STUDY: dict[str, Any] = {
    "project": "roof.toml",
    "until": "lamellas",
    "variable": [
        {"key": "surface.neck_radius", "range": [1.0, 2.0]},
        {"key": "lamella.height", "values": [0.05, 0.1]},
        {"key": "lamella.material", "values": ["1.4301", "no steel"]},
    ],
    "sampler": {"count": 3},
    "objective": [{"figure": "lamellas.utilisation_max"}, {"figure": "surface.area", "goal": "max"}],
}


def test_a_designer_finds_her_way(tmp_path: Path) -> None:
    (tmp_path / "roof.toml").write_text(
        '[surface]\nkind = "catenoid"\nneck_radius = 1.2\nheight = [0.0, 2.0]\n[network]\ncells = 12\n'
    )
    study = lamella.study(STUDY, folder=tmp_path, out=tmp_path / "out", jobs=1)
    assert study.columns["status"].count("done") == 6
    with Browser() as browser:
        page = browser.page(1200, 1000)
        page.open(tmp_path / "out" / "study.html")
        assert page.value("document.querySelectorAll('#parallel path.v').length") == 6
        assert page.value("document.querySelectorAll('#scatter circle').length") == 6
        # five axes: three variables, two objectives
        assert page.value("document.querySelectorAll('#matrix circle').length") == 6 * (5 * 5 - 5)
        assert page.value("document.querySelectorAll('#refused tr').length") == 6
        best = page.value("document.querySelectorAll('#scatter circle.best').length")
        assert best == len(study.best) > 0
        page.until(f"{CANVAS}.getContext('2d').getImageData(0, 0, 300, 300).data.some((value) => value)")
        before = page.value(f"{CANVAS}.toDataURL()")
        page.value(f"{CANVAS}.scrollIntoView()")
        x, y = page.value(f"(() => {{ const box = {CANVAS}.getBoundingClientRect(); return [box.x, box.y]; }})()")
        page.drag((x + 100, y + 100), (x + 180, y + 130))
        assert page.value(f"{CANVAS}.toDataURL()") != before
        # a brush over the upper part of the first axis leaves the wider necks
        page.value("scrollTo(0, 0)")
        box = "document.querySelector('#parallel .grab').getBoundingClientRect()"
        x, y, height = page.value(f"(() => {{ const box = {box}; return [box.x + 10, box.y, box.height]; }})()")
        page.drag((x, y + 2), (x, y + 0.6 * height))
        assert page.value("document.querySelectorAll('#parallel path.v.out').length") == 2
        assert "4 within" in page.value("document.getElementById('counts').textContent")
        page.value("document.querySelector('#gallery button:last-child').click()")
        chosen = page.value("document.getElementById('chosen-name').textContent")
        assert any(name in chosen for name in study.columns["id"])
        assert page.complaints() == []
