"""`lamella optimise` as its users meet it: every problem from a file to a file, figures that are physical numbers,
what is told of the mesh, exit codes, refusals that write nothing.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from lamella import Catenoid, Enneper, Unduloid, quad_mesh
from lamella.command.main import main
from lamella.command.optimise_options import USED
from lamella.files.quad_mesh_files import QuadFile, quad_mesh_bytes, read_quad_mesh
from lamella.files.write.optimise_json import optimise_schema
from lamella.projection.mesh_figures import mesh_figures
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.star_measures import circle_angles, star_spheres
from projection.nets import grid_faces, hexagonal_net, lamella_patch, noisy, rotational_net, spider, weingarten_patch

SCHEMA = jsonschema.Draft202012Validator(optimise_schema())
UNDULOID = Unduloid(0.6, 1.4, (-8.0, 8.0))
PROJECT = '[surface]\nkind = "unduloid"\nneck_radius = 0.6\nbulge_radius = 1.4\nheight = [-8.0, 8.0]\n'
EXAMPLE = Path(__file__).parents[2] / "examples" / "optimise" / "unduloid_patch.obj"


def test_schema_refuses_what_is_not_written() -> None:
    jsonschema.Draft202012Validator.check_schema(optimise_schema())
    assert not SCHEMA.is_valid({"schema": "lamella/optimise/1"})
    problems = optimise_schema()["properties"]["problem"]["enum"]
    assert problems == list(USED)


def put(path: Path, mesh: QuadMesh) -> Path:
    like = QuadFile(mesh)
    path.write_bytes(quad_mesh_bytes(path.suffix, mesh, mesh_figures(mesh), like=like, name="a", version="0"))
    return path


def run(mesh: Path, problem: str, *options: object, out: str = "out.ply", code: int = 0) -> tuple[QuadMesh, Any]:
    target, figures = mesh.parent / out, mesh.parent / "figures.json"
    arguments = ["optimise", mesh, "--as", problem, "--out", target, "--json", figures, *options]
    assert main([str(word) for word in arguments]) == code
    said = json.loads(figures.read_text())
    SCHEMA.validate(said)
    return read_quad_mesh(target).mesh, said


def test_example_finds_the_radius_of_its_unduloid(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The patch was drawn on an unduloid of H = 1 / (neck + bulge) = 1/2, with noise of 2 % of the edge."""
    out, figures = tmp_path / "net.ply", tmp_path / "net.json"
    command = ["optimise", str(EXAMPLE), "--as", "sphere-stars", "--out", str(out), "--json", str(figures)]
    assert main(command) == 0
    said = json.loads(figures.read_text())
    radius, doubt = said["result"]["radius"], said["result"]["radius_uncertainty"]
    assert radius == pytest.approx(2.0, rel=0.01)
    assert abs(radius - 2.0) < 3 * doubt
    assert not said["result"]["ill_determined"]
    assert f"radius found: {radius:.6g} m" in capsys.readouterr().err
    net = read_quad_mesh(out).mesh
    stars = star_spheres(net, net.inner)
    assert stars.deviation.max() <= 1e-9 * net.mean_edge
    assert np.abs(stars.curvature) == pytest.approx(1 / radius, rel=1e-6)
    assert np.abs(circle_angles(net, net.inner) - 90).max() <= 1e-4


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".3dm", ".json"])
def test_asymptotic_in_every_format(suffix: str, tmp_path: Path) -> None:
    given = noisy(lamella_patch(Catenoid(1.0, (-1.5, 1.5)), 12, 1.2), 0.02, 1)
    net, said = run(put(tmp_path / f"in{suffix}", given), "asymptotic", out=f"out{suffix}")
    assert net.faces.tolist() == given.faces.tolist()
    # all digits: the residual survives the file
    assert star_spheres(net, net.inner).planarity.max() <= 1e-9 * net.mean_edge
    assert np.abs(circle_angles(net, net.inner) - 90).max() <= 1e-4
    moved = np.linalg.norm(net.vertices - given.vertices, axis=1)
    assert said["vertices"]["moved"] == pytest.approx(moved, abs=1e-12)
    (solution,) = said["solutions"]
    assert solution["verdict"] == "solved"
    first, last = solution["iterations"][0], solution["iterations"][-1]
    assert last["residual"]["stars"] < 1e-10 < first["residual"]["stars"]
    assert last["drift"]["vertices"] * given.mean_edge == pytest.approx(np.sqrt((moved**2).mean() / 3), rel=1e-6)
    assert said["after"]["star_planarity"]["largest"] < said["before"]["star_planarity"]["median"] / 1e6


