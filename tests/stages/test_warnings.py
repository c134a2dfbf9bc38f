"""What a run warns about, and what it keeps quiet about."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lamella import compute, make_surface, parse_project
from lamella.base.material import MATERIALS
from lamella.base.message import Message
from lamella.files.write.surface_patches import is_written
from lamella.network.cell_sizes import small_cells
from lamella.stages.lamellas.warnings import lamella_warnings
from lamella.stages.network.warnings import network_warnings
from lamella.stages.surface.warnings import surface_file_warnings
from refusals import check_stated, keys, numbers_in, refused, warned
from surface.element.exact_elements import sphere_cap


def warnings(kind: str, until: str = "lamellas", tables: dict[str, Any] | None = None, **surface: Any) -> list[Message]:
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
    assert (reported.key, "0.1" in numbers_in(reported)) == ("unit_large", True)


def test_a_small_lamella_on_a_building() -> None:
    """The lamella may have been converted and the surface not, or the other way round."""
    values = {"neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4, 4]}
    assert warnings("unduloid", "surface", **values) == []
    low = {"lamella": {"height": 0.001, "thickness": 0.0001}}
    warned(warnings("unduloid", "surface", low, **values), "unit_large", [0.001])
    warned(warnings("scherk", "surface", extent=1.0, scale=0.1), "unit_small", [0.308, 0.1])


def test_large_but_possible_buildings_are_not_warned_about() -> None:
    assert warnings("catenoid", "surface", neck_radius=40.0, height=[-40, 40]) == []


def test_left_out_lamellas_are_counted() -> None:
    for minimum, left_out in ((0.5, 0), (2.0, 4)):
        # so low that no cell is small for it
        tables = {"network": {"cells": 13, "minimum_length": minimum}, "lamella": {"height": 0.05}}
        results = compute(
            parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}} | tables), until="network"
        )
        assert keys(results.summary["warnings"]) == ["lamellas_short"] * (left_out > 0)
        assert results.summary["network"]["lamellas_left_out"] == left_out
        if left_out:
            warned(results.summary["warnings"], "lamellas_short", [left_out], ["network.minimum_length"])


def test_small_cells_are_reported_by_place() -> None:
    """Every node distance under a tenth of the height counts, the least one with its place; others are not named."""
    network = compute(
        parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}}), until="network"
    ).network
    assert network
    edges = np.sort(network.cell_edges)
    assert "cells_small" not in keys(network_warnings(network, 9.9 * edges[0]))
    # a little above the third one, so that rounding decides nothing
    height = 10 * float(np.sqrt(edges[2] * edges[edges > 1.01 * edges[2]][0]))
    count, places = small_cells(network, height / 10)
    assert count == (edges < height / 10).sum()
    assert places[0].edge == edges[0]
    reported = warned(list(network_warnings(network, height)), "cells_small", [count, 100 * height])
    for place in places:
        assert f"({', '.join(f'{x:.3g}' for x in place.point)}) m" in reported
        gaps = np.linalg.norm(network.node_points - place.point, axis=1)
        # midway between two nodes
        assert np.sort(gaps)[1] == pytest.approx(place.edge / 2, rel=1e-3)


def test_one_is_and_several_are() -> None:
    network = compute(parse_project({"surface": {"kind": "scherk", "extent": 1.2, "scale": 3.0}})).network
    assert network
    one, two = (list(network_warnings(replace(network, left_out=n), 0.1)) for n in (1, 2))
    assert keys(one) == keys(two) == ["lamellas_short"]
    assert (numbers_in(one[0]), numbers_in(two[0])) == (["1"], ["2"])
    # each in its own grammar, and not the one with the other's number
    assert one[0].replace("1", "2") != two[0]
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
        warned([reported], "overstressed", [2.5, count, 48], ["A1"])


def test_cells_smaller_than_the_strip() -> None:
    values = {"radius": 2.0, "height": [0, 1]}
    coarse = keys(warnings("cylinder", "network", {"network": {"cells": 60}}, **values))
    assert not {"cells_small", "cells_narrow"} & set(coarse)
    reported = warnings("cylinder", "network", {"network": {"cells": 120}}, **values)
    assert keys(reported) == ["cells_small", "cells_narrow"]
    warned(reported, "cells_small", [240])
    warned(reported, "cells_narrow", [74, 100, 84])


def test_overstress_names_the_lamella_and_counts() -> None:
    values = {"neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4, 4]}
    reported = warnings("unduloid", tables={"lamella": {"thickness": 0.02, "layers": 1}}, **values)
    project = parse_project({"surface": {"kind": "unduloid"} | values, "lamella": {"thickness": 0.02, "layers": 1}})
    results = compute(project, until="lamellas")
    most = results.summary["lamellas"]["utilisation_max"]
    assert most > 1
    warned(reported[:1], "overstressed", [most, 48])


def test_strips_too_high_for_the_curvature() -> None:
    reported = warnings("cylinder", tables={"lamella": {"height": 0.4, "layers": 1}}, radius=0.3, height=[0, 1])
    warned(reported, "strip_high", [0.2, 0.67])
    reported = warnings("cylinder", tables={"lamella": {"height": 0.2, "layers": 1}}, radius=0.3, height=[0, 1])
    assert "strip_high" not in keys(reported)


def test_layers_cut_alike_that_drift_apart() -> None:
    """A cylinder's lamellas are geodesics: layers to the side are as long. Elsewhere they drift, in any net density."""
    assert warnings("cylinder", radius=2.0, height=[0, 4]) == []
    reported = []
    for cells in (24, 96):
        tables = {"network": {"cells": cells}}
        reported.append(
            warned(warnings("catenoid", "lamellas", tables, neck_radius=2.0, height=[-2, 2]), "layers_drift")
        )
    # the integral of kg ds = sinh u / (sqrt2 cosh u) du from the neck to the rim, there and back
    drift = 25 * np.log(np.cosh(1.0))
    for message in reported:
        check_stated(message, [2, 3, drift])
    for lamella in ({"layers": 1}, {"layer_lengths": "own"}, {"offset": 0.002}):
        found = warnings("catenoid", neck_radius=2.0, height=[-2, 2], tables={"lamella": lamella})
        assert not any(key.startswith("layers_") for key in keys(found))


