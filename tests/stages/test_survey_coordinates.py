"""Drawings in survey coordinates: the same surface and net as at the origin, in the drawing's coordinates again.

A double holds 5.3e6 m to 9e-10 m: what comes back may differ by some of these, far below the micrometre asked here.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import rhino3dm

from lamella import __version__, compute, parse_project, write
from lamella.base.drawing_origin import NOWHERE, coordinates, origin_of, reported_from
from lamella.base.errors import InputError
from lamella.base.units import METRES
from lamella.files.write.curves_3dm import write_curves_3dm
from lamella.files.write.model_3dm import model_bytes
from lamella.files.write.rhino_file import Frame
from lamella.files.write.surface_3dm import surface_3dm_bytes
from lamella.project.read import read_project
from lamella.project.tables import FormFoundTable
from lamella.stages.check import check_project
from lamella.stages.results import Results
from lamella.stages.surface.boundary_of_tables import boundary_loops, with_origin

FAR = np.array([4_500_013.0, 5_300_027.0, 503.0])
SAME = 1e-6
# corners of a roof of 12 x 9 m, and an eye in it
TURNS = 2 * np.pi * np.arange(24) / 24
RIM = np.stack([6 * np.cos(TURNS), 4.5 * np.sin(TURNS), 1.2 * np.cos(2 * TURNS)], 1)
EYE = np.array([1.5, 0.5, 1.0]) + 1.2 * np.stack([np.cos(TURNS), np.sin(TURNS), 0 * TURNS], 1)

Tables = dict[str, Any]


def drawn_by_points(folder: Path, at: np.ndarray) -> list[Tables]:
    return [{"points": (loop + at).tolist()} for loop in (RIM, EYE)]


def drawn_in_millimetres(folder: Path, at: np.ndarray) -> list[Tables]:
    return [{"points": (1000 * (loop + at)).tolist(), "unit": "mm"} for loop in (RIM, EYE)]


def drawn_by_parts(folder: Path, at: np.ndarray) -> list[Tables]:
    """A vault between two arches that stand on planes along which they slide, and two straight walls."""
    corner = np.array([[-4.0, -3, 0], [4, -3, 0], [4, 3, 0], [-4, 3, 0]]) + at
    crown = np.array([[4.0, 0, 2.0], [-4, 0, 2.0]]) + at
    wall = [{"points": corner[[0, 1]].tolist()}, {"points": corner[[2, 3]].tolist()}]
    arch = [
        {"arc": {"start": corner[a].tolist(), "middle": crown[k].tolist(), "end": corner[b].tolist()}}
        for k, (a, b) in enumerate(((1, 2), (3, 0)))
    ]
    for one, x in zip(arch, (4.0, -4.0), strict=True):
        one["slide"] = {"point": (np.array([x, 0, 0]) + at).tolist(), "normal": [1.0, 0.0, 0.0]}
    return [{"part": [wall[0], arch[0], wall[1], arch[1]]}]


def drawn_as_dxf(folder: Path, at: np.ndarray) -> list[Tables]:
    drawing = ezdxf.new(units=6)  # type: ignore[attr-defined]
    for layer, loop in (("rim", RIM), ("eye", EYE)):
        drawing.modelspace().add_polyline3d((loop + at).tolist(), close=True, dxfattribs={"layer": layer})
    drawing.saveas(folder / "a.dxf")
    return [{"file": "a.dxf", "layer": layer, "interpolation": "spline"} for layer in ("rim", "eye")]


def drawn_as_json(folder: Path, at: np.ndarray) -> list[Tables]:
    curves = {name: {"points": (1000 * (loop + at)).tolist()} for name, loop in (("rim", RIM), ("eye", EYE))}
    (folder / "a.json").write_text(json.dumps({"unit": "mm", "curves": curves}))
    return [{"file": "a.json", "id": name} for name in ("rim", "eye")]


def drawn_in_rhino(folder: Path, at: np.ndarray) -> list[Tables]:
    tables = [{"points": loop.tolist(), "name": name} for name, loop in (("rim", RIM), ("eye", EYE))]
    loops = boundary_loops(parse_project(film(tables)).surface, folder)  # type: ignore[arg-type]
    write_curves_3dm(folder / "a.3dm", loops, Frame("mm", tuple(at.tolist())), name="x", version="1")
    return [{"file": "a.3dm", "id": name} for name in ("rim", "eye")]


DRAWN = (drawn_by_points, drawn_in_millimetres, drawn_by_parts, drawn_as_dxf, drawn_as_json, drawn_in_rhino)


def film(boundary: list[Tables], **more: Any) -> Tables:
    surface = {"kind": "form-found", "tolerance": 5e-2, "boundary": boundary}
    return {"surface": surface | more, "network": {"cells": 10}}


def mesh_of(folder: Path, at: np.ndarray, **more: Any) -> Tables:
    """A patch of a catenoid about the y axis, in triangles of a tenth of its size."""
    u, v = (part.ravel() for part in np.meshgrid(np.linspace(-1, 1, 17), np.linspace(-0.9, 1.1, 17), indexing="ij"))
    points = 3 * np.stack([np.cosh(u) * np.sin(v), u, np.cosh(u) * np.cos(v)], 1) + at
    first = (np.arange(16)[:, None] * 17 + np.arange(16)).ravel() + 1
    faces = np.concatenate([np.stack([first, first + 17, first + 18], 1), np.stack([first, first + 18, first + 1], 1)])
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()] + [f"f {a} {b} {c}" for a, b, c in faces.tolist()]
    (folder / "a.obj").write_text("\n".join(rows))
    return {"kind": "mesh", "file": "a.obj", "tolerance": 5e-2} | more


def both(tables: Any, folder: Path, until: str) -> tuple[Results, Results]:
    """A project at the origin, and far from it."""
    here, there = (compute(parse_project(tables(at)), until=until, folder=folder) for at in (np.zeros(3), FAR))
    return here, there


def assert_same_surface(here: Results, there: Results) -> None:
    assert here.origin == NOWHERE
    assert "origin" not in here.summary["surface"]
    assert there.summary["surface"]["origin"] == list(there.origin)
    assert np.abs(np.array(there.origin) - FAR).max() <= 50
    assert np.abs(there.mesh.points - (FAR - there.origin) - here.mesh.points).max() < SAME
    assert there.summary["surface"]["area"] == pytest.approx(here.summary["surface"]["area"], rel=1e-8)


def assert_same_net(here: Results, there: Results) -> None:
    assert here.network is not None
    assert there.network is not None
    shift = FAR - there.origin
    for name in ("node_points", "sample_points"):
        assert np.abs(getattr(there.network, name) - shift - getattr(here.network, name)).max() < SAME
    assert there.network.ids == here.network.ids


@pytest.mark.parametrize("draw", DRAWN)
def test_curves_are_measured_from_a_point_beside_them(draw: Any, tmp_path: Path) -> None:
    t = np.linspace(0, 1, 500)
    loops = []
    for at in (np.zeros(3), FAR):
        table = with_origin(parse_project(film(draw(tmp_path, at))).surface, tmp_path)  # type: ignore[arg-type]
        loops.append((np.array(table.origin or NOWHERE) - at, boundary_loops(table, tmp_path)))
    (_, here), (shift, there) = loops
    assert np.abs(shift).max() <= 50
    for one, other in zip(here, there, strict=True):
        assert np.abs(other.at(t) + shift - one.at(t)).max() < 1e-8
        for old, new in zip(one.slides, other.slides, strict=True):
            assert old.point is not None
            assert new.point is not None
            assert np.abs(new.point + shift - old.point).max() < 1e-8
            assert np.array_equal(new.normal, old.normal)


def test_a_sliding_vault_of_a_volume_far_from_the_origin_has_the_same_net(tmp_path: Path) -> None:
    here, there = both(lambda at: film(drawn_by_parts(tmp_path, at), volume=45.0), tmp_path, "network")
    assert_same_surface(here, there)
    assert_same_net(here, there)
    assert there.summary["surface"]["volume"] == pytest.approx(45.0, rel=1e-9)


@pytest.mark.parametrize("mean_curvature", ["fit", "varying"])
def test_a_mesh_far_from_the_origin_means_the_same_surface(mean_curvature: str, tmp_path: Path) -> None:
    here, there = both(
        lambda at: {"surface": mesh_of(tmp_path, at, mean_curvature=mean_curvature)}, tmp_path, "surface"
    )
    assert_same_surface(here, there)


@pytest.mark.slow
def test_a_loop_that_is_adjusted_far_from_the_origin(tmp_path: Path) -> None:
    """The curve of the drawing, as it was changed, is written where the drawing is, in its unit."""
    turns = 2 * np.pi * np.arange(24) / 24
    rng = np.random.default_rng(3)
    rim = np.stack([6 * np.cos(turns), 4.5 * np.sin(turns), 2.5 - 2.5 * np.cos(2 * turns)], 1)
    waves = [np.outer(f(k * turns), rng.normal(size=3)) for k in range(4) for f in (np.cos, np.sin)]
    rim += 0.3 * sum(waves) / np.abs(sum(waves)).max() + FAR
    (tmp_path / "rim.json").write_text(json.dumps({"unit": "mm", "curves": {"rim": {"points": (1000 * rim).tolist()}}}))
    adjust = {"move": 0.3, "scale": 0.1, "tilt": 5.0, "points": 0.3}
    eye = {"center": (FAR + np.array([0, 0, 2.0])).tolist(), "radius": 1.3}
    tables = film([{"file": "rim.json", "adjust": adjust}, {"circle": eye, "adjust": {"move": 0.3, "scale": 0.1}}])
    tables["network"] = {"cells": 24, "closing": "adjust"}
    there = compute(parse_project(tables), until="network", folder=tmp_path)
    assert there.adjusted
    assert there.summary["network"]["closed"]
    assert there.summary["surface"]["origin"] == list(there.origin)
    write(there, tmp_path / "out")
    model = rhino3dm.File3dm.Read(str(tmp_path / "out" / "adjusted.3dm"))
    for loop, thing in zip(boundary_loops(there.adjusted.table, tmp_path), model.Objects, strict=True):
        start = thing.Geometry.PointAtStart
        drawn = np.array([start.X, start.Y, start.Z]) / 1000
        assert np.abs(drawn - loop.at(0.0) - there.origin).max() < SAME
        assert np.abs(drawn - FAR).max() < 10


def test_every_file_and_message_is_in_the_drawings_coordinates(tmp_path: Path) -> None:
    """Everything written or said of a drawing far from its origin is in its own coordinates."""
    project = {}
    for name, at in (("here", np.zeros(3)), ("there", FAR)):
        folder = tmp_path / name
        folder.mkdir()
        tables = film(drawn_as_dxf(folder, at)) | {"lamella": {"thickness": 0.004, "height": 0.02}}
        # ends too short to meet beyond the rim: no other number of cells is searched
        tables["fabrication"] = {"end_distance": 0.012, "rim_overhang": 0.0}
        results = compute(parse_project(tables), folder=folder)
        write(results, folder / "out")
        project[name] = results
    here, there = (tmp_path / name / "out" for name in ("here", "there"))

    def rows(path: Path, begin: str, columns: slice, between: str | None = None) -> np.ndarray:
        lines = [line for line in path.read_text().splitlines() if re.match(begin, line)]
        return np.array([line.split(between)[columns] for line in lines], float)

    assert_same_surface(*project.values())
    assert_same_net(*project.values())
    one, other = (json.loads((folder / "network.json").read_text()) for folder in (here, there))
    for key, inner in (("nodes", "point"), ("lamellas", "centreline")):
        for a, b in zip(one[key], other[key], strict=True):
            assert np.abs(np.array(b[inner]) - np.array(a[inner]) - FAR).max() < SAME
    for file in ("surface.obj", "network.obj"):
        a, b = (rows(folder / file, "v ", slice(1, 4)) for folder in (here, there))
        assert np.abs(b - a - FAR).max() < SAME
    a, b = (rows(folder / "nodes.csv", r"\d", slice(2, 5), ",") for folder in (here, there))
    assert np.abs(b - a - FAR).max() < SAME
    a, b = (np.array([n["point"] for n in r.summary["network"]["umbilics"]]) for r in project.values())
    assert len(a)
    assert np.abs(b - a - FAR).max() < SAME
    for file in ("model.3dm", "surface.3dm"):
        a, b = (corners_of(folder / file) for folder in (here, there))
        assert np.abs(b - a - FAR).max() < SAME
    places = [
        re.findall(r"\(([-\d.e+]+), ([-\d.e+]+), ([-\d.e+]+)\) m", " ".join(r.summary["warnings"]))
        for r in project.values()
    ]
    assert places[0]
    assert len(places[0]) == len(places[1])
    # three digits of the one, millimetres of the other
    assert np.abs(np.array(places[1], float) - np.array(places[0], float) - FAR).max() < 0.05
    # the project as it was filled in measures from the same point
    again = read_project(there / "project.toml").surface
    assert isinstance(again, FormFoundTable)
    assert again.origin == project["there"].origin
    reported = f"{project['there'].origin[0]:.10g}, {project['there'].origin[1]:.10g}"
    assert reported in (there / "report.html").read_text()


def corners_of(path: Path) -> np.ndarray:
    """Corners of the bounding boxes of a model's objects, in its unit."""
    boxes = [thing.Geometry.GetBoundingBox() for thing in rhino3dm.File3dm.Read(str(path)).Objects]
    return np.array([[p.X, p.Y, p.Z] for box in boxes for p in (box.Min, box.Max)])


