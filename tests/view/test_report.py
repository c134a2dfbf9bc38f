"""report.html: complete, offline, inert to what a project says, and true to its scene."""

from __future__ import annotations

import base64
import html
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import lamella
from lamella.base.message import Message
from lamella.stages.lamellas.scene import lamellas_scene
from lamella.stages.network.scene import network_scene
from lamella.stages.surface.output import SurfaceOutput
from lamella.stages.surface.scene import surface_scene
from lamella.surface.closed_forms.catenoid import Catenoid
from lamella.surface.closed_forms.cylinder import Cylinder
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface
from lamella.view.bundle import IMPORT, asset, bundled
from lamella.view.report import CORNER_LIMIT, ReportData, _policy, report_html, write_report
from lamella.view.scene.encode import encode_scene
from lamella.view.scene.encoding import array_of, unpacked
from lamella.view.scene.scene import Scene, make_scene
from lamella.view.scene.surface_quantities import surface_quantities
from surface.element.exact_elements import sphere_cap

FIGURES = (
    ("Surface", "Area", "62.41", "m²"),
    ("Network", "Nodes", "408", ""),
    ("Surface", "Mean curvature", "0", "1/m"),
)


def scene_bytes(text):
    return base64.b64decode(re.search(r'<script type="text/plain" id="scene">(.*?)</script>', text, re.S)[1])


