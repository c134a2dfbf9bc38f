"""Lines of a given normal curvature on closed forms of revolution, against Euler's formula."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import Catenoid, Cylinder, Enneper, InputError, Nodoid, Unduloid, compute, parse_project
from lamella.network.lattice.density import choose_density
from lamella.network.network import REGULAR
from lamella.network.pattern import Pattern
from network.lattice.test_trace import _check_combinatorics
from network.test_pattern import inner, same_points

LEANING = [
    (Unduloid(0.6, 1.4, (-0.4, 0.5)), 0.0),
    (Unduloid(0.6, 1.4, (-0.4, 1.3)), 0.7),
    (Nodoid(1.0, 4.0, (-0.5, 0.4)), 0.0),
    (Catenoid(1.0, (-0.5, 0.8)), -0.3),
    (Cylinder(1.0, (0.0, 3.0)), 0.3),
]


@pytest.mark.parametrize(("surface", "wanted"), LEANING)
def test_lines_of_a_given_normal_curvature(surface: Any, wanted: float) -> None:
    """Euler's formula: kn = H + mu^2 cos 2 phi, and the families cross at 2 phi or its supplement."""
    network = lamella.net(surface, cells=24, normal_curvature=wanted, minimum_length=0)
    _check_combinatorics(network, 0)
    assert np.abs(network.sample_darboux.kn - wanted).max() < 1e-14
    nodes = network.node_points[network.node_kinds == REGULAR]
    half = abs(surface.flux) / (nodes[:, 0] ** 2 + nodes[:, 1] ** 2)
    cosine = np.cos(np.radians(network.node_angles))
    assert cosine == pytest.approx(np.abs(wanted - surface.mean_curvature) / half, abs=1e-10)
    # A twists with tg > 0, and tg^2 = (k1 - kn)(kn - k2)
    tg = network.sample_darboux.tg
    here = abs(surface.flux) / (network.sample_points[:, :2] ** 2).sum(1)
    assert tg**2 == pytest.approx(here**2 - (wanted - surface.mean_curvature) ** 2, abs=1e-12)
    assert (np.sign(tg) == np.where(np.repeat(network.families, np.diff(network.sample_offsets)) == "A", 1, -1)).all()
    # every lamella of a family is the first one turned about the axis
    assert np.abs(np.abs(np.array(network.periods[0][1:])) - 24).max() < 1e-9
    lengths = network.lengths
    assert lengths == pytest.approx(np.full(48, lengths[0]), rel=1e-9)


def test_curvatures_of_such_lines_from_their_points_alone() -> None:
    """kn and kg from differences of tangents at equal arcs: of second order in the samples' distance."""
    for surface, wanted in LEANING[:4]:
        misses = []
        for cells in (24, 48):
            n = lamella.net(surface, cells=cells, normal_curvature=wanted, minimum_length=0)
            first, stops = slice(0, n.sample_offsets[1]), n.stop_samples[: n.stop_offsets[1]]
            t, normal, s = n.sample_tangents[first], n.sample_normals[first], n.sample_arclengths[first]
            # inside the pieces between nodes arcs are equal
            inside = np.setdiff1d(np.arange(1, len(s) - 1), stops)
            turning = (t[inside + 1] - t[inside - 1]) / (s[inside + 1] - s[inside - 1])[:, None]
            kg = (turning * np.cross(normal, t)[inside]).sum(1)
            kn = (turning * normal[inside]).sum(1)
            misses.append([np.abs(kg - n.sample_darboux.kg[inside]).max(), np.abs(kn - wanted).max()])
        rate = np.log2(np.array(misses[0]) / misses[1])
        assert rate.min() > 1.8, (surface.kind, misses)


def test_helices_of_the_cylinder() -> None:
    """kn = sin^2(pitch angle) / R: the families cross at twice the angle, all cells are alike."""
    network = lamella.net(Cylinder(1.0, (0.0, 3.0)), cells=24, normal_curvature=0.3)
    pitch = np.degrees(np.arcsin(np.sqrt(0.3)))
    assert network.node_angles == pytest.approx(np.full(len(network.node_angles), 2 * pitch), abs=1e-10)
    whole = network.cell_edges[network.cell_edges > 0.999 * network.cell_edges.max()]
    # half of the angle between neighbours on a circle, over the helix's slope
    assert whole == pytest.approx(np.full(len(whole), np.pi / 24 / np.sqrt(0.3)), rel=1e-9)


