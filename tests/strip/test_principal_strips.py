"""Strips on principal lines: bent and not twisted, with outlines of varying curvature."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella.strip.principal_strips import principal_strips


def test_strips_on_a_catenoid() -> None:
    """k = -+1 / (c cosh^2 u) along meridian and parallel; kg of parallels is sinh u / (c cosh^2 u), at most 1 / 2 c."""
    c, cells = 2.0, 24
    # whole cells on either side of the neck
    end = c * 2 * np.pi / cells * 5
    net = lamella.net(lamella.Catenoid(c, (-end, end)), cells=cells, kind="principal")
    strips = principal_strips(net)
    assert strips.twist_max < 1e-12
    assert strips.edgewise_max == pytest.approx(1 / c, rel=1e-3)
    assert strips.edgewise_min == pytest.approx(-1 / c, rel=1e-3)
    assert strips.bend_max == pytest.approx(1 / (2 * c), rel=0.02)
    meridians = (net.closed == 0).sum()
    rings = int(net.closed.sum())
    # all meridians are alike, and rings above the neck like those below
    assert strips.different == 1 + (rings + 1) // 2
    assert meridians == cells


def test_lamellas_of_the_same_surface_are_cut_alike_and_twist() -> None:
    surface = lamella.Catenoid(2.0, (-1.5, 1.5))
    net = lamella.net(surface, cells=24)
    assert np.abs(net.sample_darboux.tg).max() == pytest.approx(1 / 2.0, rel=1e-2)
    assert np.abs(net.sample_darboux.kn).max() < 1e-12
