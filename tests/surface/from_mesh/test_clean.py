"""What is mended in a mesh, and what is refused with figures."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from lamella import InputError
from lamella.files.read.mesh import read_mesh
from lamella.surface.from_mesh.clean import CleanMesh, clean
from lamella.surface.from_mesh.edges import face_normals, find_edges
from lamella.surface.from_mesh.raw_mesh import RawMesh
from lamella.surface.from_mesh.slivers import SLIVER_OF_EDGE
from refusals import keys, refused, warned
from surface.from_mesh.meshes import disc, grid, irregular, moebius, sphere, stl_bytes, torus, triangles

POINTS, QUADS = grid(9, 9)
FACES = triangles(QUADS)


def cleaned(points, faces) -> CleanMesh:
    mesh = clean(RawMesh(np.asarray(points, dtype=float), np.asarray(faces)))
    check(mesh)
    return mesh


def check(mesh):
    """Everything a clean mesh promises, by counting half-edges."""
    half = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    forward = {tuple(row) for row in half.tolist()}
    assert len(forward) == len(half), "an edge is used twice in one direction"
    assert set(mesh.faces.ravel().tolist()) == set(range(len(mesh.points)))
    open_edges = {edge for edge in forward if edge[::-1] not in forward}
    loops = [list(zip(loop, np.roll(loop, -1), strict=True)) for loop in mesh.borders]
    assert {(int(a), int(b)) for loop in loops for a, b in loop} == open_edges
    lengths = [sum(np.linalg.norm(mesh.points[b] - mesh.points[a]) for a, b in loop) for loop in loops]
    assert lengths == sorted(lengths, reverse=True)
    edges = len({tuple(sorted(edge)) for edge in forward})
    assert len(mesh.points) - edges + len(mesh.faces) == 2 - len(mesh.borders)


def area(mesh):
    return np.linalg.norm(face_normals(mesh.points, mesh.faces), axis=1).sum() / 2


def check_refused(points, faces, numbers=(), names=()):
    with refused("faces", numbers, names):
        clean(RawMesh(np.asarray(points, dtype=float), np.asarray(faces)))


def test_a_good_mesh_stays_as_it_is():
    mesh = cleaned(POINTS, FACES)
    assert (mesh.points == POINTS).all()
    assert (mesh.faces == FACES).all()
    assert keys(mesh.notes) == ["normals_kept"]
    assert len(mesh.borders) == 1
    assert len(mesh.borders[0]) == 32


def test_borders_run_with_the_surface_to_the_left():
    mesh = cleaned(*disc(4, 24, hole=0.3))
    for loop, sign in zip(mesh.borders, (1, -1), strict=True):
        at = mesh.points[loop]
        assert np.sign(np.cross(at, np.roll(at, -1, axis=0)).sum(axis=0)[2]) == sign
    turned = cleaned(*(lambda points, faces: (points, faces[:, ::-1]))(*disc(4, 24, hole=0.3)))
    assert turned.borders[0][0] == mesh.borders[0][0]
    assert turned.borders[0][1] == mesh.borders[0][-1]


@pytest.mark.parametrize("binary", [True, False])
def test_stl_becomes_the_mesh_it_was(tmp_path, binary):
    (tmp_path / "a.stl").write_bytes(stl_bytes(POINTS + 3, FACES, binary))
    mesh = clean(read_mesh(tmp_path / "a.stl"))
    check(mesh)
    assert len(mesh.points) == len(POINTS)
    far, twin = cKDTree(POINTS + 3).query(mesh.points)
    assert far.max() < 1e-6
    assert {frozenset(face) for face in twin[mesh.faces].tolist()} == {frozenset(face) for face in FACES.tolist()}


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=60)
def test_disorder_is_undone(seed):
    """Vertices doubled and moved by rounding, unused ones, faces doubled, turned and in any order, slivers."""
    rng = np.random.default_rng(seed)
    uv, faces = irregular(9, seed)
    points = 10 ** rng.uniform(-1, 3) * np.column_stack((uv, 0.3 * uv[:, 0] * uv[:, 1]))
    size = np.ptp(points)
    # Every corner its own vertex, moved by rounding.
    soup = points[faces].reshape(-1, 3) + 1e-8 * size * rng.uniform(-1, 1, (3 * len(faces), 3))
    corners = rng.permutation(len(soup))
    where = np.empty_like(corners)
    where[corners] = np.arange(len(corners))
    soup, broken = soup[corners], where[np.arange(3 * len(faces)).reshape(-1, 3)]
    broken = np.vstack((broken, broken[rng.integers(0, len(broken), 5)], [[0, 0, 1], [2, 2, 2]]))
    soup = np.vstack((soup, rng.random((4, 3)) * size * 50))
    flip = rng.random(len(broken)) < 0.4
    broken[flip] = broken[flip][:, ::-1]
    broken = np.array([np.roll(face, rng.integers(3)) for face in broken])[rng.permutation(len(broken))]
    mesh = cleaned(soup, broken)
    assert len(mesh.points) == len(points)
    assert len(mesh.faces) == len(faces)
    _, twin = cKDTree(points).query(mesh.points)
    assert {frozenset(f) for f in twin[mesh.faces].tolist()} == {frozenset(f) for f in faces.tolist()}
    up = face_normals(mesh.points, mesh.faces)[:, 2]
    assert (up > 0).all() or (up < 0).all()


def test_orientation_is_the_files_own_or_outwards():
    points, faces = sphere(32, 16, 2.0)
    faces = faces[points[faces].mean(axis=1)[:, 2] > 0.5]
    inwards = cleaned(points, faces[:, ::-1])
    assert (
        np.einsum("ij,ij->i", face_normals(inwards.points, inwards.faces), inwards.points[inwards.faces[:, 0]]) < 0
    ).all()
    assert keys(inwards.notes) == ["normals_kept"]
    mixed = faces.copy()
    mixed[1::2] = mixed[1::2, ::-1]
    outwards = cleaned(points, mixed)
    assert (
        np.einsum("ij,ij->i", face_normals(outwards.points, outwards.faces), outwards.points[outwards.faces[:, 0]]) > 0
    ).all()
    warned(outwards.notes, "normals_outwards", [len(faces)])
    # A plane has no outside: most of the faces decide.
    flat = FACES.copy()
    flat[:20] = flat[:20, ::-1]
    mesh = cleaned(POINTS * [1, 1, 0], flat)
    assert (face_normals(mesh.points, mesh.faces)[:, 2] > 0).all()
    warned(mesh.notes, "normals_most", [20, 128])


def insert_on_edges(points, faces, rng, count, offset):
    """Split inner edges very near to one of their ends: short edges and needles."""
    points = points.copy()
    for _ in range(count):
        edges = find_edges(faces)
        lengths = edges.lengths(points)
        pairs = edges.inner_pairs[lengths[edges.count == 2] > 0.05 * np.median(lengths)]
        first, second = pairs[rng.integers(len(pairs))]
        a, b = faces[first // 3, first % 3], faces[first // 3, (first + 1) % 3]
        c, d = faces[first // 3, (first + 2) % 3], faces[second // 3, (second + 2) % 3]
        new = len(points)
        points = np.vstack((points, points[a] + offset * (points[b] - points[a])))
        faces = np.vstack(
            (np.delete(faces, [first // 3, second // 3], axis=0), [[a, new, c], [new, b, c], [b, new, d], [new, a, d]])
        )
    return points, faces


@pytest.mark.parametrize("seed", range(8))
def test_slivers_go_and_the_shape_stays(seed):
    rng = np.random.default_rng(seed)
    uv, faces = irregular(8, seed)
    points = np.column_stack((uv, 0.3 * uv[:, 0] * uv[:, 1]))
    needles, broken = insert_on_edges(points, faces, rng, 12, 2e-5)
    mesh = cleaned(needles, broken)
    assert len(mesh.points) == len(points)
    assert area(mesh) == pytest.approx(np.linalg.norm(face_normals(points, faces), axis=1).sum() / 2, rel=1e-3)
    warned(mesh.notes, "slivers_removed")
    assert find_edges(mesh.faces).lengths(mesh.points).min() > SLIVER_OF_EDGE / 10


def test_flat_triangles_are_flipped_inside_and_dropped_on_the_border():
    # Vertex 4 lies almost on the edge 0-1, which is an inner edge of the first mesh and a border of the second.
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 1e-6, 0], [0.5, -1, 0]]
    faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5]]
    mesh = cleaned(points, faces)
    assert len(mesh.faces) == 5
    assert area(mesh) == pytest.approx(1.5, rel=1e-5)
    warned(mesh.notes, "slivers_removed", [1])
    mesh = cleaned(points[:5], faces[:4])
    assert len(mesh.faces) == 3
    assert len(mesh.borders[0]) == 5


def test_t_junctions_are_closed():
    # Two quads below, four above: the middle vertices of the upper side lie on the lower edges.
    lower = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
    upper = [
        [0.3, 1, 0],
        [0.6, 1, 0],
        [1.5, 1, 0],
        [0, 2, 0],
        [0.3, 2, 0],
        [0.6, 2, 0],
        [1, 2, 0],
        [1.5, 2, 0],
        [2, 2, 0],
    ]
    row = [3, 6, 7, 4, 8, 5]
    faces = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]
    for k in range(5):
        faces += [[row[k], row[k + 1], 10 + k], [row[k], 10 + k, 9 + k]]
    mesh = cleaned(lower + upper, faces)
    assert area(mesh) == pytest.approx(4)
    assert len(mesh.borders) == 1
    warned(mesh.notes, "t_junctions_closed", [3])


def test_cracks_are_refused():
    # The finer side of the seam is bent by a fiftieth of an edge: no vertex lies on the coarse edge.
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.5, 0.02, 0], [0, -1, 0], [1, -1, 0]]
    points += [[-1, -1, 0], [-1, 1, 0], [2, -1, 0], [2, 1, 0]]
    faces = [[0, 4, 2], [4, 3, 2], [4, 1, 3], [5, 6, 1], [5, 1, 0]]
    faces += [[7, 5, 0], [7, 0, 8], [8, 0, 2], [6, 9, 1], [9, 10, 1], [1, 10, 3]]
    check_refused(points, faces, [1, 10])
    # A slit that reaches the outer border.
    points, quads = grid(9, 9, lambda x, y: 0 * x)
    faces = triangles(quads)
    slit = np.flatnonzero((points[:, 0] == 0.5) & (points[:, 1] < 0.6))
    copies = {int(v): len(points) + k for k, v in enumerate(slit[:-1])}
    points = np.vstack((points, points[slit[:-1]] + [1e-3, 0, 0]))
    right = points[faces].mean(axis=1)[:, 0] > 0.5
    faces[right] = np.vectorize(lambda v: copies.get(v, v))(faces[right])
    check_refused(points, faces)


def test_non_manifold_edges_are_refused_with_place():
    points = np.vstack((POINTS, [[0.5, 0.5, 2]]))
    middle = int(np.flatnonzero((POINTS[:, :2] == 0.5).all(axis=1))[0])
    fin = [middle, middle + 1, len(POINTS)]
    check_refused(points, [*FACES, fin], [1, 3], ["(0.5, 0.5625, 0.0844) m"])


def test_bow_ties_are_refused_with_place():
    keep = np.ones(len(FACES), dtype=bool)
    middles = POINTS[FACES].mean(axis=1)
    for x, y in ((0.44, 0.44), (0.56, 0.56)):
        near = (np.abs(middles[:, :2] - [x, y]) < 0.0625).all(axis=1)
        keep &= ~near
    check_refused(POINTS, FACES[keep], [1], ["(0.5, 0.5, 0.075)"])


def test_several_pieces_are_refused_and_fragments_dropped():
    points, faces = disc()
    two = np.vstack((points, 0.5 * points + [3, 0, 0]))
    check_refused(two, np.vstack((faces, faces + len(points))), [2, 3.106, 264, 0.7765])
    small = np.vstack((points, 0.01 * points + [3, 0, 0]))
    mesh = cleaned(small, np.vstack((faces, faces + len(points))))
    assert len(mesh.faces) == len(faces)
    warned(mesh.notes, "fragments_dropped", [1, 0.0001])
    # Pieces that touch at one vertex are pieces.
    touching = np.vstack((points, points + np.array([2, 0, 0])))
    check_refused(touching, np.vstack((faces, faces + len(points))), [2])


@pytest.mark.parametrize("seed", range(3))
def test_one_sided_surfaces_are_refused(seed):
    points, faces = moebius()
    faces = faces.copy()
    flip = np.random.default_rng(seed).random(len(faces)) < 0.5
    faces[flip] = faces[flip][:, ::-1]
    check_refused(points, faces)


def test_closed_surfaces_and_handles_are_refused():
    check_refused(*sphere(), [266, 792, 528, 2])
    check_refused(*torus(), [1, 288, 864, 576])
    points, faces = torus()
    check_refused(points, faces[1:], [1, 288, 864, 575, -1])
    hole = sphere()[0], sphere()[1][1:]
    assert len(cleaned(*hole).borders) == 1


def test_nothing_left_is_refused():
    check_refused([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 1], [1, 2, 2]])
    check_refused([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])


@given(seed=st.integers(0, 2**32 - 1), kind=st.sampled_from(["soup", "moved", "dropped"]))
@settings(deadline=None, max_examples=150)
def test_anything_is_cleaned_or_refused(seed, kind):
    rng = np.random.default_rng(seed)
    if kind == "soup":
        points = rng.integers(0, 4, (12, 3)).astype(float)
        faces = rng.integers(0, 12, (int(rng.integers(1, 20)), 3))
    else:
        uv, faces = irregular(6, seed)
        points = np.column_stack((uv, 0.3 * uv[:, 0] * uv[:, 1]))
        if kind == "moved":
            some = rng.integers(0, len(points), 8)
            points[some] = points[rng.integers(0, len(points), 8)] + rng.choice([0, 1e-7, 1e-4, 1e-2]) * rng.random(3)
        else:
            faces = faces[rng.random(len(faces)) < 0.9]
    try:
        cleaned(points, faces)
    except InputError as refusal:
        assert refusal.remedy  # noqa: PT017


def test_a_hundred_thousand_loose_faces_are_welded():
    uv, faces = irregular(225)
    points = np.column_stack((uv, 0.3 * uv[:, 0] * uv[:, 1]))
    soup = points[faces].reshape(-1, 3)
    mesh = clean(RawMesh(soup, np.arange(len(soup)).reshape(-1, 3)))
    assert len(mesh.points) == len(points)
