"""Strips cut from stock: used up, apart, never worse than pieces nearly equal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import lamella
from fabrication.test_sheets import placed_outlines
from lamella import InputError
from lamella.fabrication.parts import make_parts
from lamella.fabrication.sheet import nest
from lamella.fabrication.stock import Stock, Supply
from lamella.fabrication.stock_nesting import nest_on_stock

DENSITY = 7900.0


def made(surface, stocks, cells=12, section=None, **measures):
    strips = lamella.net(surface, cells=cells).strips(section or lamella.Section())
    section = strips.section
    supply = Supply.of(
        tuple(stocks),
        height=section.height,
        thickness=section.thickness,
        material="1.4301",
        density=DENSITY,
        gap=0.01,
        straight=strips.network.normal_curvature == 0,
    )
    parts = make_parts(strips.network, strips, density=DENSITY, supply=supply, **measures)
    return strips, parts, nest_on_stock(parts, supply)


ROUND = lamella.Unduloid(1.6, 2.8, (-1.5, 4.0))  # H = 1 / 4.4 m
STRAIGHT = lamella.Catenoid(2.5, (-2.0, 3.0))
SHEET = Stock("sheet", 3.0, 1.5)
BAR = Stock("bar", 6.0, 0.1)


def test_arcs_use_seven_tenths_of_their_sheets_and_straight_strips_nine_of_their_bars() -> None:
    strips, parts, nesting = made(ROUND, [SHEET])
    assert strips.network.normal_curvature == pytest.approx(1 / 4.4)
    area = sum(part.quantity * part.area for part in parts.parts)
    assert area / np.prod(nesting.sizes, axis=1).sum() >= 0.7
    today = make_parts(strips.network, strips, density=DENSITY, sheet=(3.0, 1.5))
    assert nesting.sheet_count < nest(today, sheet=(3.0, 1.5)).sheet_count
    strips, parts, nesting = made(STRAIGHT, [BAR])
    length = sum(part.quantity * part.length for part in parts.parts)
    assert length / nesting.sizes[:, 0].sum() >= 0.9
    assert all(stock.kind == "bar" for stock in nesting.stocks)


@pytest.mark.parametrize(
    ("surface", "stocks"),
    [
        (ROUND, [SHEET]),
        (ROUND, [Stock("coil", 50.0, 1.0)]),
        (STRAIGHT, [SHEET]),
        (STRAIGHT, [Stock("coil", 50.0, 1.0)]),
        (STRAIGHT, [BAR, Stock("bar", 4.0, 0.1)]),
        (STRAIGHT, [Stock("coil", 40.0, 0.1)]),
    ],
    ids=["arcs on sheets", "arcs on a coil", "rows", "rows on a coil", "two bars", "slit coil"],
)
def test_pieces_on_stock_keep_their_distance(surface, stocks) -> None:
    _, parts, nesting = made(surface, stocks, cells=8)
    assert len(nesting.parts) == parts.pieces
    assert np.bincount(nesting.parts).tolist() == [part.quantity for part in parts.parts]
    outlines = list(placed_outlines(parts, nesting, 0.01))
    for number in range(nesting.sheet_count):
        here = [outlines[i] for i in np.flatnonzero(nesting.sheets == number)]
        # a bar is used from end to end
        margin = 0.0 if min(stocks[0].width, nesting.sizes[number, 1]) <= 0.1 + 1e-9 else 0.01
        points = np.concatenate(here)
        assert points.min() > margin - 1e-6
        assert np.all(points.max(axis=0) < nesting.sizes[number] - margin + 1e-6)
        for k, one in enumerate(here):
            for other in here[:k]:
                if np.all(one.min(axis=0) < other.max(axis=0) + 0.01) and np.all(
                    other.min(axis=0) < one.max(axis=0) + 0.01
                ):
                    assert _distance(one, other) > 0.01 - 1e-4


def test_families_on_two_levels_have_two_radii_and_are_laid_apart() -> None:
    section = lamella.Section(height=0.06, thickness=0.004, offset=0.04, layer_lengths="own", level=0.03)
    _, parts, nesting = made(ROUND, [SHEET], cells=8, section=section)
    radii = {part.family: round(1 / part.curvature, 6) for part in parts.parts}
    assert len(set(radii.values())) == 2
    # pieces of one radius touch no others: their sheets are their own
    for number in range(nesting.sheet_count):
        on_it = nesting.parts[nesting.sheets == number]
        assert len({parts.parts[k].family for k in on_it.tolist()}) == 1
    outlines = list(placed_outlines(parts, nesting, 0.01))
    for number in range(nesting.sheet_count):
        here = [outlines[k] for k in np.flatnonzero(nesting.sheets == number)]
        assert np.concatenate(here).min() > 0.01 - 1e-6
        for k, one in enumerate(here):
            assert all(_distance(one, other) > 0.01 - 1e-4 for other in here[:k])


def _distance(one, other) -> float:
    from scipy.spatial import cKDTree

    return float(cKDTree(one).query(other)[0].min())


def test_splices_lie_between_nodes_and_pieces_are_carried() -> None:
    strips, parts, _ = made(STRAIGHT, [BAR], transport_length=3.0)
    assert max(part.length for part in parts.parts) <= 3.0 + 1e-9
    stations = strips.stop_stations
    for part in parts.parts:
        own = stations[strips.network.stop_owner == part.lamella]
        for end in (part.start, part.end):
            inside = own[0] < end < own[-1]
            assert not inside or np.abs(own[:-1] + own[1:] - 2 * end).min() < 1e-9
    # without stock too
    plain = make_parts(strips.network, strips, density=DENSITY, transport_length=3.0)
    assert max(part.length for part in plain.parts) <= 3.0 + 1e-9
    assert [warning.key for warning in plain.warnings if warning.key == "lamellas_split"]


def test_cuts_keep_room_for_splices() -> None:
    strips, parts, _ = made(STRAIGHT, [BAR], splice_room=0.15)
    inner = [part for part in parts.parts if "." in part.id]
    assert inner
    for part in inner:
        gaps = []
        if not part.id.endswith(".1"):
            gaps.append(part.slots[0] - part.start)
        if part.end < strips.developed_lengths[part.lamella] - 0.2:
            gaps.append(part.end - part.slots[-1])
        assert min(gaps) >= 0.15 - 1e-9


def test_what_costs_least_is_cut() -> None:
    cheap, dear = replace(SHEET, price=1.0), replace(BAR, price=1.0)
    *_, nesting = made(STRAIGHT, [cheap, dear], cells=6)
    assert {stock.kind for stock in nesting.stocks} == {"sheet"}
    *_, nesting = made(STRAIGHT, [replace(cheap, price=100.0), dear], cells=6)
    assert {stock.kind for stock in nesting.stocks} == {"bar"}


@pytest.mark.parametrize(
    ("surface", "stocks", "number"),
    [
        (ROUND, [BAR], "120"),  # no bars for arcs; a sheet has to be wider than strip and gaps
        (STRAIGHT, [Stock("sheet", 3.0, 0.11)], "120"),
        (STRAIGHT, [Stock("sheet", 3.0, 1.5, thickness=0.002)], "0.0015"),
        (STRAIGHT, [Stock("bar", 0.3, 0.1)], "0.3"),  # a cell is longer
        (ROUND, [Stock("sheet", 0.5, 0.3)], "0.5"),
    ],
)
def test_stock_that_no_strip_comes_from_is_refused(surface, stocks, number) -> None:
    with pytest.raises(InputError) as refused:
        made(surface, stocks)
    assert refused.value.where == "stock"
    assert number in str(refused.value)
