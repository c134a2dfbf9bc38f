"""The stage "erection": its files, its figures, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.erection.samples import sampled
from lamella.stages.check import check_project
from lamella.stages.erection.stage import STATE_BYTES
from lamella.stages.fabrication.slot_widths import _needed
from lamella.stages.scene import scene_of
from lamella.view.scene.encode import encode_scene
from stages.csv_rows import rows
from validation.measure_network import measure

PROJECT = {
    "name": "Patch",
    "surface": {"kind": "enneper", "order": 2, "radius": 0.6, "scale": 3.0},
    "network": {"spacing": 0.6},
    "lamella": {"layers": 2},
    "erection": {"states": 4, "elements": 3},
}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("erection") / "out"
    lamella.write(lamella.compute(lamella.parse_project(PROJECT), until="erection"), folder)
    return folder


def test_states_are_networks(run: Path) -> None:
    """The ruler measures every state from its points: edges keep their lengths, the flat one is planar."""
    network = json.loads((run / "network.json").read_text())
    states = json.loads((run / "erection" / "states.json").read_text())
    assert states["schema"] == "lamella/erection/1"
    assert [state["share"] for state in states["states"]] == pytest.approx([0, 1 / 3, 2 / 3, 1], abs=1e-9)
    angles = []
    for state in states["states"]:
        laid = network | {
            "nodes": [
                node | {"point": point, "normal": normal}
                for node, point, normal in zip(network["nodes"], state["nodes"], state["normals"], strict=True)
            ],
            "lamellas": [
                one | {"centreline": other["centreline"], "normals": other["normals"]}
                for one, other in zip(network["lamellas"], state["lamellas"], strict=True)
            ],
        }
        assert [one["id"] for one in network["lamellas"]] == [one["id"] for one in state["lamellas"]]
        figures = measure(laid)
        # two elements of the helix between the samples: nodes lie on the lamellas
        assert figures["node_off_centreline_max"] < 1e-9
        assert figures["node_arclength_error_max"] < 2e-4
        kinds = [node["kind"] for node in network["nodes"]]
        told = [a for a, kind in zip(state["joint_angles_deg"], kinds, strict=True) if kind == "regular"]
        # the ruler fits quartics across joints, where the slope of the curvature jumps
        mean = np.mean([abs(a - 90) for a in told])
        assert mean == pytest.approx(figures["node_angle_deviation_mean_deg"], abs=0.8)
        angles.append(max(abs(a - 90) for a in told))
    flat = np.array(states["states"][0]["nodes"])
    assert np.linalg.svd(flat - flat.mean(0), compute_uv=False)[2] < 1e-8
    assert angles == sorted(angles, reverse=True)


def test_path(run: Path) -> None:
    """A row a node and state, the same places to 0.01 mm."""
    states = json.loads((run / "erection" / "states.json").read_text())["states"]
    told = rows(run / "erection" / "path.csv")
    assert len(told) == sum(len(state["nodes"]) for state in states)
    places = np.array([[float(row[key]) for key in ("x_m", "y_m", "z_m")] for row in told])
    np.testing.assert_allclose(places, np.concatenate([state["nodes"] for state in states]), atol=5.1e-6)


def test_assembly_drawing(run: Path) -> None:
    """Every layer of every lamella once, as long and as thick as it is; no errors of the file."""
    drawing = ezdxf.readfile(run / "erection" / "flat.dxf")
    assert not drawing.audit().errors
    network = json.loads((run / "network.json").read_text())
    layers = [entity for entity in drawing.modelspace() if entity.dxf.layer == "MARK"]
    lengths = {one["id"]: one["node_arclengths"][-1] for one in network["lamellas"]}
    found: dict[str, list[float]] = {}
    for entity in layers:
        corners = np.array([point[:2] for point in entity.get_points()])
        half = len(corners) // 2
        tag = entity.get_xdata("LAMELLA")[0].value
        one, other = corners[:half], corners[half:][::-1]
        assert np.linalg.norm(one - other, axis=1) == pytest.approx(1.5, abs=1e-6)
        found.setdefault(tag, []).append(np.linalg.norm(np.diff((one + other) / 2, axis=0), axis=1).sum() / 1000)
    assert set(found) == set(lengths)
    for tag, both in found.items():
        assert len(both) == 2
        # layers to either side are longer and shorter than the centre line, which drawn in chords loses little
        assert np.mean(both) == pytest.approx(lengths[tag], rel=2e-3)


def test_figures(run: Path) -> None:
    figures = json.loads((run / "summary.json").read_text())["erection"]
    assert figures["flat"]["lies"]
    assert figures["flat"]["height"] == 0
    assert figures["flat"]["overlaps"] == 0
    assert figures["flat"]["joint_angle_min_deg"] + figures["flat"]["joint_angle_max_deg"] == pytest.approx(
        180, abs=1e-5
    )
    off = np.radians(figures["flat"]["joint_angle_max_deg"] - 90)
    assert figures["slot_width_needed"] == pytest.approx(0.0015 * (1 + np.sin(off)) / np.cos(off), rel=1e-9)
    assert 0 < figures["energy_flat"] < figures["energy_designed"]
    assert 0.3 < figures["leaves_plane"] < 1


def test_same_bytes_twice(run: Path, tmp_path: Path) -> None:
    lamella.write(lamella.compute(lamella.parse_project(PROJECT), until="erection"), tmp_path / "out")
    for name in ("states.json", "path.csv", "flat.dxf"):
        assert (tmp_path / "out" / "erection" / name).read_bytes() == (run / "erection" / name).read_bytes()


def test_no_stage_without_its_table() -> None:
    project = lamella.parse_project({key: value for key, value in PROJECT.items() if key != "erection"})
    assert lamella.compute(project).summary["erection"] is None
    with pytest.raises(InputError) as caught:
        lamella.compute(project, until="erection")
    assert caught.value.where == "erection"


WIDE = PROJECT | {"surface": {"kind": "enneper", "order": 2, "radius": 0.9, "scale": 3.0}, "network": {"spacing": 1.2}}


def _slots(folder: Path) -> set[float]:
    """Widths of the slots in the drawings, mm, by their feet."""
    found = set()
    for name in "AB":
        for entity in ezdxf.readfile(folder / "fabrication" / f"{name}.dxf").modelspace():
            if entity.dxf.layer == "CUT" and entity.dxftype() == "LWPOLYLINE":
                corners = np.array([point[:2] for point in entity.get_points()])
                edges = np.diff(corners, axis=0)
                short = np.linalg.norm(edges, axis=1)
                # a foot is square to the sides before and behind it, which are longer than it is wide
                foot = (short[1:-1] < 10) & (short[:-2] > 40) & (short[2:] > 40)
                found |= set(np.round(short[1:-1][foot], 3).tolist())
    return found


def test_slots_are_as_wide_as_the_way_needs(tmp_path: Path) -> None:
    """Nothing says how wide they are: in the figures, the drawings and the filled in project; given ones stay."""
    results = lamella.compute(lamella.parse_project(WIDE))
    needed, width = results.summary["erection"]["slot_width_needed"], results.summary["fabrication"]["slot_width"]
    assert 0.003 < needed <= width <= 1.1 * needed
    assert results.project.fabrication.slot_width == width
    lamella.write(results, tmp_path / "out")
    assert _slots(tmp_path / "out") == {1000 * width}
    assert "slots_too_narrow" not in [warning.key for warning in results.summary["warnings"]]
    again = lamella.compute(lamella.parse_project(WIDE), until="fabrication")
    assert again.summary["fabrication"]["slot_width"] == width
    given = lamella.compute(lamella.parse_project(WIDE | {"fabrication": {"slot_width": 0.003}}))
    assert given.project.fabrication.slot_width == 0.003
    assert "slots_too_narrow" in [warning.key for warning in given.summary["warnings"]]


def test_slots_of_segments() -> None:
    """The widest that any of the segments needs, which are those that are erected."""
    project = lamella.parse_project(WIDE | {"joint": {}, "segments": {"size": 6.0}, "erection": {"states": 2}})
    results = lamella.compute(project)
    made = results.summary["erection"]["segments"]
    assert len(made) > 1
    needed = max(one["slot_width_needed"] for one in made if one["fault"] is None)
    most = project.lamella.offset / 2
    assert results.summary["fabrication"]["slot_width"] == pytest.approx(min(max(needed, 0.003), most), rel=0.1)


@pytest.mark.parametrize(("key", "value"), [("states", 1), ("elements", 0), ("driver", "wind")])
def test_refused(key: str, value: object) -> None:
    with pytest.raises(InputError) as caught:
        lamella.parse_project(PROJECT | {"erection": {key: value}})
    assert caught.value.where == f"erection.{key}"


def test_narrow_slots_are_named() -> None:
    """A slot as wide as the strip lets nothing turn: the joint and the width that is needed are told."""
    project = lamella.parse_project(PROJECT | {"fabrication": {"slot_width": 0.0016}})
    results = lamella.compute(project, until="erection")
    (warning,) = [text for text in results.summary["warnings"] if text.key == "slots_too_narrow"]
    assert f"{1e3 * results.summary['erection']['slot_width_needed']:.3g} mm" in warning


def test_bracing_keeps_the_shape() -> None:
    """Locked joints alone hold nothing; diagonals hold it better, edge beams still better, both best (paper, 3.3)."""
    project = PROJECT | {
        "network": {"spacing": 0.8},
        "joint": {},
        "cables": {"every": 1},
        "edge_beam": {"section": "tube 60.3x3.2"},
        "erection": {"states": 2, "elements": 1},
    }
    figures = lamella.compute(lamella.parse_project(project), until="erection").summary["erection"]
    braced = figures["spring_back_braced"]
    assert braced["both"] < braced["edge_beams"] < braced["cables"] < figures["spring_back"]


def test_a_net_that_nothing_braces_is_named() -> None:
    results = lamella.compute(lamella.parse_project(PROJECT), until="erection")
    (warning,) = [text for text in results.summary["warnings"] if text.key == "springs_back"]
    assert f"{results.summary['erection']['spring_back']:.3g} m" in warning


@pytest.mark.slow
def test_segments(tmp_path: Path) -> None:
    """Each is laid flat by itself, in a folder of its own; together they have the edges that are not cut."""
    project = PROJECT | {
        "lamella": {"layers": 1},
        "segments": {"size": 3.0},
        "erection": {"states": 3, "elements": 1},
    }
    results = lamella.compute(lamella.parse_project(project), until="erection")
    lamella.write(results, tmp_path / "out")
    figures = results.summary["erection"]
    told = {one["id"]: one for one in figures["segments"]}
    assert [one["id"] for one in results.summary["fabrication"]["segments"]] == list(told)
    assert len(told) > 1
    for name, one in told.items():
        assert one["fault"] is None
        assert one["flat"]["lies"]
        assert max(one["flat"]["size"]) < 3.5
        states = json.loads((tmp_path / "out" / "erection" / name / "states.json").read_text())["states"]
        points = np.array(states[0]["nodes"])
        assert np.linalg.svd(points - points.mean(0), compute_uv=False)[2] < 1e-8
        assert (tmp_path / "out" / "erection" / name / "flat.dxf").stat().st_size > 0
    assert figures["spring_back"] == max(one["spring_back"] for one in told.values())
    assert figures["energy_designed"] == pytest.approx(sum(one["energy_designed"] for one in told.values()))
    assert figures["spring_back_braced"] == {}


def test_a_check_leaves_long_ones_to_the_run() -> None:
    """Up to so many elements times states it lays the net flat, beyond that it says that it does not."""
    short = check_project(lamella.parse_project(PROJECT))
    assert not short.left
    long = PROJECT | {"erection": {"states": 1000, "elements": 2}}
    (left,) = check_project(lamella.parse_project(long)).left
    assert "elements times states" in left


def test_stacked_lamellas_need_no_slots() -> None:
    """They turn about their bolts: no width of slots is told, however thick they are."""
    project = PROJECT | {
        "lamella": {"height": 0.06, "thickness": 0.008, "layers": 2, "material": "C24"},
        "joint": {"kind": "stacked"},
        "erection": {"states": 2, "elements": 1},
    }
    summary = lamella.compute(lamella.parse_project(project), until="erection").summary
    assert summary["erection"]["slot_width_needed"] is None
    assert not [text for text in summary["warnings"] if text.key == "slots_too_narrow"]
    assert summary["erection"]["flat"]["lies"]


CORNERS = [[-1.2, 1.5, 0.3], [1.5, -1.2, 0.3]]
SMALL = PROJECT | {"network": {"spacing": 0.9}, "lamella": {"layers": 1}}


def driven(**keys: object) -> dict[str, object]:
    return SMALL | {"erection": {"states": 3, "elements": 1} | keys}


def test_driven_by_a_cable(tmp_path: Path) -> None:
    """Forces, states and figures tell the same way; what is written is read back."""
    project = lamella.parse_project(driven(driver={"cable": {"between": CORNERS, "by": 0.4}}))
    results = lamella.compute(project, until="erection")
    lamella.write(results, tmp_path / "out")
    way = results.summary["erection"]["way"]
    states = json.loads((tmp_path / "out" / "erection" / "states.json").read_text())
    told = rows(tmp_path / "out" / "erection" / "forces.csv")
    assert (states["driver"], states["driver_unit"], states["start"]) == ("cable", "N", "flat")
    assert [float(row["share"]) for row in told] == [state["share"] for state in states["states"]] == [0, 0.5, 1]
    assert way["force_max"] == pytest.approx(max(float(row["force_n"]) for row in told), abs=1e-3)
    assert results.summary["erection"]["driver_max"] == pytest.approx(way["force_max"])
    assert results.summary["erection"]["joint_moment_max"] is None
    node = int(told[0]["node"])
    points = np.array([state["nodes"] for state in states["states"]])
    spans = np.linalg.norm(points[:, node, None] - points, axis=2)
    # one node is drawn nearer by what the cable loses
    assert np.abs(spans[0] - spans[2] - 0.4).min() < 1e-6
    again = lamella.read_project(tmp_path / "out" / "project.toml")
    assert again.erection == project.erection


def test_a_mechanism_between_two_angles() -> None:
    results = lamella.compute(
        lamella.parse_project(driven(driver={"angles": {"least": 80.0, "most": 105.0}})), until="erection"
    )
    way = results.summary["erection"]["way"]
    assert (way["motion"]["least"], way["motion"]["most"]) == pytest.approx((80, 105), abs=1e-6)
    made = results.outputs["erection"].made[0]
    at = made.model.joint_nodes.tolist().index(way["motion"]["node"])
    assert [state.angles[at] for state in made.states] == pytest.approx([80, 92.5, 105], abs=1e-6)
    assert way["force_max"] is None


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ({"driver": 3}, "driver"),
        ({"driver": {"lft": {}}}, "driver.lft"),
        ({"driver": {"lift": {"at": [], "by": 1.0}}}, "driver.lift.at"),
        ({"driver": {"lift": {"at": CORNERS, "by": 1.0}, "supports": {"at": CORNERS, "by": 1.0}}}, "driver.supports"),
        ({"driver": {"cable": {"between": CORNERS[:1], "by": 0.1}}}, "driver.cable[0].between"),
        ({"driver": {"cable": [{"between": CORNERS, "by": 0.1}, {"between": CORNERS}]}}, "driver.cable[1].by"),
        ({"driver": {"radius": {"factor": 0.9}}}, "driver.radius.boundary"),
        ({"driver": {"radius": {"factor": -1.0, "boundary": "rim"}}}, "driver.radius.factor"),
        ({"driver": {"angles": {"least": 90.0, "most": 80.0}}}, "driver.angles.most"),
        ({"driver": {"angles": {"least": 80.0, "most": 90.0}}, "gravity": True}, "gravity"),
        ({"driver": {"lift": {"at": CORNERS, "by": 1.0}}, "gravity": False}, "gravity"),
        ({"start": "designed"}, "start"),
        ({"props": []}, "props"),
    ],
)
def test_refused_drivers(table: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as caught:
        lamella.parse_project(driven(**table))
    assert caught.value.where == f"erection.{key}"


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ({"driver": {"cable": {"between": CORNERS[:1] * 2, "by": 0.1}}, "start": "designed"}, "driver.cable"),
        ({"driver": {"cable": {"between": CORNERS, "by": 60.0}}, "start": "designed"}, "driver.cable.by"),
        ({"driver": {"lift": {"at": [[90.0, 0, 0]], "by": 0.1}}}, "driver.lift.at"),
        ({"driver": {"supports": {"at": CORNERS, "by": 30.0}}, "start": "designed"}, "driver.supports.by"),
        ({"driver": {"radius": {"boundary": "rin", "factor": 0.9}}}, "driver.radius.boundary"),
        ({"driver": {"radius": {"through": [0, 0, 0], "factor": 0.9}}}, "driver.radius.through"),
        ({"driver": {"angles": {"least": 80.0, "most": 90.0, "at": [2.0, 2.0, 0]}}}, "driver.angles.at"),
    ],
)
def test_drivers_that_do_not_suit_the_net(table: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as caught:
        lamella.compute(lamella.parse_project(driven(**table)), until="erection")
    assert caught.value.where == f"erection.{key}"


def test_segments_are_driven_by_their_angles() -> None:
    project = driven(driver={"supports": {"at": CORNERS, "by": 0.1}}) | {"segments": {"size": 3.0}}
    with pytest.raises(InputError) as caught:
        lamella.compute(lamella.parse_project(project), until="erection")
    assert caught.value.where == "erection.driver"


def test_lifted_by_a_crane(tmp_path: Path) -> None:
    """Figures, list and warning tell the same; what braces it least is named."""
    project = driven(lifting={"points": [4]}) | {"lamella": {}, "joint": {}, "cables": {"every": 1}}
    results = lamella.compute(lamella.parse_project(project), until="erection")
    lamella.write(results, tmp_path / "out")
    figures = results.summary["erection"]["lifting"]
    told = rows(tmp_path / "out" / "erection" / "lifting.csv")
    assert [one["bracing"] for one in figures] == [row["bracing"] for row in told] == ["none", "cables"]
    for one, row in zip(figures, told, strict=True):
        assert [str(node) for node in one["nodes"]] == row["nodes"].split(";")
        assert float(row["deflection_m"]) == pytest.approx(one["deflection"], abs=1e-4)
        assert max(map(float, row["slings_n"].split(";"))) == pytest.approx(one["sling_max"], abs=0.1)
    assert [one["holds"] for one in figures] == [False, True]
    (warning,) = [text for text in results.summary["warnings"] if text.key == "lifting_needs_bracing"]
    assert warning.endswith("cables")


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ({"points": [5]}, "points"),
        ({"points": [3, 3]}, "points"),
        ({"points": []}, "points"),
        ({"at": [[0, 0, 0]]}, "at"),
        ({"limit": 0.0}, "limit"),
        ({"hook": -1.0}, "hook"),
    ],
)
def test_refused_lifting(table: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as caught:
        lamella.parse_project(driven(lifting=table))
    assert caught.value.where == f"erection.lifting.{key}"


def test_the_view_has_a_slider() -> None:
    """Strips and joints of the frames are where the states have them, and take the place of the designed net."""
    results = lamella.compute(lamella.parse_project(driven()), until="erection")
    (made,) = results.outputs["erection"].made
    scene = scene_of(results)
    (frames,) = [one for one in scene.frames if one.name == "erection"]
    assert frames.values.tolist() == [state.share for state in made.states]
    assert {"strips A", "strips B", "surface"} <= set(frames.hides)
    moved = {motion.layer: motion for motion in frames.motions}
    points, normals = sampled(made.model, made.states[0].poses)
    network = made.model.lamellas.network
    for family in "AB":
        own = np.repeat(network.families == family, np.diff(network.sample_offsets))
        np.testing.assert_allclose(moved[f"erection {family}"].positions[0], points[own], atol=1e-12)
        np.testing.assert_allclose(moved[f"erection {family}"].normals[0], normals[own], atol=1e-12)
    for state, turns in zip(made.states, moved["erection joints"].values["joint_turn"], strict=True):
        np.testing.assert_allclose(turns, state.angles - 90)
    assert len(encode_scene(scene)) > 10_000


def test_the_size_of_large_files_is_told_before(run: Path) -> None:
    """What is told is what is written, but for a tenth; of small files nothing is."""
    states = (run / "erection" / "states.json").stat().st_size
    network = json.loads((run / "network.json").read_text())
    samples = sum(len(one["centreline"]) for one in network["lamellas"]) + len(network["nodes"])
    assert states == pytest.approx(PROJECT["erection"]["states"] * samples * STATE_BYTES, rel=0.1)
    said: list[str] = []
    lamella.compute(
        lamella.parse_project(driven(states=2)), until="erection", progress=lambda report: said.append(report.text)
    )
    assert any("laid flat, and driven" in text for text in said)
    assert not any("MB" in text for text in said)


def test_joints_that_fold_up_do_not_widen_all_slots() -> None:
    """Those within 15 degrees of straight are held on the floor: the widest of the others counts."""
    net = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.6).strips()
    folded = SimpleNamespace(
        turned=(np.array([10.0, 82.0]), np.array([5.0, 30.0])), model=SimpleNamespace(lamellas=net)
    )
    assert _needed(folded) == pytest.approx(0.0015 * np.sqrt(3), rel=1e-12)