@pytest.mark.slow
def test_check_tells_places_in_the_drawings_coordinates(tmp_path: Path) -> None:
    tables = film(drawn_by_points(tmp_path, FAR)) | {"lamella": {"thickness": 0.004}}
    reported = " ".join(check_project(parse_project(tables), folder=tmp_path).warnings)
    assert re.search(r"\(45000\d\d\.\d{3}, 53000\d\d\.\d{3}, 50\d\.\d{3}\) m", reported)


def test_refusals_of_loops_are_in_the_drawings_coordinates(tmp_path: Path) -> None:
    spike = RIM.copy()
    spike[3] = spike[2]
    with pytest.raises(InputError, match=r"\(4500\d+\.\d{3}, 53000\d+\.\d{3}, 50\d\.\d{3}\)"):
        compute(parse_project(film([{"points": (spike + FAR).tolist()}])), until="surface")


@pytest.mark.parametrize(
    ("away", "size", "origin"),
    [
        (0.0, 20.0, 0.0),
        # 999 sizes away it is left where it is
        (999 * 20.0, 20.0, 0.0),
        (1002 * 20.0, 20.0, 20_000.0),
        (5_300_027.0, 20.0, 5_300_000.0),
        (5_300_027.0, 250.0, 5_300_000.0),
        (5_300_027.4, 0.5, 5_300_027.0),
        (-5_300_027.0, 20.0, -5_300_000.0),
    ],
)
def test_the_origin_is_round_and_only_where_the_drawing_is_far(away: float, size: float, origin: float) -> None:
    assert origin_of(np.array([[away - size / 2, 0.0, 0.0], [away + size / 2, 0.0, 0.0]])) == (origin, 0.0, 0.0)


