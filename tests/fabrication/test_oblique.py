"""Slots of lamellas that do not cross at right angles, against lines and strips laid across each other in a plane."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import Catenoid
from lamella.base.material import MATERIALS
from lamella.fabrication.part import Parts
from lamella.fabrication.parts import make_parts
from lamella.network.network import REGULAR, Network
from lamella.strip.lamellas import Section, make_lamellas

SECTION = Section(height=0.04, thickness=0.001, layers=2, offset=0.012)
SLOT = 0.002


def parts_of(wanted: float | None) -> tuple[Network, Parts]:
    network = lamella.net(Catenoid(1.0, (-0.5, 0.8)), cells=16, normal_curvature=wanted)
    material = MATERIALS["1.4301"]
    parts = make_parts(
        network, make_lamellas(network, SECTION, material), density=material.density, slot_width=SLOT, sheet=(12.0, 2.0)
    )
    return network, parts


def test_slots_lie_where_the_layers_cross() -> None:
    network, parts = parts_of(0.25)
    assert network.node_angles.min() < 80
    owner, node = network.stop_owner, network.stop_nodes
    tangents = network.sample_tangents[network.sample_offsets[owner] + network.stop_samples]
    offsets = SECTION.layer_offsets
    named = {part.id: part for part in parts.parts}
    checked = 0
    for stop in np.flatnonzero(network.node_kinds[node] == REGULAR).tolist():
        (partner,) = [k for k in np.flatnonzero(node == node[stop]).tolist() if k != stop]
        normal = network.node_normals[node[stop]]
        t, other = tangents[stop], tangents[partner]
        frame = np.stack([t, np.cross(normal, t)])
        for layer, own in enumerate(offsets.tolist()):
            crossings = []
            for across in offsets.tolist():
                # own u + x t = across u' + y t', in the tangent plane
                u, v = frame @ np.cross(normal, t), frame @ np.cross(normal, other)
                x, _ = np.linalg.solve(np.column_stack([frame @ t, -frame @ other]), across * v - own * u)
                crossings.append(network.stop_arclengths[stop] + x)
            part = named[f"{network.ids[owner[stop]]}-{layer + 1}"]
            for crossing in crossings:
                assert np.abs(part.slots - crossing).min() < 1e-9
                checked += 1
    assert checked > 500
    assert {part.quantity for part in parts.parts} == {1}


def test_slots_are_wide_enough() -> None:
    """A strip through another one at the angle a covers T / sin a + T / |tan a| of it, and the play over sin a."""
    network, parts = parts_of(0.25)
    angle = np.radians(network.node_angles)
    needed = SECTION.thickness * (1 / np.sin(angle) + 1 / np.abs(np.tan(angle)))
    play = (SLOT - SECTION.thickness) / np.sin(angle)
    assert max(part.slot_width for part in parts.parts) == pytest.approx((needed + play).max(), rel=1e-6)
    assert min(part.slot_width for part in parts.parts) > SLOT
    assert not any(part.slots_left_out for part in parts.parts)


def test_right_angles_need_nothing_of_it() -> None:
    _, parts = parts_of(None)
    assert {part.slot_width for part in parts.parts} == {SLOT}
    assert {part.quantity for part in parts.parts} == {2}
