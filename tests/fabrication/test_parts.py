"""Flat parts: outlines, ends, slots, splits and their warnings."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from fabrication.test_strips import Strip, build, random_strips, sampled
from lamella.base.errors import InputError
from lamella.fabrication.axis import Axis
from lamella.fabrication.flat import extents, longest_fitting, outline_area
from lamella.fabrication.parts import make_parts
from lamella.fabrication.splitting import cut_stations

STEEL = 7900.0


def parts_of(strips, curvature=0.0, *, relax=1.0, section=None, **options):
    network, lamellas = build(strips, curvature, relax=relax, **(section or {}))
    return make_parts(
        network,
        lamellas,
        rim_overhang=options.pop("rim_overhang", np.nan_to_num(options.get("end_distance", 0.05))),
        density=STEEL,
        **options,
    )


def polygon_area(points):
    x, y = points.T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


@pytest.mark.parametrize("curvature", [0.8, -0.8, 1e-7])
def test_develop_is_the_circle_of_the_definition(curvature):
    s, z = np.meshgrid(np.linspace(-1, 2, 7), [-0.05, 0.0, 0.05])
    k = curvature
    expected = np.stack(((1 / k - z) * np.sin(k * s), 1 / k - (1 / k - z) * np.cos(k * s)), axis=-1)
    # the definition itself cancels: 1/k times rounding
    np.testing.assert_allclose(Axis.arc(-1.0, 1.0, k).develop(s, z), expected, atol=4e-16 / abs(k) + 1e-15)


def test_develop_of_a_straight_strip_is_the_identity():
    np.testing.assert_array_equal(Axis.arc(0.0, 2.0, 0.0).develop([1.0, 3.0], [0.1, -0.2]), [[0.0, 0.1], [2.0, -0.2]])


@pytest.mark.parametrize("curvature", [0.0, 0.9, -0.9, 1e-5])
@pytest.mark.parametrize("family", ["A", "B"])
def test_area_is_the_strip_less_its_slots(curvature, family):
    strip = Strip(family, (0.0, 0.2, 0.45, 0.6), "|oo|")
    (part,) = parts_of([strip], curvature).parts
    z = 0.05 if family == "A" else -0.05

    def edge(p):
        # the edge's circle seen from a slot's axis
        if curvature == 0.0:
            return z
        r = 1 / curvature - z
        return 1 / curvature - np.sign(r) * np.sqrt(r * r - p * p)

    slot = abs(quad(edge, -0.0015, 0.0015)[0])
    assert part.length == pytest.approx(0.7, abs=1e-15)
    # the quadrature cancels against 1/k, too
    assert part.area == pytest.approx(0.1 * 0.7 - 4 * slot, abs=1e-12)
    assert part.mass == pytest.approx(STEEL * 0.0015 * part.area, rel=1e-14)
    assert polygon_area(sampled(part.outline, 1e-4)) == pytest.approx(part.area, abs=2e-9)


def test_straight_outline_vertex_by_vertex():
    (part,) = parts_of([Strip("B", (0.0, 0.3, 0.5), "|o|")], section={"layers": 1}).parts
    # from -0.05 to 0.55, so the frame's origin is at 0.25 and the slot at 0.05
    expected = [
        (-0.3, -0.05), (0.0485, -0.05), (0.0485, 0.0), (0.0515, 0.0), (0.0515, -0.05),
        (0.3, -0.05), (0.3, 0.05), (-0.3, 0.05),
    ]  # fmt: skip
    np.testing.assert_allclose(part.outline[:, :2], expected, atol=1e-15)
    assert not part.outline[:, 2].any()


@pytest.mark.parametrize("curvature", [1.1, -1.1])
@pytest.mark.parametrize("family", ["A", "B"])
def test_arcs_are_exact_and_slots_radial(curvature, family):
    (part,) = parts_of([Strip(family, (0.0, 0.2, 0.45, 0.6), "|oo|")], curvature).parts
    centre = np.array([0.0, 1 / curvature])
    arcs = np.flatnonzero(part.outline[:, 2])
    assert len(arcs) == 6
    radii = []
    for index in arcs:
        (x0, y0, bulge), (x1, y1, _) = part.outline[[index, index + 1]]
        # the sagitta is half the chord times the bulge, to the right of an arc that turns left
        crown = np.array([(x0 + x1) / 2 + bulge * (y1 - y0) / 2, (y0 + y1) / 2 - bulge * (x1 - x0) / 2])
        distances = np.hypot(*(np.array([(x0, y0), crown, (x1, y1)]) - centre).T)
        assert np.ptp(distances) < 1e-14
        radii.append(distances[0])
    notched, plain = abs(1 / curvature - 0.05), abs(1 / curvature + 0.05)
    if family == "B":
        notched, plain = plain, notched
    np.testing.assert_allclose(sorted(radii), sorted([notched] * 5 + [plain]), atol=1e-14)
    # feet: middle on the centre line, sides parallel to the radius there
    size = np.hypot(*np.diff(part.outline[:, :2], axis=0).T)
    feet = [i for i in range(len(size)) if abs(size[i] - 0.003) < 1e-12]
    assert len(feet) == 4
    for i in feet:
        a, b, c, d = part.outline[i - 1 : i + 3, :2]
        radial = (b + c) / 2 - centre
        assert np.hypot(*radial) == pytest.approx(abs(1 / curvature), abs=1e-14)
        for side in (b - a, d - c):
            assert abs(np.cross(np.append(side, 0), np.append(radial, 0))[2]) < 1e-15
            assert 0.0499 < np.hypot(*side) < 0.0501
        assert (np.hypot(*(a - centre)) > np.hypot(*radial)) == ((family == "A") == (curvature < 0))


@pytest.mark.parametrize(("layers", "spread"), [(1, [0.0]), (2, [-0.0125, 0.0125]), (3, [-0.025, 0.0, 0.025])])
def test_slots_and_ends(layers, spread):
    strip = Strip("A", (0.0, 0.2, 0.45, 0.6), "+oo|")
    parts = parts_of([strip], section={"layers": layers}, end_distance=0.04)
    (part,) = parts.parts
    expected = np.add.outer([0.0, 0.2, 0.45], spread).ravel()
    np.testing.assert_allclose(part.slots, expected, atol=1e-15)
    assert part.start == pytest.approx(spread[0] - 0.04, abs=1e-15)
    assert part.end == pytest.approx(0.64, abs=1e-15)
    assert part.quantity == parts.pieces == layers
    assert parts.mass == pytest.approx(layers * part.mass)
    assert parts.warnings == ()


def test_slots_near_the_rim_push_the_end_out():
    (part,) = parts_of([Strip("A", (0.0, 0.3, 0.305), "|o|")]).parts
    assert part.end == pytest.approx(0.3 + 0.0125 + 0.05, abs=1e-15)


def test_hub_ends_short_of_the_singular_node():
    (part,) = parts_of([Strip("A", (0.0, 0.3, 0.6), "*o*")], hub_radius=0.03).parts
    assert (part.start, part.end) == pytest.approx((0.03, 0.57), abs=1e-15)
    assert len(part.slots) == 2
    np.testing.assert_array_equal(part.nodes, [0.0, 0.3, 0.6])


def test_nothing_left_between_hubs():
    parts = parts_of([Strip("A", (0.0, 0.03), "**"), Strip("A", (0.0, 0.3), "*|")])
    assert [part.id for part in parts.parts] == ["A2"]
    assert "1 of 2 lamellas are left out of the parts (A1)" in parts.warnings[0]


def test_one_cell_without_crossing():
    (part,) = parts_of([Strip("B", (0.0, 0.01), "||")], 0.5).parts
    assert part.slots.size == 0
    assert part.length == pytest.approx(0.11)
    assert part.area == pytest.approx(0.011, abs=1e-15)


def test_ring_opens_at_mid_cell():
    stations = (0.0, 0.5, 0.9, 1.4, 2.0)
    (part,) = parts_of([Strip("A", stations, "oooo", closed=True)], 1.0).parts
    assert part.length == pytest.approx(2.0, abs=1e-15)
    assert part.start == pytest.approx(-0.3, abs=1e-15)
    assert len(part.slots) == 8
    assert part.slots.min() > part.start
    assert part.slots.max() < part.end


def test_close_slots_are_left_out_and_told():
    strips = [Strip("A", (0.0, 0.2, 0.23, 0.5), "|oo|"), Strip("A", (0.0, 0.2, 0.25, 0.5), "|oo|")]
    parts = parts_of(strips)
    first, second = parts.parts
    assert (len(first.slots), first.slots_left_out) == (0, 4)
    assert (len(second.slots), second.slots_left_out) == (4, 0)
    assert first.area == pytest.approx(first.length * 0.1, abs=1e-15)
    (warning,) = parts.warnings
    for text in ("1 of 2 parts are drawn without slots", "(A1)", "30.0 mm", "need 31.0 mm from node to node"):
        assert text in warning


def test_just_enough_room_between_slots():
    for family, curvature in (("A", 0.8), ("B", -0.8)):
        # on the inner edge lengths are shorter by 1 - 0.8 * 0.05
        needed = 0.025 + 0.006 / 0.96
        for cell, slots in ((needed + 1e-6, 4), (needed - 1e-6, 0)):
            strip = Strip(family, (0.0, 0.2, 0.2 + cell, 0.6), "|oo|")
            (part,) = parts_of([strip], curvature).parts
            assert len(part.slots) == slots


def test_split_into_fewest_nearly_equal_pieces():
    stations = tuple(np.arange(0, 26) * 1.0)
    parts = parts_of([Strip("A", stations, "|" + "o" * 24 + "|"), Strip("A", (0.0, 1.0), "||")])
    # 25.1 m on 11.98 m: three pieces
    assert [part.id for part in parts.parts] == ["A1.1", "A1.2", "A1.3", "A2"]
    lengths = [part.length for part in parts.parts[:3]]
    assert sum(lengths) == pytest.approx(25.1)
    assert max(lengths) - min(lengths) < 1.0
    assert sum(len(part.slots) for part in parts.parts) == 48
    for left, right in zip(parts.parts[:2], parts.parts[1:3], strict=True):
        assert left.end == right.start
        assert left.end == pytest.approx(0.5 * (left.nodes[-1] + right.nodes[0]))
    assert parts.warnings == (
        "1 of 2 lamellas were split midway between nodes into 3 pieces: 1 do not fit the sheet of 12 x 2 m "
        "(the longest has 25.100 m)",
    )


@pytest.mark.parametrize("seed", range(5))
def test_cuts_are_fewest(seed):
    rng = np.random.default_rng(seed)
    nodes = np.cumsum(rng.uniform(0.2, 1.0, 12))
    start, end, longest = nodes[0] - 0.1, nodes[-1] + 0.1, 2.5
    cuts = cut_stations(start, end, nodes, longest)
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    assert np.all(np.isin(cuts, middles))
    assert np.diff([start, *cuts, end]).max() <= longest
    # fewest by trying all: the least number of pieces that reaches each cut
    reach = {start: 0}
    for place in [*middles, end]:
        reach[place] = 1 + min(n for at, n in reach.items() if place - at <= longest)
    assert len(cuts) + 1 == reach[end]


def test_rings_that_would_overlap_are_split():
    stations = tuple(np.linspace(0.0, 6.2, 11))
    parts = parts_of([Strip("A", stations, "o" * 10, closed=True)], 1.0, sheet=(3.0, 3.0))
    assert [part.id for part in parts.parts] == ["A1.1", "A1.2"]
    assert sum(part.length for part in parts.parts) == pytest.approx(6.2)
    assert "1 turn through more than 1.9 pi and would overlap themselves" in parts.warnings[0]


def test_cell_longer_than_the_sheet():
    parts = parts_of([Strip("A", (0.0, 3.0, 6.0), "|o|")], sheet=(2.0, 1.0))
    assert [part.id for part in parts.parts] == ["A1"]
    assert parts.warnings == (
        "1 of 1 lamellas do not fit the sheet of 2 x 1 m even if cut at every cell (the longest is A1 with "
        "6.100 m): drawn alone on over-size sheets",
    )


@pytest.mark.parametrize("curvature", [0.0, 0.4, -2.0, 1e-6])
@pytest.mark.parametrize("length", [0.2, 1.5, 2.9])
def test_extents_are_those_of_the_outline(curvature, length):
    strips = [Strip("A", (0.0, length), "||")]
    (part,) = parts_of(strips, curvature, end_distance=0.005, section={"height": 0.06}).parts
    points = sampled(part.outline, 1e-4)
    expected = [*points.min(axis=0), *points.max(axis=0)]
    np.testing.assert_allclose(part.bounds, expected, atol=2e-8)


@pytest.mark.parametrize("curvature", [0.0, 0.3, 1.5, -4.0])
def test_longest_fitting_touches_the_rectangle(curvature):
    length = longest_fitting(2.0, 0.9, 0.1, curvature, 1.9 * np.pi)
    half_width, rise = extents(length, 0.1, curvature)
    slack = (2.0 - 2 * half_width, 0.9 - rise - 0.05, 1.9 * np.pi - abs(curvature) * length)
    assert min(slack) == pytest.approx(0.0, abs=1e-12)
    assert longest_fitting(2.0, 0.09, 0.1, curvature, 6.0) == 0.0


def test_area_of_flat_and_round_arcs():
    for bulge in (1e-9, 9.9e-5, 1.01e-4, 0.3, 1.0, -0.2):
        lens = np.array([(0.0, 0.0, bulge), (1.0, 0.0, bulge)])
        angle = 4 * np.arctan(abs(bulge))
        radius = 1 / (2 * np.sin(angle / 2))
        expected = np.sign(bulge) * radius**2 * (angle - np.sin(angle))
        assert outline_area(lens) == pytest.approx(expected, rel=1e-7, abs=1e-9)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"end_distance": 0.004}, "end_distance is 0.004 m"),
        ({"end_distance": np.nan}, "end_distance is nan m"),
        ({"hub_radius": -0.1}, "hub_radius is -0.1 m"),
        ({"slot_width": 0.001}, "less than the thickness 0.0015 m"),
        ({"gap": 0.0}, "gap is 0, it has to be more than 0"),
        ({"sheet": (12.0, 0.02)}, "sheet is 0.02, it has to be more than 0.02"),
    ],
)
def test_measures_no_part_can_be_made_with(options, text):
    with pytest.raises(InputError, match=text):
        parts_of([Strip("A", (0.0, 0.3), "||")], **options)


def test_too_tight_a_circle_is_refused():
    with pytest.raises(InputError, match=r"circle has a radius of 0\.08 m"):
        parts_of([Strip("A", (0.0, 0.3), "||")], 12.5)


def test_relaxed_marks_move_the_slots():
    strips = random_strips(1, count=1)
    plain, relaxed = (parts_of(strips, relax=relax).parts[0] for relax in (1.0, 1.001))
    # `build` holds the stations and shortens the arcs
    np.testing.assert_allclose(plain.nodes, relaxed.nodes, rtol=1e-14)
