"""Unrolling from written points: converges, and lamellas come out straight or as circles of radius 1/H."""

import numpy as np
import pytest

import lamella
from conftest import draw_surface
from lamella import Section, Unduloid, find_material
from lamella.strip.lamellas import make_lamellas
from lamella.strip.planarity import planarity_score
from lamella.strip.unroll import develop, developed_line, development_deviation


def _small_circle(count, radius=3.0, angle=0.6, turn=1.2):
    """A circle of latitude on a sphere, unevenly sampled: kn = 1/radius all along, the normal inwards."""
    t = turn * (np.linspace(0, 1, count) + 0.1 * np.sin(np.linspace(0, 1, count) * np.pi))
    out = np.column_stack([np.cos(t) * np.cos(angle), np.sin(t) * np.cos(angle), np.full(count, np.sin(angle))])
    return radius * out, -out, np.array([0, count])


def test_development_converges_at_fourth_order():
    def miss(count):
        return development_deviation(*_small_circle(count), 1 / 3.0).max()

    assert miss(40) < 1e-4
    assert miss(40) / miss(80) > 10


def test_development_keeps_length_and_turns_by_normal_curvature():
    points, normals, offsets = _small_circle(200)
    plane, s = develop(points, normals, offsets)
    length = 3 * np.cos(0.6) * 1.2
    assert s[-1] == pytest.approx(length, rel=1e-8)
    assert abs(plane[-1]) == pytest.approx(2 * 3 * np.sin(length / 3 / 2), rel=1e-7)  # chord of the developed circle
    assert plane[-1].imag > 0  # bends towards the normal


def test_wrong_radius_is_seen():
    points, normals, offsets = _small_circle(200)
    length = 3 * np.cos(0.6) * 1.2
    off = development_deviation(points, normals, offsets, 1 / 3.1).max()
    assert off > (1 / 3 - 1 / 3.1) * length**2 / 32


@pytest.mark.parametrize("kind", ["unduloid", "nodoid", "catenoid", "cylinder", "helicoid", "enneper", "scherk"])
@pytest.mark.parametrize("cells", [24, 60])
def test_ten_metre_lamellas_unroll_to_a_tenth_of_a_millimetre(kind, cells):
    rng = np.random.default_rng([cells, 4])
    surface = draw_surface(kind, rng)
    network = lamella.net(surface, cells=cells)
    scale = 10 / network.lengths.max()
    deviation = development_deviation(
        network.sample_points * scale, network.sample_normals, network.sample_offsets, network.mean_curvature / scale
    )
    assert deviation.max() <= 1e-4


def test_developed_line():
    assert developed_line(np.array([2.0]), 0.0)[0] == 2
    quarter = developed_line(np.array([np.pi]), 0.5)[0]  # a quarter of a circle of radius 2
    assert quarter == pytest.approx(2 + 2j)


def test_planarity_score_of_the_papers_square():
    """Paper section 2.3: a 1 x 1 m square whose diagonals are 1 cm apart scores about 0.007."""
    v = np.array([[0, 0, 0], [1, 0, 0.01], [1, 1, 0], [0, 1, 0.01]], float)
    score = planarity_score(*(p[None] for p in v))[0]
    assert score == pytest.approx(0.01 / np.sqrt(2), rel=1e-3)
    assert planarity_score(*(p[None] for p in v * [1, 1, 0]))[0] == 0


def test_relaxed_marks_are_longer_by_the_shortening():
    """On a cylinder tg = 1/(2 R) all along, so every distance grows by the factor 1 + h^2 tg^2 / 24."""
    from lamella import Cylinder

    network = lamella.net(Cylinder(0.5, (0, 2)), cells=20)
    steel = find_material("1.4301")
    plain = make_lamellas(network, Section(), steel)
    relaxed = make_lamellas(network, Section(marks="relaxed"), steel)
    np.testing.assert_allclose(relaxed.stop_stations, plain.stop_stations * (1 + 0.1**2 / 24), rtol=1e-12)
    assert plain.restraint.min() > 0
    assert relaxed.restraint.max() == 0
    assert relaxed.utilisation.max() < plain.utilisation.max()


def test_relaxed_marks_where_the_twist_varies():
    network = lamella.net(Unduloid(0.5, 1.5, (-2, 2)), cells=24)
    relaxed = make_lamellas(network, Section(marks="relaxed"), find_material("1.4301"))
    a, b = network.sample_offsets[:2]
    s, tg = network.sample_arclengths[a:b], network.sample_darboux.tg[a:b]
    from scipy.interpolate import CubicSpline

    exact = s[-1] + CubicSpline(s, tg**2).integrate(0, s[-1]) * 0.1**2 / 24
    assert relaxed.developed_lengths[0] == pytest.approx(exact, abs=2e-6)


def test_strip_higher_than_its_own_circle_is_refused():
    from lamella import InputError

    network = lamella.net(Unduloid(0.02, 0.03, (-0.05, 0.05)), cells=12)
    with pytest.raises(InputError, match=r"height = 0\.1 m: strips of radius 0\.05 m"):
        make_lamellas(network, Section(), find_material("1.4301"))
