"""Nesting and the part list."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fabrication.test_strips import Strip, build, random_strips, sampled
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.parts import make_parts
from lamella.fabrication.schedule import congruent_parts, write_schedule
from lamella.fabrication.sheet import nest

DENSITY = 8000.0


def nested(strips, curvature=0.0, *, sheet, gap=0.01, section=None):
    network, lamellas = build(strips, curvature, **(section or {}))
    parts = make_parts(network, lamellas, rim_overhang=0.05, density=DENSITY, sheet=sheet, gap=gap)
    return network, lamellas, parts, nest(parts, sheet=sheet, gap=gap)


def placed_outlines(parts, nesting, step=5e-3):
    for piece, index in enumerate(nesting.parts):
        sign = -1 if nesting.rotations[piece] == 180 else 1
        yield sign * sampled(parts.parts[index].outline, step) + (nesting.x[piece], nesting.y[piece])


@pytest.mark.parametrize(
    ("curvature", "sheet", "height"),
    [
        (0.0, (2.0, 1.0), 0.1),
        (0.5, (3.0, 1.2), 0.1),
        (-0.9, (2.5, 1.5), 0.1),
        (1.2, (4.0, 3.0), 0.1),  # beyond a half circle
        (2.5, (2.0, 2.0), 0.1),
        (0.9, (6.0, 0.9), 0.2),
    ],
)
def test_pieces_keep_their_distance(curvature, sheet, height):
    rng = np.random.default_rng(11)
    strips = [
        Strip(family, tuple(np.linspace(0, length, 9)), "|" + "o" * 7 + "|")
        for family in "AB"
        for length in rng.uniform(0.4, 2.8, 9)
    ]
    gap, step = 0.02, 2e-3
    _, _, parts, nesting = nested(strips, curvature, sheet=sheet, gap=gap, section={"height": height})
    assert len(nesting.parts) == parts.pieces
    assert np.all(nesting.sizes == sheet)
    outlines = list(placed_outlines(parts, nesting, step))
    for number in range(nesting.sheet_count):
        here = [outlines[i] for i in np.flatnonzero(nesting.sheets == number)]
        assert here
        for i, outline in enumerate(here):
            assert outline.min() > gap - 1e-9
            assert np.all(outline.max(axis=0) < np.array(sheet) - gap + 1e-9)
            tree = cKDTree(outline)
            for other in here[:i]:
                # samples are at most one step apart: true distances are less by sqrt(d^2 + step^2) - d
                assert tree.query(other)[0].min() > gap - 1e-9


def test_arcs_are_nested_into_each_other():
    # by bounding boxes five would fit, nested ones are 0.17 m apart
    strips = [Strip("A", (0.0, 1.5), "||")] * 6
    _, _, parts, nesting = nested(strips, 1.0, sheet=(2.35, 2.31))
    left, low, right, high = parts.parts[0].bounds
    assert (2.31 - 0.01) // (high - low + 0.01) == 5
    assert nesting.sheet_count == 1
    assert parts.pieces == 12
    assert 2 * (right - left) > 2.35
    assert np.all(np.diff(np.sort(nesting.y)) < high - low)


def test_straight_rows_are_filled():
    # 1.2 and 0.75 m share a row of 2 m, nine rows a metre: 16 rows on two sheets
    strips = [Strip("A", (0.0, 1.1), "||")] * 8 + [Strip("B", (0.0, 0.65), "||")] * 8
    _, _, _, nesting = nested(strips, sheet=(2.0, 1.0))
    assert nesting.sheet_count == 2
    assert nesting.oversize == 0
    assert len(np.unique(np.round(nesting.sheets * 10 + nesting.y, 9))) == 16


def test_copies_are_numbered():
    _, _, _, nesting = nested(random_strips(1, count=1), sheet=(2.0, 1.0), section={"layers": 3})
    assert nesting.copies.tolist() == [1, 2, 3, 1, 2, 3]
    assert nesting.parts.tolist() == [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize("curvature", [0.0, 0.2])
def test_oversize_part_lies_alone(curvature):
    strips = [Strip("A", (0.0, 5.0), "||"), Strip("A", (0.0, 0.5), "||")]
    _, _, parts, nesting = nested(strips, curvature, sheet=(2.0, 1.0))
    assert nesting.sheets.tolist() == [1, 2, 0, 0]
    assert nesting.sizes[0].tolist() == [2.0, 1.0]
    assert nesting.oversize == 2
    low_x, low_y, high_x, high_y = parts.parts[0].bounds
    assert nesting.sizes[1].tolist() == pytest.approx([high_x - low_x + 0.02, max(1.0, high_y - low_y + 0.02)])


def rows_of(path):
    with path.open(newline="", encoding="utf-8") as file:
        first = file.readline().rstrip("\n")
        columns, *rows = csv.reader(file)
    return first, [dict(zip(columns, row, strict=True)) for row in rows]


def scheduled(folder, strips, curvature=0.0, *, sheet=(2.0, 1.0), **options):
    network, lamellas = build(strips, curvature, **options)
    parts = make_parts(network, lamellas, rim_overhang=0.05, density=DENSITY, sheet=sheet)
    nesting = nest(parts, sheet=sheet)
    path = folder / "schedule.csv"
    write_schedule(path, parts, nesting, network, lamellas, name='Café, "B"', version="1.2.3")
    first, rows = rows_of(path)
    # without what would begin another cell
    assert first == "# lamella 1.2.3 · project Café B"
    assert len(rows) == len(parts.parts)
    return network, lamellas, nesting, rows


def test_schedule_numbers(tmp_path):
    strips = [Strip("A", (0.0, 0.2, 0.45, 0.6), "|oo|"), Strip("B", (0.0, 0.3), "||")]
    _, _, nesting, (first, second) = scheduled(tmp_path, strips)
    assert first["id"] == "A1"
    assert first["family"] == "A"
    assert first["quantity"] == "2"
    assert float(first["length_mm"]) == 700.0
    assert first["radius_mm"] == ""
    assert first["node_distances_mm"] == "200.0000;250.0000;150.0000"
    assert first["slots"] == "4"
    # 0.7 m x 0.1 m less four slots of 3 x 50 mm, 1.5 mm thick, 8 t/m3
    assert float(first["mass_kg"]) == pytest.approx((0.07 - 4 * 0.00015) * 0.0015 * DENSITY, rel=1e-5)
    # samples 0 to 24 carry 1 to 25, those of B 26 to 34; tg runs down from 34
    assert float(first["geodesic_curvature_max_1/m"]) == 25.0
    assert float(first["geodesic_torsion_max_1/m"]) == 34.0
    assert float(second["geodesic_torsion_max_1/m"]) == 9.0
    assert float(first["normal_curvature_max_1/m"]) == 0.0
    names = ("bending_MPa", "torsion_MPa", "helix_MPa", "restraint_MPa", "von_mises_MPa")
    assert [float(first[name]) for name in names] == [25.0, 50.0, 75.0, 100.0, 125.0]
    assert [float(second[name]) for name in names] == [34.0, 68.0, 102.0, 136.0, 170.0]
    assert float(first["utilisation"]) == 0.25
    assert first["sheets"] == second["sheets"] == "1"
    assert nesting.sheet_count == 1


def test_schedule_of_circular_pieces(tmp_path):
    stations = tuple(np.arange(7) * 0.5)
    strips = [Strip("A", stations, "|" + "o" * 5 + "|")]
    _, _, _, rows = scheduled(tmp_path, strips, -0.5, relax=1.001, sheet=(2.0, 1.0))
    assert [row["id"] for row in rows] == ["A1.1", "A1.2"]
    assert [row["radius_mm"] for row in rows] == ["2000.0000", "2000.0000"]
    assert [len(row["node_distances_mm"].split(";")) for row in rows] == [2, 3]
    # eight samples a cell, carrying 1 to 49; the cut is in the middle of the third cell
    assert [float(row["bending_MPa"]) for row in rows] == [21.0, 49.0]
    assert [float(row["geodesic_torsion_max_1/m"]) for row in rows] == [49.0, 29.0]


def test_schedule_of_a_split_ring_wraps(tmp_path):
    stations = tuple(np.linspace(0.0, 6.2, 11))
    _, _, _, rows = scheduled(tmp_path, [Strip("A", stations, "o" * 10, closed=True)], 1.0, sheet=(3.0, 3.0))
    # samples carry 1 to 81; the first piece begins half a cell before the first node, the ring's end
    assert [float(row["bending_MPa"]) for row in rows] == [81.0, 77.0]


def test_congruent_parts_name_the_first(tmp_path):
    shape = (0.0, 0.2, 0.45, 0.6)
    strips = [
        Strip("A", shape, "|oo|"),
        Strip("A", (0.0, 0.2, 0.45, 0.6 + 9e-6), "|oo|"),
        Strip("A", (0.0, 0.2, 0.45, 0.6 + 3e-5), "|oo|"),
        Strip("A", (0.0, 0.15, 0.4, 0.6), "|oo|"),  # mirrored
        Strip("A", (0.0, 0.2 - 9e-6, 0.45, 0.6), "|oo|"),
        Strip("A", (0.0, 0.2 - 3e-5, 0.45, 0.6), "|oo|"),
        Strip("A", shape, "|o||"),
        Strip("B", shape, "|oo|"),
        Strip("B", shape, "|oo|"),
    ]
    _, _, _, rows = scheduled(tmp_path, strips)
    assert [row["same_as"] for row in rows] == ["", "A1", "", "", "A1", "", "", "", "B1"]


@pytest.mark.parametrize("seed", range(3))
def test_congruence_agrees_with_trying_all(seed):
    rng = np.random.default_rng(seed)
    base = np.array([0.0, 0.2, 0.45])
    strips = [Strip("A", tuple(base + rng.integers(-2, 3, 3) * 6e-6), "|o|") for _ in range(40)]
    network, lamellas = build(strips)
    parts = make_parts(network, lamellas, rim_overhang=0.05, density=DENSITY)
    profiles = [np.append(part.nodes - part.start, part.length) for part in parts.parts]
    expected = []
    for i, profile in enumerate(profiles):
        near = [j for j in range(i) if expected[j] == j and np.abs(profiles[j] - profile).max() <= 1e-5]
        expected.append(near[0] if near else i)
    assert congruent_parts(parts) == expected
    assert len(set(expected)) > 3


@pytest.mark.slow
@pytest.mark.parametrize("curvature", [0.0, 0.02])
def test_two_thousand_parts_of_two_hundred_slots(tmp_path, curvature):
    strips = random_strips(1, count=1000, cells=101, low=0.15, high=0.25)
    network, lamellas = build(strips, curvature)
    parts = make_parts(network, lamellas, rim_overhang=0.05, density=DENSITY, sheet=(30.0, 5.0))
    nesting = nest(parts, sheet=(30.0, 5.0))
    write_drawings(tmp_path, parts, nesting, name="x", version="0")
    write_schedule(tmp_path / "schedule.csv", parts, nesting, network, lamellas, name="x", version="0")
    assert sum(len(part.slots) for part in parts.parts) > 390_000
