"""Strips made developable by turning their rulings (paper, Figures 7 and 10).

1. Between neck and bulge of an unduloid: planar to rounding, upright, borders on the surface and on the parallel one;
rulings lean as r = kg n + tg t says. 2. Across the neck no developable strip exists: the figures say so. 3. Curves on a
mesh of triangles, on a surface that was found. 4. Bad input.
"""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from lamella import Unduloid
from lamella.network.elements.element_network import element_network
from lamella.projection.foot_points import MeshFeet, foot_surface
from lamella.projection.problems.planar_strips import PlanarStrips, planar_strips
from lamella.strip.planarity import planarity_score
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.find import find_film
from refusals import refused

UNDULOID = Unduloid(0.6, 1.4, (-8.0, 8.0))
HALF = UNDULOID.period / 2
HEIGHT = 0.05


def lamella(start: float, end: float, count: int = 12, turn: float = 0.0) -> np.ndarray:
    """U - V = const between two shares of the half period from neck (0) to bulge (1)."""
    u = np.linspace(start, end, count) * HALF
    return UNDULOID.at(u + 1j * (u + turn)).position


@cache
def strips() -> PlanarStrips:
    curves = [lamella(0.25, 0.75), lamella(0.3, 0.8, 15, 1.0)]
    return planar_strips(curves, foot_surface(UNDULOID), HEIGHT)


def test_quads_become_planar() -> None:
    found, figures = strips(), strips().figures()
    assert all(s.solved for s in found.solutions)
    assert figures["red_before"] > 0.9
    assert figures["red_after"] == 0.0
    assert figures["largest_after"] < 1e-6
    assert figures["not_developable"] == 0.0
    for lower, upper, after in zip(found.lower, found.upper, found.after, strict=True):
        assert planarity_score(lower[:-1], lower[1:], upper[1:], upper[:-1]) == pytest.approx(after)


def test_borders_are_on_the_surface_and_its_parallel_one() -> None:
    surface = foot_surface(UNDULOID)
    for lower, upper in zip(strips().lower, strips().upper, strict=True):
        foot = surface.foot(lower)
        assert np.linalg.norm(lower - foot.position, axis=1).max() < 1e-7
        foot = surface.foot(upper)
        assert upper - foot.position == pytest.approx(HEIGHT * foot.normal, abs=1e-7)


def test_strips_stand_upright_and_stay_near_their_curves() -> None:
    found = strips()
    assert max(t.max() for t in found.tilt) < 2
    assert max(s.max() for s in found.shift) < 0.1
    assert max(t.max() for t in found.turn) < 15
    # the same number of rulings after two rounds
    assert [len(c) for c in found.lower] == [4 * 11 + 1, 4 * 14 + 1]


def test_rulings_lean_as_curvatures_say() -> None:
    """r = kg n + tg t: along U - V = const tan(lean) is about tg / kg = T sqrt 2 / (r r_U / r), DESIGN section 9.

    Away from the ends of the strip; the curve has moved, so to a few degrees.
    """
    lower, upper = strips().lower[0], strips().upper[0]
    inside = slice(len(lower) // 3, -len(lower) // 3)
    t = np.gradient(lower, axis=0)
    t /= np.linalg.norm(t, axis=1)[:, None]
    along = ((upper - lower) * t).sum(1)
    lean = np.degrees(np.arctan2(np.abs(along), HEIGHT))[inside]
    # the curve as it is now: kg from its own bend, tg from the surface
    at = foot_surface(UNDULOID).foot(lower)
    u = np.cross(at.normal, t)
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(lower, axis=0), axis=1))])
    kg = (np.gradient(t, s, axis=0) * u).sum(1)[inside]
    tg = -(np.gradient(at.normal, s, axis=0) * u).sum(1)[inside]
    assert lean == pytest.approx(np.degrees(np.arctan2(np.abs(tg), np.abs(kg))), abs=4)


