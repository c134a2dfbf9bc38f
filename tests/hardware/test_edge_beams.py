"""Edge beams: their axes, segments, end plates, base plates, and the lamellas' ends at them."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import lamella
from lamella import InputError, Section, compute, parse_project
from lamella.fabrication.cut_length import segment_lengths
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.flat import outline_points
from lamella.fabrication.parts import make_parts
from lamella.fabrication.read_back import read_slots
from lamella.files.write.dxf_text import BlockWriter, Placed
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.hardware.beam_axes import edge_beam_axes
from lamella.hardware.edge_rules import EdgeBeamRules
from lamella.hardware.fold_drawing import draw_folds
from lamella.hardware.make_hardware import Joined, half_joint_of, make_hardware
from lamella.hardware.rims import rim_pieces
from lamella.hardware.rules import JointRules
from lamella.hardware.shape import Sweep
from lamella.network.network import BOUNDARY
from lamella.strip.lamellas import Lamellas, crossings
from lamella.strip.layer_map import LayerMap
from solid.overlaps import Structure

SECTION = Section(0.1, 0.0015, 2, 0.025)
JOINTS = JointRules()
TUBE = EdgeBeamRules(ground=0.0)
FLAT = EdgeBeamRules(section=None, flat=(0.1, 0.01), segment=2.0)

NETS = {
    # straight edges of a film, which lamellas meet at right angles
    "skew square": lambda: lamella.net(
        lamella.film([lamella.polyline([(0, 0, 0), (4, 0, 1.2), (4, 4, 0), (0, 4, 1.2)])]), cells=8
    ),
    # a rim met at all angles, crossings next to it
    "wavy rim": lambda: lamella.net(lamella.Enneper(3, 0.8, 3.0), cells=8),
    # two rims, met at 45 degrees
    "rings": lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8),
}


SOME = ["skew square", pytest.param("wavy rim", marks=pytest.mark.slow), pytest.param("rings", marks=pytest.mark.slow)]


@cache
def strips_of(name: str) -> Lamellas:
    return NETS[name]().strips(SECTION)


@cache
def beams_of(name: str, rules: EdgeBeamRules) -> tuple[EdgeBeamAxes, Joined]:
    lamellas = strips_of(name)
    axes = edge_beam_axes(lamellas, {0: rules, 1: rules}, JOINTS, half_joint_of(lamellas, JOINTS))
    parts = make_parts(lamellas.network, lamellas, density=7900, trims=axes.trims)
    return axes, make_hardware(lamellas, parts, JOINTS, None, axes)


def test_rims_of_known_length_with_the_surface_to_their_left() -> None:
    # parallels of an unduloid, edges of a square, a circle of the parameter disc
    unduloid = lamella.Unduloid(1.0, 1.6, (-1.0, 1.0))
    pieces = rim_pieces(unduloid)
    assert [piece.closed for piece in pieces] == [True, True]
    for piece in pieces:
        radius = np.hypot(*piece.points[0, :2])
        assert piece.length == pytest.approx(2 * np.pi * radius, rel=1e-4)
        there = piece.frames(np.linspace(0, piece.length, 7))
        # outwards is away from the waist
        assert (there.out[:, 2] * np.sign(there.points[:, 2]) > 0).all()
        assert np.abs(np.hypot(*there.points[:, :2].T) - radius).max() < 1e-9
    square = rim_pieces(lamella.Scherk(1.0, 2.5))
    assert [piece.closed for piece in square] == [False] * 4
    for piece in square:
        ends = piece.points[[0, -1]]
        assert np.abs(ends[:, :2]).max(axis=0) == pytest.approx([2.5, 2.5], rel=1e-12)
        middle = piece.frames(np.array([piece.length / 2]))
        assert middle.out[0] @ (middle.points[0] * (1, 1, 0)) > 0
    corners = {
        tuple(piece.points[0].round(9).tolist()) for piece in rim_pieces(strips_of("skew square").network.surface)
    }
    assert corners == {(0, 0, 0), (4, 0, 1.2), (4, 4, 0), (0, 4, 1.2)}


@pytest.mark.parametrize("name", SOME)
def test_beams_keep_their_distance_from_the_rim_and_their_length(name: str) -> None:
    axes, made = beams_of(name, FLAT)
    beams = made.hardware.of("edge_beam")
    total = 0.0
    for axis in axes.axes:
        here = f"side {axis.piece.number + 1} of boundary {axis.piece.loop + 1},"
        mine = [(item, k) for item in beams for k, label in enumerate(item.places.labels) if label.startswith(here)]
        assert all(item.length <= FLAT.segment + 2 * 0.1 for item, _ in mine)
        fine = axis.piece.frames(np.linspace(0, axis.piece.length, 4001))
        curve = fine.beside(axis.distance)
        total += np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
        for item, k in mine:
            (shape,) = item.shape
            assert isinstance(shape, Sweep)
            assert item.length == pytest.approx(shape.length, rel=1e-12)
            inner = item.places.world(shape.points[1:-1])[k]
            if len(inner):
                away = np.linalg.norm(inner[:, None] - curve[None], axis=2).min(axis=1)
                assert away.max() < np.linalg.norm(np.diff(curve, axis=0), axis=1).max() / 2 + 1e-4
    # closed forms of revolution have no corners, a square's sides go on in its corners by the distance
    corners = 2 * sum(not axis.piece.closed for axis in axes.axes) * axes.axes[0].distance
    assert sum(item.quantity * item.length for item in beams) == pytest.approx(total + corners, rel=1e-3)


def test_a_bar_around_a_ring_is_cut_as_a_cone_unrolled() -> None:
    """A bar along the normals of a circle of radius R is a cone, which is exactly an annulus of radii |1/kn| + z."""
    axes, made = beams_of("rings", FLAT)
    width = FLAT.flat[0]
    bars = made.hardware.of("edge_beam")
    assert all(item.plate for item in bars)
    for item in bars:
        (frame, point) = item.places.axes[0], item.places.origins[0]
        axis = min(axes.axes, key=lambda one: abs(one.piece.points[0, 2] - point[2]))
        assert axis.piece.closed
        radius = np.hypot(*point[:2])
        outwards = np.append(point[:2] / radius, 0.0)
        bend = -(frame[1] @ outwards) / radius
        flat = outline_points(item.cut.outline, 1)[:-1]
        half = len(flat) // 2
        # the middle of the whole of it, along y from the middle of the bar
        heading = item.length * bend / 2
        away = np.hypot(flat[:, 0], flat[:, 1] - 1 / bend)
        side = np.where(np.arange(len(flat)) < half, -width / 2, width / 2)
        np.testing.assert_allclose(away, np.abs(1 / bend - side), atol=2e-5)
        for edge, z in ((flat[:half], -width / 2), (flat[half:], width / 2)):
            angle = np.ptp(np.arctan2(edge[:, 0], np.abs(edge[:, 1] - 1 / bend)))
            assert angle == pytest.approx(2 * abs(heading), rel=1e-4)
            # the true length of that edge of the cone
            assert angle * abs(1 / bend - z) == pytest.approx(item.length * (1 - z * bend), rel=1e-4)
        assert item.cut.area == pytest.approx(item.length * width, rel=1e-4)


def test_a_twisted_bar_is_as_long_as_its_edges_but_for_the_twist() -> None:
    """Edges of a bar twisted by tg are longer by tg^2 w^2 / 8 than those of the flat one, mitred or not."""
    for name in ("wavy rim", "skew square"):
        _, made = beams_of(name, FLAT)
        for item in made.hardware.of("edge_beam"):
            if item.pattern is None:
                # straight towards the normal: bought as it is
                assert "cut straight" in item.description
                continue
            (shape,) = item.shape
            twist = float(item.description.split("up to ")[1].split()[0]) if "up to" in item.description else 0.0
            strain = np.radians(twist) ** 2 * FLAT.flat[0] ** 2 / 8
            outline = item.cut.outline
            half = len(outline) // 2
            for part, z in ((outline[:half], -0.05), (outline[half:], 0.05)):
                lengths = segment_lengths(np.vstack([part, part[:1]]))[: half - 1]
                # the bar stands square to its own axis
                along = np.gradient(shape.points, axis=0, edge_order=2)
                along /= np.linalg.norm(along, axis=1)[:, None]
                up = shape.up - np.einsum("ij,ij->i", shape.up, along)[:, None] * along
                up /= np.linalg.norm(up, axis=1)[:, None]
                true = np.linalg.norm(np.diff(shape.points + z * up, axis=0), axis=1).sum()
                assert -1e-4 < true / lengths.sum() - 1 < strain + 1e-4


@pytest.mark.parametrize("turned", [False, True])
def test_folds_are_drawn_with_their_angle_on_the_leg(turned: bool, tmp_path: Path) -> None:
    """The middle of the fold across the plate, its angle in strokes beside it on the plate, clear of the holes."""
    _, made = beams_of("wavy rim", TUBE)
    for item in made.hardware.of("end plate"):
        (fold,) = item.folds
        writer = BlockWriter("")
        draw_folds(writer, item, turned=turned)
        drawn = Placed(writer.block(), 0.0, 0.0)
        points = drawn.points @ (np.array([[0, -1], [1, 0]]) if turned else np.eye(2)) / 1e3
        layers = {one.layer: [] for one in drawn.block.drawn}
        for one in drawn.block.drawn:
            layers[one.layer].append(points[one.first : one.end])
        (line,) = layers["MARK"]
        outline = item.cut.outline[:, :2]
        low, high = outline.min(axis=0), outline.max(axis=0)
        np.testing.assert_allclose(np.sort(line[:, 1]), [low[1], high[1]], atol=1e-9)
        # from the inner end: the leg, and half of the fold's middle surface
        thickness, legs = TUBE.end_plate, item.description.split("folded by ")[1].split()[0]
        assert np.degrees(fold.angle) == pytest.approx(float(legs), abs=1e-9)
        bent = 1.5 * thickness * fold.angle
        leg = high[0] - line[0, 0] - bent / 2 + 1.5 * thickness * np.tan(fold.angle / 2)
        assert leg == pytest.approx(TUBE.end_plate_leg, abs=1e-9) or leg < TUBE.end_plate_leg
        text = np.concatenate(layers["TEXT"])
        assert (text > [line[0, 0] + fold.radius, low[1]]).all()
        assert (text < high).all()
        assert fold.text == f"UP {float(legs):g}"


def test_a_square_of_straight_tubes_is_mitred() -> None:
    _, made = beams_of("skew square", TUBE)
    beams = made.hardware.of("edge_beam")
    side = np.hypot(4.0, 1.2)
    # opposite sides are equal, neighbours mirrored
    assert [item.quantity for item in beams] == [2, 2]
    assert [item.length for item in beams] == pytest.approx([side] * 2, rel=1e-9)
    assert all(item.description.endswith("straight") for item in beams)
    metal = np.pi / 4 * (0.0603**2 - (0.0603 - 2 * 0.0032) ** 2)
    assert beams[0].mass == pytest.approx(7900 * metal * side, rel=1e-9)
    # planes of the mitres halve the angle of the corner
    for item in beams:
        cuts = item.shape[0].cuts
        ahead = np.diff(item.shape[0].points, axis=0)[0] / side
        corner = np.arccos(np.clip((np.array([4, 0, 1.2]) / side) @ (np.array([0, 4, -1.2]) / side), -1, 1))
        assert np.arccos(cuts @ ahead) == pytest.approx([corner / 2] * 2, abs=1e-6)
    # of eight corners' ends on the ground two plates are left, one a corner
    assert [item.quantity for item in made.hardware.of("base plate")] == [2]


@pytest.mark.parametrize("name", SOME)
def test_each_end_plate_has_the_fold_of_its_lamella(name: str) -> None:
    axes, made = beams_of(name, TUBE)
    plates = made.hardware.of("end plate")
    network = strips_of(name).network
    ids = {one: k for k, one in enumerate(network.ids)}
    checked = 0
    for item in plates:
        fold = float(item.description.split("folded by ")[1].split()[0])
        for label in item.places.labels:
            lamella_id, which = label.split()
            k = ids[lamella_id]
            at = network.sample_offsets[k + 1] - 1 if which == "end" else network.sample_offsets[k]
            point, tangent = network.sample_points[at], network.sample_tangents[at]
            # the rim's direction from its samples alone
            nearest = min(
                (axis.piece for axis in axes.axes), key=lambda p: np.linalg.norm(p.points - point, axis=1).min()
            )
            at = int(np.argmin(np.linalg.norm(nearest.points - point, axis=1)))
            chord = nearest.points[min(at + 1, len(nearest.points) - 1)] - nearest.points[max(at - 1, 0)]
            angle = np.degrees(np.arccos(min(abs(tangent @ chord) / np.linalg.norm(chord), 1.0)))
            # a plate's distance from the rim turns it by its share of the rim's radius
            assert fold == pytest.approx(angle, abs=8.0 if name == "wavy rim" else 0.6)
            checked += 1
    assert checked == sum(item.quantity for item in plates) > 10
    told = sum(note.key == "ends_at_their_joint" for note in made.hardware.warnings)
    assert checked == len(axes.ends)
    assert told == bool(len(axes.left_out))
    # two screws and two packers a plate
    screws = [item for item in made.hardware.of("screw") if item.id.startswith("end")]
    assert sum(item.quantity for item in screws) == 2 * checked
    assert sum(item.quantity for item in made.hardware.of("end-packer")) == 2 * checked


@pytest.mark.parametrize("name", ["skew square", "wavy rim"])
def test_ends_of_both_layers_rebuilt_from_the_drawings_lie_before_the_beam(name: str, tmp_path: Path) -> None:
    lamellas = strips_of(name)
    axes, made = beams_of(name, TUBE)
    write_drawings(tmp_path, made.parts, made.parts.nest(), name="x", version="0")
    drawn = read_slots(tmp_path / "A.dxf") | read_slots(tmp_path / "B.dxf")
    told_ends = (values.tolist() for values in (axes.ends.lamellas, axes.ends.last, axes.ends.axes))
    ends = {(k, last): number for k, last, number in zip(*told_ends, strict=True)}
    checked, shifts = 0, []
    for part in made.parts.parts:
        told = drawn[part.id]
        assert told.corners / 1e3 + part.start == pytest.approx(part.corners, abs=2e-7)
        layer = LayerMap.of(lamellas, part.lamella, part.layer - 1)
        for last in (False, True):
            if (part.lamella, last) not in ends:
                continue
            axis = axes.axes[ends[part.lamella, last]]
            for z, station in zip((-0.05, 0.05), told.corners[int(last)] / 1e3 + part.start, strict=True):
                point, _, normal, _ = layer.frames(np.array([station]))
                corner = (point + z * normal)[0]
                fine = axis.piece.frames(np.linspace(0, axis.piece.length, 20001))
                k = int(np.argmin(np.linalg.norm(fine.points - corner, axis=1)))
                out = (corner - fine.points[k]) @ fine.out[k]
                assert out == pytest.approx(axis.trim, abs=1e-4)
            shifts.append(float(np.ptp(told.corners[int(last)])))
            checked += 1
    assert checked == 2 * len(axes.ends)
    # mm: they are cut obliquely
    assert max(shifts) > 0.5 or name == "skew square"


def test_an_end_without_a_plate_is_cut_behind_its_last_joint() -> None:
    lamellas = strips_of("wavy rim")
    axes, made = beams_of("wavy rim", TUBE)
    network = lamellas.network
    on_rim = network.node_kinds[network.stop_nodes] == BOUNDARY
    left_out = set(zip(axes.left_out.lamellas.tolist(), axes.left_out.last.tolist(), strict=True))
    plated = set(zip(axes.ends.lamellas.tolist(), axes.ends.last.tolist(), strict=True))
    assert len(left_out) > 5
    assert len(left_out) + len(plated) + axes.askew + axes.loose == on_rim.sum()
    assert not left_out & plated
    crossing = crossings(network)[network.stop_nodes]
    checked = 0
    for part in made.parts.parts:
        own = np.arange(network.stop_offsets[part.lamella], network.stop_offsets[part.lamella + 1])
        joints = own[crossing[own]]
        for last, joint, end in ((False, joints[0], part.start), (True, joints[-1], part.end)):
            if (part.lamella, last) in left_out:
                station = lamellas.layers.stop_stations[part.layer - 1, joint]
                # its outer slots, and as much beyond them as everywhere
                assert abs(end - station) == pytest.approx(SECTION.offset / 2 + 0.05, abs=1e-9)
                assert part.slots.size
                checked += 1
    assert checked == 2 * len(left_out)
    # no shear block beyond it
    for item in made.hardware.of("shear block"):
        for label in item.places.labels:
            name, at = label.split(" at ")
            k, arc = network.ids.index(name), float(at.split()[0]) / 1e3
            own = slice(network.stop_offsets[k], network.stop_offsets[k + 1])
            places = network.stop_arclengths[own][crossing[own]]
            assert (k, False) not in left_out or arc > places[0]
            assert (k, True) not in left_out or arc < places[-1]


@pytest.mark.slow
def test_end_plates_in_corners_of_a_vault_lead_back() -> None:
    """Lamellas that meet a rim at 45 degrees next to its corners: all ends have plates, clear of one another."""
    example = (Path(__file__).parents[2] / "examples" / "15_vault.toml").read_text()
    table = tomllib.loads(example)
    table["lamella"] |= {"layers": 2, "layer_lengths": "own"}
    results = compute(parse_project(table | {"joint": {}, "edge_beam": {"section": "tube 60.3x3.2"}}))
    made, lamellas = results.outputs["fabrication"], results.outputs["lamellas"].lamellas
    assert sum(item.quantity for item in made.hardware.of("end plate")) == 116
    assert not [note for note in made.hardware.warnings if note.key.startswith("ends_")]
    corners = {tuple(axis.points[0].round(6).tolist()) for axis in rim_pieces(lamellas.network.surface)}
    assert len(corners) == 4
    structure = Structure(lamellas, made.parts, made.hardware.items)
    plates = [k for k in structure.of("end-") if structure.names[k].split()[0].split("-")[1].isdigit()]
    middles = (structure.low[plates] + structure.high[plates]) / 2
    for corner in corners:
        nearest = middles[np.argsort(np.linalg.norm(middles - corner, axis=1))[:4]]
        pairs = [pair for place in nearest for pair in structure.overlaps(place)]
        # but for the mitre of the tubes themselves, of which one is bent
        assert [pair for pair in pairs if not all(name.startswith("edge-") for name in pair[:2])] == []


@pytest.mark.parametrize("name", ["wavy rim", pytest.param("rings", marks=pytest.mark.slow)])
def test_no_two_solids_overlap_at_the_ends(name: str) -> None:
    lamellas = strips_of(name)
    _, made = beams_of(name, TUBE)
    structure = Structure(lamellas, made.parts, made.hardware.items)
    plates = [k for k in structure.of("end-") if structure.names[k].split()[0].split("-")[1].isdigit()]
    middles = (structure.low[plates] + structure.high[plates]) / 2
    assert [pair for place in middles[:: max(len(plates) // 3, 1)] for pair in structure.overlaps(place)] == []


@pytest.mark.parametrize(
    ("rules", "where"),
    [
        (EdgeBeamRules(section="tube 30x2"), "end_plate_height"),
        (EdgeBeamRules(section="pipe 30x2"), "section"),
        (EdgeBeamRules(section="tube 30x15"), "section"),
        (EdgeBeamRules(section=None, flat=(0.03, 0.01)), "end_plate_height"),
        (EdgeBeamRules(section=None, flat=(0.01, 0.1)), "flat"),
        (EdgeBeamRules(end_plate_height=0.2, section=None, flat=(0.3, 0.01)), "end_plate_height"),
        (EdgeBeamRules(end_plate_height=0.01), "end_plate_height"),
        (EdgeBeamRules(end_plate=0.03), "end_plate"),
        (EdgeBeamRules(end_plate_leg=0.008), "end_plate_leg"),
        (EdgeBeamRules(ground=0.0, base_plate=0.06, anchor=0.02), "base_plate"),
        (EdgeBeamRules(distance=-0.5), "distance"),
        (EdgeBeamRules(end_plate_leg=1.5), "end_plate_leg"),
    ],
)
def test_bad_measures_are_refused_with_their_limit(rules: EdgeBeamRules, where: str) -> None:
    with pytest.raises(InputError) as refused:
        beams_of("skew square", rules)
    assert refused.value.where == where
    assert any(digit.isdigit() for digit in refused.value.remedy)


PROJECT = {
    "surface": {
        "kind": "form-found",
        "boundary": [
            {"circle": {"center": [0, 0, 0], "radius": 2.0}, "edge_beam": False},
            {"circle": {"center": [0, 0, 0.8], "radius": 1.2}},
        ],
    },
    "network": {"cells": 10},
    "lamella": {"layer_curves": "cut"},
    "joint": {"block_spacing": 0},
    "edge_beam": {"section": "tube 60.3x3.2"},
}

THIN = {"circle": {"center": [0, 0, 0], "radius": 2.0}, "edge_beam": {"section": "tube 9x1"}}


def test_each_boundary_has_its_own_beam_or_none() -> None:
    results = compute(parse_project(PROJECT))
    figures = results.summary["fabrication"]["hardware"]["edge_beam"]
    # one ring at the distance that the crossings next to the rim need
    assert figures["length"] > 2 * np.pi * 1.2 * 0.97
    assert figures["count"] == np.ceil(figures["length"] / 6)
    circumference = np.pi * (0.0603**2 - 0.0539**2) / 4 * 7850 * figures["length"]
    assert figures["mass"] == pytest.approx(circumference, rel=1e-6)


@pytest.mark.parametrize(
    ("tables", "where"),
    [
        ({"edge_beam": {"section": "tube 20x2"}}, "edge_beam.end_plate_height"),
        ({"edge_beam": {"section": "tube 60x3", "flat": [0.1, 0.01]}}, "edge_beam.flat"),
        ({"edge_beam": {"flat": [100, 10]}}, "edge_beam.flat"),
        ({"edge_beam": {"material": "cheese"}}, "edge_beam.material"),
        ({"edge_beam": {"sektion": "tube 60x3"}}, "edge_beam.sektion"),
        ({"joint": None}, "edge_beam"),
        (
            {"surface": PROJECT["surface"] | {"boundary": [THIN, PROJECT["surface"]["boundary"][1]]}},
            "surface.boundary[0].edge_beam.end_plate_height",
        ),
    ],
)
def test_what_cannot_be_an_edge_beam_is_refused_by_its_key(tables: dict, where: str) -> None:
    project = {key: value for key, value in (PROJECT | tables).items() if value is not None}
    with pytest.raises(InputError) as refused:
        compute(parse_project(project))
    assert refused.value.where == where
    assert refused.value.remedy
