"""Lines that wind around without reaching the rim: refused, and what the refusal says lets them end."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lamella import InputError, compute, parse_project
from lamella.base.arrays import Floats
from lamella.network.pattern import NetKind, Pattern
from lamella.network.streamlines.winding import refuse_winding
from lamella.stages.check import check_project

Faces = list[tuple[int, ...]]


def tube(radius: Callable[[Floats, Floats], Floats], height: float, around: int = 40, up: int = 13) -> Any:
    """Points and quads of a tube, its radius by angle and share of the height."""
    turn, share = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(0, 1, up), indexing="ij")
    r = radius(turn, share)
    points = np.stack([r * np.cos(turn), r * np.sin(turn), height * share], -1).reshape(-1, 3)
    rows = [(i * up + j, (i + 1) % around * up + j) for i in range(around) for j in range(up - 1)]
    return points, [(a, b, b + 1, a + 1) for a, b in rows]


def dome(height: Callable[[Floats, Floats], Floats], long: float, wide: float, rings: int = 12) -> Any:
    """Points and triangles of a dome over an ellipse, its height by x and y."""
    plan = [np.zeros((1, 2))]
    for k in range(1, rings + 1):
        turn = 2 * np.pi * np.arange(6 * k) / (6 * k)
        plan.append(k / rings * np.column_stack([long * np.cos(turn), wide * np.sin(turn)]))
    faces: Faces = [(0, 1 + i, 1 + (i + 1) % 6) for i in range(6)]
    for k in range(1, rings):
        inner, outer = 1 + 3 * k * (k - 1), 1 + 3 * k * (k + 1)
        for i in range(6 * (k + 1)):
            # the inner point at the same share of a turn, and the next one within a sixth
            sixth, at = divmod(i, k + 1)
            low = inner + (sixth * k + at) % (6 * k)
            faces.append((outer + i, outer + (i + 1) % (6 * (k + 1)), low))
            if at < k:
                faces.append((low, outer + i + 1, inner + (sixth * k + at + 1) % (6 * k)))
    xy = np.concatenate(plan)
    return np.column_stack([xy, height(xy[:, 0], xy[:, 1])]), faces


def polar_dome(height: Callable[[Floats], Floats], rim: float, around: int = 36, up: int = 11) -> Any:
    """Points, quads between rings and triangles around the top of a dome of revolution, its height by the radius."""
    points, faces = tube(lambda _, s: rim * (1 - s * (1 - 1 / up)), 0.0, around, up)
    top = len(points)
    faces += [(i * up + up - 1, (i + 1) % around * up + up - 1, top) for i in range(around)]
    points = np.vstack([points, np.zeros(3)])
    points[:, 2] = height(np.linalg.norm(points[:, :2], axis=1))
    return points, faces


def project(path: Path, mesh: Any, **network: Any) -> Any:
    points, faces = mesh
    rows = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in points.tolist()]
    path.write_text("\n".join([*rows, *("f " + " ".join(str(k + 1) for k in face) for face in faces)]) + "\n")
    surface = {"kind": "mesh", "file": path.name, "unit": "m", "mean_curvature": "varying", "tolerance": 2e-2}
    return parse_project({"surface": surface, "network": {"spacing": 0.6, **network}, "lamella": {"layers": 1}})


def refusal(path: Path, mesh: Any) -> str:
    with pytest.raises(InputError) as refused:
        check_project(project(path, mesh, kind="principal"), folder=path.parent)
    assert refused.value.where == "network.kind"
    assert "wind around" in refused.value.message
    return refused.value.remedy


def cut_line(remedy: str) -> Floats:
    """Points close together on the line along which the mesh is to be cut."""
    corners = np.array([[float(x) for x in place.split(",")] for place in re.findall(r"\(([^)]*)\)", remedy)])
    t = np.linspace(0, len(corners) - 1, 400)
    return np.column_stack([np.interp(t, np.arange(len(corners)), x) for x in corners.T])


def along(mesh: Any, line: Floats) -> NDArray[np.bool_]:
    """Faces that a line passes through."""
    points, faces = mesh
    middles = np.array([points[list(face)].mean(0) for face in faces])
    return np.isin(np.arange(len(faces)), cKDTree(middles).query(line)[1])


def without(mesh: Any, gone: NDArray[np.bool_]) -> Any:
    points, faces = mesh
    kept = [face for face, out in zip(faces, gone.tolist(), strict=True) if not out]
    used = np.unique(np.concatenate(kept))
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    return points[used], [tuple(number[list(face)].tolist()) for face in kept]


WAIST = tube(lambda _, s: 2 - 0.5 * np.sin(np.pi * s), 4.0, 24, 9)
BARREL = tube(lambda _, s: 2 + 0.6 * np.sin(np.pi * s), 4.0)
BUMPS = tube(lambda t, s: 2 + 0.16 * np.cos(3 * t) * np.sin(np.pi * s), 4.0)
HILL = dome(lambda x, y: -0.09 * x**2 - 0.17 * y**2, 4.0, 3.0)
ROUND = polar_dome(lambda r: -0.12 * r**2 - 0.0015 * r**4, 4.0)


def test_a_normal_curvature_is_offered_where_its_lines_cover_the_surface(tmp_path: Path) -> None:
    """Principal lines that wind are refused with a normal curvature; its lines cover the surface."""
    remedy = refusal(tmp_path / "m.obj", WAIST)
    value = re.search(r"normal_curvature = (-?[\d.]+)", remedy)
    assert value
    there = project(tmp_path / "m.obj", WAIST, normal_curvature=float(value[1]))
    results = compute(there, until="network", folder=tmp_path)
    figures = results.summary["network"]
    assert figures["inner_ends"] == 0
    assert figures["unreal_area_share"] == figures["flat_area_share"] == 0
    assert figures["node_angle_mean_deg"] > 60
    assert figures["cell_edge_min"] > 0.05 * figures["cell_edge_median"]


@pytest.mark.parametrize(
    ("kind", "key", "remedy"),
    [("principal", "kind", 'kind = "lamellas"'), ("lamellas", "angle", "another angle")],
)
def test_where_an_angle_is_given_neither_a_curvature_nor_a_cut_is_offered(kind: NetKind, key: str, remedy: str) -> None:
    """The surface's own normal curvature is the lamellas', and there is no mesh; nothing is searched for in vain."""
    lines: Any = SimpleNamespace(endless=np.array([True]), count=1, half=np.array([0]), position=np.zeros((1, 3)))
    nothing: Any = None
    with pytest.raises(InputError) as refused:
        refuse_winding(nothing, nothing, lines, Pattern(kind, angle=70.0), 0.5, 5.0)
    assert refused.value.where == key
    assert remedy in refused.value.remedy
    assert not re.search(r"normal_curvature|mesh", refused.value.remedy)


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [BARREL, BUMPS], ids=["barrel", "bumps"])
def test_a_cut(mesh: Any, tmp_path: Path) -> None:
    """None of a tube's rings winds once the faces along the line are taken out."""
    remedy = refusal(tmp_path / "m.obj", mesh)
    assert "normal_curvature" not in remedy
    assert "cut the mesh open" in remedy
    opened = without(mesh, along(mesh, cut_line(remedy)))
    checked = check_project(project(tmp_path / "m.obj", opened, kind="principal"), folder=tmp_path)
    assert checked.nodes


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [HILL, ROUND], ids=["hill", "round"])
def test_a_dome_in_two_parts(mesh: Any, tmp_path: Path) -> None:
    """Between the two umbilics, so that no line goes around both, or through the one."""
    remedy = refusal(tmp_path / "m.obj", mesh)
    assert "divide the mesh in two" in remedy
    line = cut_line(remedy)
    middles = np.array([mesh[0][list(face)].mean(0) for face in mesh[1]])
    across = np.cross(line[-1] - line[0], [0.0, 0.0, 1.0])
    side = (middles - line[0]) @ across > 0
    for part in (side, ~side):
        there = project(tmp_path / "m.obj", without(mesh, part), kind="principal")
        assert check_project(there, folder=tmp_path).nodes
