"""Results: pickled and copied without their caches, compared, printed in a line, shown in a notebook."""

from __future__ import annotations

import copy
import inspect
import multiprocessing
import pickle
import re
import xml.etree.ElementTree as ET
from concurrent.futures import ProcessPoolExecutor
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

import lamella
from lamella.base.compare import close
from lamella.base.result import Shown
from lamella.base.sparse import SymmetricPattern
from lamella.files.quad_mesh_files import QuadFile

TURNS = 2 * np.pi * np.arange(8) / 8
RIM = lamella.spline(np.stack([3 * np.cos(TURNS), 2.5 * np.sin(TURNS), 0.5 * np.cos(2 * TURNS)], 1))


def made() -> dict[str, Any]:
    """One of each."""
    film = lamella.film([RIM], tolerance=0.02, order=3)
    net = lamella.net(film, cells=6)
    strips = net.strips()
    parts = strips.parts()
    quads = lamella.quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], [[0, 1, 2, 3]])
    asymptotic = lamella.net(lamella.Helicoid(5.0, 1.0, 4.0, 1.0), cells=8)
    results = [film, net, strips, parts, parts.parts[0], parts.nest(), film.mesh(0.05), RIM, quads, asymptotic]
    results += [film.check_places(), film.check_points(), strips.section, strips.material]
    closed = [
        lamella.Catenoid(2.0, (-1.0, 1.0)),
        lamella.Cylinder(1.0, (0.0, 1.0)),
        lamella.Enneper(3, 0.9, 2.0),
        lamella.Helicoid(5.0, 1.0, 4.0, 1.0),
        lamella.Nodoid(0.5, 1.5, (-0.1, 0.1)),
        lamella.Scherk(1.0, 1.0),
        lamella.Unduloid(0.5, 1.5, (-1.0, 1.0)),
    ]
    catenoid = {"surface": {"kind": "catenoid", "neck_radius": 2.0, "height": [-1.0, 1.0]}, "network": {"cells": 6}}
    project = lamella.parse_project(catenoid)
    runs = [lamella.compute(project), lamella.compute(project, until="surface")]
    every = [*results, *closed, project, *runs, *projected()]
    return {f"{type(x).__name__} {k}": x for k, x in enumerate(every)}


def projected() -> list[Any]:
    """Results of guided projection, on a catenoid's lamellas."""
    u, v = np.mgrid[0:5, 0:5].reshape(2, -1) / 6 - 1 / 3
    k = np.arange(25).reshape(5, 5)
    faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    surface = lamella.Catenoid(2.0, (-2.0, 2.0))
    along = lamella.quad_mesh(surface.at(u + 1j * v).position, faces)
    across = lamella.quad_mesh(surface.at((u + v) / 2 + 1j * (u - v) / 2).position, faces)
    feet = lamella.foot_surface(surface)
    curve = surface.at(np.linspace(-0.3, 0.3, 9) * (1 + 1j)).position
    return [
        lamella.asymptotic(across),
        lamella.straighten(along, feet),
        lamella.planar_strips([curve], feet, 0.05, rounds=1),
        lamella.deform(across, k.diagonal(), 0.99, closed=False, iterations=3)[0],
        QuadFile(across),
    ]


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    return made()


def test_pickles_and_copies_are_the_same(results: dict[str, Any]) -> None:
    for name, result in results.items():
        for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
            assert type(other) is type(result), name
            assert close(result, other, 0.0), name


def test_a_surface_from_a_pickle_answers_as_before(results: dict[str, Any]) -> None:
    film = results["ElementSurface 0"]
    other = pickle.loads(pickle.dumps(film))
    assert film.umbilics.orders.tolist() == other.umbilics.orders.tolist()
    assert lamella.net(other, cells=6).allclose(results["Network 1"], 1e-12)
    # what was computed on the way is not written: the nodes and what joins them, in words of 8 bytes
    numbers = film.nodes.size + film.connectivity.elements.size + 3 * film.connectivity.faces.size
    assert len(pickle.dumps(film)) < 2 * 8 * numbers


def test_patterns_of_matrices_leave_the_solver_behind() -> None:
    pattern = SymmetricPattern.from_pairs(np.array([0, 1, 0]), np.array([0, 1, 1]), 2, backend="rslab")
    values = pattern.assemble(np.array([2.0, 3.0, 1.0]))
    solution = pattern.factor(values).solve(np.array([1.0, 0.0]))
    assert pattern._symbolic
    other = pickle.loads(pickle.dumps(pattern))
    assert not other._symbolic
    np.testing.assert_array_equal(other.factor(values).solve(np.array([1.0, 0.0])), solution)
    assert copy.deepcopy(pattern)._symbolic == {}


