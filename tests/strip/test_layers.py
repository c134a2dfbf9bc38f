"""Layers cut at the node distances of their own curves, and what happens where they are cut alike."""

import numpy as np
import pytest

import lamella
from lamella import Catenoid, Helicoid, Section, Unduloid, find_material
from lamella.fabrication.parts import make_parts
from lamella.fabrication.stroke_font import GLYPHS
from lamella.strip.lamellas import layer_drift, make_lamellas

STEEL = find_material("1.4301")


@pytest.mark.parametrize("surface", [Catenoid(2.0, (-1.5, 2.0)), Unduloid(1.0, 2.0, (-2.0, 3.0)), Helicoid(5, 1, 4, 1)])
def test_own_lengths_are_those_of_the_curves_to_the_side(surface):
    """Against the chords of c + d u, d to the side of the written centre line."""
    section = Section(layers=3, offset=0.04, layer_lengths="own")
    network = lamella.net(surface, cells=24)
    lamellas = make_lamellas(network, section, STEEL)
    sideways = np.cross(network.sample_normals, network.sample_tangents)
    for d, stations in zip(section.layer_offsets, lamellas.layer_stations, strict=True):
        curve = network.sample_points + d * sideways
        chord = np.linalg.norm(np.diff(curve, axis=0), axis=1)
        chord[network.sample_offsets[1:-1] - 1] = 0.0
        s = np.append(0.0, np.cumsum(chord))
        start = network.sample_offsets[network.stop_owner]
        # chords miss the arc by (kappa h)^2 / 24 of it
        np.testing.assert_allclose(stations, s[start + network.stop_samples] - s[start], rtol=2e-4, atol=1e-6)
    np.testing.assert_allclose(lamellas.layer_stations[1], network.stop_arclengths, rtol=1e-12)


def test_layers_alike_share_the_centre_lines_marks():
    network = lamella.net(Catenoid(2.0, (-1.5, 2.0)), cells=24)
    lamellas = make_lamellas(network, Section(layers=2), STEEL)
    assert (lamellas.layer_stations == network.stop_arclengths).all()


def test_drift_of_layers_cut_alike():
    """A helix of the helicoid turns by the integral of kg: its layers differ in length by that times their distance."""
    network = lamella.net(Helicoid(5.0, 1.0, 4.0, 1.0), cells=10)
    lamellas = make_lamellas(network, Section(layers=2, offset=0.03, layer_lengths="own"), STEEL)
    ends = network.stop_offsets[1:] - 1
    difference = np.abs(np.diff(lamellas.layer_stations, axis=0)[0][ends])
    turn = layer_drift(network)
    np.testing.assert_allclose(difference, 0.03 * turn, rtol=1e-3, atol=1e-9)
    c = 5 / (2 * np.pi)
    assert turn.max() == pytest.approx(2 * np.pi * np.sinh(np.arcsinh(4 / c)) / np.cosh(np.arcsinh(4 / c)), rel=1e-3)


def test_own_layers_are_parts_of_their_own():
    network = lamella.net(Catenoid(2.0, (-1.5, 2.0)), cells=24)
    lamellas = make_lamellas(network, Section(layers=2, layer_lengths="own"), STEEL)
    parts = make_parts(network, lamellas, density=7900.0)
    assert [part.id for part in parts.parts[:4]] == ["A1-1", "A1-2", "A2-1", "A2-2"]
    # what is engraved is what the part list says: the stroke font has capitals only
    assert all(set(part.id) <= set(GLYPHS) for part in parts.parts)
    assert {part.quantity for part in parts.parts} == {1}
    assert parts.pieces == 2 * len(network.ids)
    a, b = parts.parts[:2]
    assert a.length + b.length == pytest.approx(2 * (network.lengths[0] + 0.02), rel=1e-3)
    assert abs(a.length - b.length) > 1e-3
    # every slot pair of one layer of A meets two layers of B
    assert len(a.slots) == len(b.slots)
