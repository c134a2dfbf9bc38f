"""Segments: patches within their limits, each part in one of them, lifted around its centre of gravity."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.fabrication.parts import make_parts
from lamella.hardware.item import Hardware
from lamella.hardware.make_hardware import make_hardware
from lamella.hardware.rules import JointRules
from lamella.segments.make_segments import Divided, make_segments
from lamella.segments.partition import Graph, Limits, extent, partition
from lamella.segments.weights import Weights

CATENOID = lamella.Catenoid(2.5, (-2.0, 3.0))


def divided(surface, limits: Limits, *, joined: bool, cells: int = 12) -> tuple[lamella.Lamellas, Divided]:
    strips = lamella.net(surface, cells=cells).strips()

    def make(borders):
        parts = make_parts(strips.network, strips, density=7900.0, borders=borders)
        if not joined:
            return parts, Hardware()
        made = make_hardware(strips, parts, JointRules())
        return made.parts, made.hardware

    return strips, make_segments(strips, limits, make)


def check(strips, made: Divided, limits: Limits) -> None:
    network, segments = strips.network, made.segments
    # everything is in one segment, once
    assert segments.mass == pytest.approx(made.parts.mass + made.hardware.mass, rel=1e-12)
    assert sorted(np.concatenate([one.parts for one in segments.segments]).tolist()) == list(
        range(len(made.parts.parts))
    )
    assert sorted(np.concatenate([one.nodes for one in segments.segments]).tolist()) == list(
        range(len(segments.of_node))
    )
    for one in segments.segments:
        assert one.mass <= limits.mass * (1 + 1e-9)
        assert one.size <= limits.size * (1 + 1e-9)
        if not len(one.lifting):
            # told, and true: no three of its nodes surround the centre
            flat = network.node_points[one.nodes, :2] - one.centre[:2]
            turns = np.sort(np.arctan2(flat[:, 1], flat[:, 0]))
            assert np.diff(np.append(turns, turns[0] + 2 * np.pi)).max() > np.pi - 1e-6
            assert [warning.key for warning in segments.warnings] == ["segments_lifting"]
            continue
        assert one.shares.sum() == pytest.approx(1)
        assert one.shares.min() > 0
        lifted = one.shares @ network.node_points[one.lifting]
        assert lifted[:2] == pytest.approx(one.centre[:2], abs=1e-9)
        assert set(one.lifting.tolist()) <= set(one.nodes.tolist())
    # connected: as many trees as segments, by union of the cells that are not cut
    root = list(range(len(segments.of_node)))

    def find(k: int) -> int:
        while root[k] != k:
            k = root[k]
        return k

    cut = 0
    for lamella_, cells in enumerate(segments.borders):
        stops = network.stop_nodes[network.stop_offsets[lamella_] : network.stop_offsets[lamella_ + 1]]
        for cell, (a, b) in enumerate(zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True)):
            same = segments.of_node[a] == segments.of_node[b]
            assert same == (cell not in cells)
            cut += not same
            if same:
                root[find(a)] = find(b)
    assert len({find(k) for k in range(len(root))}) == len(segments.segments)
    # a joint for every cut cell and kind of strip, in the middle of the cell
    kinds = 1 if not strips.section.own_parts else strips.section.layers
    assert len(segments.joints) == cut * kinds
    for joint in segments.joints:
        one, other = (made.parts.parts[k] for k in joint.parts)
        assert one.end == pytest.approx(other.start) or network.closed[joint.lamella]
    # each part's nodes are in its segment
    for k, part in enumerate(made.parts.parts):
        begin = int(network.stop_offsets[part.lamella]) + part.first_node
        nodes = network.stop_nodes[begin : begin + len(part.nodes)]
        assert set(segments.of_node[nodes].tolist()) == {int(segments.of_part[k])}


def test_segments_by_mass_with_what_is_bolted() -> None:
    limits = Limits(mass=150.0)
    strips, made = divided(CATENOID, limits, joined=True)
    check(strips, made, limits)
    # the least number by mass, and not twice as many
    least = int(np.ceil(made.segments.mass / 150.0))
    assert least <= len(made.segments.segments) < 2 * least


def test_segments_by_size_around_a_singular_node() -> None:
    limits = Limits(size=2.5)
    strips, made = divided(lamella.Enneper(3, 0.8, 3.0), limits, joined=False, cells=8)
    check(strips, made, limits)


def test_a_structure_light_enough_is_one_segment() -> None:
    _, made = divided(CATENOID, Limits(mass=1e4, size=100.0), joined=False)
    assert len(made.segments.segments) == 1
    assert not made.segments.joints
    # of revolution: the centre is on the axis, to what samples allow
    assert np.abs(made.segments.segments[0].centre[:2]).max() < 1e-9


def test_the_centre_of_a_straight_strip_is_its_middle() -> None:
    # one family of a helicoid are its rulings
    strips = lamella.net(lamella.Helicoid(2.0, 0.5, 2.0, 0.5), cells=8).strips()
    network = strips.network
    parts = make_parts(network, strips, density=7900.0)
    weights = Weights.of(parts, Hardware(), strips)
    straight = 0
    for k, part in enumerate(parts.parts):
        first, last = network.sample_offsets[part.lamella], network.sample_offsets[part.lamella + 1] - 1
        if np.abs(network.sample_darboux.kg[first : last + 1]).max() > 1e-9:
            continue
        straight += 1
        begin, along = network.sample_points[first], network.sample_tangents[first]
        assert weights.part_centres[k] == pytest.approx(begin + 0.5 * (part.start + part.end) * along, abs=1e-9)
    assert straight > 3


def test_what_goes_with_nodes_is_all_there_is() -> None:
    strips = lamella.net(CATENOID, cells=8).strips()
    parts = make_parts(strips.network, strips, density=7900.0)
    weights = Weights.of(parts, Hardware(), strips)
    assert weights.nodes.sum() == pytest.approx(parts.mass, rel=1e-12)
    # scaled by a thousand the patches are the same
    graph = Graph.of(strips.network, weights.nodes)
    large = Graph(
        graph.ends, graph.lamellas, graph.cells, 1e9 * graph.masses, 1e3 * graph.points, 1e3 * graph.reach, graph.firm
    )
    mass = parts.mass / 5
    assert np.array_equal(partition(graph, Limits(mass)), partition(large, Limits(1e9 * mass)))
    size = extent(graph, np.ones(len(graph.masses), bool)) / 3
    assert np.array_equal(partition(graph, Limits(size=size)), partition(large, Limits(size=1e3 * size)))


@pytest.mark.parametrize(("limits", "where"), [(Limits(mass=0.5), "mass"), (Limits(size=0.2), "size")])
def test_limits_below_what_goes_with_a_node_are_refused(limits: Limits, where: str) -> None:
    with pytest.raises(InputError) as refused:
        divided(CATENOID, limits, joined=False, cells=8)
    assert refused.value.where == where
    limit = float(refused.value.remedy.split(f"{where} = ")[1].split()[0])
    at_it = Limits(mass=limit) if where == "mass" else Limits(size=limit)
    _, made = divided(CATENOID, at_it, joined=False, cells=8)
    assert len(made.segments.segments) > 20