def strips_of(surface: Any) -> Any:
    return lamella.net(surface, cells=6).strips()


def test_in_another_process() -> None:
    """As joblib and Dask do it: the surface goes there, the strips come back."""
    surface = lamella.Catenoid(2.0, (-1.0, 1.5))
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        strips = pool.submit(strips_of, surface).result(60)
    assert strips.allclose(strips_of(surface), 0.0)
    assert strips.network.surface.allclose(surface)


def test_compared(results: dict[str, Any]) -> None:
    net = results["Network 1"]
    moved = net.node_points + 1e-7
    assert not net.allclose(replace(net, node_points=moved))
    assert net.allclose(replace(net, node_points=moved), 1e-7)
    assert not net.allclose(replace(net, ids=(*net.ids[:-1], "C1")), 1.0)
    assert not net.allclose(replace(net, node_points=net.node_points[1:]), 1.0)
    assert not net.allclose(results["Network 9"], 1.0)
    assert not net.allclose("net")
    # where it comes from does not count, what it is does
    assert net.allclose(replace(net, surface=None, notes=("a note",)))
    assert close({"a": [1, 2.0, None, np.nan]}, {"a": [1, 2.0 + 1e-10, None, np.nan]}, 1e-9)
    assert not close({"a": 1}, {"b": 1}, 1.0)
    assert close(1, 1.0 + 1e-10, 1e-9)
    assert not close(True, "yes", 1.0)
    assert not close(np.array([1, 2]), np.array([1, 3]), 5.0)
    for k, one in enumerate(results.values()):
        for m, other in enumerate(results.values()):
            assert close(one, other, 0.0) == (k == m)


def test_frozen(results: dict[str, Any]) -> None:
    with pytest.raises(FrozenInstanceError):
        results["Network 1"].cells = 7
    assert len({results["Network 1"], results["Network 9"]}) == 2


def test_arrays_are_documented(results: dict[str, Any]) -> None:
    """Every array of a public result with its shape, in the section of attributes."""
    seen = 0
    for kind in {type(result) for result in results.values() if is_dataclass(result)}:
        sections = " ".join(inspect.getdoc(cls) or "" for cls in kind.__mro__ if is_dataclass(cls))
        told = re.findall(r"^([\w, ]+) : (.*)", sections.replace("    ", ""), re.M)
        shapes = {name: shape for names, shape in told for name in names.split(", ")}
        for field in fields(kind):
            if re.search(r"Floats|Integers|Booleans|Complexes|NDArray", str(field.type)):
                assert "(" in shapes.get(field.name, ""), f"{kind.__name__}.{field.name}"
                seen += 1
    assert seen > 70


def test_printed_in_a_line(results: dict[str, Any]) -> None:
    for name, result in results.items():
        if name.startswith(("Section", "Material", "Project")):
            continue
        line = repr(result)
        assert line.startswith(f"{type(result).__name__}("), name
        assert line.endswith(")"), name
        assert len(line) < 150, name
        assert "\n" not in line, name
    net = results["Network 1"]
    assert f"6 cells: {len(net.ids)} lamellas, {len(net.node_points)} nodes, " in repr(net)


def test_notebooks_show_a_picture(results: dict[str, Any]) -> None:
    shown = {name: result for name, result in results.items() if isinstance(result, Shown)}
    assert len(shown) >= 15
    for name, result in shown.items():
        page = ET.fromstring(result._repr_html_())
        (picture,) = page.findall("{http://www.w3.org/2000/svg}svg")
        paths = picture.findall("{http://www.w3.org/2000/svg}path")
        assert paths, name
        width, height = (float(picture.get(side, "")) for side in ("width", "height"))
        assert 20 < width <= 430, name
        assert 5 < height <= 330, name
        places = [
            [float(x) for x in place.split(",")]
            for path in paths
            for place in path.get("d", "").replace("M", " ").replace("Z", " ").split()
        ]
        assert np.min(places) >= 0, name
        assert (np.max(places, axis=0) <= (width, height)).all(), name
        code = page.find(".//code")
        assert code is not None
        assert code.text == repr(result)
        assert len(result._repr_html_()) < 200_000, name
