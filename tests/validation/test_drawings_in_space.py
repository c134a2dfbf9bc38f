"""Drawings alone, put on the curves in space: what is slotted into each other, and what is bolted, has to meet."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import Section
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.read_back import read_slots
from lamella.hardware.make_hardware import make_hardware
from lamella.hardware.rules import JointRules
from lamella.solid.strip import layer_rows
from lamella.strip.layer_map import LayerMap

# m
FITS = 1e-4

NETS = {
    "layers at one distance": (lambda: lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12), "own", "offset"),
    "cut to their curvature": (lambda: lamella.net(lamella.Enneper(3, 0.8, 3.0), cells=10), "own", "cut"),
    "on lamella curves": (lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8), "own", "lamella"),
}


@pytest.mark.parametrize("name", NETS)
@pytest.mark.few(1)
def test_slots_and_holes_meet_in_space(name: str, tmp_path: Path) -> None:
    make, lengths, curves = NETS[name]
    section = Section(0.08, 0.0015, 2, 0.025, layer_lengths=lengths, layer_curves=curves)
    lamellas = make().strips(section)
    cut = lamellas.parts(sheet=(3.0, 1.5))
    made = make_hardware(lamellas, cut, JointRules(splice=False))
    write_drawings(tmp_path, made.parts, made.parts.nest(sheet=(3.0, 1.5)), name="x", version="0")
    drawn = read_slots(tmp_path / "A.dxf") | read_slots(tmp_path / "B.dxf")
    slots: dict[str, list[np.ndarray]] = {"A": [], "B": []}
    holes, count = [], 0
    for part in made.parts.parts:
        told = drawn[part.id]
        assert len(told.slots) == len(part.slots)
        assert told.holes == pytest.approx(1e3 * (part.holes - (part.start, 0.0, 0.0)), abs=1e-4)
        for row in layer_rows(part, lamellas):
            layer = LayerMap.of(lamellas, part.lamella, row)
            slots[part.family].append(layer.frames(part.start + told.slots / 1e3)[0])
            point, _, normal, _ = layer.frames(part.start + told.holes[:, 0] / 1e3)
            holes.append(point + told.holes[:, 1, None] / 1e3 * normal)
            count += len(told.holes)
    a, b = (np.concatenate(slots[family]) for family in "AB")
    away, which = cKDTree(b).query(a)
    assert len(a) == len(b) == len(np.unique(which)) > 100
    assert away.max() < FITS
    # each hole lies on the axis of its screw
    screws = made.hardware.of("screw")
    heads = np.concatenate([item.places.origins for item in screws])
    axes = np.concatenate([item.places.axes[:, 2] for item in screws])
    bored = np.concatenate(holes)
    _, near = cKDTree(heads - 0.0125 * axes).query(bored)
    off = bored - heads[near]
    off -= np.einsum("ij,ij->i", off, axes[near])[:, None] * axes[near]
    assert len(bored) == 2 * len(heads) == count
    assert np.bincount(near).tolist() == [2] * len(heads)
    assert np.linalg.norm(off, axis=1).max() < FITS
