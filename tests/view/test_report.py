"""report.html: complete, offline, inert to what a project says, and true to its arrays."""

from __future__ import annotations

import base64
import html
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import lamella
from lamella.base.material import find_material
from lamella.strip.lamellas import Section, make_lamellas
from lamella.surface.closed_forms.catenoid import Catenoid
from lamella.surface.closed_forms.cylinder import Cylinder
from lamella.surface.mesh import SurfaceMesh
from lamella.view import encoding, report
from lamella.view.report import CORNER_LIMIT, ReportData, report_html, write_report
from lamella.view.scene.surface_quantities import surface_quantities
from surface.element.exact_elements import sphere_cap

FIGURES = (
    ("Surface", "Area", "62.41", "m²"),
    ("Network", "Nodes", "408", ""),
    ("Surface", "Mean curvature", "0", "1/m"),
)
DTYPES = {"f4": "<f4", "i2": "<i2", "u1": "u1", "u2": "<u2", "u4": "<u4"}


def decode(spec):
    if spec["type"] == "constant":
        return np.full(spec["count"], np.nan if spec["value"] is None else spec["value"])
    values = np.frombuffer(base64.b64decode(spec["data"]), DTYPES[spec["type"]])
    if "step" not in spec:
        return values
    return np.where(values == encoding.MISSING, np.nan, spec["low"] + values * spec["step"])


def payload(text):
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])


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


@pytest.fixture(scope="module")
def full():
    surface = Catenoid(2.0, (-1.2, 2.2))
    network = lamella.net(surface, cells=12)
    lamellas = make_lamellas(network, Section(), find_material("1.4301"))
    return ReportData(
        name="Oculus",
        version="9.8.7",
        kind="catenoid",
        figures=FIGURES,
        corners=(),
        warnings=("Twists more than it bends.", "Closed with 12 cells."),
        surface=surface.mesh(),
        mean_curvature=0.0,
        network=network,
        lamellas=lamellas,
        material="1.4301",
    )


def at_stage(full, stage):
    return {
        "surface": replace(full, network=None, lamellas=None),
        "network": replace(full, lamellas=None),
        "lamellas": full,
    }[stage]


@pytest.mark.parametrize("stage", ["surface", "network", "lamellas"])
def test_says_who_made_it_and_what_of(full, stage, tmp_path):
    write_report(tmp_path / "report.html", at_stage(full, stage))
    page = Page((tmp_path / "report.html").read_text(encoding="utf-8"))
    for text in ("Oculus", "lamella 9.8.7", "catenoid", "2 warnings", "Closed with 12 cells.", "62.41"):
        assert text in page.text
    assert ("100 × 1.5 mm, 2 layers 25 mm apart · 1.4301" in page.text) == (stage == "lamellas")
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


@pytest.mark.parametrize("stage", ["surface", "network", "lamellas"])
def test_holds_what_the_stage_has(full, stage):
    data = payload(report_html(at_stage(full, stage)))
    assert (data["network"] is not None) == (stage != "surface")
    assert (data["lamellas"] is not None) == (stage == "lamellas")


def test_asks_for_nothing_from_anywhere(full):
    text = report_html(full)
    page = Page(text)
    fetched = {"src", "href", "srcset", "data", "action", "poster", "background", "xlink:href"}
    assert [a for a in page.attributes if a[1] in fetched] == [("link", "href", "data:,")]
    assert not {"iframe", "object", "embed", "img", "audio", "video", "base"} & set(page.tags)
    css = re.search(r"<style>(.*?)</style>", text, re.S)[1]
    assert not re.search(r"@import|url\(|//", css)
    ours = text.rsplit("<script>", 1)[1]
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
    scripts = re.findall(r"<script>(.*?)</script>", text, re.S)
    assert scripts == [report._asset("three.min.js"), report._asset("report.js")]
    assert report._policy(*scripts) in text


def test_points_come_back_to_float32_even_far_from_the_origin(full):
    away = np.array([4e5, 5e6, 100.0])
    surface = replace(full.surface, points=full.surface.points + away)
    network = replace(
        full.network,
        sample_points=full.network.sample_points + away,
        node_points=full.network.node_points + away,
    )
    data = payload(report_html(replace(full, surface=surface, network=network)))
    size = np.ptp(surface.points, axis=0).max()
    for spec, points in (
        (data["surface"]["points"], surface.points),
        (data["network"]["points"], network.sample_points),
        (data["network"]["nodePoints"], network.node_points),
    ):
        back = decode(spec).reshape(-1, 3) + np.array(data["centre"])
        # float32 of the offset, and the rounding of coordinates of 5e6 in float64
        assert np.abs(back - points).max() <= size * 2.0**-24 + 2e-9