class Page(HTMLParser):
    """Tags, attributes and text of a page, scripts and styles apart."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.text, self.inside = [], [], "", []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, key, value) for key, value in attrs]
        self.inside.append(tag)

    def handle_endtag(self, tag):
        while self.inside and self.inside.pop() != tag:
            pass

    def handle_data(self, data):
        if not {"script", "style"} & set(self.inside):
            self.text += data


def surface_output(surface: Surface, mesh: SurfaceMesh | None = None) -> SurfaceOutput:
    return SurfaceOutput(
        lamella.parse_project({"surface": {"kind": "cylinder", "radius": 1, "height": [0, 1]}}),
        surface,
        mesh or surface.mesh(),
        None,
        "",
    )


@pytest.fixture(scope="module")
def scenes():
    surface = Catenoid(2.0, (-1.2, 2.2))
    network = lamella.net(surface, cells=12)
    parts = [
        surface_scene(surface_output(surface), alone=False),
        network_scene(network),
        lamellas_scene(network.strips()),
    ]
    shown = [list(part) for part in parts]
    alone = make_scene("Oculus", surface_scene(surface_output(surface), alone=True))
    return {
        "surface": alone,
        "network": make_scene("Oculus", shown[0] + shown[1]),
        "lamellas": make_scene("Oculus", shown[0] + shown[1] + shown[2]),
    }


@pytest.fixture(scope="module")
def full(scenes):
    return ReportData(
        name="Oculus",
        version="9.8.7",
        subtitle=("catenoid", "lamellas 100 × 1.5 mm", ""),
        figures=FIGURES,
        corners=(),
        warnings=(Message("twists", "Twists more than it bends."), Message("closed", "Closed with 12 cells.")),
        scene=scenes["lamellas"],
    )


@pytest.mark.parametrize("stage", ["surface", "network", "lamellas"])
def test_says_who_made_it_and_what_of(full, scenes, stage, tmp_path):
    write_report(tmp_path / "report.html", replace(full, scene=scenes[stage]))
    page = Page((tmp_path / "report.html").read_text(encoding="utf-8"))
    for text in ("Oculus", "lamella 9.8.7", "catenoid · lamellas 100", "2 warnings", "Closed with 12 cells.", "62.41"):
        assert text in page.text
    assert page.tags.count("table") == 2
    assert "{{" not in page.text


def test_corners_of_the_boundary_are_a_table(full):
    """A row a corner, in order, under four headings; of a rim of many corners the rest is in the summary."""
    rows = tuple((f"{k}.0, 2.5, <0", "108.9", "–", f"{k / 7:.2f}") for k in range(30))
    for count in (5, 30):
        text = report_html(replace(full, corners=rows[:count]))
        page = Page(text)
        assert page.tags.count("table") == 3
        table = text.rsplit("<table", 1)[1].split("</table>")[0]
        assert table.count('<th scope="col">') == 4
        shown = re.findall(r'<th scope="row">(.*?)</th>' + 3 * r"<td[^>]*>(.*?)</td>", table)
        assert [tuple(map(html.unescape, row)) for row in shown] == list(rows[: min(count, CORNER_LIMIT)])
        assert ("6 more" in table) == (count == 30)


def test_asks_for_nothing_from_anywhere(full):
    text = report_html(full)
    page = Page(text)
    fetched = {"src", "href", "srcset", "data", "action", "poster", "background", "xlink:href"}
    assert [a for a in page.attributes if a[1] in fetched] == [("link", "href", "data:,")]
    assert not {"iframe", "object", "embed", "img", "audio", "video", "base"} & set(page.tags)
    css = re.search(r"<style>(.*?)</style>", text, re.S)[1]
    assert not re.search(r"@import|url\(|//", css)
    ours = text.rsplit('<script type="module">', 1)[1]
    assert not re.search(r"\b(fetch|import|XMLHttpRequest|WebSocket|sendBeacon)\s*\(", ours)
    policy = next(value for _, key, value in page.attributes if key == "content" and "default-src" in value)
    assert policy.startswith("default-src 'none';")
    assert "connect-src" not in policy
    # Namespaces are names; nothing else in the file looks like an address.
    assert set(re.findall(r"https?://[\w./]+", text)) == {
        "http://www.w3.org/1999/xhtml",
        "http://www.w3.org/2000/svg",
    }


def test_scripts_are_whole_and_their_hashes_allowed(full):
    text = report_html(full)
    scripts = re.findall(r"<script(?: type=\"module\")?>(.*?)</script>", text, re.S)
    assert scripts == [asset("three.min.js"), bundled("report.js")]
    assert _policy(*scripts) in text


def test_the_bundle_has_every_module_once_and_no_name_twice():
    """Modules become one script: what they declare at the top may not meet, and imports give no other names."""
    text = bundled("report.js")
    assert "import " not in re.sub(r"[\"'`].*?[\"'`]", "", text)
    assert not re.search(r"^export ", text, re.M)
    declared = re.findall(r"^(?:async )?(?:function|class|const|let) (\w+)", text, re.M)
    assert [name for name in declared if declared.count(name) > 1] == []
    names = set(declared)
    seen, waiting = set(), ["report.js"]
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            source = asset(name)
            assert not re.search(r"\bas \w+[,\s}].* from", source)
            for listed in re.findall(r"^import \{([^}]*)\} from", source, re.M):
                assert {one.strip() for one in listed.split(",") if one.strip()} <= names
            waiting += [f"{other}.js" for other in IMPORT.findall(source)]
    assert len(seen) > 15


def test_the_scene_is_whole(full, scenes):
    assert scene_bytes(report_html(full)) == encode_scene(scenes["lamellas"])


def test_warnings_lead_to_their_places(full):
    text = report_html(full)
    assert '<li data-warning="twists">Twists more' in text
    assert "<li>Plain" in report_html(replace(full, warnings=("Plain.",)))


@pytest.mark.parametrize(
    "evil",
    [
        "</script><img src=x onerror=alert(1)>",
        "<!--<script>",
        "\"'><svg onload=alert(1)>",
        "{{css}} {{scene}} \\1 \\g<0>",
        "&lt;b&gt; ]]> é 𝔏",
    ],
)
def test_words_of_the_project_stay_words(full, evil):
    def page_of(word):
        return Page(
            report_html(
                replace(
                    full,
                    name=word,
                    version=word,
                    subtitle=(word, word),
                    warnings=(word, word),
                    figures=tuple((word, word, word, word) for _ in FIGURES),
                    scene=replace(full.scene, name=word, remarks=(word,)),
                )
            )
        )

    page, harmless = page_of(evil), page_of("harmless")
    assert page.tags == harmless.tags
    assert not [key for _, key, _ in page.attributes if key.startswith("on")]
    assert page.text == harmless.text.replace("harmless", evil)
    header, _ = unpacked(scene_bytes(report_html(replace(full, scene=Scene(evil)))))
    assert header["name"] == evil


def test_same_input_same_bytes(full, tmp_path):
    for name in ("a.html", "b.html"):
        write_report(tmp_path / name, full)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_no_warnings_no_warning_box(full):
    assert "warnings" not in Page(report_html(replace(full, warnings=()))).text
    assert "Warning" in Page(report_html(replace(full, warnings=("Once.",)))).text


def test_big_surfaces_are_thinned(monkeypatch):
    monkeypatch.setattr("lamella.stages.surface.scene.VERTEX_LIMIT", 300)
    surface = Catenoid(2.0, (-1.2, 2.2))
    mesh = surface.mesh()
    scene = make_scene("x", surface_scene(surface_output(surface), alone=False))
    layer = scene.layer("surface")
    assert 100 < len(layer.positions) <= 300
    assert layer.faces.max() < len(layer.positions)
    assert len(np.unique(layer.faces)) == len(layer.positions)
    corners = layer.positions[layer.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    fine = mesh.points[mesh.faces]
    diagonals = np.cross(fine[:, 2] - fine[:, 0], fine[:, 3] - fine[:, 1])
    assert area == pytest.approx(np.linalg.norm(diagonals, axis=1).sum() / 2, rel=0.1)
    assert f"{len(layer.positions):,} of {len(mesh.points):,} vertices" in scene.remarks[0]


def colourings(surface, mesh=None):
    """Header and arrays of a surface's quantities as they come back, by their keys."""
    scene = make_scene("x", surface_scene(surface_output(surface, mesh), alone=True))
    header, data = unpacked(encode_scene(scene))
    layer = next(one for one in header["layers"] if one["name"] == "surface")
    return {one["key"]: (one, array_of(one["values"], data)) for one in layer["quantities"]}


