"""Layers on lamella curves of their own: u + v shifted, kn = H, and slots where the layers' curves cross in space."""

from __future__ import annotations

import json

import numpy as np
import pytest
import rhino3dm
from scipy.interpolate import CubicSpline

import lamella
from lamella import (
    Catenoid,
    Enneper,
    Helicoid,
    InputError,
    Lamellas,
    Section,
    Unduloid,
    compute,
    find_material,
    parse_project,
    write,
)
from lamella.fabrication.parts import make_parts
from lamella.network.elements.element_network import element_network
from lamella.network.network import Network
from lamella.strip.lamellas import crossings, make_lamellas
from lamella.strip.unroll import development_deviation
from network.elements.test_element_network import catenoid

STEEL = find_material("1.4301")
SECTION = Section(height=0.06, thickness=0.001, layers=2, offset=0.03, layer_curves="lamella")


def lines(network: Network) -> list[slice]:
    return [slice(a, b) for a, b in zip(network.sample_offsets[:-1], network.sample_offsets[1:], strict=True)]


@pytest.mark.parametrize("surface", [Catenoid(2.0, (-1.5, 2.0)), Unduloid(1.0, 2.0, (-2.0, 3.0))], ids=lambda s: s.kind)
def test_their_curves_are_lamellas(surface):
    """On surfaces of revolution u + v or u - v is U +- V up to a factor: constant along each layer."""
    network = lamella.net(surface, cells=20)
    layers = make_lamellas(network, SECTION, STEEL, surface).layers
    for points, offset in zip(layers.points, SECTION.layer_offsets, strict=True):
        angle = np.arctan2(points[:, 1], points[:, 0])
        u = parameter(surface, points)
        for line in lines(network):
            up = np.sign(network.sample_tangents[line, 2].mean())
            v = np.unwrap(angle[line])
            sense = np.sign(up * (v[-1] - v[0]))
            level = u[line] - sense * v
            assert np.ptp(level) < 2e-9
            radius = np.hypot(*network.sample_points[line].T[:2])
            shift = (
                level.mean()
                - (network.sample_where[line].real - sense * np.unwrap(network.sample_where[line].imag)).mean()
            )
            shift = (shift + np.pi) % (2 * np.pi) - np.pi
            # shift / sqrt2 in the parameters is shift r / sqrt2 on the surface: its mean over equal steps of U, where
            # ds = sqrt2 r dU, is that of equal layers
            s = network.sample_arclengths[line]
            mean = s[-1] / ((1 / radius[1:] + 1 / radius[:-1]) / 2 * np.diff(s)).sum()
            assert abs(shift) * mean / np.sqrt(2) == pytest.approx(abs(offset), rel=1e-6)
    # to the left is u = n x t
    sideways = np.cross(network.sample_normals, network.sample_tangents)
    for points, distance in zip(layers.points, layers.distances, strict=True):
        across = ((points - network.sample_points) * sideways).sum(1)
        assert (across * distance > 0).all()
        np.testing.assert_allclose(across, distance, rtol=2e-3)


def parameter(surface, points: np.ndarray) -> np.ndarray:
    """U of points on a surface of revolution, by Newton's method on the height."""
    u = np.interp(points[:, 2], *(lambda g: (surface.profile(g).z, g))(np.linspace(-6, 6, 2001)))
    for _ in range(8):
        p = surface.profile(u)
        u = u - (p.z - points[:, 2]) / p.z_u
    return u


def meeting_gaps(network: Network, lamellas: Lamellas) -> np.ndarray:
    """Distances in space of the two places that layers call their crossing, m, over all nodes, (nodes, layers^2)."""
    layers, count = lamellas.layers, lamellas.section.layers
    found: dict[int, dict[str, tuple[np.ndarray, np.ndarray]]] = {}
    for k, line in enumerate(lines(network)):
        curves = [CubicSpline(layers.stations[row, line], layers.points[row, line]) for row in range(count)]
        for stop in range(network.stop_offsets[k], network.stop_offsets[k + 1]):
            at = network.sample_offsets[k] + network.stop_samples[stop]
            places = np.array(
                [
                    curve(layers.stop_stations[row, stop] + layers.slot_shifts[row, stop])
                    for row, curve in enumerate(curves)
                ]
            )
            node = int(network.stop_nodes[stop])
            side = np.cross(network.sample_normals[at], network.sample_tangents[at])
            found.setdefault(node, {})[str(network.families[k])] = (places, side)
    gaps = []
    for node in np.flatnonzero(crossings(network) & (network.node_kinds == 0)).tolist():
        (a, left_of_a), (b, left_of_b) = found[node]["A"], found[node]["B"]
        # slots ascend along a lamella: from the other's right layer on where its left lies ahead
        tangent_a, tangent_b = (
            np.cross(left_of_a, network.node_normals[node]),
            np.cross(left_of_b, network.node_normals[node]),
        )
        if tangent_a @ left_of_b < 0:
            a = a[:, ::-1]
        if tangent_b @ left_of_a < 0:
            b = b[:, ::-1]
        gaps.append(np.linalg.norm(a - b.transpose(1, 0, 2), axis=2).ravel())
    return np.array(gaps)