def test_at_the_mean_curvature_they_are_the_lamellas() -> None:
    surface = Unduloid(0.6, 1.4, (-0.4, 1.3))
    plain = lamella.net(surface, cells=24)
    same = lamella.net(surface, cells=24, normal_curvature=surface.mean_curvature)
    assert np.array_equal(plain.sample_points, same.sample_points)
    near = lamella.net(surface, cells=24, normal_curvature=surface.mean_curvature + 1e-9)
    same_points(near.node_points, plain.node_points, 1e-7)


def test_spacing_of_such_lines() -> None:
    """The cells are rhombi, and the guess from which the nearest number is looked for knows it."""
    for surface, wanted in LEANING:
        median = float(np.median(lamella.net(surface, cells=40, normal_curvature=wanted).cell_edges))
        assert lamella.net(surface, spacing=median, normal_curvature=wanted).cells == pytest.approx(40, abs=1)
        fine = choose_density(surface, spacing=median / 10, pattern=Pattern(normal_curvature=wanted))
        assert fine.estimated_nodes > 20_000
        assert fine.cells == pytest.approx(400, rel=0.1)


def test_such_lines_with_some_left_out() -> None:
    full = lamella.net(Catenoid(1.0, (-0.5, 0.8)), cells=24, normal_curvature=0.2)
    some = lamella.net(Catenoid(1.0, (-0.5, 0.8)), cells=24, normal_curvature=0.2, every=(2, 1))
    _check_combinatorics(some, 0)
    assert cKDTree(inner(full)).query(inner(some))[0].max() < 1e-12


@pytest.mark.parametrize(
    ("surface", "wanted", "told"),
    [
        (Unduloid(0.6, 1.4, (-1.0, 2.0)), 0.0, "where the surface is widest"),
        (
            Catenoid(1.0, (-0.5, 0.5)),
            0.76,
            r"run from -0.7864 to 0.7864 1/m, and lines have to cross at 20 deg or more",
        ),
        (Enneper(2, 0.9), 5.0, r"no direction of the surface has it, its normal curvatures run from k2 = -2 to k1 = 2"),
    ],
)
def test_normal_curvatures_that_are_refused(surface: Any, wanted: float, told: str) -> None:
    """The catenoid's principal curvatures at the rim: +-1 / cosh(0.5)^2 = 0.7864; Enneper's are 2 in the middle."""
    with pytest.raises(InputError, match=told) as refused:
        lamella.net(surface, cells=24, normal_curvature=wanted)
    assert refused.value.where == "normal_curvature"


def test_the_remedy_of_a_refused_normal_curvature_works() -> None:
    surface = Unduloid(0.6, 1.4, (-1.0, 2.0))
    with pytest.raises(InputError) as refused:
        lamella.net(surface, cells=24, normal_curvature=0.0)
    low, high = re.findall(r"from (\S+) to (\S+) 1/m", refused.value.remedy)[0]
    for value in (float(low), float(high)):
        assert lamella.net(surface, cells=24, normal_curvature=value).node_angles.min() > 20


def test_normal_curvature_in_the_project_file() -> None:
    surface = {"kind": "unduloid", "neck_radius": 0.6, "bulge_radius": 1.4, "height": [-0.4, 0.5]}
    results = compute(parse_project({"surface": surface, "network": {"normal_curvature": 0.0}}))
    # straight strips, though H is not 0
    assert results.surface.mean_curvature == 0.5
    assert {part.curvature for part in results.parts.parts} == {0.0}
    assert results.summary["lamellas"]["development_deviation_max"] < 1e-4
    told = results.summary["network"]
    assert told["normal_curvature"] == 0
    assert told["normal_curvature_deviation_max"] < 1e-14
    # cos = H r^2 / T, T = r_m r_M H: 60 deg where r^2 is half of it
    assert 20 < told["node_angle_min_deg"] < told["node_angle_max_deg"] < 90
    with pytest.raises(InputError, match="are both given"):
        parse_project({"surface": surface, "network": {"normal_curvature": 0.0, "kind": "principal"}})