def test_scores_of_twisted_strips() -> None:
    """A quad a long and h high, turned by tg a along the curve, has the score h tg a / (2 sqrt(a^2 + h^2))."""
    u = np.linspace(0.25, 0.75, 4 * 11 + 1) * HALF
    middle = UNDULOID.profile((u[1:] + u[:-1]) / 2)
    long, turned = np.sqrt(2) * middle.r * np.diff(u), UNDULOID.flux / middle.r**2
    expected = HEIGHT * turned * long / (2 * np.hypot(long, HEIGHT))
    assert strips().before[0] == pytest.approx(expected, rel=0.05)


def test_across_a_neck_the_figures_say_that_none_exists() -> None:
    found = planar_strips([lamella(-0.5, 0.5)], foot_surface(UNDULOID), HEIGHT)
    height = found.buildable[0]
    assert height.min() == 0.0
    assert (height[[4, 5, 6, 7]] < HEIGHT).all()
    assert (height[[0, 11]] > HEIGHT).all()
    assert found.figures()["not_developable"] > 0.2
    # what planar quads there are bridge the neck by a jump of the rulings
    assert found.figures()["largest_turn"] > 20


def test_surface_as_a_mesh_of_triangles() -> None:
    mesh = UNDULOID.mesh(1e-4)
    triangles = np.concatenate([mesh.faces[:, [0, 1, 2]], mesh.faces[:, [0, 2, 3]]])
    feet = MeshFeet(mesh.points, triangles)
    found = planar_strips([lamella(0.25, 0.75)], feet, HEIGHT, rounds=1, tolerance=1e-6)
    assert found.figures()["red_after"] < 0.1
    assert found.figures()["median_after"] < found.figures()["median_before"] / 10


def test_strips_of_a_found_surface() -> None:
    """A free-form surface of H = 0.68, as in the paper's Figure 10: all its lamellas, as upright planar strips."""
    t = np.arange(36) * 2 * np.pi / 36
    loop = make_loop("rim", closed_spline(np.column_stack([np.cos(t), 0.8 * np.sin(t), 0.2 * np.cos(2 * t)])))
    surface = find_film((loop,), 0.68).surface("form-found")
    net = element_network(surface, cells=8, minimum_length=0.4).network
    curves = []
    for first, end in pairwise(net.sample_offsets):
        s, points = net.sample_arclengths[first:end], net.sample_points[first:end]
        even = np.linspace(0, s[-1], max(6, int(s[-1] / 0.08)))
        curves.append(np.stack([np.interp(even, s, x) for x in points.T], 1))
    found = planar_strips(curves, foot_surface(surface), HEIGHT)
    figures = found.figures()
    assert figures["largest_after"] < 1e-6 < 1e-3 < figures["median_before"]
    assert figures["largest_tilt"] < 2
    assert figures["largest_shift"] < HEIGHT
    # lamellas whose geodesic curvature changes its sign are no developable strips there
    assert 0 < figures["not_developable"] < 0.3


class TestRefused:
    def test_curves(self) -> None:
        surface = foot_surface(UNDULOID)
        with refused():
            planar_strips([], surface, HEIGHT)
        with refused(numbers=(1,)):
            planar_strips([lamella(0.2, 0.8), lamella(0.2, 0.8)[:3]], surface, HEIGHT)
        with refused(numbers=(0,)):
            planar_strips([lamella(0.2, 0.8)[[0, 0, 1, 2]]], surface, HEIGHT)

    def test_height_beyond_the_centre_of_curvature(self) -> None:
        """Lamellas of an unduloid have kn = H = 1/2 towards the axis: their normals meet 2 m inwards."""
        surface, curves = foot_surface(UNDULOID), [lamella(-1.0, 1.0, 40)]
        assert planar_strips(curves, surface, 1.9, rounds=1, iterations=1).height == 1.9
        with refused(names=("height",), numbers=(2.1, 0)):
            planar_strips(curves, surface, 2.1)
        with refused(names=("height",), numbers=(-50,)):
            planar_strips(curves, surface, -50.0)

    def test_height(self) -> None:
        with refused(names=("height",), numbers=(0,)):
            planar_strips([lamella(0.2, 0.8)], foot_surface(UNDULOID), 0.0)
