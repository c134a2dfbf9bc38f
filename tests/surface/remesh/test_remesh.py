"""Remeshing: shapes, sizes, topology and boundary of the result, measured with nothing but points and faces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from lamella.surface.remesh.remesh import TriangleMesh, remesh

TAU = 2 * np.pi


class Curve:
    """A closed curve f(u) by its arc length, u in [0, 1), through a dense table."""

    def __init__(self, f: Callable, corners: Sequence[float] = ()) -> None:
        self.f, self.u = f, np.linspace(0, 1, 20001)
        steps = np.linalg.norm(np.diff(f(self.u), axis=0), axis=1)
        self.length = float(steps.sum())
        self.s = np.concatenate([[0.0], np.cumsum(steps)]) / self.length
        self.corners = self.parameter(np.asarray(corners, dtype=float)).tolist()

    def parameter(self, u: np.ndarray) -> np.ndarray:
        return np.interp(np.mod(u, 1.0), self.u, self.s)

    def at(self, t: np.ndarray) -> np.ndarray:
        return self.f(np.interp(np.mod(t, 1.0), self.s, self.u))


@dataclass
class Case:
    mesh: TriangleMesh
    rims: list[Curve]
    size: Callable
    project: Callable
    sharp: bool = False  # has corners below 75 degrees

    def run(self, **how: int) -> TriangleMesh:
        return remesh(self.mesh, size=self.size, project=self.project, rims=self.rims, **how)


def even(h: float) -> Callable:
    return lambda p: np.full(len(p), h)


def flat(p: np.ndarray) -> np.ndarray:
    return p * [1.0, 1.0, 0.0]


def circle(u: np.ndarray) -> np.ndarray:
    return np.column_stack([np.cos(TAU * u), np.sin(TAU * u), 0 * u])


def grid(nu: int, nv: int, closed: bool) -> np.ndarray:
    i, j = (x.ravel() for x in np.meshgrid(np.arange(nu if closed else nu - 1), np.arange(nv - 1), indexing="ij"))
    k = (i + 1) % nu
    a, b, c, d = i * nv + j, k * nv + j, k * nv + j + 1, i * nv + j + 1
    return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def annulus(f, nu, nv, size, project, *, skew=0.0, power=1.0, corners=((), ())) -> Case:
    """Grid on f(u, v), u around and v from loop 0 to loop 1, sheared by `skew` turns and crowded by `power`."""
    rims = [Curve(lambda u, v=v: f(u, np.full_like(u, v)), c) for v, c in zip((0.0, 1.0), corners, strict=True)]
    i, j = (x.ravel() for x in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))
    v = (j / (nv - 1)) ** power
    u = i / nu + skew * v
    loop = np.select([j == 0, j == nv - 1], [0, 1], -1)
    parameter = np.select([j == 0, j == nv - 1], [r.parameter(u) for r in rims], np.nan)
    return Case(TriangleMesh(f(u, v), grid(nu, nv, True), loop, parameter), rims, size, project)


def disc(f, nu, nv, size, project, *, power=1.0, corners=(), sharp=False) -> Case:
    """Polar grid on f(u, v) with its pole at v = 0 and loop 0 at v = 1."""
    rim = Curve(lambda u: f(u, np.ones_like(u)), corners)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))
    u, v = np.append(i / nu, 0.0), np.append(((j + 1) / nv) ** power, 0.0)
    loop = np.where(np.append(j, -1) == nv - 1, 0, -1)
    k = np.arange(nu)
    fan = np.column_stack([np.full(nu, nu * nv), k * nv, (k + 1) % nu * nv])
    faces = np.concatenate([grid(nu, nv, True)[:, ::-1], fan])
    parameter = np.where(loop == 0, rim.parameter(u), np.nan)
    return Case(TriangleMesh(f(u, v), faces, loop, parameter), [rim], size, project, sharp)


def ring(inner, outer, nu, nv, size, **how) -> Case:
    return annulus(lambda u, v: (inner + (outer - inner) * v)[:, None] * circle(u), nu, nv, size, flat, **how)


def catenoid(nu, nv, size, **how) -> Case:
    end = 1.08

    def f(u, v):
        z = end * (2 * v - 1)
        return np.cosh(z)[:, None] * circle(u) + z[:, None] * [0.0, 0.0, 1.0]

    def project(p):
        r, z = np.hypot(p[:, 0], p[:, 1]), p[:, 2].copy()
        for _ in range(20):
            slope = np.sinh(z) ** 2 + np.cosh(z) * (np.cosh(z) - r) + 1
            z -= ((np.cosh(z) - r) * np.sinh(z) + z - p[:, 2]) / np.maximum(slope, 0.3)
        z = np.clip(z, -end, end)
        return np.column_stack([p[:, :2] * (np.cosh(z) / r)[:, None], z])

    return annulus(f, nu, nv, size, project, **how)


def cap(nu, nv, size) -> Case:
    def f(u, v):
        return np.sin(1.2 * v)[:, None] * circle(u) + np.cos(1.2 * v)[:, None] * [0.0, 0.0, 1.0]

    return disc(f, nu, nv, size, lambda p: p / np.linalg.norm(p, axis=1)[:, None])


def star(nu, nv, size, **how) -> Case:
    """The saddle z = 0.4 (x^2 - y^2) over a star with five points of 55 degrees in plan and five re-entrant corners."""
    corners = np.arange(10) / 10
    radius = np.where(np.arange(11) % 2 == 0, 1.6, 0.8)
    x, y = radius * np.cos(TAU * np.arange(11) / 10), radius * np.sin(TAU * np.arange(11) / 10)

    def lift(x, y):
        return np.column_stack([x, y, 0.4 * (x * x - y * y)])

    def f(u, v):
        at = np.mod(u, 1)
        return lift(v * np.interp(at, np.arange(11) / 10, x), v * np.interp(at, np.arange(11) / 10, y))

    def project(p):
        q = lift(p[:, 0], p[:, 1])
        for _ in range(15):
            n = np.column_stack([-0.8 * q[:, 0], 0.8 * q[:, 1], np.ones(len(q))])
            n /= np.linalg.norm(n, axis=1)[:, None]
            way = p - q
            way -= np.sum(way * n, axis=1)[:, None] * n
            q = lift(*(q + way)[:, :2].T)
        return q

    return disc(f, nu, nv, size, project, corners=corners, sharp=True, **how)


def square_with_hole(nu, nv, size) -> Case:
    def f(u, v):
        c = circle(u)
        return 0.4 * (1 - v)[:, None] * c + v[:, None] * c / np.abs(c).max(axis=1)[:, None]

    return annulus(f, nu, nv, size, flat, corners=((), (0.125, 0.375, 0.625, 0.875)))


def helicoid(nu, nv, size) -> Case:
    """A turn and a half with radii from 0.3 to 1.2; sheets of the same plan lie 0.8 above each other."""
    rise, turn, inner, outer = 0.8 / TAU, 1.5 * TAU, 0.3, 1.2

    def surface(r, angle):
        return np.column_stack([r * np.cos(angle), r * np.sin(angle), rise * angle])

    def f(u):
        side, w = np.divmod(4 * np.mod(u, 1.0), 1.0)
        angle = turn * np.select([side == 0, side == 1, side == 2], [w, 1, 1 - w], 0.0)
        return surface(inner + (outer - inner) * np.select([side == 0, side == 1, side == 2], [0, w, 1], 1 - w), angle)

    def project(p):
        angle = p[:, 2] / rise
        for _ in range(15):
            along = p[:, 0] * np.cos(angle) + p[:, 1] * np.sin(angle)
            across = p[:, 0] * np.sin(angle) - p[:, 1] * np.cos(angle)
            angle = angle - (along * across + rise * (rise * angle - p[:, 2])) / (p[:, 0] ** 2 + p[:, 1] ** 2 + rise**2)
        along = p[:, 0] * np.cos(angle) + p[:, 1] * np.sin(angle)
        return surface(np.clip(along, inner, outer), np.clip(angle, 0, turn))

    rim = Curve(f, (0.0, 0.25, 0.5, 0.75))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))
    x, y = i / (nu - 1), j / (nv - 1)
    sides = [(j == 0) & (i < nu - 1), (i == nu - 1) & (j < nv - 1), (j == nv - 1) & (i > 0), i == 0]
    u = np.select(sides, [0.25 * x, 0.25 + 0.25 * y, 0.75 - 0.25 * x, 1 - 0.25 * y], np.nan)
    loop = np.where(np.isnan(u), -1, 0)
    parameter = np.where(loop == 0, rim.parameter(np.nan_to_num(u)), np.nan)
    points = surface(inner + (outer - inner) * y, turn * x)
    return Case(TriangleMesh(points, grid(nu, nv, False), loop, parameter), [rim], size, project)


def graded(p: np.ndarray) -> np.ndarray:
    """0.01 at the hole of radius 0.05, growing by a quarter of the distance to twenty times that."""
    return np.minimum(0.01 + 0.25 * np.maximum(np.hypot(p[:, 0], p[:, 1]) - 0.05, 0.0), 0.2)


def spot(p: np.ndarray) -> np.ndarray:
    """A small size at a place inside, away from every vertex of a coarse start."""
    return np.minimum(0.01 + 0.3 * np.hypot(p[:, 0] - 0.9, p[:, 1] - 0.3), 0.4)


CASES: dict[str, Callable[[], Case]] = {
    "catenoid, sheared and crowded": lambda: catenoid(60, 6, even(0.1), skew=0.3, power=2.0),
    "catenoid of 10 triangles": lambda: catenoid(5, 2, even(0.1)),
    "catenoid coarsened": lambda: catenoid(150, 40, even(0.35)),
    "cap of 36 triangles": lambda: cap(12, 2, even(0.05)),
    "cap coarsened": lambda: cap(120, 50, even(0.28)),
    "square with a hole": lambda: square_with_hole(40, 4, even(0.07)),
    "saddle over a star, needles": lambda: star(200, 8, even(0.12), power=3.0),
    "helicoid": lambda: helicoid(40, 4, even(0.08)),
    "helicoid of 18 triangles": lambda: helicoid(10, 2, even(0.08)),
    "helicoid coarsened": lambda: helicoid(200, 20, even(0.25)),
    "thin annulus": lambda: ring(1.0, 1.15, 20, 2, even(0.08)),
    "thin annulus, sides of the start cross the hole": lambda: ring(1.0, 1.15, 6, 2, even(0.05)),
    "annulus sheared by 0.9 turns": lambda: ring(0.3, 1.3, 60, 60, even(0.06), skew=0.9),
    "graded 1 to 20, sheared": lambda: ring(0.05, 1.6, 40, 30, graded, skew=0.4),
    "graded 1 to 20 from 16 triangles": lambda: ring(0.05, 1.6, 8, 2, graded),
    "graded 1 to 40 about a spot, from 6 triangles": lambda: disc(
        lambda u, v: 2 * v[:, None] * circle(u), 6, 1, spot, flat
    ),
}


def edges_of(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    half = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(half, axis=0, return_counts=True)


def euler(mesh: TriangleMesh) -> int:
    return len(np.unique(mesh.faces)) - len(edges_of(mesh.faces)[0]) + len(mesh.faces)


def smallest_angles(mesh: TriangleMesh) -> np.ndarray:
    corners = mesh.points[mesh.faces]
    a, b = corners[:, [1, 2, 0]] - corners, corners[:, [2, 0, 1]] - corners
    cosine = np.sum(a * b, axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).min(axis=1)


def face_vectors(mesh: TriangleMesh) -> np.ndarray:
    a, b, c = np.moveaxis(mesh.points[mesh.faces], 1, 0)
    return np.cross(b - a, c - a) / 2


@pytest.fixture(scope="module")
def results() -> dict[str, tuple[Case, TriangleMesh]]:
    return {name: (case := make(), case.run()) for name, make in CASES.items()}


@pytest.mark.parametrize(
    "make",
    [
        lambda: ring(0.05, 1.6, 36, 34, graded, skew=0.4),
        lambda: ring(0.05, 1.6, 48, 26, graded, skew=0.4),
        lambda: ring(0.05, 1.6, 44, 34, graded, skew=0.4),
        lambda: disc(lambda u, v: 2 * v[:, None] * circle(u), 6, 1, spot, flat),
    ],
)
def test_no_edge_is_stretched_after_the_last_cuts(make) -> None:
    """Of 40 graded starts, smoothing and flips leave an edge of 1.5 to 1.6 sizes in three unless it is cut again."""
    case = make()
    mesh = case.run()
    ends = mesh.points[edges_of(mesh.faces)[0]]
    assert (np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / case.size(ends.mean(axis=1))).max() < 1.5
    assert smallest_angles(mesh).min() > 22


@pytest.mark.parametrize("name", CASES)
class TestCases:
    def test_triangles_are_well_shaped(self, results, name) -> None:
        _, mesh = results[name]
        smallest = smallest_angles(mesh)
        assert smallest.min() > 22
        assert np.mean(smallest < 30) < 0.005
        assert smallest.mean() > 49

    def test_edges_have_the_wanted_length(self, results, name) -> None:
        case, mesh = results[name]
        edges, _ = edges_of(mesh.faces)
        ends = mesh.points[edges]
        ratio = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / case.size(ends.mean(axis=1))
        assert np.mean((ratio < 0.6) | (ratio > 1.4)) < 0.01
        assert ratio.min() > 0.4
        assert ratio.max() < 1.5
        assert 0.93 < np.median(ratio) < 1.08

    def test_topology_and_orientation_stay(self, results, name) -> None:
        case, mesh = results[name]
        assert euler(mesh) == euler(case.mesh)
        directed = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
        assert len(np.unique(directed, axis=0)) == len(directed), "two faces run the same way along an edge"
        edges, count = edges_of(mesh.faces)
        assert count.max() == 2
        assert np.array_equal(np.unique(edges[count == 1]), np.flatnonzero(mesh.loop >= 0))
        assert np.array_equal(np.unique(mesh.faces), np.arange(len(mesh.points)))
        # The vector area depends on the boundary alone, so it tells the orientation whatever the triangles are.
        before, after = face_vectors(case.mesh).sum(axis=0), face_vectors(mesh).sum(axis=0)
        assert before @ after > 0 or np.linalg.norm(after) < 0.1

    def test_no_triangle_is_turned_over(self, results, name) -> None:
        _, mesh = results[name]
        vectors = face_vectors(mesh)
        normals = vectors / np.linalg.norm(vectors, axis=1)[:, None]
        half = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
        _, edge, count = np.unique(np.sort(half, axis=1), axis=0, return_inverse=True, return_counts=True)
        face = np.tile(np.arange(len(mesh.faces)), 3)[np.argsort(edge.ravel(), kind="stable")]
        start = np.cumsum(count) - count
        pair = start[count == 2]
        assert np.min(np.sum(normals[face[pair]] * normals[face[pair + 1]], axis=1)) > 0.7

    def test_boundary_is_exact(self, results, name) -> None:
        case, mesh = results[name]
        assert np.array_equal(np.isnan(mesh.parameter), mesh.loop < 0)
        edges, count = edges_of(mesh.faces)
        rim_edges = edges[count == 1]
        for which, rim in enumerate(case.rims):
            mine = np.flatnonzero(mesh.loop == which)
            t = mesh.parameter[mine]
            assert np.array_equal(mesh.points[mine], rim.at(t))
            assert t.min() >= 0
            assert t.max() < 1
            assert np.all(np.isin(rim.corners, t))
            ringed = mine[np.argsort(t)]
            wanted = np.sort(np.column_stack([ringed, np.roll(ringed, -1)]), axis=1)
            have = rim_edges[mesh.loop[rim_edges[:, 0]] == which]
            assert {*map(tuple, have.tolist())} == {*map(tuple, wanted.tolist())}

    def test_boundary_shares_out_the_size(self, results, name) -> None:
        """Between two corners each edge spans the same integral of ds/size, as near to 1 as a whole number allows."""
        case, mesh = results[name]
        for which, rim in enumerate(case.rims):
            t = np.sort(mesh.parameter[mesh.loop == which])
            stops = [*rim.corners, rim.corners[0] + 1] if rim.corners else [t[0], t[0] + 1]
            fine = np.linspace(stops[0], stops[-1], 40001)
            density = rim.length / case.size(rim.at(fine))
            total = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
            around = np.sort(np.concatenate([t, t + 1]))
            for low, high in pairwise(stops):
                inside = around[(around >= low - 1e-12) & (around <= high + 1e-12)]
                spans = np.diff(np.interp(inside, fine, total))
                assert spans == pytest.approx(np.full(spans.size, spans.mean()), rel=0.01)
                assert spans.size == max(round(spans.sum()), 1)

    def test_triangles_touch_the_boundary_with_one_edge(self, results, name) -> None:
        case, mesh = results[name]
        edges, count = edges_of(mesh.faces)
        bridges = edges[(count == 2) & (mesh.loop[edges] >= 0).all(axis=1)]
        ears = np.flatnonzero(np.bincount(edges.ravel()) == 2)
        assert ears.size == (5 if case.sharp else 0)
        assert len(bridges) == ears.size
        assert np.all(np.isin(mesh.parameter[ears], case.rims[0].corners))

    def test_inner_points_are_on_the_surface(self, results, name) -> None:
        case, mesh = results[name]
        inside = mesh.points[mesh.loop < 0]
        assert np.abs(case.project(inside) - inside).max() < 1e-6


def test_same_result_again() -> None:
    case = CASES["graded 1 to 20, sheared"]()
    one, other = case.run(), case.run()
    assert np.array_equal(one.faces, other.faces)
    assert one.points.tobytes() == other.points.tobytes()


def test_start_is_not_changed() -> None:
    case = CASES["thin annulus"]()
    points, faces, loop = case.mesh.points.copy(), case.mesh.faces.copy(), case.mesh.loop.copy()
    case.run()
    assert np.array_equal(points, case.mesh.points)
    assert np.array_equal(faces, case.mesh.faces)
    assert np.array_equal(loop, case.mesh.loop)


def test_result_is_a_start_again() -> None:
    case = CASES["helicoid"]()
    fine = case.run()
    coarse = replace(case, mesh=fine, size=even(0.2)).run()
    again = replace(case, mesh=coarse).run()
    assert len(coarse.faces) < len(fine.faces) / 4
    assert abs(len(again.faces) / len(fine.faces) - 1) < 0.05
    assert smallest_angles(again).min() > 25


def test_corner_that_is_no_vertex_yet() -> None:
    """The nine vertices of the start on the square miss all its corners."""
    case = square_with_hole(9, 3, even(0.15))
    assert not np.any(np.isin(case.rims[1].corners, case.mesh.parameter))
    mesh = case.run()
    assert np.all(np.isin(case.rims[1].corners, mesh.parameter))
    assert smallest_angles(mesh).min() > 25


def test_turned_triangles_of_the_start_are_mended() -> None:
    case = ring(0.3, 1.3, 40, 12, even(0.06))
    points = case.mesh.points.copy()
    inside = case.mesh.loop < 0
    points[inside, :2] += 0.04 * np.random.default_rng(1).uniform(-1, 1, (inside.sum(), 2))
    start = replace(case.mesh, points=points)
    up = face_vectors(start)[:, 2] * np.sign(face_vectors(case.mesh)[0, 2])
    assert np.sum(up < 0) == 9
    mesh = replace(case, mesh=start).run()
    assert np.all(face_vectors(mesh)[:, 2] * np.sign(face_vectors(case.mesh)[0, 2]) > 0)
    assert smallest_angles(mesh).min() > 25


def test_small_hole_keeps_three_edges() -> None:
    case = ring(0.03, 1.0, 30, 5, even(0.3), skew=0.3)
    mesh = case.run()
    assert np.sum(mesh.loop == 0) == 3
    assert euler(mesh) == 0


def test_closed_surface() -> None:
    points = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    start = TriangleMesh(points, faces, np.full(6, -1), np.full(6, np.nan))
    mesh = remesh(start, size=even(0.2), project=lambda p: p / np.linalg.norm(p, axis=1)[:, None], rims=[])
    assert euler(mesh) == 2
    assert smallest_angles(mesh).min() > 30


def test_folded_start_is_refused() -> None:
    with pytest.raises(ValueError, match="folded"):
        ring(0.3, 1.3, 30, 12, even(0.06), skew=1.5).run(rounds=2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: replace(m, faces=np.concatenate([m.faces, m.faces[:1]])), "oriented manifold"),
        (lambda m: replace(m, faces=np.concatenate([m.faces[:1, ::-1], m.faces[1:]])), "oriented manifold"),
        (lambda m: replace(m, loop=np.where(m.loop == 1, 0, m.loop)), "no vertex of the mesh lies on boundary loop 1"),
        (lambda m: replace(m, loop=np.where(np.arange(m.loop.size) == 0, -1, m.loop)), "not those on the boundary"),
        (lambda m: replace(m, parameter=np.mod(7 * m.parameter, 1.0)), "order of its parameters"),
        (lambda m: replace(m, points=np.vstack([m.points, m.points[:1]]), loop=np.append(m.loop, -1),
                           parameter=np.append(m.parameter, np.nan)), "belongs to no triangle"),
    ],
)  # fmt: skip
def test_bad_starts_are_refused(change, message) -> None:
    case = ring(0.5, 1.5, 20, 4, even(0.2))
    with pytest.raises(ValueError, match=message):
        replace(case, mesh=change(case.mesh)).run()