@pytest.mark.parametrize(
    "surface",
    [Catenoid(2.0, (-1.5, 2.0)), Unduloid(1.0, 2.0, (-2.0, 3.0)), Helicoid(5.0, 1.0, 4.0, 1.0), Enneper(2, 0.8, 3.0)],
    ids=lambda s: s.kind,
)
def test_slots_are_where_layers_cross(surface):
    network = lamella.net(surface, cells=20)
    lamellas = make_lamellas(network, SECTION, STEEL, surface)
    assert meeting_gaps(network, lamellas).max() < 2e-5
    assert lamellas.layer.max() == 0
    # kn of the layers' own curves, from their points and normals alone
    for points, normals in zip(lamellas.layers.points, lamellas.layers.normals, strict=True):
        own = development_deviation(points, normals, network.sample_offsets, network.normal_curvature)
        centre = development_deviation(
            network.sample_points, network.sample_normals, network.sample_offsets, network.normal_curvature
        )
        assert own.max() < 2 * centre.max() + 1e-7


def test_on_elements():
    """The same on a surface of elements, and beside it against parallel layers, which are bent by millimetres."""
    _, surface = catenoid(48, 26)
    network = element_network(surface, cells=12).network
    section = Section(height=0.04, thickness=0.001, layers=2, offset=0.015, layer_curves="lamella")
    lamellas = make_lamellas(network, section, STEEL, surface)
    assert meeting_gaps(network, lamellas).max() < 2e-5
    own = [
        development_deviation(p, n, network.sample_offsets, 0.0).max()
        for p, n in zip(lamellas.layers.points, lamellas.layers.normals, strict=True)
    ]
    parallel = make_lamellas(network, Section(height=0.04, thickness=0.001, layers=2, offset=0.015), STEEL).layers
    bent = [
        development_deviation(p, n, network.sample_offsets, 0.0).max()
        for p, n in zip(parallel.points, parallel.normals, strict=True)
    ]
    assert max(own) < 1e-4
    assert min(bent) > 5 * max(own)


def test_next_to_a_singular_node():
    """Rays: their layers turn away from them at the node. Strips end where neighbours are clear of each other."""
    surface = Enneper(3, 0.8, 3.0)
    network = lamella.net(surface, cells=16)
    lamellas = make_lamellas(network, SECTION, STEEL, surface)
    assert np.isfinite(lamellas.layers.stations).all()
    parts = make_parts(network, lamellas, density=7900.0)
    equal = make_parts(network, make_lamellas(network, Section(0.06, 0.001, 2, 0.03), STEEL), density=7900.0)
    rays = [
        part for part in parts.parts if network.node_kinds[network.stop_nodes[network.stop_offsets[part.lamella]]] == 2
    ]
    plain = {part.id: part for part in equal.parts}
    assert len(rays) == 12
    for part in rays:
        # the layers' distance grows like r^(-1/2) towards the node
        assert part.start > 1.15 * plain[part.id.split("-")[0]].start
        at = np.searchsorted(lamellas.layers.stations[part.layer - 1, lines(network)[part.lamella]], part.start)
        away = lamellas.layers.distances[part.layer - 1, lines(network)[part.lamella]][at]
        assert abs(away) < part.start * np.tan(np.pi / 6)


@pytest.mark.parametrize("way", ["offset", "lamella"])
def test_whole_runs_with_a_singular_node(tmp_path, way):
    """Every file of a run, of each way, around a hexagonal node, where layers on lamella curves are not followed."""
    project = {
        "name": way,
        "surface": {"kind": "enneper", "order": 3, "radius": 0.8, "scale": 3.0},
        "network": {"cells": 10},
        "lamella": {"height": 0.06, "thickness": 0.001, "offset": 0.03, "layer_curves": way},
    }
    results = compute(parse_project(project))
    write(results, tmp_path / way)
    lamellas = json.loads((tmp_path / way / "lamellas.json").read_bytes())["lamellas"]
    key = {"distance"} if way == "lamella" else set()
    assert all(set(layer) == {"offset"} | key for one in lamellas for layer in one["layers"])
    model = rhino3dm.File3dm.Read(str(tmp_path / way / "model.3dm"))
    names = {model.Layers[item.Attributes.LayerIndex].Name: [] for item in model.Objects}
    for item in model.Objects:
        names[model.Layers[item.Attributes.LayerIndex].Name].append(item.Attributes.Name)
    drawn = names["layers A"] + names["layers B"]
    ids = [id for family in "AB" for id in results.network.ids if id[0] == family]
    assert drawn == [f"{id}-{layer}" for id in ids for layer in (1, 2)]
    stress = results.summary["lamellas"]["stress_layer_max"]
    assert (stress > 1e6) == (way == "offset")


def test_lines_of_another_normal_curvature_have_none():
    from lamella.network.lattice.density import choose_density
    from lamella.network.lattice.trace import trace_closed_form
    from lamella.network.pattern import Pattern

    surface = Catenoid(2.0, (-1.5, 2.0))
    pattern = Pattern("lamellas", (1, 1), 0.05)
    network = trace_closed_form(surface, choose_density(surface, cells=24, spacing=None, pattern=pattern))
    with pytest.raises(InputError) as caught:
        make_lamellas(network, SECTION, STEEL, surface)
    assert caught.value.where == "section.layer_curves"
    with pytest.raises(InputError) as caught:
        make_lamellas(lamella.net(surface, cells=24), SECTION, STEEL)
    assert caught.value.where == "surface"
