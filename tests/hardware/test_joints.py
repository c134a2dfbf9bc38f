"""Joints of a net: where they are, how many kinds there are, and what cannot be made."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import InputError, Section
from lamella.hardware.cables import cables
from lamella.hardware.diagonals import diagonals
from lamella.hardware.grid_joint import grid_joints
from lamella.hardware.hubs import singular_rays
from lamella.hardware.make_hardware import make_hardware
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import CableRules, JointRules
from lamella.strip.lamellas import crossings
from lamella.strip.layer_map import LayerMap

CATENOID = lamella.Catenoid(2.5, (-2.0, 3.0))


@pytest.fixture(scope="module")
def strips():
    return lamella.net(CATENOID, cells=12).strips()


def test_every_crossing_has_one_joint(strips) -> None:
    network = strips.network
    frames = NodeFrames.of(network)
    assert frames.nodes.tolist() == np.flatnonzero(crossings(network)).tolist()
    assert np.degrees(frames.angles) == pytest.approx(90, abs=1e-6)
    made = {item.kind: item for item in grid_joints(frames, strips, JointRules()).items}
    assert {kind: item.quantity for kind, item in made.items()} == {
        "washer": 2 * len(frames),
        "key": 2 * len(frames),
        "bolt": len(frames),
        "nut": len(frames),
    }
    # the bolt stands on the node's axis
    off = made["bolt"].places.origins - network.node_points[frames.nodes]
    normal = network.node_normals[frames.nodes]
    assert np.abs(np.cross(off, normal)).max() < 1e-12


@pytest.mark.parametrize("surface", [CATENOID, lamella.Unduloid(1.0, 1.6, (-1.0, 1.0))], ids=["catenoid", "unduloid"])
def test_the_surface_around_a_node_to_third_order(surface) -> None:
    network = lamella.net(surface, cells=12)
    frames = NodeFrames.of(network)
    # along the B lamella, which the A lamella's curvatures say nothing of but for kn, tg and H
    owner = network.stop_owner[frames.stop_b]
    sample = network.sample_offsets[owner] + network.stop_samples[frames.stop_b]
    inner = (network.stop_samples[frames.stop_b] >= 4) & (sample + 4 < network.sample_offsets[owner + 1])
    errors = []
    for steps in (4, 2, 1):
        local = np.einsum(
            "qij,qj->qi", frames.axes, network.sample_points[np.where(inner, sample + steps, sample)] - frames.origins
        )
        height = frames.height(local[:, :1], local[:, 1:2])[:, 0]
        errors.append(np.abs(height - local[:, 2])[inner].max())
    assert np.log2(errors[0] / errors[1]) > 2.7
    assert np.log2(errors[1] / errors[2]) > 2.7


def test_washers_lie_on_the_strips_and_not_in_them(strips) -> None:
    # the plane of the washer's lower face against the upper edges of all four strips below it
    network = strips.network
    frames = NodeFrames.of(network)
    rules = JointRules()
    length = rules.star_length(strips.section, frames.least_angle)
    (washer,) = [item for item in grid_joints(frames, strips, rules).items if item.kind == "washer"]
    half = strips.section.height / 2
    for q in range(0, len(frames), 7):
        seat = (washer.places.origins[q] - frames.origins[q]) @ frames.axes[q, 2]
        heights = []
        for stop in (frames.stop_a[q], frames.stop_b[q]):
            at = network.stop_arclengths[stop] + np.linspace(-length / 2, length / 2, 41)
            for row in range(2):
                faces = LayerMap.of(strips, int(network.stop_owner[stop]), row, by_arclength=True).surfaces(
                    at, np.full(41, half), strips.section.thickness
                )
                heights += [(face - frames.origins[q]) @ frames.axes[q, 2] for face in faces]
        assert seat >= np.max(heights) - 1e-6
        assert seat < np.max(heights) + 2e-4


def test_oblique_nets_have_washers_of_their_angles() -> None:
    strips = lamella.net(lamella.Nodoid(1.0, 3.0, (-0.5, 0.5)), cells=14, normal_curvature=0.0).strips(
        Section(0.06, 0.001, 2, 0.02)
    )
    frames = NodeFrames.of(strips.network)
    made = grid_joints(frames, strips, JointRules(washer_thickness=0.003)).items
    washers = [item for item in made if item.kind == "washer"]
    angles = np.degrees(frames.angles)
    assert len(washers) > 1
    assert sum(item.quantity for item in washers) == 2 * len(frames)
    for item in washers:
        angle = float(item.description.split(", ")[1].split()[0])
        nodes = [int(label.split()[1]) for label in item.places.labels]
        at = np.searchsorted(frames.nodes, nodes)
        assert np.abs(angles[at] - angle).max() <= 0.5


@pytest.mark.parametrize(
    ("section", "rules", "where"),
    [
        (Section(0.1, 0.0015, layers=1), JointRules(), ""),
        (Section(0.1, 0.0015, layers=3), JointRules(), ""),
        (Section(0.1, 0.0015, offset=0.008), JointRules(), "bolt"),
        (Section(0.1, 0.0015), JointRules(washer_length=1.5), "washer_length"),
        (Section(0.1, 0.0015), JointRules(washer_length=0.03), "washer_length"),
        (Section(0.1, 0.0015), JointRules(washer_thickness=0.06), "washer_thickness"),
        (Section(0.1, 0.0015), JointRules(bolt=0.007), "bolt"),
        (Section(0.1, 0.0015), JointRules(block_spacing=0.02), "block_spacing"),
        (Section(0.1, 0.0015), JointRules(block_bolt=0.016), "block_bolt"),
    ],
)
def test_bad_measures_are_refused_with_their_limit(section: Section, rules: JointRules, where: str) -> None:
    strips = lamella.net(CATENOID, cells=12).strips(section)
    with pytest.raises(InputError) as refused:
        make_hardware(strips, strips.parts(), rules)
    assert refused.value.where == where
    assert refused.value.remedy


def test_a_hub_that_reaches_the_first_crossing_is_refused() -> None:
    strips = lamella.net(lamella.Enneper(3, 0.8, 0.5), cells=16).strips(Section(0.06, 0.001, 2, 0.02))
    for radius, reason in ((0.02, "plates"), (0.03, "next joint")):
        with pytest.raises(InputError, match=reason) as refused:
            make_hardware(strips, strips.parts(hub_radius=radius), JointRules(washer=False))
        assert refused.value.where == "hub"


def test_rays_of_a_hub_are_in_order_and_at_their_own_angles() -> None:
    strips = lamella.net(lamella.Enneper(4, 0.8, 3.0), cells=10).strips()
    (rays,) = singular_rays(strips)
    network = strips.network
    assert len(rays.lamellas) == 8
    normal = network.node_normals[rays.node]
    following = np.roll(rays.directions, -1, axis=0)
    turn = np.arctan2(
        np.einsum("ij,j->i", np.cross(rays.directions, following), normal), (rays.directions * following).sum(1)
    )
    assert np.degrees(turn) == pytest.approx(45, abs=1e-6)
    # families alternate
    assert (network.families[rays.lamellas] != np.roll(network.families[rays.lamellas], 1)).all()


def test_holes_lie_where_the_blocks_are_and_take_their_area(strips) -> None:
    parts = strips.parts()
    made = make_hardware(strips, parts, JointRules(block_spacing=0.4))
    holes = sum(len(part.holes) * part.quantity for part in made.parts.parts)
    blocks = sum(item.quantity for item in made.hardware.of("block"))
    assert holes == 2 * blocks > 0
    for before, after in zip(parts.parts, made.parts.parts, strict=True):
        area = np.pi / 4 * np.sum(after.holes[:, 2] ** 2)
        assert before.area - after.area == pytest.approx(area, abs=1e-12)
        assert after.mass / before.mass == pytest.approx(after.area / before.area, rel=1e-12)
        if len(after.holes):
            # at most that far from each other within a cell, and clear of the slots
            away = np.abs(after.holes[:, :1] - after.slots)
            assert away.min() > 0.015


def test_cables_run_along_every_second_diagonal() -> None:
    # on a catenoid the diagonals are parallels and meridians: 12 cells of each family make 24 meridians
    strips = lamella.net(CATENOID, cells=12).strips()
    network, frames = strips.network, NodeFrames.of(strips.network)
    for every, meridians in ((1, 24), (2, 12)):
        lines = diagonals(network, frames, every)
        angle = [np.unwrap(np.arctan2(*network.node_points[line.nodes, 1::-1].T)) for line in lines]
        upright = [np.ptp(a) < 1e-9 for a in angle]
        assert sum(upright) == meridians
        rings = [line for line, straight in zip(lines, upright, strict=True) if not straight]
        assert all(line.closed and np.ptp(network.node_points[line.nodes, 2]) < 1e-9 for line in rings)
        # the two kinds
        assert len({line.first for line in rings}) == 1


def test_cables_are_cut_to_their_way_less_turnbuckle_and_stretch(strips) -> None:
    frames = NodeFrames.of(strips.network)
    rules, top = JointRules(), np.full(len(frames), 0.06)
    made = {}
    for force in (0.0, 5000.0):
        measures = CableRules(every=2, diameter=0.008, prestress=force, turnbuckle=0.3)
        made[force] = cables(strips.network, frames, strips.section, top, rules, measures)
        (clamp,) = [item for item in made[force].items if item.kind == "clamp"]
        # clamps on every node a line goes through, each once
        on = {node for line in diagonals(strips.network, frames, 2) for node in line.nodes.tolist()}
        assert sorted(clamp.places.labels) == sorted(f"node {node}" for node in on)
    slack, tight = ([item for item in made[force].items if item.kind == "cable"] for force in (0.0, 5000.0))
    assert len(slack) == 2 * len(diagonals(strips.network, frames, 2))
    strain = 5000.0 / (130e9 * 0.57 * np.pi / 4 * 0.008**2)
    for one, other in zip(slack, tight, strict=True):
        way = one.shape[0].length
        assert one.length == pytest.approx(way - 0.3 + 2 * 0.05, rel=1e-12)
        assert other.length == pytest.approx((way - 0.3) / (1 + strain) + 2 * 0.05, rel=1e-12)
    with pytest.raises(InputError) as refused:
        cables(strips.network, frames, strips.section, top, rules, CableRules(diameter=0.002, prestress=1e5))
    assert refused.value.where == "prestress"


def test_a_splice_with_a_slot_beside_it_is_refused() -> None:
    strips = lamella.net(lamella.Cylinder(1.0, (0.0, 2.0)), cells=44).strips(Section(0.05, 0.001, 2, 0.02))
    rules = JointRules(washer=False, block_spacing=0, block_bolt=0.005)
    with pytest.raises(InputError, match="next slot") as refused:
        make_hardware(strips, strips.parts(sheet=(1.2, 1.0)), rules)
    assert refused.value.where == "splice"
    # where the gap is too narrow for plates and heads
    strips = lamella.net(lamella.Cylinder(1.0, (0.0, 2.0)), cells=8).strips(Section(0.05, 0.001, 2, 0.012))
    with pytest.raises(InputError) as refused:
        make_hardware(strips, strips.parts(sheet=(1.2, 1.0)), JointRules(washer=False, block_spacing=0))
    assert refused.value.where == "splice_thickness"
