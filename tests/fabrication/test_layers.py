"""Parts of layers: cut to their own curvature, on lamella curves of their own, and which of them lies left."""

from __future__ import annotations

import csv

import ezdxf
import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from fabrication.test_sheets import placed_outlines
from fabrication.test_strips import sampled
from lamella import Catenoid, Enneper, Section, Unduloid, find_material
from lamella.fabrication.axis import Axis, outline
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.engraving import engrave
from lamella.fabrication.flat import outline_area
from lamella.fabrication.parts import make_parts
from lamella.fabrication.read_back import read_slots
from lamella.fabrication.schedule import write_schedule
from lamella.fabrication.sheet import nest
from lamella.fabrication.stroke_font import text_strokes
from lamella.strip.lamellas import make_lamellas
from lamella.strip.layers import SIDES
from lamella.strip.unroll import develop

STEEL = find_material("1.4301")
SHEET = (6.0, 2.0)
SURFACES = [Catenoid(2.0, (-1.5, 2.0)), Unduloid(1.0, 2.0, (-2.0, 3.0)), Enneper(3, 0.8, 3.0)]


def built(surface, way, *, layers=2, cells=16, **options):
    network = lamella.net(surface, cells=cells)
    section = Section(0.08, 0.001, layers, 0.03, layer_curves=way)
    lamellas = make_lamellas(network, section, STEEL, surface)
    return network, lamellas, make_parts(network, lamellas, density=7900.0, sheet=SHEET, **options)


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: s.kind)
def test_cut_outlines_are_the_layers_unrolled(surface):
    """The part's centre line against the layer's curve in space, unrolled from points and normals alone.

    What remains is of second order in the layer's distance; of strips cut alike it is of first order.
    """
    worst = {}
    for offset in (0.04, 0.02):
        network = lamella.net(surface, cells=16)
        section = Section(0.08, 0.001, 2, offset, layer_curves="cut")
        lamellas = make_lamellas(network, section, STEEL)
        parts = make_parts(network, lamellas, density=7900.0, sheet=(60.0, 30.0))
        layers, kinds = lamellas.layers, {"cut": 0.0, "alike": 0.0}
        for part in parts.parts:
            line = slice(*network.sample_offsets[part.lamella : part.lamella + 2])
            row = part.layer - 1
            count = np.array([0, line.stop - line.start])
            plane, arc = develop(layers.points[row, line], layers.normals[row, line], count)
            stations = layers.stations[row, line]
            np.testing.assert_allclose(arc, stations, rtol=1e-4, atol=2e-5)
            inside = (stations > part.start) & (stations < part.end)
            for kind, axis in (("cut", part.axis), ("alike", Axis.arc(part.start, part.end, part.curvature))):
                flat = axis.develop(stations[inside], 0.0)
                kinds[kind] = max(kinds[kind], off_best_placement(plane[inside], flat[:, 0] + 1j * flat[:, 1]))
        worst[offset] = kinds
    assert worst[0.04]["alike"] > 8 * worst[0.04]["cut"]
    assert worst[0.02]["cut"] < 0.4 * worst[0.04]["cut"] + 3e-5
    assert worst[0.02]["cut"] < 2e-4


def off_best_placement(one: np.ndarray, other: np.ndarray) -> float:
    one, other = one - one.mean(), other - other.mean()
    turn = np.vdot(other, one)
    return float(np.abs(one - turn / abs(turn) * other).max())


@pytest.mark.parametrize(
    ("surface", "way"),
    [(SURFACES[0], "offset"), (SURFACES[1], "cut"), (SURFACES[2], "cut"), (SURFACES[2], "lamella")],
    ids=lambda x: getattr(x, "kind", x),
)
def test_slots_read_back(tmp_path, surface, way):
    """What the drawing says of each part, measured on its outline alone, arcs of changing curvature included."""
    _, _, parts = built(surface, way, cells=10)
    nesting = nest(parts, sheet=SHEET)
    write_drawings(tmp_path, parts, nesting, name="layers", version="0")
    for family, name in (("A", "A.dxf"), ("B", "sheets.dxf")):
        readings = read_slots(tmp_path / name)
        for part in parts.parts:
            if part.family != family:
                continue
            reading = readings[part.id]
            np.testing.assert_allclose(reading.slots, 1e3 * (part.slots - part.start), atol=2e-4)
            assert reading.length == pytest.approx(1e3 * part.length, abs=1e-4)
            assert reading.height == pytest.approx(80.0, abs=1e-6)
            turn = (part.axis.curvatures * np.diff(part.axis.knots)).sum()
            assert reading.curvature == pytest.approx(1e-3 * turn / part.length, abs=1e-9)
    assert (max(part.bow for part in parts.parts) > 5e-4) == (way == "cut")