def test_quantities_come_back_to_a_65534th_of_their_range(full):
    data = payload(report_html(full))
    net, strips = full.network, full.lamellas
    for key, values in (
        ("normalCurvature", net.sample_darboux.kn),
        ("geodesicCurvature", net.sample_darboux.kg),
        ("geodesicTorsion", net.sample_darboux.tg),
    ):
        back = decode(data["network"][key])
        assert np.abs(back - values).max() <= 0.51 * np.ptp(values) / 65534
    for key, values in (
        ("bending", strips.bending),
        ("torsion", strips.torsion),
        ("helixEdge", strips.helix_edge),
        ("helixCentre", strips.helix_centre),
        ("restraint", strips.restraint),
        ("layer", strips.layer),
        ("vonMises", strips.von_mises),
    ):
        megapascal = values * 1e-6
        assert np.abs(decode(data["lamellas"][key]) - megapascal).max() <= 0.51 * np.ptp(megapascal) / 65534
    normals = decode(data["network"]["normals"]).reshape(-1, 3) / 32767
    assert np.abs(normals - net.sample_normals).max() < 2e-5


def test_lists_of_lamellas_and_nodes_come_back(full):
    data, net = payload(report_html(full))["network"], full.network
    assert tuple(data["ids"]) == net.ids
    assert data["families"] == "".join(net.families)
    for key, values in (
        ("offsets", net.sample_offsets),
        ("stopOffsets", net.stop_offsets),
        ("stopNodes", net.stop_nodes),
        ("stopSamples", net.stop_samples),
        ("nodeKinds", net.node_kinds),
    ):
        np.testing.assert_array_equal(decode(data[key]), values)


@pytest.mark.parametrize(
    "evil",
    [
        "</script><img src=x onerror=alert(1)>",
        "<!--<script>",
        "\"'><svg onload=alert(1)>",
        "{{css}} {{data}} \\1 \\g<0>",
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
                    kind=word,
                    material=word,
                    warnings=(word, word),
                    figures=tuple((word, word, word, word) for _ in FIGURES),
                    network=replace(full.network, ids=(word, *full.network.ids[1:])),
                )
            )
        )

    page, harmless = page_of(evil), page_of("harmless")
    assert page.tags == harmless.tags
    assert not [key for _, key, _ in page.attributes if key.startswith("on")]
    assert page.text == harmless.text.replace("harmless", evil)
    assert payload(report_html(replace(full, name=evil)))["name"] == evil


def test_same_input_same_bytes(full, tmp_path):
    for name in ("a.html", "b.html"):
        write_report(tmp_path / name, full)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_no_warnings_no_warning_box(full):
    assert "warnings" not in Page(report_html(replace(full, warnings=()))).text
    assert "Warning" in Page(report_html(replace(full, warnings=("Once.",)))).text


def test_big_nets_are_thinned_but_keep_their_nodes(full, monkeypatch):
    net, strips = full.network, full.lamellas
    limit = len(net.stop_nodes) + 300
    monkeypatch.setattr(report, "SAMPLE_LIMIT", limit)
    text = report_html(full)
    data = payload(text)["network"]
    points = decode(data["points"]).reshape(-1, 3)
    assert len(net.stop_nodes) <= len(points) <= limit + len(net.ids)
    assert f"{len(points):,} of {len(net.sample_points):,} centre line samples" in Page(text).text
    starts = np.repeat(decode(data["offsets"])[:-1], np.diff(decode(data["stopOffsets"])))
    stops = starts + decode(data["stopSamples"])
    nodes = decode(data["nodePoints"]).reshape(-1, 3)
    np.testing.assert_allclose(points[stops], nodes[decode(data["stopNodes"])], atol=1e-9)
    lengths = decode(data["arclengths"])[decode(data["offsets"])[1:].astype(int) - 1]
    np.testing.assert_allclose(lengths, net.lengths, rtol=1e-6)
    # The worst strip quad is still seen.
    planarity = decode(payload(text)["lamellas"]["planarity"])
    assert planarity.max() == pytest.approx(strips.planarity.max(), rel=1e-9)
    assert planarity.min() > 0


