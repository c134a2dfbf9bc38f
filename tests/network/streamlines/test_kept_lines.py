"""Nets on meshes kept as they are, against closed forms of their lines."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

from lamella import InputError, Memory, compute, parse_project
from lamella.network.network import BOUNDARY, REGULAR
from lamella.stages.results import Results
from network.streamlines.test_streamline_network import is_sound, lamellas, ruled

MEMORY = Memory()
"""Of meshes on which several nets are made, by the content of their files: fitted once."""

Map = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, ...]]


def hypar(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """z = x y / 4: its rulings are x = const and y = const."""
    return u, v, u * v / 4


def hyperboloid(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """(x^2 + y^2) / 4 - z^2 / 2.25 = 1."""
    return 2 * np.cosh(v) * np.cos(u), 2 * np.cosh(v) * np.sin(u), 1.5 * np.sinh(v)


def torus(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """Radii 3 and 1."""
    return (3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)


def ellipsoid(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """Semi-axes 3, 2 and 1.5."""
    return 3 * np.cos(u) * np.cos(v), 2 * np.cos(u) * np.sin(v), 1.5 * np.sin(u)


def write_grid(
    path: Path,
    surface: Map,
    u: tuple[float, float],
    v: tuple[float, float],
    columns: int,
    rows: int,
    around: bool = False,
) -> None:
    """A mesh of quads over a rectangle of parameters."""
    a, b = np.meshgrid(
        np.linspace(*u, columns + 1)[: columns if around else None], np.linspace(*v, rows + 1), indexing="ij"
    )
    points = np.stack(surface(a.ravel(), b.ravel()), 1)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    n, after = rows + 1, (i + 1) % columns if around else i + 1
    faces = np.column_stack([i * n + j, after * n + j, after * n + j + 1, i * n + j + 1]) + 1
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    path.write_text("\n".join([*lines, *(f"f {p} {q} {r} {s}" for p, q, r, s in faces.tolist())]))


def run_on(path: Path, until: str | None = "network", surface: dict[str, Any] | None = None, **network: Any) -> Results:
    table = {"kind": "mesh", "file": path.name, "mean_curvature": "varying"} | (surface or {})
    return compute(
        parse_project({"surface": table, "network": network}), until=until, folder=path.parent, memory=MEMORY
    )


def crookedness(points: np.ndarray) -> float:
    """Largest distance of points from the line through the first and the last, m."""
    along = points[-1] - points[0]
    along /= np.linalg.norm(along)
    off = points - points[0]
    return float(np.linalg.norm(off - (off @ along)[:, None] * along, axis=1).max())


def test_asymptotic_lines_of_a_hyperbolic_paraboloid(tmp_path: Path) -> None:
    """They are its straight rulings; the error falls by more than h^2.5 with the mesh, from 10 to 40 quads a side."""
    errors = []
    for n in (10, 40):
        write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), n, n)
        results = run_on(tmp_path / "m.obj", normal_curvature=0.0, cells=10)
        network = results.network
        is_sound(network)
        # the surface's own corners are no nodes
        assert np.bincount(np.diff(network.face_offsets)).tolist() == [0, 0, 0, 4, 117]
        assert len(network.ids) == 20
        worst = 0.0
        for family in "AB":
            pieces = lamellas(network, family)
            across = min(range(2), key=lambda axis: np.ptp(pieces[0][:, axis]))
            worst = max(worst, *(np.ptp(piece[:, across]) for piece in pieces))
            assert max(map(crookedness, pieces)) <= 2 * worst
        errors.append(worst)
        if n == 40:
            # Enneper and Beltrami: tg^2 = -K on asymptotic lines, K = -(1/4)^2 / (1 + (x^2 + y^2) / 16)^2
            x, y, _ = network.sample_points.T
            curvature = 0.25 / (1 + (x**2 + y**2) / 16)
            assert np.abs(np.abs(network.sample_darboux.tg) - curvature).max() < 5e-3 * 0.25
            figures = ruled(network)
            assert figures["normal_curvature_error_rel_max"] < 1e-2
            assert figures["family_sign_errors"] == 0
            reported = results.summary["network"]
            assert reported["normal_curvature_deviation_p95"] < 2e-3
            assert (
                reported["node_angle_min_deg"]
                <= reported["node_angle_mean_deg"]
                <= reported["node_angle_max_deg"]
                <= 90
            )
            # cos of the angle of the rulings at (x, y): x y / sqrt((16 + x^2) (16 + y^2)), at the outermost nodes 1.8
            most = np.degrees(np.arccos(1.8**2 / (16 + 1.8**2)))
            assert reported["node_angle_min_deg"] == pytest.approx(most, abs=0.1)
    assert np.log(errors[0] / errors[1]) / np.log(4) > 2.5


@pytest.mark.slow
def test_lamellas_less_straight_than_promised_are_told_of(tmp_path: Path) -> None:
    """Off by up to 2e-3 of the curvature scale, says docs/getting-started.md: no less than the ruler finds."""
    for n, warned in ((8, True), (40, False)):
        write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), n, n)
        results = run_on(tmp_path / "m.obj", normal_curvature=0.0, cells=10)
        reported, scale = results.summary["network"], results.summary["surface"]["curvature_scale"]
        messages = [m for m in results.summary["warnings"] if "the normal curvature of the lamellas" in m]
        assert bool(messages) == warned == (reported["normal_curvature_deviation_max"] > 2e-3 * scale)
        figures = ruled(results.network)
        assert figures["normal_curvature_error_p95"] <= reported["normal_curvature_deviation_p95"]
        assert warned or figures["normal_curvature_error_p95"] < 1e-3 * figures["curvature_scale"]
        if warned:
            most, usual = (reported[f"normal_curvature_deviation_{key}"] for key in ("max", "p95"))
            assert f"off by up to {most:.2g} 1/m, {most / scale:.1e} of the curvature scale" in messages[0]
            assert f"at 95 % of the samples by {usual / scale:.1e}" in messages[0]


@pytest.mark.slow
def test_asymptotic_lines_of_a_hyperboloid(tmp_path: Path) -> None:
    """Straight rulings again, and a net that closes around the hole: as many lamellas as seeds around it."""
    errors = []
    for n in (10, 20):
        write_grid(tmp_path / "m.obj", hyperboloid, (0, 2 * np.pi), (-0.4, 0.5), 4 * n, n, around=True)
        network = run_on(tmp_path / "m.obj", normal_curvature=0.0, cells=16).network
        is_sound(network)
        assert network.cells == 16
        assert (network.families == "A").sum() == (network.families == "B").sum() == 16
        errors.append(np.mean([crookedness(piece) for family in "AB" for piece in lamellas(network, family)]))
        # disc with a hole: vertices - edges + faces = 0
        rim = (network.node_kinds == BOUNDARY).sum()
        edges = len(network.cell_edges) + rim
        assert len(network.node_points) - edges + len(network.face_offsets) - 1 == 0
    assert errors[1] < errors[0] / 4
    assert errors[1] < 5e-4


@pytest.mark.slow
def test_asymptotic_lines_of_a_torus(tmp_path: Path) -> None:
    """(R + r cos v) cos v du^2 + r dv^2 = 0, from the fundamental forms of the torus."""
    fine = np.linspace(2.1, 4.1, 4001)
    swept = cumulative_simpson(np.sqrt(-1 / ((3 + np.cos(fine)) * np.cos(fine))), x=fine, initial=0)
    errors = []
    for n in (12, 24, 48):
        write_grid(tmp_path / "m.obj", torus, (0, 1.2), (2.2, 4.0), n, n)
        network = run_on(tmp_path / "m.obj", normal_curvature=0.0, spacing=0.25).network
        is_sound(network)
        worst = 0.0
        for family in "AB":
            for points in lamellas(network, family):
                u = np.arctan2(points[:, 1], points[:, 0])
                v = np.mod(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1]) - 3), 2 * np.pi)
                there = np.interp(v, fine, swept)
                worst = max(worst, min(np.ptp(u - there), np.ptp(u + there)))
        errors.append(worst)
    assert np.log(errors[0] / errors[2]) / np.log(4) > 2
    assert errors[2] < 2e-3


def test_principal_lines_of_a_torus(tmp_path: Path) -> None:
    """They are its meridians and parallels."""
    write_grid(tmp_path / "m.obj", torus, (0, 1.2), (2.2, 4.0), 32, 32)
    results = run_on(tmp_path / "m.obj", None, kind="principal", cells=8)
    assert results.lamellas is None
    for family in "AB":
        for points in lamellas(results.network, family):
            assert min(np.ptp(np.arctan2(points[:, 1], points[:, 0])), np.ptp(points[:, 2])) < 5e-3
    assert results.summary["network"]["panel_planarity"]["max"] < 5e-3
    assert results.summary["network"]["normal_curvature_deviation_max"] is None


def test_strips_and_parts_of_it(tmp_path: Path) -> None:
    write_grid(tmp_path / "m.obj", hypar, (-2, 2), (-2, 2), 24, 24)
    results = run_on(tmp_path / "m.obj", None, normal_curvature=0.0, cells=8)
    assert {part.curvature for part in results.parts.parts} == {0.0}
    # straight rulings are unrolled to their own length: sides of 4 m, and rulings of slope c / 4
    lengths = np.sort(results.network.lengths)
    place = -2 + 4 / 16 * (2 * np.arange(8) + 1)
    assert lengths == pytest.approx(np.sort(np.tile(4 * np.sqrt(1 + place**2 / 16), 2)), rel=1e-3)
    assert np.percentile(np.abs(results.network.sample_darboux.kg), 95) < 2e-2


def test_what_is_refused(tmp_path: Path) -> None:
    """Lines that a mesh does not have are refused with the range it has; rough and flat meshes are refused."""
    write_grid(tmp_path / "m.obj", ellipsoid, (-0.6, 0.6), (0.2, 1.4), 10, 10)
    with pytest.raises(InputError, match="no direction of the surface has it") as refused:
        run_on(tmp_path / "m.obj", normal_curvature=0.0)
    low, high = (float(x) for x in refused.value.remedy.split("from ")[1].split(" 1/m")[0].split(" to "))
    network = run_on(tmp_path / "m.obj", normal_curvature=(low + high) / 2, cells=6).network
    is_sound(network)
    with pytest.raises(InputError, match="mean curvature varies") as refused:
        run_on(tmp_path / "m.obj", cells=6)
    assert refused.value.where == "network.normal_curvature"
    for more, key in (({"every": 2}, "every"), ({"closing": "round"}, "closing")):
        with pytest.raises(InputError) as refused:
            run_on(tmp_path / "m.obj", normal_curvature=(low + high) / 2, **more)
        assert refused.value.where == f"network.{key}"
    rng = np.random.default_rng(3)
    write_grid(
        tmp_path / "m.obj", lambda u, v: (u, v, u * v / 4 + rng.normal(0, 0.15, len(u))), (-2, 2), (-2, 2), 12, 12
    )
    with pytest.raises(InputError, match="too rough"):
        run_on(tmp_path / "m.obj", normal_curvature=0.0)
    write_grid(tmp_path / "m.obj", lambda u, v: (u, v, 0 * u), (-2, 2), (-2, 2), 12, 12)
    assert run_on(tmp_path / "m.obj", "surface").summary["surface"]["area"] == pytest.approx(16)
    with pytest.raises(InputError):
        run_on(tmp_path / "m.obj", normal_curvature=0.0)


def half_ring(stretch: float, uneven: float) -> Map:
    """A vault over an ellipse-shaped ring, higher in places: mirrored by two planes where it is even."""

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
        away = 5 + 2 * np.cos(v)
        height = 2 * np.sin(v) * (1 + 0.15 * np.cos(2 * u) + uneven * np.sin(u + 0.5))
        return away * np.cos(u), stretch * away * np.sin(u), height

    return surface


@pytest.mark.parametrize(
    ("stretch", "uneven"), [pytest.param(*one, marks=pytest.mark.slow) for one in ((0.9, 0.05), (1.0, 0.0), (0.8, 0.0))]
)
def test_lines_that_wind_around_are_refused_with_a_normal_curvature_that_does(
    tmp_path: Path, stretch: float, uneven: float
) -> None:
    """Closed principal lines, and spirals; the remedy followed to the letter gives a net."""
    write_grid(tmp_path / "m.obj", half_ring(stretch, uneven), (0, 2 * np.pi), (0.2, np.pi - 0.2), 40, 10, around=True)
    with pytest.raises(InputError) as refused:
        run_on(tmp_path / "m.obj", kind="principal", cells=12)
    assert refused.value.where == "network.kind"
    value = re.search(r'kind = "(\w+)" and normal_curvature = (-?[0-9.e-]+)', refused.value.remedy)
    assert value is not None
    network = run_on(tmp_path / "m.obj", kind=value[1], normal_curvature=float(value[2]), cells=12).network
    assert network is not None
    assert (network.node_kinds == REGULAR).sum() > 50
