"""Developable strips along nets: planarity, buildable height, bending, meeting, flat shape, in closed form or by rates.

On the catenoid rho = c cosh u kg = sinh u / (sqrt2 c cosh^2 u), tg = 1 / (c cosh^2 u), kn = 0, ds = sqrt2 c cosh u du
(Schling et al. 2018, section 2): L = sqrt2 / sinh u, L' = -1 / (c sinh^2 u), so that a strip half of which stands on
either side exists up to the height 2 c sinh^2 u.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import fsolve

import lamella
from lamella import Section
from lamella.strip.developable_strips import (
    DevelopableStrips,
    developable_strips,
    flat_ends,
    meeting_offsets,
    rulings,
)
from lamella.strip.lamellas import Lamellas

WAIST = 1.2
LIMIT = 5e-4


def catenoid(cells: int = 12, height: float = 0.1) -> tuple[Lamellas, DevelopableStrips]:
    net = lamella.net(lamella.Catenoid(WAIST, (-1.0, 1.5)), cells=cells)
    lamellas = net.strips(Section(height=height, layers=1))
    return lamellas, developable_strips(lamellas)


def test_the_buildable_height_of_a_catenoid_is_its_closed_form_at_second_order() -> None:
    errors = []
    for cells in (12, 24):
        lamellas, strips = catenoid(cells)
        z = lamellas.network.sample_points[:, 2]
        away = np.abs(z) > 0.3
        exact = 2 * WAIST * np.sinh(z[away] / WAIST) ** 2
        errors.append(np.abs(strips.heights[away] / exact - 1).max())
    assert errors[1] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 1.7


@pytest.mark.parametrize(
    "surface",
    [
        lamella.Unduloid(0.6, 1.4, (-0.5, 2.2)),
        lamella.Enneper(3, 0.8, 3.0),
        lamella.Catenoid(WAIST, (-1.0, 1.5)),
        lamella.Helicoid(4.0, 1.0, 3.0, 1.0),
    ],
)
def test_quads_are_planar_wherever_the_strip_can_be_built(surface: lamella.Surface) -> None:
    strips = developable_strips(lamella.net(surface, cells=12).strips(Section(layers=1)))
    scores = strips.planarity[np.isfinite(strips.planarity)]
    assert len(scores) > 100
    assert scores.max() < LIMIT / 10
    assert np.array_equal(strips.exists, strips.heights > 0.1)
    assert not np.isfinite(strips.planarity[~strips.exists]).any()


def test_planarity_falls_with_the_third_power_of_the_distance() -> None:
    score = []
    for cells in (12, 24):
        found = catenoid(cells)[1].score
        assert found is not None
        score.append(found["median"])
    assert np.log2(score[0] / score[1]) == pytest.approx(3, abs=0.3)


def test_bending_is_the_angle_between_quads_over_their_distance() -> None:
    lamellas, strips = catenoid(24)
    network, half = lamellas.network, 0.05
    ruling = rulings(network, strips.slopes)
    edges = [network.sample_points + side * half * ruling for side in (-1, 1)]
    # quads of the first lamella, away from the place where they fold
    inside = np.flatnonzero(strips.heights[: network.sample_offsets[1]] > 0.3)
    inside = inside[np.append(np.diff(inside) == 1, False)]
    inside = inside[np.append(np.diff(inside) == 1, False)]
    normal = np.cross(edges[0][inside + 1] - edges[0][inside], ruling[inside])
    after = np.cross(edges[0][inside + 2] - edges[0][inside + 1], ruling[inside + 1])
    sine = np.linalg.norm(np.cross(normal, after), axis=1)
    angle = sine / np.linalg.norm(normal, axis=1) / np.linalg.norm(after, axis=1)
    along = ruling[inside + 1] / np.linalg.norm(ruling[inside + 1], axis=1)[:, None]
    widths = [np.linalg.norm(np.cross(edge[inside + 2] - edge[inside], along), axis=1) / 2 for edge in edges]
    assert strips.curvatures[inside + 1] == pytest.approx(angle / np.minimum(*widths), rel=2e-2)
    modulus, thickness = lamellas.material.youngs_modulus, lamellas.section.thickness
    assert strips.bending[inside] == pytest.approx(modulus * thickness / 2 * strips.curvatures[inside])


def _apart(
    curve_a: CubicSpline, ruling_a: CubicSpline, curve_b: CubicSpline, ruling_b: CubicSpline, z: float, x: np.ndarray
) -> np.ndarray:
    """Of a point (s, z) = x[:2] of one ruled surface from the one at the station x[2] and the height z of another."""
    return np.asarray(curve_a(x[0]) + x[1] * ruling_a(x[0]) - curve_b(x[2]) - z * ruling_b(x[2]))


def test_two_strips_meet_beside_the_normal() -> None:
    errors = []
    for height in (0.08, 0.04):
        lamellas, strips = catenoid(24, height)
        network = lamellas.network
        offsets = meeting_offsets(network, strips, height)
        stops_a = slice(int(network.stop_offsets[0]), int(network.stop_offsets[1]))
        node = next(
            int(k)
            for k in network.stop_nodes[stops_a][::-1]
            if np.isfinite(offsets[k]) and network.node_points[k, 2] > 0.8
        )
        surfaces = []
        for stop in np.flatnonzero(network.stop_nodes == node).tolist():
            owner = int(network.stop_owner[stop])
            span = slice(int(network.sample_offsets[owner]), int(network.sample_offsets[owner + 1]))
            s = network.sample_arclengths[span]
            surfaces.append(
                (
                    CubicSpline(s, network.sample_points[span]),
                    CubicSpline(s, rulings(network, strips.slopes)[span]),
                    float(network.stop_arclengths[stop]),
                )
            )
        (curve_a, ruling_a, start_a), (curve_b, ruling_b, start_b) = surfaces

        found = fsolve(
            partial(_apart, curve_a, ruling_a, curve_b, ruling_b, height / 2),
            [start_a, height / 2, start_b],
            xtol=1e-13,
        )
        away = curve_a(found[0]) + found[1] * ruling_a(found[0]) - network.node_points[node]
        normal = network.node_normals[node]
        off = np.linalg.norm(away - away @ normal * normal)
        errors.append(abs(off - offsets[node]))
        assert off == pytest.approx(offsets[node], rel=0.2)
    assert np.log2(errors[0] / errors[1]) > 2.5


def test_flat_edges_are_as_long_as_those_in_space() -> None:
    net = lamella.net(lamella.Unduloid(0.6, 1.4, (0.5, 2.0)), cells=24)
    lamellas = net.strips(Section(height=0.06, layers=1))
    strips = developable_strips(lamellas)
    flat = flat_ends(lamellas, strips.slopes)
    ruling = rulings(net, strips.slopes)
    both = strips.exists[:-1] & strips.exists[1:]
    both[net.sample_offsets[1:-1] - 1] = False
    for side, edge in zip((-1, 1), flat, strict=True):
        there = net.sample_points + side * 0.03 * ruling
        lengths, own = (np.linalg.norm(np.diff(points, axis=0), axis=1)[both] for points in (there, edge))
        assert own.sum() == pytest.approx(lengths.sum(), rel=1e-5)


def test_none_where_kg_changes_its_sign() -> None:
    lamellas, strips = catenoid()
    network = lamellas.network
    gaps = strips.gaps(network)
    # every lamella goes once through the waist
    assert [lamella for lamella, _, _ in gaps] == list(range(len(network.ids)))
    z = network.sample_points[:, 2]
    limit = WAIST * np.arcsinh(np.sqrt(0.1 / (2 * WAIST)))
    for _, first, last in gaps:
        assert z[[first, last]].min() < 0 < z[[first, last]].max()
        assert np.abs(z[first : last + 1]).max() < limit + 1e-6
        assert strips.heights[first : last + 1].min() == 0.0
        assert not strips.exists[first : last + 1].any()
    assert strips.share == pytest.approx((np.abs(z) > limit).mean(), abs=0.01)


def test_a_helix_on_a_cylinder_bears_none() -> None:
    strips = developable_strips(lamella.net(lamella.Cylinder(1.0, (0.0, 2.0)), cells=6).strips(Section(layers=1)))
    assert strips.share == 0
    assert strips.score is None
    assert np.isinf(strips.bending).all()
