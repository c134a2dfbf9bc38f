"""Networks on films of random boundaries: what holds of every net, whatever the surface.

Issue: every regular node is one A and one B lamella, faces form a disc with holes of the right Euler number, every
singular node has its rays, and lamellas do not cross themselves within a node spacing.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.network.elements.element_network import ElementNetwork, element_network
from lamella.network.network import REGULAR, SEAM, SINGULAR
from lamella.surface.form_finding.find import find_film
from network.elements.random_boundaries import sketch
from network.elements.test_element_network import euler, ruler


def woven(seed: int) -> tuple[str, ElementNetwork | None, int]:
    """What became of a sketch, its net if there is one, and its number of loops."""
    case = sketch(seed)
    refused: InputError | None = None
    try:
        found = find_film(case.loops, case.mean_curvature, tolerance=2e-2, most_nodes=12_000)
    except InputError as error:
        refused = error
    if refused:
        assert refused.remedy, seed
        return "no surface", None, len(case.loops)
    closing = ("open", "round")[seed % 2]
    try:
        net = element_network(found.surface("form-found"), cells=case.cells, closing=closing, minimum_length=0.0)
    except InputError as error:
        refused = error
    if refused:
        # rounding may take more cells than there are between two umbilics
        assert closing == "round", (seed, refused.message)
        assert "folds it near" in refused.message, (seed, refused.message)
        return "folded", None, len(case.loops)
    return closing, net, len(case.loops)


def check(seed: int) -> str:
    told, net, loops = woven(seed)
    if net is None:
        return told
    network = net.network
    a, b = network.node_degrees()
    regular = network.node_kinds == REGULAR
    assert (a[regular] == 1).all(), seed
    assert (b[regular] == 1).all(), seed
    for node in np.flatnonzero(network.node_kinds == SINGULAR):
        zero = int(np.linalg.norm(net.umbilics.position - network.node_points[node], axis=1).argmin())
        rays = int(net.umbilics.orders[zero]) + 2
        # with one of its coordinates half a cell off the lattice it is a node of one family alone
        assert {int(a[node]), int(b[node])} in ({rays}, {0, rays}), (seed, a[node], b[node])
    sides = np.diff(network.face_offsets)
    assert sides.min() >= 3, seed
    assert sides.max() <= 6, seed
    number = euler(network)
    if not (network.node_kinds == SEAM).any():
        # a face that is left out is a hole, or a bite out of the rim
        assert 2 - loops - len(network.faces_left_out) <= number <= 2 - loops, seed
        if not len(network.faces_left_out):
            assert len(np.unique(network.face_nodes)) == len(network.node_points), seed
    if told == "round":
        assert not (network.node_kinds == SEAM).any(), seed
        assert all(joint.closed for joint in net.joints), seed
        assert net.describe()["closed"], seed
        # what is told of loops around holes is told of the rounded net
        counts = [cells for period in network.periods for cells in period[1:]]
        assert np.abs(counts - np.round(counts)).max(initial=0.0) < 1e-9, seed
        # a rounded net goes through every umbilic that is not on the rim
        assert all(umbilic["node"] for umbilic in net.describe()["umbilics"]), seed
    measured = ruler(network)
    assert measured["family_sign_errors"] == 0, seed
    # lamellas turn sharply past umbilics that are no nodes, and are sampled finely there
    assert measured["node_arclength_error_max"] < 2e-5 * measured["cell_edge_median"], seed
    assert measured["node_angle_deviation_max_deg"] < 0.1 + 1.5 * np.abs(network.node_angles - 90).max(), seed
    # no lamella passes one node twice, but where a closed one comes back to its first
    for k in range(len(network.ids)):
        stops = network.stop_nodes[network.stop_offsets[k] : network.stop_offsets[k + 1]]
        inside = stops[:-1] if network.closed[k] else stops
        twice = [node for node, times in Counter(inside.tolist()).items() if times > 1]
        assert all(network.node_kinds[node] == SINGULAR for node in twice), (seed, network.ids[k])
    return told


@pytest.mark.parametrize("seed", [1, 9, pytest.param(24, marks=pytest.mark.slow)])
@pytest.mark.few(1)
def test_random_networks(seed: int) -> None:
    """A random film has a sound net: degrees of nodes, faces, the Euler number, no lamella twice."""
    check(seed)


@pytest.mark.slow
def test_many_random_networks() -> None:
    """What is refused is refused for its reason, and most are not."""
    told = Counter(check(seed) for seed in range(100, 124))
    print(dict(told))
    assert told["open"] + told["round"] >= 16
    assert told["folded"] <= 1
