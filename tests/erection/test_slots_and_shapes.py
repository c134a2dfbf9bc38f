"""Slots that joints turn in, planes and spheres through points, crossings beside nodes."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.erection.flatness import fitted_plane, fitted_sphere
from lamella.erection.joint_angles import twist_over_depth
from lamella.erection.overlaps import crossings_beside_nodes
from lamella.erection.slot_room import largest_turn, slot_width_needed
from lamella.strip.lamellas import crossings

SEED = 5


@pytest.mark.parametrize(("degrees", "ratio"), [(15, 1.30), (30, 1.73), (36.87, 2.00), (45, 2.41)])
def test_slot_width(degrees: float, ratio: float) -> None:
    """w / t = (1 + sin a) / cos a, and the turn that a slot allows is its inverse."""
    angle = np.radians(degrees)
    width = float(slot_width_needed(-angle, 0.0015))
    assert width / 0.0015 == pytest.approx(ratio, abs=0.005)
    assert width / 0.0015 == pytest.approx((1 + np.sin(angle)) / np.cos(angle), rel=1e-14)
    assert largest_turn(width, 0.0015) == pytest.approx(angle, rel=1e-12)


def test_slot_narrower_than_the_strip() -> None:
    with pytest.raises(InputError) as caught:
        largest_turn(0.001, 0.0015)
    assert caught.value.where == "slot_width"


def test_turned_rectangle_in_its_slot() -> None:
    """A long rectangle turned by a touches both sides of a slot of that width: its extent measured on corners."""
    thickness, depth, angle = 0.002, 0.002, np.radians(25)
    # the strip passes through another of the same thickness: within its depth the slot has to hold the strip's faces
    along, normal = np.array([np.sin(angle), np.cos(angle)]), np.array([np.cos(angle), -np.sin(angle)])
    x = []
    for face in (-0.5, 0.5):
        for side in (-0.5, 0.5):
            # where the face crosses the plane y = side * depth
            at = face * thickness * normal
            x.append(at[0] + (side * depth - at[1]) / along[1] * along[0])
    assert np.ptp(x) == pytest.approx(float(slot_width_needed(angle, thickness)), rel=1e-12)


def test_plane_and_sphere() -> None:
    """Points moved and turned at random: the plane's height and the sphere's radius are kept."""
    rng = np.random.default_rng(SEED)
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    flat = np.column_stack((rng.uniform(-3, 3, 50), rng.uniform(-1, 1, 50), np.zeros(50)))
    flat[0, 2] = 1e-3
    plane = fitted_plane(flat @ turn.T + [5, 6, 7])
    assert plane.height == pytest.approx(1e-3, rel=0.05)
    assert np.linalg.det(plane.axes) == pytest.approx(1)
    directions = rng.standard_normal((40, 3))
    ball = 4 * directions / np.linalg.norm(directions, axis=1)[:, None] + [1, 2, 3]
    sphere = fitted_sphere(ball)
    np.testing.assert_allclose(sphere.centre, [1, 2, 3], rtol=1e-12)
    assert sphere.radius == pytest.approx(4, rel=1e-13)
    assert sphere.deviation < 1e-12
    with pytest.raises(InputError):
        fitted_sphere(np.column_stack((flat[:, :2], np.zeros(50))))
    with pytest.raises(InputError):
        fitted_plane(flat[:2])


def test_plane_looks_to_the_normals_side() -> None:
    points = np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0], [2, 1, 0]])
    for up in (1.0, -1.0):
        plane = fitted_plane(points, np.tile([0.0, 0, up], (4, 1)))
        np.testing.assert_allclose(plane.axes[2], [0, 0, up], atol=1e-15)
        assert np.linalg.det(plane.axes) == pytest.approx(1)


def test_crossings_beside_nodes() -> None:
    """Random segments: the crossings of brute force, but for those with a node in common."""
    rng = np.random.default_rng(SEED)
    ends = rng.uniform(0, 1, (60, 2, 2))
    nodes = rng.integers(0, 40, (60, 2))
    pairs, places = crossings_beside_nodes(ends, nodes)
    found = {tuple(pair) for pair in pairs.tolist()}
    expected = set()
    for i in range(60):
        for j in range(i + 1, 60):
            system = np.column_stack((ends[i, 1] - ends[i, 0], ends[j, 0] - ends[j, 1]))
            s, t = np.linalg.solve(system, ends[j, 0] - ends[i, 0])
            if 0 <= s <= 1 and 0 <= t <= 1 and not set(nodes[i].tolist()) & set(nodes[j].tolist()):
                expected.add((i, j))
    assert found == expected
    assert len(expected) > 50
    for (i, _), place in zip(pairs.tolist(), places, strict=True):
        along = (place - ends[i, 0]) @ (ends[i, 1] - ends[i, 0]) / np.sum((ends[i, 1] - ends[i, 0]) ** 2)
        np.testing.assert_allclose(ends[i, 0] + along * (ends[i, 1] - ends[i, 0]), place, atol=1e-12)


def test_twist_turns_strips_at_the_foot_of_a_slot() -> None:
    """Lines of two twisted strips at a depth, by differences of points on the helicoid's normals."""
    network = lamella.net(lamella.Helicoid(4.0, 0.3, 1.5, 0.7), cells=6)
    nodes, depth = np.flatnonzero(crossings(network)), 0.05
    sample = network.sample_offsets[network.stop_owner] + network.stop_samples
    least = np.zeros(len(nodes))
    for z in (-depth, depth):
        lines = {}
        for family in "AB":
            stops = [
                int(np.flatnonzero((network.stop_nodes == node) & (network.families[network.stop_owner] == family))[0])
                for node in nodes
            ]
            at = sample[stops]
            frame = network.sample_tangents[at], network.sample_normals[at]
            kn, tg = (getattr(network.sample_darboux, key)[at][:, None] for key in ("kn", "tg"))
            # a step along c(s) + z n(s), with n' = -kn t - tg u and u = n x t
            step = frame[0] - z * (kn * frame[0] + tg * np.cross(frame[1], frame[0]))
            lines[family] = step / np.linalg.norm(step, axis=1)[:, None]
        # square at the surface: what is left of the cosine is the turn
        least = np.maximum(least, np.abs(np.arcsin((lines["A"] * lines["B"]).sum(1))))
    turned = twist_over_depth(network, nodes, depth)
    np.testing.assert_allclose(turned, least, rtol=1e-9, atol=1e-12)
    # both turn by atan(z |tg|), to opposite sides
    torsion = np.abs(network.sample_darboux.tg).max()
    assert turned.max() <= 2 * np.arctan(depth * torsion) * (1 + 1e-9)
    assert turned.max() > np.arctan(depth * torsion)