@pytest.mark.parametrize("family", ["A", "B"])
def test_an_outline_of_changing_curvature(family):
    """Area, slots square to the centre line, feet on it, edges at half the height: of an s-shaped strip."""
    rng = np.random.default_rng(3)
    knots = np.r_[0.0, np.sort(rng.uniform(0.1, 2.9, 11)), 3.0]
    axis = Axis.of(knots, rng.uniform(-0.3, 0.3, 12) + 0.1)
    slots = np.r_[0.2, knots[4], 1.4, 1.9, 2.6]
    vertices = outline(axis, 0.1, slots, 0.004, family == "A")
    points = sampled(vertices, 1e-3)
    stations = axis.stations(points)
    # heights of the outline's points above their feet
    feet, heading = axis.develop(stations, 0.0), axis.heading(stations)
    heights = -(points - feet)[:, 0] * np.sin(heading) + (points - feet)[:, 1] * np.cos(heading)
    assert np.abs(heights).max() == pytest.approx(0.05, abs=1e-6)
    near = np.abs(stations[:, None] - slots).min(1) < 0.0025
    ends = (stations < 1e-4) | (stations > 3 - 1e-4)
    side = 0.05 if family == "A" else -0.05
    on_edge = ~near & ~ends
    assert np.abs(np.abs(heights[on_edge]) - 0.05).max() < 1e-6
    assert (np.sign(heights[near]) != np.sign(side)).any()
    # the strip's area does not depend on how it bends, as it lies evenly about its centre line
    assert outline_area(vertices) == pytest.approx(0.3 - 5 * 0.004 * 0.05, rel=2e-5)
    # mean direction along x, middle of the centre line at the origin
    np.testing.assert_allclose(axis.develop(1.5, 0.0), 0.0, atol=1e-14)
    fine = np.linspace(0, 3, 20001)
    assert axis.heading(fine).mean() == pytest.approx(0, abs=1e-4)
    np.testing.assert_allclose(axis.stations(axis.develop(fine, 0.03)), fine, atol=1e-9)


@pytest.mark.parametrize("surface", SURFACES[:2], ids=lambda s: s.kind)
def test_cut_pieces_keep_their_distance_on_the_sheets(surface):
    _, _, parts = built(surface, "cut", cells=6)
    gap, step = 0.01, 5e-3
    nesting = nest(parts, sheet=SHEET, gap=gap)
    assert (nesting.sizes == SHEET).all()
    outlines = list(placed_outlines(parts, nesting, step))
    for number in range(nesting.sheet_count):
        here = [outlines[i] for i in np.flatnonzero(nesting.sheets == number)]
        for i, one in enumerate(here):
            assert one.min() > gap - 1e-6
            assert (one.max(axis=0) < np.array(SHEET) - gap + 1e-6).all()
            tree = cKDTree(one)
            for other in here[:i]:
                assert tree.query(other)[0].min() > gap - step / 2


@pytest.mark.parametrize("layers", [2, 3, 4])
def test_which_layer_lies_left(tmp_path, layers):
    """Left is u = n x t. The part says so in what is engraved, the schedule in a column."""
    network, lamellas, parts = built(SURFACES[0], "cut", layers=layers, cells=8)
    sideways = np.cross(network.sample_normals, network.sample_tangents)
    middle = (network.sample_offsets[:-1] + network.sample_offsets[1:]) // 2
    for part in parts.parts:
        at = middle[part.lamella]
        across = (lamellas.layers.points[part.layer - 1, at] - network.sample_points[at]) @ sideways[at]
        assert across == pytest.approx(part.distance, abs=1e-4)
        assert part.side == SIDES[layers][part.layer - 1]
        assert ("L" in part.side) == (part.distance > 1e-9)
        assert ("R" in part.side) == (part.distance < -1e-9)
        assert part.label == f"{part.id} {part.side}"
        assert len(engrave(part).strokes) == len(text_strokes(part.label))
    nesting = nest(parts, sheet=SHEET)
    write_schedule(tmp_path / "s.csv", parts, nesting, network, lamellas, name="x", version="0")
    with (tmp_path / "s.csv").open(encoding="utf-8") as file:
        file.readline()
        rows = list(csv.DictReader(file))
    for part, row in zip(parts.parts, rows, strict=True):
        assert (row["layer"], row["side"]) == (str(part.layer), part.side)
        assert float(row["distance_mm"]) == pytest.approx(1e3 * part.distance, abs=1e-4)
        assert float(row["bow_mm"] or 0) == pytest.approx(1e3 * part.bow, abs=1e-4)


def test_layers_alike_have_no_side(tmp_path):
    network, lamellas, parts = built(SURFACES[0], "offset", cells=8)
    assert {(part.layer, part.side, part.label == part.id, part.quantity) for part in parts.parts} == {(0, "", True, 2)}
    write_schedule(tmp_path / "s.csv", parts, nest(parts), network, lamellas, name="x", version="0")
    with (tmp_path / "s.csv").open(encoding="utf-8") as file:
        file.readline()
        assert {(row["layer"], row["side"], row["distance_mm"], row["bow_mm"]) for row in csv.DictReader(file)} == {
            ("", "", "", "")
        }


def test_arcs_in_the_drawing_follow_each_other_smoothly(tmp_path):
    """A laser sees no corner where one arc goes over into the next: directions agree there to rounding."""
    _, _, parts = built(SURFACES[1], "cut", cells=8)
    write_drawings(tmp_path, parts, nest(parts, sheet=SHEET), name="x", version="0")
    for entity in ezdxf.readfile(str(tmp_path / "A.dxf")).modelspace().query("LWPOLYLINE[layer=='CUT']"):
        x, y, bulge = np.array(entity.get_points("xyb"), float).T
        chord = np.arctan2(np.roll(y, -1) - y, np.roll(x, -1) - x)
        leave, come = chord - 2 * np.arctan(bulge), np.roll(chord + 2 * np.arctan(bulge), 1)
        both = (bulge != 0) & (np.roll(bulge, 1) != 0)
        assert both.sum() > 10
        assert np.abs(np.sin(leave - come)[both]).max() < 1e-7