def test_order_two_is_told_before_it_is_tried() -> None:
    reported: list[str] = []
    rings = [{"circle": {"center": [0.0, 0.0, z], "radius": r}} for z, r in ((0.0, 3.0), (2.0, 2.0))]
    surface = {"kind": "form-found", "order": 2, "tolerance": 0.01, "most_nodes": 500, "boundary": rings}
    project = parse_project({"surface": surface})
    with refused("surface.tolerance", names=["order = 3"]):
        make_surface(project, progress=lambda report: reported.append(str(report)))
    check_stated(reported[0], [2, 20_000, 0.01, 500], ["order", "tolerance", "most_nodes"])
    reported.clear()
    found = make_surface(
        parse_project({"surface": surface | {"order": 3, "most_nodes": 15_000}}),
        progress=lambda report: reported.append(str(report)),
    )
    assert not any("order = " in line for line in reported)
    assert found.describe()["surface_nodes"] < 15_000


def test_nodes_of_order_two_grow_as_told() -> None:
    """Nodes fall with the square of the tolerance, and are within a factor of three of what is reported beforehand."""
    rings = [{"circle": {"center": [0.0, 0.0, z], "radius": r}} for z, r in ((0.0, 3.0), (2.0, 2.0))]
    surface = {"kind": "form-found", "order": 2, "boundary": rings}
    for tolerance in (0.1, 0.03):
        nodes = make_surface(parse_project({"surface": surface | {"tolerance": tolerance}})).describe()["surface_nodes"]
        assert 1 / 3 < nodes / (2 / tolerance**2) < 3


@pytest.mark.parametrize("order", [3, 4])
def test_a_surface_file_without_nurbs_is_told(monkeypatch: pytest.MonkeyPatch, order: int) -> None:
    surface = sphere_cap(order)
    assert list(surface_file_warnings(surface, True)) == []
    count = 3 * len(surface.connectivity.elements)
    monkeypatch.setattr("lamella.files.write.surface_patches.MOST_PATCHES", count - 1)
    (reported,) = surface_file_warnings(surface, True)
    warned([reported], "surface_3dm_mesh", [count, count - 1], ["surface.3dm", "surface.tolerance"])
    # no order is higher than 4
    assert ("surface.order" in reported) == (order < 4)


def test_a_large_surface_file_is_written_where_it_is_requested(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = sphere_cap(3)
    count = 3 * len(surface.connectivity.elements)
    for small, requested, written in (
        (count, None, True),
        (count - 1, None, False),
        (count - 1, True, True),
        (count, False, False),
    ):
        monkeypatch.setattr("lamella.files.write.surface_patches.SMALL_PATCHES", small)
        assert is_written(surface, requested) == written
        reported = list(surface_file_warnings(surface, requested))
        if requested is None and not written:
            warned(reported, "surface_3dm_left_out", [count, small], ["surface.3dm", "files.surface_3dm"])
        else:
            assert reported == []


@pytest.mark.parametrize(("order", "cells"), [(6, 12), (4, 30)])
def test_cells_that_make_large_ones_smaller(order: int, cells: int) -> None:
    """Around a zero of order m an edge goes like cells^(-2 / (m + 2)): m = order - 2 on Enneper's surfaces."""

    def net(count: int) -> tuple[Any, list[Message]]:
        project = parse_project(
            {"surface": {"kind": "enneper", "order": order, "radius": 1.1, "scale": 4.0}, "network": {"cells": count}}
        )
        network = compute(project, until="network").network
        assert network is not None
        return network, [one for one in network_warnings(network, 0.01) if one.key == "cells_large"]

    before, (reported,) = net(cells)
    # the first even number of cells larger than now
    offered = next(int(one) for one in numbers_in(reported) if one.isdigit() and int(one) > cells and not int(one) % 2)
    after, _ = net(offered)
    assert after.cell_edges.max() < 1.1 * 4 * np.median(before.cell_edges)
    # not many more than that needs
    assert after.cell_edges.max() > 0.8 * 4 * np.median(before.cell_edges)
