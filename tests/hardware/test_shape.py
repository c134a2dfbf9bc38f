"""Outlines of plates against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from lamella import InputError
from lamella.fabrication.flat import outline_area
from lamella.hardware.bolts import LENGTHS, SIZES, bolt_size
from lamella.hardware.classes import classes, rounded_down
from lamella.hardware.shape import circle, crossed, hexagon, rectangle, rhombus, slot


@pytest.mark.parametrize("angle", [0.5, np.pi / 3, np.pi / 2, 2.2])
def test_crossing_bars_and_what_they_have_in_common(angle: float) -> None:
    # two bars 2 l x 2 w less the rhombus both have: sides 2 w / sin
    length, w = 0.2, 0.02
    common = (2 * w) ** 2 / np.sin(angle)
    assert outline_area(crossed(length, w, angle)) == pytest.approx(2 * (2 * length * 2 * w) - common, rel=1e-12)
    assert outline_area(rhombus(w, angle)) == pytest.approx(common, rel=1e-12)


def test_round_shapes() -> None:
    assert outline_area(circle(0.3)) == pytest.approx(np.pi * 0.15**2, rel=1e-12)
    assert outline_area(slot(0.05, 0.01, (1.0, 2.0))) == pytest.approx(0.04 * 0.01 + np.pi * 0.005**2, rel=1e-12)
    assert outline_area(slot(0.01, 0.01)) == pytest.approx(np.pi * 0.005**2, rel=1e-12)
    assert outline_area(hexagon(0.013)) == pytest.approx(np.sqrt(3) / 2 * 0.013**2, rel=1e-12)
    assert outline_area(rectangle(0.3, 0.2)) == pytest.approx(0.06, rel=1e-12)


@pytest.mark.parametrize("size", SIZES.values(), ids=lambda size: size.name)
def test_bolts_hold_their_grip(size) -> None:
    assert bolt_size(size.diameter) is size
    assert size.diameter < size.neck < size.hole < size.nut_flange
    for grip in (0.001, 0.03, 0.1085, 0.3):
        length = size.length(grip)
        assert length in LENGTHS
        assert length >= grip + size.nut + 2 * size.pitch
        shorter = [one for one in LENGTHS if one < length]
        assert not shorter or shorter[-1] < grip + size.nut + 2 * size.pitch


def test_what_is_no_bolt_is_refused() -> None:
    with pytest.raises(InputError, match=r"0\.007") as refused:
        bolt_size(0.007)
    assert "0.008" in refused.value.remedy
    with pytest.raises(InputError):
        SIZES[0.008].length(0.6)


def test_nearly_equal_sizes_are_one_class_whatever_rounding_does() -> None:
    values = np.array([0.0101, 0.0100, 0.0110, 0.0111, 0.0125])
    for noise in (0.0, 1e-12, -1e-12):
        kind, sizes = classes(values + noise * np.array([1, -1, 1, -1, 1]), 1e-3, lowest=True)
        assert kind.tolist() == [0, 0, 0, 1, 2]
        assert rounded_down(sizes, 1e-4) == pytest.approx([0.0100, 0.0111, 0.0125], abs=1e-12)
    assert len(classes(np.empty(0), 1.0)[1]) == 0
