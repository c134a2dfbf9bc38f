"""Normal curvature of written centre lines, from their points alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lamella import Catenoid, Unduloid, make_network
from lamella.network.sampled_bend import sampled_bend


@pytest.mark.parametrize("surface", [Catenoid(1.0, (-1.0, 1.2)), Unduloid(0.6, 1.2, (-1.6, 2.0))])
def test_smooth_lines_bend_with_the_mean_curvature(surface) -> None:
    """kn = H on every lamella; open and closed ones. Sixteen samples a cell: the rest falls with the fourth power."""
    errors = []
    for cells in (10, 20):
        network = make_network(surface, cells=cells)
        errors.append(np.abs(sampled_bend(network) - surface.mean_curvature).max())
    assert errors[0] > 10 * errors[1]
    assert errors[1] < 1e-6


def test_a_kink_reads_as_curvature_beside_it() -> None:
    """A centre line that turns by a small angle at a place: from 0.5 to 1.2 of the angle over the samples' distance."""
    network = make_network(Catenoid(1.0, (-1.0, 1.2)), cells=12)
    angle = 1e-3
    first, last = network.sample_offsets[:2]
    arc = network.sample_arclengths[first:last]
    for share in (0.0, 0.25, 0.5, 0.75):
        k = len(arc) // 2
        step = arc[k + 1] - arc[k]
        at = arc[k] + share * step
        points = network.sample_points.copy()
        lift = angle / 2 * np.abs(arc - at)
        points[first:last] += lift[:, None] * network.sample_normals[first:last]
        read = np.abs(sampled_bend(replace(network, sample_points=points))).max() * step / angle
        assert 0.5 < read < 1.25, (share, read)