def test_angle_of_a_linear_weingarten_net(tmp_path: Path) -> None:
    """Lamellas at 80 degrees: k1 / k2 = -tan^2 phi with 2 phi = 80 (paper, section 2); the closed form is the start."""
    given = noisy(weingarten_patch(80.0, 0.0, 14, 1.2), 0.01, 2)
    net, said = run(put(tmp_path / "a.ply", given), "angle", "--angle", 80, "--radius", "inf")
    angle = circle_angles(net, net.inner)
    assert np.abs(np.minimum(angle, 180 - angle) - 80).max() <= 1e-4
    assert said["result"] == {"radius": None, "radius_found": False}


def test_straighten_writes_both_meshes(tmp_path: Path) -> None:
    i, j = (x.ravel() for x in np.meshgrid(np.arange(9), np.arange(20), indexing="ij"))
    u = 1.3 * np.linspace(-1, 1, 9) * 8 * np.pi / 20
    given = quad_mesh(UNDULOID.at(u[i] + 2j * np.pi * j / 20).position, grid_faces(9, 20, True)[:, ::-1])
    (tmp_path / "u.toml").write_text(PROJECT)
    net, said = run(put(tmp_path / "a.obj", given), "straighten", "--surface", tmp_path / "u.toml", out="m.obj")
    assert net.faces.tolist() == given.faces.tolist()
    lamellas = read_quad_mesh(tmp_path / "m-lamellas.obj").mesh
    assert len(lamellas.vertices) == len(given.edges)
    # circles of a net of squares cross at 90 degrees up to the square of the edge
    assert np.abs(circle_angles(lamellas, lamellas.inner) - 90).max() < 0.4
    assert said["lamellas"]["star_radius"]["median"] == pytest.approx(2.0, rel=0.02)


def test_deform_narrows_the_waist(tmp_path: Path) -> None:
    given = rotational_net(UNDULOID, 12, 11, -5 * np.pi / 12)
    path = put(tmp_path / "a.ply", given)
    net, said = run(path, "deform", "--driver", "64=0.95", "--radius", 2)
    ring = said["result"]["ring"]
    assert sorted(ring) == list(range(60, 72))
    around = [np.linalg.norm(mesh.vertices[ring] - mesh.vertices[ring].mean(0), axis=1) for mesh in (given, net)]
    assert around[1] == pytest.approx(0.95 * around[0], rel=1e-7)
    a, b = net.edges.T
    length = [np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1) for mesh in (given, net)]
    assert np.abs(length[1] - length[0]).max() <= 1e-8 * given.mean_edge
    assert [state["share"] for state in said["result"]["states"]][-1] == pytest.approx(0.95)
    listed = ",".join(map(str, ring)) + "=0.95"
    again, _ = run(path, "deform", "--driver", listed, "--radius", 2)
    assert again.vertices == pytest.approx(net.vertices)


