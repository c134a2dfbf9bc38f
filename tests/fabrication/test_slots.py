"""Slots with play beyond the centre line and rounded feet."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import lamella
from lamella import InputError, Section
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.read_back import read_slots

NETS = {
    "straight": lambda: lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12),
    "arcs": lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8),
}


@pytest.mark.parametrize("net", NETS)
def test_play_and_rounded_feet_take_and_leave_their_areas(net: str, tmp_path: Path) -> None:
    strips = NETS[net]().strips(Section(0.1, 0.0015))
    plain, made = strips.parts(), strips.parts(slot_play=0.0005, foot_radius=0.0007)
    for before, after in zip(plain.parts, made.parts, strict=True):
        # a slot is a rectangle more, less two corners of a square less a quarter of a circle
        more = len(before.slots) * (0.003 * 0.0005 - 2 * (1 - np.pi / 4) * 0.0007**2)
        assert before.area - after.area == pytest.approx(more, abs=1e-12)
    # the drawing says where they are as before
    write_drawings(tmp_path, made, made.nest(), name="x", version="0")
    drawn = read_slots(tmp_path / "A.dxf") | read_slots(tmp_path / "B.dxf")
    for part in made.parts:
        assert drawn[part.id].slots == pytest.approx(1e3 * (part.slots - part.start), abs=1e-6)
        assert drawn[part.id].length == pytest.approx(1e3 * part.length, abs=1e-6)


def test_engraved_lines_end_at_the_feet() -> None:
    from lamella.fabrication.engraving import engrave

    strips = NETS["straight"]().strips(Section(0.1, 0.0015, layers=1))
    for part in strips.parts(slot_play=0.002).parts:
        ends = engrave(part).nodes[:, :, 1]
        at_slot = np.isclose(np.abs(part.nodes[:, None] - part.slots).min(axis=1), 0.0, atol=1e-9)
        # A is cut from above, to below the centre line
        foot = -0.002 if part.family == "A" else 0.002
        assert ends[at_slot[: len(ends)]][:, 0] == pytest.approx(foot, abs=1e-9)


@pytest.mark.parametrize(
    ("key", "value"),
    [("slot_play", -0.001), ("slot_play", 0.03), ("foot_radius", -1.0), ("foot_radius", 0.0008), ("slot_play", np.inf)],
)
def test_what_would_hold_strips_apart_is_refused(key: str, value: float) -> None:
    strips = NETS["straight"]().strips(Section(0.1, 0.0015))
    with pytest.raises(InputError) as refused:
        strips.parts(**{key: value})
    assert refused.value.where == key
    assert refused.value.remedy