def test_triangles_and_missing_curvatures():
    mesh = SurfaceMesh(
        points=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        normals=np.tile([0.0, 0, 1], (4, 1)),
        faces=np.array([[0, 1, 2, 2], [0, 2, 3, 3]]),
        mean_curvature=np.zeros(4),
        gaussian_curvature=np.full(4, np.nan),
        k1=np.array([np.nan, 1.0, 2.0, np.inf]),
        k2=np.array([np.nan, 1.0, 1.0, 1.0]),
    )
    surface = Catenoid(2.0, (-1.2, 2.2))
    (layer, *_) = surface_scene(surface_output(surface, mesh), alone=True)
    np.testing.assert_array_equal(layer.faces, [[0, 1, 2], [0, 2, 3]])
    values = {key: back for key, (_, back) in colourings(surface, mesh).items()}
    np.testing.assert_array_equal(values["deviation"], np.zeros(4))
    np.testing.assert_array_equal(values["K"], np.full(4, np.nan))
    np.testing.assert_allclose(values["k1"], [np.nan, 1, 2, np.nan])
    np.testing.assert_array_equal(values["k2"], np.ones(4))


def test_surface_colourings_come_back_within_their_limits():
    found = sphere_cap(3)
    quantities = surface_quantities(found.mesh(), found.mean_curvature)
    # the mesh of small surfaces is made anew for a view
    told = colourings(found, replace(found.mesh()))
    assert list(told) == list(quantities)
    for spec, back in told.values():
        span = spec["high"] - spec["low"]
        inside = back[np.isfinite(back)]
        assert inside.min() >= spec["low"] - 10.01 * span - 1e-12
        assert inside.max() <= spec["high"] + 10.01 * span + 1e-12


def test_colouring_at_the_start(scenes):
    def first(surface, *, alone):
        return make_scene("x", surface_scene(surface_output(surface), alone=alone)).layer("surface").quantity

    assert first(Catenoid(2.0, (-1.2, 2.2)), alone=False) == ""
    assert first(Catenoid(2.0, (-1.2, 2.2)), alone=True) == "K"
    assert first(Cylinder(1.0, (0.0, 1.0)), alone=True) == ""
    assert [scenes["network"].layer("lines A").quantity, scenes["lamellas"].layer("strips A").quantity] == [
        "layer",
        "utilisation",
    ]


def test_a_colouring_without_variation_costs_nothing():
    spec, _ = colourings(Catenoid(2.0, (-1.2, 2.2)))["deviation"]
    assert spec["values"]["type"] == "constant"
    assert spec["low"] == spec["high"] == 0
    assert spec["remark"] == "to rounding, H0 = 0 1/m"
