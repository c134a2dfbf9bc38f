"""Strip ends that meet beyond the rim: on a cylinder their distance from the rim is known exactly."""

import re

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import Cylinder, Section, find_material
from lamella.fabrication.collisions import _near
from lamella.fabrication.parts import make_parts
from lamella.strip.lamellas import make_lamellas

RADIUS, CELLS = 2.0, 20
# rows of nodes of helices at 45 degrees
ROW = np.pi * RADIUS / CELLS


def warnings(beyond, overhang, layers=1):
    """Warnings of a cylinder whose rim lies so low that strips would cross `beyond` past their rim nodes."""
    network = lamella.net(Cylinder(RADIUS, (0.3 * ROW, 5 * ROW - beyond / np.sqrt(2))), cells=CELLS)
    lamellas = make_lamellas(network, Section(layers=layers, height=0.05), find_material("1.4301"))
    parts = make_parts(network, lamellas, density=7900.0, end_distance=0.02, rim_overhang=overhang)
    return [w for w in parts.warnings if "meet beyond the rim" in w]


@pytest.mark.parametrize(("beyond", "overhang", "pairs"), [(0.02, 0.0195, 0), (0.02, 0.0205, CELLS), (0.05, 0.01, 0)])
def test_single_strips(beyond, overhang, pairs):
    found = warnings(beyond, overhang)
    assert len(found) == (pairs > 0)
    if pairs:
        assert found[0].startswith(f"{pairs} pairs")
        # told by their names, and how short ends have to be: as far as strips cross beyond their rim nodes
        assert re.search(r"\(A\d+ and B\d+, .*\.\.\.\) meet", found[0])
        shorter = re.search(r"end_distance = ([\d.]+) and rim_overhang = ([\d.]+), or move the rim", found[0])
        assert shorter
        assert float(shorter[1]) < 0.02
        assert 0.99 * beyond < float(shorter[2]) < 1.01 * beyond
        assert not warnings(beyond, float(shorter[2]))


def test_outer_layers_meet_earlier():
    """Two layers 25 mm apart reach 12.5 mm further to the side."""
    assert not warnings(0.03, 0.017, layers=2)
    assert warnings(0.03, 0.018, layers=2)


def test_a_crossing_on_the_rim_has_its_slot_and_is_no_collision():
    assert not warnings(0.0, 0.03)


@pytest.mark.parametrize("sizes", [(0, 3), (1, 1), (40, 90)])
def test_pairs_of_ends_are_those_of_a_search_tree(sizes):
    rng = np.random.default_rng(5)
    one, other = (rng.uniform(size=(n, 3)) * [1, 9, 1] for n in sizes)
    for distance in (0.3, 1.0, 20.0):
        expected = cKDTree(one).query_ball_point(other, distance) if len(one) else [()] * len(other)
        pairs = {(i, j) for j, near in enumerate(expected) for i in near}
        first, second = _near(one, other, distance)
        assert len(first) == len(pairs)
        assert set(zip(first.tolist(), second.tolist(), strict=True)) == pairs