def test_not_all_conditions_exits_with_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A general net cannot keep edges and stars (4 conditions on 3 coordinates): written, told, exit 1."""
    given = noisy(rotational_net(UNDULOID, 12, 11, -5 * np.pi / 12), 0.02, 3)
    _, said = run(put(tmp_path / "a.ply", given), "deform", "--driver", "64=0.98", "--radius", 2, code=1)
    assert not said["solved"]
    last = said["solutions"][-1]
    assert {"edges", "stars"} <= set(last["unmet"])
    assert last["iterations"][-1]["residual"]["stars"] > 1e-4
    error = capsys.readouterr().err
    assert "not all conditions hold" in error
    assert "only symmetric nets keep both" in error
    patch = noisy(lamella_patch(UNDULOID, 12, 1.2), 0.02, 3)
    diagonal = "13,26,39,52,65=0.97"
    path = put(tmp_path / "c.ply", patch)
    run(path, "deform", "--driver", diagonal, "--open-driver", "--radius", 2, "--iterations", 2, code=1)
    assert "the way to 0.97 ended there: iterations used up" in capsys.readouterr().err
    run(put(tmp_path / "b.ply", patch), "sphere-stars", "--radius", 2, "--iterations", 1, code=1)
    assert "allow more with --iterations" in capsys.readouterr().err


def test_meshes_too_small_for_planar_strips(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Refused with the vertices there are and that are needed; with as many quads in a row as are named it goes."""
    (tmp_path / "u.toml").write_text(PROJECT)
    options = ["--as", "planar", "--height", "0.05", "--surface", str(tmp_path / "u.toml"), "--rounds", "1"]
    centre = 0.25 * UNDULOID.period
    small = put(tmp_path / "a.ply", lamella_patch(UNDULOID, 3, 0.2, centre))
    assert main(["optimise", str(small), "--out", str(tmp_path / "s.ply"), *options]) == 2
    said = capsys.readouterr().err
    found = re.search(r"no polyline has (\d+) vertices, the longest has (\d+)\s+remedy: .*at least (\d+) quads", said)
    assert found
    needed, longest, quads = map(int, found.groups())
    assert (needed, longest) == (4, 3)
    assert not (tmp_path / "s.ply").exists()
    large = put(tmp_path / "b.ply", lamella_patch(UNDULOID, quads + 1, 0.2, centre))
    assert main(["optimise", str(large), "--out", str(tmp_path / "s.ply"), *options]) == 0


