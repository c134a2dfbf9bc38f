"""Supports and loads of nets: nodes by place, tributary areas against the surfaces' own, load sums."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import lamella
from lamella.base.errors import InputError
from lamella.hardware.item import Hardware, Item, Places
from lamella.hardware.shape import Sweep, rectangle
from lamella.network.network import BOUNDARY, SINGULAR
from lamella.structure.actions.hardware_masses import hardware_masses
from lamella.structure.actions.load_rules import LoadRule, Region, load_cases
from lamella.structure.actions.node_supports import SupportRule, supports_of
from lamella.structure.actions.places import Place, named_rims, nodes_at
from lamella.structure.actions.tributary import tributary_areas

CATENOID = lamella.Catenoid(1.0, (-0.5, 1.0))
SURFACES = {
    "catenoid": CATENOID,
    "unduloid": lamella.Unduloid(0.6, 1.4, (-1.0, 1.5)),
    "enneper": lamella.Enneper(order=3, radius=0.8),
    "helicoid": lamella.Helicoid(2.0, 0.5, 2.0, 0.5),
}
NOWHERE = Region(1.0, low=(9.0, 9.0, 9.0), high=(10.0, 10.0, 10.0))


@cache
def net(name, cells):
    return lamella.net(SURFACES[name], cells=cells)


def load(network, **keys):
    (case,) = load_cases(network, [LoadRule("x", **keys)], named_rims(network))
    return case


@pytest.mark.parametrize("name", SURFACES)
def test_areas_add_up_to_that_of_the_surface_with_second_order(name):
    surface, cells = SURFACES[name], (12, 24, 48)
    networks = [net(name, n) for n in cells]
    sizes = [np.median(network.cell_edges) for network in networks]
    areas = [tributary_areas(network) for network in networks]
    errors = [1 - area.true.sum() / surface.area() for area in areas]
    order = np.log(errors[0] / errors[2]) / np.log(sizes[0] / sizes[2])
    assert 1.7 < order < 2.4
    assert errors[2] < 0.002
    for network, area in zip(networks, areas, strict=True):
        # every node has a part of it, whose normal is the surface's
        turned = np.einsum("ij,ij->i", area.vectors, network.node_normals)
        assert (turned > 0).all()
        assert (turned <= area.true * (1 + 1e-12)).all()


def test_a_singular_node_has_an_equal_share_in_the_faces_around_it():
    network = net("enneper", 24)
    assert (network.node_kinds == SINGULAR).sum() == 1
    (node,) = np.flatnonzero(network.node_kinds == SINGULAR)
    rays = np.flatnonzero(network.stop_nodes == node)
    assert len(rays) == 6
    area = tributary_areas(network)
    # by symmetry its vector area stands on the surface
    normal = network.node_normals[node]
    assert np.linalg.norm(np.cross(area.vectors[node], normal)) < 1e-9 * area.true[node]
    assert area.true[node] > area.true[network.node_kinds == 0].min()


@pytest.mark.parametrize("cells", [12, 24])
def test_snow_loads_the_plan_of_a_roof(cells):
    # Scherk's surface stands over a square, whose corners are nodes: its faces fill the plan exactly
    network = lamella.net(lamella.Scherk(scale=3.0, extent=1.2), cells=cells)
    case = load(network, kind="area", value=500.0, per="plan")
    assert case.total == pytest.approx([0, 0, -500 * (2 * 3.0 * 1.2) ** 2], rel=1e-12, abs=1e-9)


def test_cladding_loads_the_true_area_and_a_slanted_direction_counts_by_its_length():
    network = net("catenoid", 24)
    down = load(network, kind="area", value=100.0)
    assert down.total == pytest.approx([0, 0, -100 * tributary_areas(network).true.sum()])
    slanted = load(network, kind="area", value=100.0, direction=(3.0, 0.0, -4.0))
    assert slanted.total == pytest.approx(down.total[2] * np.array([-0.6, 0, 0.8]))


def test_pressure_adds_up_to_that_on_the_openings():
    # divergence theorem: the vector area of the faces is that of their two rings, which are polygons in circles
    network = net("catenoid", 24)
    total = load(network, kind="area", value=1000.0, direction="normal").total
    openings = []
    for height in (-0.5, 1.0):
        radius, chords = np.cosh(height), rim_chords(network, height)
        openings.append((radius**2 * np.sin(2 * np.arcsin(chords / 2 / radius))).sum() / 2)
    assert abs(total[2]) == pytest.approx(1000 * (openings[1] - openings[0]), rel=1e-9)
    assert total[:2] == pytest.approx([0, 0], abs=1e-9)


def rim_chords(network, height):
    """Distances of neighbouring nodes on a ring, by the angle around the axis, m."""
    ring = network.node_points[np.isclose(network.node_points[:, 2], height)]
    ring = ring[np.argsort(np.arctan2(ring[:, 1], ring[:, 0]))]
    return np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1)


def test_regions_have_their_own_coefficients_and_the_first_counts():
    network = net("catenoid", 24)
    normal = network.node_normals
    toward = Region(0.8, facing=(1.0, 0.0, 0.0))
    away = Region(-0.5, facing=(-1.0, 0.0, 0.0))
    case = load(network, kind="area", value=1000.0, direction="normal", regions=(toward, away))
    areas = tributary_areas(network)
    expected = np.where(normal[:, 0] > 0, 800, np.where(normal[:, 0] < 0, -500, 1000))[:, None] * areas.vectors
    assert case.node_forces == pytest.approx(expected)
    box = Region(2.0, low=(-9.0, -9.0, 0.5), high=(9.0, 9.0, 9.0))
    first = load(network, kind="area", value=1000.0, regions=(box, toward), coefficient=0.0)
    high = network.node_points[:, 2] >= 0.5
    assert first.node_forces[high, 2] == pytest.approx(-2000 * areas.true[high])
    ball = Region(1.0, near=tuple(network.node_points[7]), radius=1e-3)
    one = load(network, kind="area", value=1000.0, regions=(ball,), coefficient=0.0)
    assert np.flatnonzero(one.node_forces.any(1)).tolist() == [7]


def test_a_line_load_adds_up_to_the_length_of_its_ring():
    network, radius = net("catenoid", 24), np.cosh(1.0)
    case = load(network, kind="line", value=200.0, place=Place("upper"))
    chords = rim_chords(network, 1.0)
    assert case.total == pytest.approx([0, 0, -200 * chords.sum()], rel=1e-12)
    # each chord is there once: their arcs make the whole ring
    assert (2 * radius * np.arcsin(chords / 2 / radius)).sum() == pytest.approx(2 * np.pi * radius, rel=1e-9)
    on_it = case.node_forces.any(1)
    assert network.node_points[on_it, 2] == pytest.approx(1.0)
    assert on_it.sum() == len(chords)


def test_a_point_load_goes_to_the_nearest_node_or_to_all_around():
    network = net("catenoid", 24)
    at = tuple((network.node_points[11] + 1e-4).tolist())
    one = load(network, kind="point", value=2000.0, place=Place(near=at), direction=(0, 1, 0), moment=(1.0, 2.0, 3.0))
    assert np.flatnonzero(one.node_forces.any(1)).tolist() == [11]
    assert one.node_forces[11] == pytest.approx([0, 2000, 0])
    assert one.node_moments[11] == pytest.approx([1, 2, 3])
    around = load(network, kind="point", value=2000.0, place=Place(near=at, radius=0.6))
    assert (around.node_forces[:, 2] < 0).sum() > 3
    assert around.total == pytest.approx([0, 0, -2000])


def test_other_kinds():
    network = net("catenoid", 12)
    weight = load(network, kind="self_weight", value=1.0)
    assert weight.self_weight.tolist() == [0, 0, -1]
    assert not weight.node_forces.any()
    assert load(network, kind="temperature", value=-30.0).temperature == -30
    settled = load(network, kind="settlement", value=0.02, place=Place("lower")).settlements
    on_it = np.isclose(network.node_points[:, 2], -0.5)
    assert settled[on_it, 2] == pytest.approx(-0.02)
    assert not settled[~on_it].any()


def test_supports_by_boundary_ground_region_and_point():
    network = net("catenoid", 24)
    points, rims = network.node_points, named_rims(network)
    assert nodes_at(network, Place("rim"), rims).tolist() == np.flatnonzero(network.node_kinds == BOUNDARY).tolist()
    assert points[nodes_at(network, Place("upper"), rims), 2] == pytest.approx(1.0)
    assert points[nodes_at(network, Place(ground=-0.5), rims), 2] == pytest.approx(-0.5)
    near = tuple(points[3].tolist())
    assert nodes_at(network, Place(near=near), rims).tolist() == [3]
    ball = nodes_at(network, Place(near=near, radius=0.7), rims)
    assert set(ball) == set(np.flatnonzero(np.linalg.norm(points - points[3], axis=1) <= 0.7))
    both = supports_of(
        network,
        [SupportRule(Place("lower"), ("x", "y")), SupportRule(Place(ground=0.0), (), {"z": 1e6, "x": 5.0})],
        rims,
    )
    low, ground = points[:, 2] < -0.49, points[:, 2] <= 0.01
    assert (both.fixed[:, :2] == low[:, None]).all()
    assert (both.springs[:, 2] == np.where(ground, 1e6, 0)).all()
    # what is fixed needs no spring
    assert (both.springs[:, 0] == np.where(ground & ~low, 5.0, 0)).all()
    assert not both.fixed[:, 3:].any()


def test_rims_are_told_apart_and_named():
    assert named_rims(net("catenoid", 24)).names == ("lower", "upper")
    one = named_rims(net("enneper", 24))
    assert one.names == ("border",)
    edges = one.edges
    # every node of a closed rim is the end of two edges
    assert (np.bincount(edges.ravel(), minlength=len(one.loops))[one.loops >= 0] == 2).all()


@pytest.mark.parametrize(
    ("place", "key", "named"),
    [
        (Place("uper"), "boundary", ["'upper'", "lower, upper"]),
        (Place(ground=-3.0), "ground", ["2.5 m", "0.01 m"]),
        (Place(near=(0.0, 0.0, 5.0), radius=1.0), "radius", ["4.287 m", "1 m"]),
    ],
)
def test_a_place_without_nodes_names_the_nearest_one(place, key, named):
    network = net("catenoid", 24)
    with pytest.raises(InputError) as caught:
        supports_of(network, [SupportRule(Place("rim")), SupportRule(place)], named_rims(network))
    assert caught.value.where == f"supports[1].{key}"
    for word in named:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("keys", "where"),
    [
        ({"kind": "area", "value": 1.0, "direction": (0.0, 0.0, 0.0)}, "loads[0].direction"),
        ({"kind": "point", "value": 1.0, "direction": "normal", "place": Place("rim")}, "loads[0].direction"),
        (
            {"kind": "area", "value": 1.0, "regions": (Region(1.0, low=(9, 9, 9), high=(10, 10, 10)),)},
            "loads[0].regions[0]",
        ),
        ({"kind": "line", "value": 1.0, "place": Place("left")}, "loads[0].boundary"),
    ],
)
def test_loads_that_act_on_nothing_are_refused(keys, where):
    with pytest.raises(InputError) as caught:
        load(net("catenoid", 12), **keys)
    assert caught.value.where == where


def test_loads_follow_a_structure_that_is_turned_and_moved():
    network = net("catenoid", 12)
    turn = np.array([[0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.8, 0.0, 0.6]])
    moved = replace(
        network,
        node_points=network.node_points @ turn.T + 7.0,
        node_normals=network.node_normals @ turn.T,
    )
    direction = np.array([0.3, -0.5, -0.8])
    for keys in ({"per": "plan"}, {"per": "true"}):
        here = load(network, kind="area", value=300.0, direction=tuple(direction), **keys)
        there = load(moved, kind="area", value=300.0, direction=tuple(turn @ direction), **keys)
        assert there.node_forces == pytest.approx(here.node_forces @ turn.T, rel=1e-12, abs=1e-11)


def test_masses_of_hardware_go_to_the_nearest_nodes_and_halfway_to_both():
    network = net("catenoid", 12)
    points = network.node_points
    a, b = network.stop_nodes[:2]
    places = np.array([points[5] + 1e-3, (points[a] + points[b]) / 2])
    frames = np.tile(np.eye(3), (2, 1, 1))
    bolt = Item("bolt-1", "bolt", "", "steel", 1000.0, (_Cube(0.002),), Places(places, frames, ("", "")))
    cable = replace(bolt, kind="cable")
    masses = hardware_masses(network, Hardware((bolt, cable)))
    assert masses.sum() == pytest.approx(4.0)
    assert masses[5] == pytest.approx(2.0)
    assert masses[[a, b]] == pytest.approx(1.0)


def test_a_bar_along_a_lamella_weighs_on_each_node_by_its_share():
    """A bar along a whole ruling of a helicoid: half of the cells beside each node, as the lever has it."""
    network = lamella.net(lamella.Helicoid(4.0, 0.3, 1.5, 0.7), cells=6)
    straight = np.flatnonzero(np.abs(network.sample_darboux.kg[network.sample_offsets[:-1]]) < 1e-9)
    k = int(straight[0])
    own = slice(network.stop_offsets[k], network.stop_offsets[k + 1])
    nodes, arcs = network.stop_nodes[own], network.stop_arclengths[own]
    middle = network.node_points[nodes].mean(axis=0)
    ends = network.node_points[nodes[[0, -1]]] - middle
    bar = Sweep(rectangle(0.05, 0.02), ends, np.tile(network.node_normals[nodes[0]], (2, 1)))
    places = Places(middle[None], np.eye(3)[None], ("",))
    item = Item("edge-1", "edge_beam", "", "steel", 7850.0, (bar,), places, length=bar.length)
    masses = hardware_masses(network, Hardware((item,)))
    edges = np.diff(arcs)
    assert len(edges) > 3
    share = (np.append(0, edges) + np.append(edges, 0)) / 2
    assert masses.sum() == pytest.approx(7850 * 0.001 * bar.length, rel=1e-12)
    # pieces of a sixteenth of a cell go to one side or the other
    np.testing.assert_allclose(
        masses[nodes], 7850 * 0.001 * share, atol=7850 * 0.001 * np.median(network.cell_edges) / 16
    )


class _Cube:
    def __init__(self, volume):
        self.volume = volume