def test_nodes_of_very_big_nets_are_thinned(full, monkeypatch):
    """One node in so many of each lamella and its ends; their numbers stay those of network.json, and counts true."""
    net = full.network
    monkeypatch.setattr(report, "STOP_LIMIT", len(net.stop_nodes) // 3)
    monkeypatch.setattr(report, "SAMPLE_LIMIT", len(net.stop_nodes))
    text = report_html(full)
    data = {key: decode(value) if isinstance(value, dict) else value for key, value in payload(text)["network"].items()}
    stops = len(data["stopNodes"])
    assert len(net.stop_nodes) / 3 <= stops <= len(net.stop_nodes) / 3 + 2 * len(net.ids)
    assert "one node in 4 among them" in Page(text).text or "one node in 3 among them" in Page(text).text
    np.testing.assert_array_equal(data["nodeCounts"], np.diff(net.stop_offsets))
    np.testing.assert_array_equal(data["kindCounts"][:3], np.bincount(net.node_kinds, minlength=3)[:3])
    samples = np.repeat(data["offsets"][:-1], np.diff(data["stopOffsets"])) + data["stopSamples"]
    points = data["points"].reshape(-1, 3) + np.array(payload(text)["centre"])
    np.testing.assert_allclose(points[samples.astype(int)], net.node_points[data["stopNodes"].astype(int)], atol=1e-5)
    for k, (first, end) in enumerate(
        zip(data["stopOffsets"][:-1].astype(int), data["stopOffsets"][1:].astype(int), strict=True)
    ):
        own = net.stop_nodes[net.stop_offsets[k] : net.stop_offsets[k + 1]]
        assert (data["stopNodes"][first], data["stopNodes"][end - 1]) == (own[0], own[-1])
    assert np.bincount(data["nodeKinds"].astype(int))[1] == (net.node_kinds == 1).sum()
    assert len(data["nodePoints"]) == 3 * len(data["nodeKinds"]) < 3 * len(net.node_points)


def test_big_surfaces_are_thinned(full, monkeypatch):
    monkeypatch.setattr(report, "VERTEX_LIMIT", 300)
    text = report_html(full)
    data = payload(text)["surface"]
    points = decode(data["points"]).reshape(-1, 3) + np.array(payload(text)["centre"])
    triangles = decode(data["triangles"]).reshape(-1, 3).astype(int)
    assert 100 < len(points) <= 300
    assert triangles.max() < len(points)
    assert len(np.unique(triangles)) == len(points)
    corners = points[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    fine = full.surface.points[full.surface.faces]
    diagonals = np.cross(fine[:, 2] - fine[:, 0], fine[:, 3] - fine[:, 1])
    assert area == pytest.approx(np.linalg.norm(diagonals, axis=1).sum() / 2, rel=0.1)
    assert f"{len(points):,} of {len(full.surface.points):,} vertices" in Page(text).text


def test_triangles_and_missing_curvatures(full):
    mesh = SurfaceMesh(
        points=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        normals=np.tile([0.0, 0, 1], (4, 1)),
        faces=np.array([[0, 1, 2, 2], [0, 2, 3, 3]]),
        mean_curvature=np.zeros(4),
        gaussian_curvature=np.full(4, np.nan),
        k1=np.array([np.nan, 1.0, 2.0, np.inf]),
        k2=np.array([np.nan, 1.0, 1.0, 1.0]),
    )
    data = payload(report_html(replace(full, surface=mesh, network=None, lamellas=None)))["surface"]
    np.testing.assert_array_equal(decode(data["triangles"]).reshape(-1, 3), [[0, 1, 2], [0, 2, 3]])
    values = {colouring["key"]: decode(colouring["values"]) for colouring in data["colourings"]}
    np.testing.assert_array_equal(values["deviation"], np.zeros(4))
    np.testing.assert_array_equal(values["K"], np.full(4, np.nan))
    np.testing.assert_allclose(values["k1"], [np.nan, 1, 2, np.nan])
    np.testing.assert_array_equal(values["k2"], np.ones(4))


def test_surface_colourings_come_back_within_their_limits(full):
    found = sphere_cap(3)
    data = payload(report_html(replace(full, surface=found.mesh(), mean_curvature=-0.5, network=None, lamellas=None)))
    quantities = surface_quantities(found.mesh(), -0.5)
    colourings = {colouring["key"]: colouring for colouring in data["surface"]["colourings"]}
    assert list(colourings) == list(quantities)
    for key, quantity in quantities.items():
        spec = colourings[key]
        back = decode(spec["values"])
        span = quantity.high - quantity.low
        # the colours are 256: no value is off by a hundredth of one
        assert np.abs(back - np.clip(quantity.values, quantity.low, quantity.high)).max() <= span / 25600
        for name in ("label", "unit", "remark", "low", "high", "least", "most"):
            assert spec[name] == getattr(quantity, name)
        assert spec["stops"] == list(quantity.stops)
    deviation = colourings["deviation"]
    assert deviation["low"] == -deviation["high"] < 0
    assert deviation["remark"] == "H0 = −0.5 1/m"


def test_colouring_at_the_start(full):
    def first(**changes):
        return payload(report_html(replace(full, **changes)))["surface"]["first"]

    alone = {"network": None, "lamellas": None}
    assert first() == "plain"
    assert first(**alone) == "K"
    cylinder = Cylinder(1.0, (0.0, 1.0))
    assert first(surface=cylinder.mesh(), mean_curvature=0.5, **alone) == "plain"


def test_a_colouring_without_variation_costs_nothing(full):
    colourings = {c["key"]: c for c in payload(report_html(full))["surface"]["colourings"]}
    assert colourings["deviation"]["values"]["type"] == "constant"
    assert colourings["deviation"]["low"] == colourings["deviation"]["high"] == 0
    assert colourings["deviation"]["remark"] == "to rounding, H0 = 0 1/m"
