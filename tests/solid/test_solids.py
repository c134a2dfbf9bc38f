"""Solids of strips and hardware: closed, of the right volume, and clear of each other."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

import lamella
from lamella import Section
from lamella.hardware.make_hardware import make_hardware
from lamella.hardware.rules import CableRules, JointRules
from lamella.hardware.shape import Prism, Sweep, circle, rectangle, slot
from lamella.solid.extrusion import prism_solid, sweep_solid
from lamella.solid.strip import strip_solid
from lamella.strip.layer_map import LayerMap
from solid.overlaps import Structure, manifold


def test_volume_of_a_plate_with_holes_is_its_area_times_its_thickness() -> None:
    prism = Prism(rectangle(0.2, 0.1), -0.002, 0.003, (rectangle(0.02, 0.03, (0.05, 0.0)), rectangle(0.01, 0.01)))
    assert prism_solid(prism).volume == pytest.approx(0.005 * (0.02 - 0.0006 - 0.0001), rel=1e-12)
    # round edges are drawn by inscribed polygons: 16 corners a circle
    polygon = 16 / 2 * 0.01**2 * np.sin(2 * np.pi / 16)
    round_hole = Prism(rectangle(0.2, 0.1), 0.0, 0.004, (circle(0.02),))
    assert prism_solid(round_hole).volume == pytest.approx(0.004 * (0.02 - polygon), rel=1e-12)
    assert manifold(prism_solid(Prism(slot(0.04, 0.01), 0.0, 0.004))).volume() > 0


def test_volume_of_a_bar_along_a_polygon() -> None:
    # mitred in its corners, a closed bar is as long as its axis; a tube in a regular polygon
    angle = 2 * np.pi * np.arange(9) / 8
    points = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(9)])
    points[-1] = points[0]
    tube = Sweep(rectangle(0.06, 0.04), points, np.tile([0.0, 0.0, 1.0], (9, 1)), (rectangle(0.05, 0.03),))
    for sweep in (tube, Sweep(tube.outline, points[:4], tube.up[:4], tube.holes)):
        solid = sweep_solid(sweep)
        assert manifold(solid).volume() == pytest.approx(sweep.volume, rel=1e-12)
        assert solid.volume == pytest.approx(sweep.volume, rel=1e-12)
    assert tube.closed
    assert tube.volume == pytest.approx((0.06 * 0.04 - 0.05 * 0.03) * 16 * np.sin(np.pi / 8), rel=1e-12)


def test_faces_of_a_twisted_strip_approach_the_ruled_surface_at_first_order() -> None:
    # two triangles on a ruled quad a step long leave it by up to tg h step / 4
    lamellas = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips(Section(0.2, 0.0015, layers=1))
    part = lamellas.parts().parts[0]
    layer = LayerMap.of(lamellas, part.lamella, 0)
    off = []
    for step in (0.08, 0.04, 0.02):
        solid = strip_solid(part, lamellas, 0, step=step)
        assert manifold(solid).volume() == pytest.approx(part.area * part.thickness, rel=1e-3)
        faces = solid.triangles[
            : np.flatnonzero(np.diff(solid.triangles.max(axis=1) >= len(solid.vertices) // 2))[0] + 1
        ]
        middle = solid.vertices[faces].mean(axis=1)
        s = layer.curve.x[np.argmin(np.linalg.norm(middle[:, None] - layer.curve(layer.curve.x), axis=2), axis=1)]
        for _ in range(8):
            point, along, normal, _ = layer.frames(s)
            z = np.einsum("ij,ij->i", middle - point, normal)
            s = s + np.einsum("ij,ij->i", middle - point - z[:, None] * normal, along)
        left = np.subtract(*layer.surfaces(s, z, part.thickness)[::-1]) / part.thickness
        off.append(np.abs(np.abs(np.einsum("ij,ij->i", middle - point - z[:, None] * normal, left)) - 0.00075).max())
    assert np.log2(off[0] / off[2]) / 2 > 0.9
    assert off[2] < np.abs(lamellas.network.sample_darboux.tg).max() * 0.2 * 0.02 / 4


LAYOUTS = {
    "pairs": (lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8), Section(0.1, 0.0015)),
    "four layers": (
        lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8),
        Section(0.06, 0.001, 4, 0.02),
    ),
    "layers on lamella curves": (
        lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8),
        Section(0.06, 0.001, 2, 0.02, layer_curves="lamella"),
    ),
    "layers cut to their curvature": (
        lambda: lamella.net(lamella.Enneper(2, 1.0, 1.0), cells=8),
        Section(0.06, 0.001, 2, 0.02, layer_curves="cut"),
    ),
    "oblique": (
        lambda: lamella.net(lamella.Nodoid(1.0, 3.0, (-0.5, 0.5)), cells=14, normal_curvature=0.0),
        Section(0.06, 0.001, 2, 0.02),
    ),
}


COSTLY = pytest.mark.slow


@pytest.mark.parametrize("layout", [pytest.param(k, marks=COSTLY) if k == "four layers" else k for k in LAYOUTS])
@pytest.mark.few(2)
def test_no_two_solids_overlap(layout: str) -> None:
    """Strips, washers, bolts and blocks have no volume in common, at eight nodes of each layout."""
    make, section = LAYOUTS[layout]
    lamellas = make().strips(section)
    # ends short enough not to meet beyond the rim
    made = make_hardware(
        lamellas, lamellas.parts(end_distance=0.03, rim_overhang=0.0), JointRules(washer_thickness=0.003)
    )
    structure = Structure(lamellas, made.parts, made.hardware.items)
    found = [pair for place in structure.places(8) for pair in structure.overlaps(place)]
    assert found == []


@pytest.mark.parametrize("layers", [2, 4])
@pytest.mark.few(1)
def test_splices_are_clear_of_everything(layers: int) -> None:
    lamellas = lamella.net(lamella.Cylinder(1.5, (0.0, 3.0)), cells=6).strips(Section(0.08, 0.0015, layers, 0.025))
    parts = lamellas.parts(sheet=(3.0, 1.0))
    made = make_hardware(lamellas, parts, JointRules())
    structure = Structure(lamellas, made.parts, made.hardware.items, step=0.002)
    plates = structure.of("splice-1")
    pieces = Counter(part.lamella for part in parts.parts)
    assert len(plates) == layers * sum(number - 1 for number in pieces.values()) > 0
    middles = (structure.low[plates] + structure.high[plates]) / 2
    assert [pair for place in middles[:: len(plates) // 3] for pair in structure.overlaps(place)] == []
    # eight screws through each plate, half of them in either piece
    assert sum(item.quantity for item in made.hardware.of("screw") if item.id.startswith("splice")) == 8 * len(plates)
    at_ends = sum((part.holes[:, 1] != 0).sum() * part.quantity for part in made.parts.parts)
    assert at_ends == 8 * len(plates)


def test_cables_and_clamps_are_clear_of_the_joints() -> None:
    lamellas = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8).strips(Section(0.1, 0.0015))
    parts = lamellas.parts(end_distance=0.03, rim_overhang=0.0)
    made = make_hardware(lamellas, parts, JointRules(block_spacing=0), CableRules(every=1))
    structure = Structure(lamellas, made.parts, made.hardware.items)
    clamps = structure.of("clamp")
    middles = (structure.low[clamps] + structure.high[clamps]) / 2
    assert [pair for place in middles[:: len(clamps) // 5] for pair in structure.overlaps(place)] == []


@pytest.mark.parametrize(("order", "layers"), [(3, 2), (4, 2), (5, 2), pytest.param(3, 4, marks=COSTLY)])
@pytest.mark.few(1)
def test_hubs_of_6_8_and_10_rays_are_clear_of_everything(order: int, layers: int) -> None:
    """Plates, fins, packers and screws of hubs at singular nodes, against each other and all strips."""
    lamellas = lamella.net(lamella.Enneper(order, 0.8, 3.0), cells=10).strips(Section(0.08, 0.001, layers, 0.02))
    rules = JointRules()
    made = make_hardware(lamellas, lamellas.parts(hub_radius=0.08), rules)
    structure = Structure(lamellas, made.parts, made.hardware.items)
    hub = structure.of("hub-1")
    assert len(structure.of("hub-1-plate")) == 2
    assert len(structure.of("hub-1-fin")) == 2 * order
    middles = (structure.low[hub] + structure.high[hub]) / 2
    assert [pair for place in middles[:: max(len(hub) // 6, 1)] for pair in structure.overlaps(place)] == []


def test_an_overlap_is_found() -> None:
    lamellas = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8).strips(Section(0.06, 0.001, 2, 0.02))
    made = make_hardware(lamellas, lamellas.parts(), JointRules())
    # the same strips without their holes
    structure = Structure(lamellas, lamellas.parts(), made.hardware.of("screw"), step=0.01)
    assert len(structure.overlaps(structure.places(1)[0])) >= 2
