"""What a run warns about, and what it keeps quiet about."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lamella import InputError, compute, make_surface, parse_project
from lamella.base.material import MATERIALS
from lamella.network.cell_sizes import small_cells
from lamella.stages.lamellas.warnings import lamella_warnings
from lamella.stages.network.warnings import network_warnings
from lamella.stages.surface.warnings import surface_file_warnings
from surface.element.exact_elements import sphere_cap


def warnings(kind: str, until: str = "lamellas", tables: dict[str, Any] | None = None, **surface: Any) -> list[str]:
    project = parse_project({"name": "x", "surface": {"kind": kind} | surface} | (tables or {}))
    reported = compute(project, until=until).summary["warnings"]
    assert all("\n" not in message and len(message) < 400 for message in reported)
    return list(reported)


def test_a_plain_building_is_warned_about_nothing() -> None:
    assert (
        warnings("unduloid", neck_radius=1.6, bulge_radius=2.8, height=[-4, 4], tables={"lamella": {"layers": 1}}) == []
    )


@pytest.mark.parametrize(
    ("kind", "surface"),
    [
        ("unduloid", {"neck_radius": 600.0, "bulge_radius": 1400.0, "height": [-1000.0, 1000.0]}),
        ("unduloid", {"neck_radius": 60.0, "bulge_radius": 140.0, "height": [0.0, 2000.0]}),
        ("nodoid", {"neck_radius": 300.0, "bulge_radius": 900.0, "height": [-150.0, 150.0]}),
        ("catenoid", {"neck_radius": 200.0, "height": [-200.0, 250.0]}),
        ("cylinder", {"radius": 200.0, "height": [0.0, 400.0]}),
        ("helicoid", {"pitch": 4000.0, "inner_radius": 1000.0, "outer_radius": 4000.0, "turns": 1.25}),
        ("enneper", {"order": 3, "radius": 0.9, "scale": 4000.0}),
        ("scherk", {"extent": 1.25, "scale": 3000.0}),
    ],
)
def test_millimetres_taken_for_metres(kind: str, surface: dict[str, Any]) -> None:
    (reported,) = warnings(kind, "surface", **surface)
    assert reported.startswith("the surface is ")
    assert (
        " m across and the lamella 0.1 m high: all lengths in a project file are metres, were millimetres" in reported
    )


def test_a_small_lamella_on_a_building() -> None:
    """The lamella may have been converted and the surface not, or the other way round."""
    values = {"neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4, 4]}
    assert warnings("unduloid", "surface", **values) == []
    assert (
        "were millimetres meant?"
        in warnings("unduloid", "surface", {"lamella": {"height": 0.001, "thickness": 0.0001}}, **values)[0]
    )
    (reported,) = warnings("scherk", "surface", extent=1.0, scale=0.1)
    assert reported.startswith("the surface is only 0.308 m across for a lamella 0.1 m high")


def test_large_but_possible_buildings_are_not_warned_about() -> None:
    assert warnings("catenoid", "surface", neck_radius=40.0, height=[-40, 40]) == []


def test_left_out_lamellas_are_counted() -> None:
    for minimum, reported in ((0.5, []), (2.0, ["4 lamellas shorter than network.minimum_length are left out"])):
        # so low that no cell is small for it
        tables = {"network": {"cells": 13, "minimum_length": minimum}, "lamella": {"height": 0.05}}
        results = compute(
            parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}} | tables), until="network"
        )
        assert results.summary["warnings"] == reported
        assert results.summary["network"]["lamellas_left_out"] == 2 * minimum * len(reported)


def test_small_cells_are_reported_by_place() -> None:
    """Every node distance under a tenth of the height counts, the least one with its place; others are not named."""
    network = compute(
        parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}}), until="network"
    ).network
    assert network
    edges = np.sort(network.cell_edges)
    assert not any("tenth of the strip" in reported for reported in network_warnings(network, 9.9 * edges[0]))
    # a little above the third one, so that rounding decides nothing
    height = 10 * float(np.sqrt(edges[2] * edges[edges > 1.01 * edges[2]][0]))
    count, places = small_cells(network, height / 10)
    assert count == (edges < height / 10).sum()
    assert places[0].edge == edges[0]
    (reported,) = (reported for reported in network_warnings(network, height) if "tenth of the strip" in reported)
    assert reported.startswith(f"{count} cell edges are shorter")
    for place in places:
        assert f"({', '.join(f'{x:.3g}' for x in place.point)}) m" in reported
        gaps = np.linalg.norm(network.node_points - place.point, axis=1)
        # midway between two nodes
        assert np.sort(gaps)[1] == pytest.approx(place.edge / 2, rel=1e-3)


def test_one_is_and_several_are() -> None:
    network = compute(parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}})).network
    assert network
    one, two = (list(network_warnings(replace(network, left_out=n), 0.1)) for n in (1, 2))
    assert one == ["1 lamella shorter than network.minimum_length is left out"]
    assert two == ["2 lamellas shorter than network.minimum_length are left out"]
    results = compute(
        parse_project({"surface": {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4, 4]}})
    )
    assert results.lamellas
    assert results.network
    for count in (1, 2):
        # stress the first samples of so many lamellas
        utilisation = np.zeros_like(results.lamellas.utilisation)
        utilisation[results.network.sample_offsets[:count]] = 2.5
        lamellas = replace(results.lamellas, utilisation=utilisation)
        reported = next(
            lamella_warnings(
                results.mesh,
                results.network,
                lamellas,
                0.003,
                MATERIALS["1.4301"],
                MATERIALS,
                lambda section, material: 1.0,
            )
        )
        assert reported.startswith("utilisation reaches 2.50 in lamella A1 at (")
        assert f"({count} of 48 lamellas {'is' if count == 1 else 'are'} over 1)" in reported


def test_cells_smaller_than_the_strip() -> None:
    values = {"radius": 2.0, "height": [0, 1]}
    assert not any("cell edges" in m for m in warnings("cylinder", "network", {"network": {"cells": 60}}, **values))
    small, *reported = warnings("cylinder", "network", {"network": {"cells": 120}}, **values)
    assert small.startswith("240 cell edges are shorter than a tenth")
    assert reported == [
        "half of the cell edges are shorter than 74 mm, less than the strip's height of 100 mm: at most 84 cells, or a "
        "strip up to 74 mm high"
    ]


def test_overstress_names_the_lamella_and_counts() -> None:
    values = {"neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4, 4]}
    reported = warnings("unduloid", tables={"lamella": {"thickness": 0.02, "layers": 1}}, **values)
    project = parse_project({"surface": {"kind": "unduloid"} | values, "lamella": {"thickness": 0.02, "layers": 1}})
    results = compute(project, until="lamellas")
    most = results.summary["lamellas"]["utilisation_max"]
    assert most > 1
    assert reported[0].startswith(f"utilisation reaches {most:.2f} in lamella ")
    assert "(48 of 48 lamellas are over 1): a thickness of " in reported[0]


def test_strips_too_high_for_the_curvature() -> None:
    reported = warnings("cylinder", tables={"lamella": {"height": 0.4, "layers": 1}}, radius=0.3, height=[0, 1])
    assert any(
        m.startswith("half the strip's height (0.2 m) is 0.67 of the surface's smallest radius") for m in reported
    )
    reported = warnings("cylinder", tables={"lamella": {"height": 0.2, "layers": 1}}, radius=0.3, height=[0, 1])
    assert not any("smallest radius" in m for m in reported)


def test_layers_cut_alike_that_drift_apart() -> None:
    """A cylinder's lamellas are geodesics: layers to the side are as long. Elsewhere they drift, in any net density."""
    assert warnings("cylinder", radius=2.0, height=[0, 4]) == []
    reported = []
    for cells in (24, 96):
        tables = {"network": {"cells": cells}}
        reported += [
            m for m in warnings("catenoid", "lamellas", tables, neck_radius=2.0, height=[-2, 2]) if "layers" in m
        ]
    # the integral of kg ds = sinh u / (sqrt2 cosh u) du from the neck to the rim, there and back
    drift = 25 * np.log(np.cosh(1.0))
    for message in reported:
        assert message.startswith("the 2 layers are cut alike")
        assert "slots' play of 3 mm" in message
        assert f"up to {drift:.3g} mm" in message
    assert len(reported) == 2
    for lamella in ({"layers": 1}, {"layer_lengths": "own"}, {"offset": 0.002}):
        found = warnings("catenoid", neck_radius=2.0, height=[-2, 2], tables={"lamella": lamella})
        assert not any("layers" in m for m in found)


