"""Quad topology: stars, ways straight on, singular vertices, and what is refused.

1. Stars are in counter-clockwise order, opposite neighbours on one polyline. 2. Runs along polylines are those found
by walking on a grid, each once. 3. Vertices of valence 3, 5 and 6 are found and end polylines. 4. Bad input.
"""

import numpy as np
import pytest

from lamella.projection.quad_mesh import quad_mesh
from projection.nets import grid_faces, spider
from refusals import refused


def grid(rows: int, columns: int, closed: bool = False):
    i, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    if closed:
        turn = 2 * np.pi * j / columns
        return quad_mesh(np.column_stack([np.cos(turn), np.sin(turn), i]), grid_faces(rows, columns, True))
    return quad_mesh(np.column_stack([i, j, 0 * i]), grid_faces(rows, columns))


def test_stars_of_a_grid() -> None:
    mesh = grid(5, 7)
    stars = mesh.stars(mesh.inner)
    assert len(mesh.inner) == 3 * 5
    legs = mesh.vertices[stars] - mesh.vertices[mesh.inner][:, None]
    assert legs[:, 0] == pytest.approx(-legs[:, 2])
    assert legs[:, 1] == pytest.approx(-legs[:, 3])
    assert np.cross(legs[:, 0], legs[:, 1])[:, 2] == pytest.approx(1)
    assert mesh.mean_edge == pytest.approx(1)
    assert len(mesh.edges) == 4 * 7 + 5 * 6
    spokes = mesh.spokes(mesh.inner)
    assert (mesh.tail[spokes] == mesh.inner[:, None]).all()
    # an edge runs from one of its ends to the other, as told
    ends = mesh.edges[mesh.edge_of[spokes]]
    ends = np.where(mesh.forward[spokes][..., None], ends, ends[..., ::-1])
    assert np.array_equal(ends, np.stack([np.broadcast_to(mesh.inner[:, None], stars.shape), stars], -1))


@pytest.mark.parametrize("length", [3, 4])
@pytest.mark.parametrize("closed", [False, True])
def test_runs_are_those_of_walking_on_the_grid(length: int, closed: bool) -> None:
    rows, columns = 6, 9
    number = np.arange(rows * columns).reshape(rows, columns)
    expected = set()
    for i in range(rows):
        for j in range(columns):
            if i + length <= rows:
                expected.add(tuple(number[i : i + length, j]))
            if closed or j + length <= columns:
                expected.add(tuple(number[i, (j + np.arange(length)) % columns]))
    runs = {tuple(r) for r in grid(rows, columns, closed).runs(length).tolist()}
    canonical = {min(r, r[::-1]) for r in runs}
    assert len(canonical) == len(runs)
    assert canonical == {min(r, r[::-1]) for r in expected}


def test_runs_pass_reentrant_corners() -> None:
    """A grid without one corner face: lines through its inner corner go on to the rim, the boundary stops there."""
    mesh = grid(5, 5)
    left = quad_mesh(mesh.vertices, mesh.faces[1:])
    corner = 6  # of the missing face
    through = {tuple(r) for r in left.runs(3).tolist() if r[1] == corner}
    assert {min(r, r[::-1]) for r in through} == {(1, 6, 11), (5, 6, 7)}
    # polylines from the rim inwards are as long as before
    assert sum(r[0] == 1 and r[1] == 6 for r in left.runs(4).tolist()) == 1


@pytest.mark.parametrize("valence", [3, 5, 6])
def test_singular_vertices(valence: int) -> None:
    points, faces = spider(valence)
    mesh = quad_mesh(points, faces)
    centre = int(np.linalg.norm(points, axis=1).argmin())
    assert mesh.singular.tolist() == [centre]
    assert mesh.valence[centre] == valence
    star = mesh.stars(mesh.singular)
    angle = np.unwrap(np.arctan2(*points[star[0], 1::-1].T))
    assert np.diff(angle) == pytest.approx(2 * np.pi / valence)
    runs = mesh.runs(3)
    assert not (runs[:, 1] == centre).any()
    # every other vertex inside has two polylines through it, one on the boundary, corners none
    through = np.bincount(runs[:, 1], minlength=len(points))
    assert (through[mesh.inner] == 2).all()
    rim = mesh.on_boundary
    assert (through[rim] == (mesh.face_count[rim] == 2)).all()


def test_order_of_faces_and_start_of_quads_do_not_matter() -> None:
    rng = np.random.default_rng(0)
    mesh = grid(5, 6)
    faces = np.array([np.roll(f, s) for f, s in zip(mesh.faces, rng.integers(0, 4, len(mesh.faces)), strict=True)])
    other = quad_mesh(mesh.vertices, rng.permutation(faces))
    assert np.array_equal(other.inner, mesh.inner)
    for mine, theirs in zip(mesh.stars(mesh.inner), other.stars(mesh.inner), strict=True):
        assert any(np.array_equal(np.roll(mine, k), theirs) for k in range(4))
    assert {tuple(r) for r in other.runs(4).tolist()} == {tuple(r) for r in mesh.runs(4).tolist()}


class TestRefused:
    def test_nothing(self) -> None:
        with refused(numbers=(0, 4)):
            quad_mesh(np.zeros((4, 3)), np.zeros((0, 4), int))

    def test_triangles(self) -> None:
        with refused(numbers=(1, 3)):
            quad_mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
        with refused(numbers=(0, 1, 2)):
            quad_mesh(np.eye(3), np.array([[0, 1, 2, 2]]))

    def test_numbers_that_are_none(self) -> None:
        points = np.array([[0.0, 0, 0], [1, 0, 0], [1, np.nan, 0], [0, 1, 0]])
        with refused(numbers=(2,)):
            quad_mesh(points, np.array([[0, 1, 2, 3]]))

    def test_index_outside(self) -> None:
        with refused(numbers=(4, 3)):
            quad_mesh(np.zeros((4, 3)), np.array([[0, 1, 2, 4]]))

    def test_opposite_sense(self) -> None:
        mesh = grid(2, 3)
        faces = mesh.faces.copy()
        faces[1] = faces[1, ::-1]
        with refused(numbers=(0, 1)):
            quad_mesh(mesh.vertices, faces)

    def test_fans_that_touch(self) -> None:
        faces = np.array([[0, 1, 2, 3], [2, 4, 5, 6]])
        with refused(numbers=(2,)):
            quad_mesh(np.random.default_rng(0).normal(size=(7, 3)), faces)

    def test_closed_surfaces_that_touch(self) -> None:
        cube = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
        other = cube + 8
        other[other == 8] = 0
        with refused(numbers=(0,)):
            quad_mesh(np.random.default_rng(0).normal(size=(16, 3)), np.vstack([cube, other]))


def test_families_of_polylines() -> None:
    """Opposite sides of quads belong to one family, adjacent sides to both; six neighbours keep them apart."""
    for mesh in (grid(4, 5), grid(4, 6, True), quad_mesh(*spider(6))):
        sides = mesh.families.reshape(-1, 4)
        assert (sides[:, 0] == sides[:, 2]).all()
        assert (sides[:, 0] + sides[:, 1] == 1).all()
        inside = mesh.twin >= 0
        assert (mesh.families[inside] == mesh.families[mesh.twin[inside]]).all()
        assert mesh.families[0] == 0


@pytest.mark.parametrize("valence", [3, 5])
def test_families_swap_around_odd_valences(valence: int) -> None:
    with refused(numbers=(valence, 90)):
        _ = quad_mesh(*spider(valence)).families