def test_places_in_messages() -> None:
    assert coordinates([1.23456, 0.0, -2.0], 3) == "1.23, 0, -2"
    with reported_from((4_500_000.0, 0.0, 0.0)):
        assert coordinates([1.23456, 0.0, -2.0], 3) == "4500001.235, 0.000, -2.000"
    assert coordinates([1.23456, 0.0, -2.0], 3) == "1.23, 0, -2"


def test_rhino_files_in_another_unit(tmp_path: Path) -> None:
    tables = film(drawn_by_points(tmp_path, np.zeros(3))[:1]) | {"files": {"unit": "mm"}}
    results = compute(parse_project(tables))
    write(results, tmp_path / "run")
    written = {file: (tmp_path / "run" / file).read_bytes() for file in ("model.3dm", "surface.3dm")}
    names = {"m": "Meters", "mm": "Millimeters", "cm": "Centimeters", "ft": "Feet", "in": "Inches"}
    boxes: dict[tuple[str, str], np.ndarray] = {}
    spans: dict[str, list[float]] = {}
    for unit, name in names.items():
        frame, signed = Frame(unit), {"name": results.project.name, "version": __version__}
        contents = {
            "model.3dm": model_bytes(
                surface=results.mesh, network=results.network, lamellas=results.lamellas, frame=frame, **signed
            ),
            "surface.3dm": surface_3dm_bytes(results.surface, frame, **signed),
        }
        if unit == "mm":
            assert contents == written
        for file, content in contents.items():
            (tmp_path / file).write_bytes(content)
            model = rhino3dm.File3dm.Read(str(tmp_path / file))
            assert model.Settings.ModelUnitSystem == getattr(rhino3dm.UnitSystem, name)
            assert pytest.approx(1e-5 / METRES[unit]) == model.Settings.ModelAbsoluteTolerance
            boxes[unit, file] = corners_of(tmp_path / file) * METRES[unit]
            assert np.abs(boxes[unit, file] - boxes["m", file]).max() < 1e-9
        # parameters are arc lengths, in the file's unit
        curves = [thing.Geometry for thing in rhino3dm.File3dm.Read(str(tmp_path / "model.3dm")).Objects]
        lengths = [one.Domain.T1 * METRES[unit] for one in curves if isinstance(one, rhino3dm.NurbsCurve)]
        assert lengths
        spans[unit] = lengths
        assert lengths == pytest.approx(spans["m"], rel=1e-12)


def test_a_unit_of_files_that_is_none_is_refused() -> None:
    with pytest.raises(InputError) as refused:
        parse_project(film(drawn_by_points(Path(), np.zeros(3))) | {"files": {"unit": "mile"}})
    assert refused.value.where == "files.unit"