def test_order_two_is_told_before_it_is_tried() -> None:
    reported: list[str] = []
    rings = [{"circle": {"center": [0.0, 0.0, z], "radius": r}} for z, r in ((0.0, 3.0), (2.0, 2.0))]
    surface = {"kind": "form-found", "order": 2, "tolerance": 0.01, "most_nodes": 500, "boundary": rings}
    project = parse_project({"surface": surface})
    with pytest.raises(InputError, match=r"surface\.tolerance: H is off") as refusal:
        make_surface(project, progress=lambda report: reported.append(str(report)))
    assert refusal.value.remedy.startswith("write order = 3 or 4, or ")
    assert reported[0].startswith("  order = 2 takes about 20,000 nodes for tolerance = 0.01 (most_nodes = 500)")
    reported.clear()
    found = make_surface(
        parse_project({"surface": surface | {"order": 3, "most_nodes": 15_000}}),
        progress=lambda report: reported.append(str(report)),
    )
    assert not any("order = " in line for line in reported)
    assert found.describe()["surface_nodes"] < 15_000


def test_nodes_of_order_two_grow_as_told() -> None:
    """Nodes fall with the square of the tolerance, and are within a factor of three of what is told beforehand."""
    rings = [{"circle": {"center": [0.0, 0.0, z], "radius": r}} for z, r in ((0.0, 3.0), (2.0, 2.0))]
    surface = {"kind": "form-found", "order": 2, "boundary": rings}
    for tolerance in (0.1, 0.03):
        nodes = make_surface(parse_project({"surface": surface | {"tolerance": tolerance}})).describe()["surface_nodes"]
        assert 1 / 3 < nodes / (2 / tolerance**2) < 3


