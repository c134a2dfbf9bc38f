"""How a load is carried: a rod that is pulled is a shell, one that is bent on edge a grillage."""

from dataclasses import replace

import numpy as np
import pytest

from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.actions.sliding_feet import sliding_feet
from lamella.structure.analysis.load_shares import LoadShares
from lamella.structure.cables import make_cables
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest, loaded
from structure.strips import rod, strip


@pytest.mark.parametrize(
    ("force", "shares"),
    [((1e3, 0, 0), (1, 0, 0)), ((0, 0, 1e-3), (0, 1, 0)), ((0, 1e-3, 0), (0, 0, 1)), ((0, 0, 0), (0, 0, 0))],
)
def test_one_kind_alone(force, shares):
    beam = strip(4, 1.0, rod(), {0: "all"})
    start = at_rest(beam, make_loads(beam, forces={4: (*force, 0, 0, 0)}))
    found = LoadShares.of(start, loaded(start))
    assert np.allclose((found.axial, found.upright, found.other), shares, atol=1e-6)


def test_cable_beside_a_cantilever():
    """Springs k (the beam, upright) and c (a cable along z) side by side: energy in proportion c to k."""
    beam = strip(8, 1.0, rod(about_u=100.0), {0: "all"})
    points = np.concatenate((beam.poses.points, [[1.0, 0, 3.0]]))
    frames = np.concatenate((beam.poses.frames, np.eye(3)[None]))
    poses = replace(beam.poses, points=points, frames=frames)
    held = np.concatenate((beam.held, np.ones((1, 6), bool)))
    cables = make_cables(poses, [[8, 9]], 3 * 200.0, prestress=1e-2)
    both = replace(beam, poses=poses, held=held, cables=cables)
    start = at_rest(both, make_loads(both, forces={8: (0, 0, -1e-3, 0, 0, 0)}))
    found = LoadShares.of(start, loaded(start))
    assert found.axial == pytest.approx(200 / (200 + 300), rel=1e-3)
    assert found.axial + found.upright + found.other == pytest.approx(1, abs=1e-12)


def test_sliding_feet():
    """Upwards alone, three restraints in plan, which is what a plane body has freedoms."""
    fixed, springs = np.zeros((5, 6), bool), np.zeros((5, 6))
    fixed[[0, 2, 3], :3] = True
    fixed[3, 3] = True
    springs[4, :3] = 1e5
    points = np.array([[0, 0, 0], [9, 9, 9], [4, 0.1, 0], [1, 0, 0], [0, 3, 0.0]])
    found = sliding_feet(NodeSupports(fixed, springs), points)
    assert found.fixed[:, 2].tolist() == [True, False, True, True, False]
    assert found.springs[4].tolist() == [0, 0, 1e5, 0, 0, 0]
    assert found.fixed[:, :2].tolist() == [[True, True], [False, False], [False, True], [False, False], [False, False]]
    assert found.fixed[3, 3]