def test_planar_strips(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    half = UNDULOID.period / 2
    given = lamella_patch(UNDULOID, 7, 0.5, 0.5 * half)
    (tmp_path / "u.toml").write_text(PROJECT)
    path = put(tmp_path / "a.ply", given)
    out, figures = tmp_path / "s.ply", tmp_path / "s.json"
    options = ["--height", "0.05", "--surface", str(tmp_path / "u.toml"), "--rounds", "1", "--json", str(figures)]
    assert main(["optimise", str(path), "--as", "planar", "--out", str(out), *options]) == 0
    said = json.loads(figures.read_text())
    SCHEMA.validate(said)
    # each of the 14 polylines of 7 vertices gets a ruling more between any two
    assert said["result"]["figures"]["largest_after"] < 1e-8
    assert said["result"]["figures"]["median_before"] > 1e-3
    assert len(said["faces"]["planarity"]) == len(said["faces"]["planarity_before"]) == 14 * 12
    assert max(said["faces"]["planarity"]) < 1e-8
    assert [int(x) for x in np.unique(said["faces"]["strip"])] == list(range(14))
    assert {tuple(strip["vertices"]) for strip in said["result"]["strips"]} >= {tuple(range(7))}
    assert "14 strips; planarity score median" in capsys.readouterr().err


def test_surface_of_the_mesh_itself(tmp_path: Path) -> None:
    """Without --surface it is the surface of constant mean curvature the mesh means: here that of H = 1/2."""
    given = lamella_patch(UNDULOID, 10, 0.8, 0.5 * UNDULOID.period / 2)
    path = put(tmp_path / "a.ply", given)
    out = tmp_path / "s.ply"
    options = ["--height", "0.03", "--rounds", "1", "--json", str(tmp_path / "s.json")]
    assert main(["optimise", str(path), "--as", "planar", "--out", str(out), *options]) in (0, 1)
    said = json.loads((tmp_path / "s.json").read_text())
    assert said["result"]["figures"]["median_after"] < said["result"]["figures"]["median_before"] / 100


@pytest.mark.parametrize("valence", [3, 5, 6])
def test_singular_vertices_and_rims_are_told(valence: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    points, faces = spider(valence)
    bowl = quad_mesh(points + 0.02 * (points**2).sum(1, keepdims=True) * [0, 0, 1], faces)
    _, said = run(put(tmp_path / "a.obj", bowl), "sphere-stars", "--radius", 25, "--iterations", 2, code=1)
    centre = int(bowl.singular[0])
    assert said["given"]["singular_vertices"] == [{"vertex": centre, "valence": valence}]
    assert said["given"]["boundary_vertices"] == int(bowl.on_boundary.sum()) == 6 * valence
    assert len(said["given"]["corners"]) == valence
    assert said["vertices"]["angle"][centre] is None
    assert f"{centre} (valence {valence})" in capsys.readouterr().err


def test_hexagonal_node(tmp_path: Path) -> None:
    """Around the flat point of Enneper's surface of order 3, six polylines meet (paper, section 3)."""
    given = noisy(hexagonal_net(Enneper(3, 0.6), 4, 0.35), 0.01, 4)
    net, said = run(put(tmp_path / "a.json", given), "asymptotic", out="b.json")
    assert [one["valence"] for one in said["given"]["singular_vertices"]] == [6]
    assert star_spheres(net, net.inner).planarity.max() <= 1e-9 * net.mean_edge


def test_files_in_millimetres(tmp_path: Path) -> None:
    given = noisy(lamella_patch(UNDULOID, 12, 1.2), 0.01, 5)
    path = put(tmp_path / "a.obj", given.at(1000 * given.vertices))
    _, said = run(path, "sphere-stars", "--radius", 2, "--unit", "mm", out="b.obj")
    assert said["given"]["metres_per_unit"] == 0.001
    again = read_quad_mesh(tmp_path / "b.obj", "mm").mesh
    assert 1 / np.abs(star_spheres(again, again.inner).curvature) == pytest.approx(2.0, rel=1e-6)


def test_moves_are_told_and_a_mesh_that_was_no_such_net(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = noisy(lamella_patch(UNDULOID, 12, 1.2), 0.01, 5)
    net, _ = run(put(tmp_path / "a.ply", given), "sphere-stars", "--radius", 2)
    moved = np.linalg.norm(net.vertices - given.vertices, axis=1)
    reported = capsys.readouterr().err
    assert (
        f"vertices moved by {np.sqrt((moved**2).mean()):.3g} m root mean square, {moved.max():.3g} m at most"
        in reported
    )
    assert "no such net by far" not in reported
    path = put(tmp_path / "b.ply", rotational_net(UNDULOID, 24, 21, -10 * np.pi / 24))
    assert main(["optimise", str(path), "--as", "asymptotic", "--out", str(tmp_path / "c.ply")]) in (0, 1)
    assert "no such net by far" in capsys.readouterr().err


def test_straighten_refuses_a_surface_without_principal_directions(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    i, j = (x.ravel() for x in np.meshgrid(np.linspace(-0.5, 0.5, 10), np.linspace(-0.5, 0.5, 10), indexing="ij"))
    ball = 3 * np.column_stack([np.cos(i) * np.cos(j), np.cos(i) * np.sin(j), np.sin(i)])
    path = put(tmp_path / "a.obj", quad_mesh(ball, grid_faces(10, 10)))
    assert main(["optimise", str(path), "--as", "straighten", "--out", str(tmp_path / "b.obj")]) == 2
    assert "every point is umbilic" in capsys.readouterr().err
    assert not (tmp_path / "b.obj").exists()


def test_straighten_on_a_surface_that_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A cylinder with unevenly spread parallels: squares exist on it, known as well as the surface itself."""
    i, j = (x.ravel() for x in np.meshgrid(np.linspace(-1, 1, 12), np.linspace(-1, 1, 12), indexing="ij"))
    points = np.column_stack([2 * np.cos(0.7 * i), 2 * np.sin(0.7 * i), 1.9 * (j + 0.15 * j**2)])
    net, said = run(put(tmp_path / "a.obj", quad_mesh(points, grid_faces(12, 12))), "straighten", out="m.obj")
    assert said["solved"]
    side = net.vertices[net.faces] - np.roll(net.vertices[net.faces], 1, axis=1)
    length = np.linalg.norm(side, axis=2)
    assert np.abs(length[:, 0] / length[:, 1] - 1).max() < 0.02


def test_picture(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    given = noisy(lamella_patch(UNDULOID, 8, 1.0), 0.01, 5)
    run(put(tmp_path / "a.obj", given), "sphere-stars", "--radius", 2, "--picture", tmp_path / "a.png", "--quiet")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("problem", "options", "match"),
    [
        ("straight", [], "one of asymptotic, sphere-stars, angle, straighten, deform, planar"),
        ("asymptotic", ["--radius", "2"], "--radius is of no use to --as asymptotic"),
        ("asymptotic", ["--angle", "5"], "between 10 and 170"),
        ("asymptotic", ["--angle", "nan"], "--angle nan is no number"),
        ("asymptotic", ["--form", "eyes"], "--form eyes is not known"),
        ("asymptotic", ["--iterations", "0"], "--iterations 0 is out of range"),
        ("asymptotic", ["--colour", "blue"], "--colour blue is not known"),
        ("angle", [], "--as angle needs --angle"),
        ("sphere-stars", ["--radius", "0.001"], "below 2 mean edges"),
        ("sphere-stars", ["--radius", "nan"], "--radius nan"),
        ("deform", [], "--as deform needs --driver"),
        ("deform", ["--driver", "5"], "does not read VERTEX"),
        ("deform", ["--driver", "5=x"], "does not read VERTEX"),
        ("deform", ["--driver", "40=0.9"], "no diagonal"),
        ("deform", ["--driver", "4000=0.9"], "no vertex 4000"),
        ("planar", [], "--as planar needs --height"),
        ("asymptotic", ["--tolerance", "0"], "--tolerance 0 is out of range"),
        ("asymptotic", ["--tolerance", "10"], "at most 0.01 edges"),
        ("asymptotic", ["--picture", "a.svg"], "is no .png"),
        ("deform", ["--driver", "13,26,39,52=0.9", "--open-driver", "--radius", "0"], "--radius 0 is out of range"),
        ("deform", ["--driver", "13,26,39,52=0.9", "--open-driver", "--radius", "-2"], "--radius -2 is out of range"),
        ("deform", ["--driver", "13,26,39,52=0.9", "--open-driver", "--radius", "0.01"], "below 2 mean edges"),
        ("planar", ["--height", "0"], "--height 0 is out of range"),
        ("planar", ["--height", "0.1", "--rounds", "9"], "--rounds 9 is out of range"),
        ("planar", ["--height", "0.1", "--surface", "none.toml"], "none.toml"),
    ],
)
def test_refused(
    problem: str, options: list[str], match: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = put(tmp_path / "a.obj", lamella_patch(UNDULOID, 9, 1.0))
    before = sorted(tmp_path.iterdir())
    assert main(["optimise", str(path), "--as", problem, "--out", str(tmp_path / "o.obj"), *options]) == 2
    error = capsys.readouterr().err
    assert match in error
    assert "remedy: " in error
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(("problem", "options"), [("straighten", []), ("planar", ["--height", "0.05"])])
def test_surface_of_another_mesh_is_refused(
    problem: str, options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "u.toml").write_text(PROJECT)
    mesh = lamella_patch(UNDULOID, 9, 1.0)
    path = put(tmp_path / "a.obj", mesh.at(mesh.vertices + np.array([5.0, 0, 0])))
    command = ["optimise", str(path), "--as", problem, "--surface", str(tmp_path / "u.toml"), *options]
    assert main([*command, "--out", str(tmp_path / "o.obj")]) == 2
    assert "half of the vertices are more than" in capsys.readouterr().err
    assert not (tmp_path / "o.obj").exists()


def test_targets_refused_before_anything_is_computed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = put(tmp_path / "a.obj", lamella_patch(UNDULOID, 9, 1.0))
    content = path.read_bytes()
    for options, match in (
        (["--out", str(path)], "in use already"),
        (["--out", str(tmp_path / "b.stl")], "b.stl: the format '.stl' holds no quad mesh"),
        (["--out", str(tmp_path / "none" / "b.obj")], "no such folder"),
        (["--out", str(tmp_path)], "is a folder"),
        (["--out", str(tmp_path / "b.json"), "--json", str(tmp_path / "b.json")], "in use already"),
    ):
        assert main(["optimise", str(path), "--as", "asymptotic", *options]) == 2
        reported = capsys.readouterr().err
        assert match in reported
        assert "b.stl" not in match or reported.count("b.stl") == 1
    assert path.read_bytes() == content
    assert [item.name for item in tmp_path.iterdir()] == ["a.obj"]


def test_plane_has_no_radius(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    i, j = (x.ravel().astype(float) for x in np.meshgrid(np.arange(7), np.arange(7), indexing="ij"))
    _, said = run(put(tmp_path / "a.obj", quad_mesh(np.column_stack([i, j, 0 * i]), grid_faces(7, 7))), "sphere-stars")
    assert said["result"]["ill_determined"]
    assert "give it with --radius" in capsys.readouterr().err


def test_help_teaches(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        main(["optimise", "--help"])
    reported = capsys.readouterr().out
    assert all(f"\n  {problem}  " in reported for problem in USED)
    for word in ("exit codes", "examples:", "metres", "COMPAS", "counted\nfrom 0"):
        assert word in reported