@pytest.mark.parametrize("order", [3, 4])
def test_a_surface_file_without_nurbs_is_told(monkeypatch: pytest.MonkeyPatch, order: int) -> None:
    surface = sphere_cap(order)
    assert list(surface_file_warnings(surface)) == []
    count = 3 * len(surface.connectivity.elements)
    monkeypatch.setattr("lamella.files.write.surface_3dm.MOST_PATCHES", count - 1)
    (reported,) = surface_file_warnings(surface)
    assert f"NURBS would be {count:,} patches (limit {count - 1:,})" in reported
    # no order is higher than 4
    assert ("a higher surface.order" in reported) == (order < 4)


@pytest.mark.parametrize(("order", "cells"), [(6, 12), (4, 30)])
def test_cells_that_make_large_ones_smaller(order: int, cells: int) -> None:
    """Around a zero of order m an edge goes like cells^(-2 / (m + 2)): m = order - 2 on Enneper's surfaces."""

    def net(count: int) -> tuple[Any, list[str]]:
        project = parse_project(
            {"surface": {"kind": "enneper", "order": order, "radius": 1.1, "scale": 4.0}, "network": {"cells": count}}
        )
        network = compute(project, until="network").network
        assert network is not None
        return network, [reported for reported in network_warnings(network, 0.01) if "over 4 x the median" in reported]

    before, (reported,) = net(cells)
    number = re.search(r"(\d+) cells make them about 4 x the median of now", reported)
    assert number
    after, _ = net(int(number[1]))
    assert after.cell_edges.max() < 1.1 * 4 * np.median(before.cell_edges)
    # not many more than that needs
    assert after.cell_edges.max() > 0.8 * 4 * np.median(before.cell_edges)
