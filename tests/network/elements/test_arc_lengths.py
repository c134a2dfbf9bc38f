"""Arc lengths of lamellas on elements against chords and circles through dense samples."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.network.network import Network
from network.elements.test_element_network import woven


def chord_misses(network: Network) -> np.ndarray:
    """Difference of the samples' arc lengths and their chords, the curve taken as a circle, over the arc length."""
    points, s = network.sample_points, network.sample_arclengths
    darboux = network.sample_darboux
    inside = np.ones(len(points) - 1, bool)
    inside[network.sample_offsets[1:-1] - 1] = False
    step = np.diff(s)[inside]
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)[inside]
    bend = np.hypot(darboux[0], darboux[1])
    bend = ((bend[1:] + bend[:-1]) / 2)[inside]
    # a circle's chord: s - k^2 s^3 / 24
    return np.abs(chord * (1 + (bend * chord) ** 2 / 24) - step) / step


@pytest.mark.parametrize("name", ["catenoid", "unduloid", "helicoid"])
def test_samples_are_as_far_apart_as_their_arc_lengths_say(name: str) -> None:
    misses = chord_misses(woven(name).net.network)
    assert np.percentile(misses, 99) < 5e-8
    assert misses.max() < 2e-7
