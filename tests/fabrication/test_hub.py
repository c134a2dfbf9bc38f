"""Strips around a singular node keep clear of each other."""

import numpy as np
import pytest

import lamella
from lamella import Enneper, Section, find_material
from lamella.fabrication.parts import make_parts
from lamella.network.network import SINGULAR
from lamella.strip.lamellas import make_lamellas


def _ends(order, **options):
    """Plan of the strips' ends around the hub: corners of every layer's rectangle nearest to the node, (rays, 4, 2)."""
    network = lamella.net(Enneper(order, 0.8, 6.0), cells=12)
    section = Section(layers=2, offset=0.03, thickness=0.002, height=0.06)
    lamellas = make_lamellas(network, section, find_material("1.4301"))
    parts = make_parts(network, lamellas, density=7900.0, **options)
    (node,) = np.flatnonzero(network.node_kinds == SINGULAR)
    owners = network.stop_owner[network.stop_nodes == node]
    first = {part.lamella: part.start for part in reversed(parts.parts)}
    layers = []
    for owner in owners:
        t = network.sample_tangents[network.sample_offsets[owner]][:2]
        sideways = np.array([-t[1], t[0]])
        reach = first[owner]
        for side in (-0.015, 0.015):
            layers.append([reach * t + (side + half) * sideways for half in (-0.001, 0.001)])
    return np.array(layers), parts


def _gap(ends):
    """Least distance between end faces of different rays, sampled."""
    t = np.linspace(0, 1, 21)[:, None]
    lines = np.array([a + t * (b - a) for a, b in ends])
    gaps = [
        np.linalg.norm(lines[i][:, None] - lines[j][None], axis=2).min()
        for i in range(len(lines))
        for j in range(i)
        if i // 2 != j // 2
    ]
    return min(gaps)


@pytest.mark.parametrize("order", [3, 4, 7])
def test_default_hub_keeps_the_layers_of_all_rays_apart(order):
    ends, parts = _ends(order)
    assert len(ends) == 4 * order
    assert _gap(ends) > 0.0005
    assert not any("singular node" in w for w in parts.warnings)


def test_a_hub_too_small_is_warned_about():
    ends, parts = _ends(5, hub_radius=0.03)
    # the outer layer's corner lies beyond the line midway to the next ray
    assert np.arctan2(0.016, 0.03) > np.pi / 10
    assert len(ends) == 20
    (warning,) = [w for w in parts.warnings if "singular node" in w]
    assert "hub_radius is 30 mm" in warning
    assert f"{1e3 * 0.017 / np.tan(np.pi / 10):.1f} mm" in warning


def test_a_hub_beyond_the_first_node_is_cut_back():
    _, parts = _ends(3, hub_radius=5.0)
    (warning,) = [w for w in parts.warnings if "first slots" in w]
    assert "5000.0 mm" in warning
    assert not any("without slots" in w for w in parts.warnings)
    assert all(len(part.slots) >= 2 for part in parts.parts)
