"""Seams and poles that are open: welded within a tolerance of the mesh's own, else named with gap and place."""

from itertools import pairwise

import numpy as np
import pytest

from lamella import InputError
from lamella.surface.from_mesh.clean import clean
from lamella.surface.from_mesh.merge import MERGE_OF_EDGE, OF_SIZE
from lamella.surface.from_mesh.raw_mesh import RawMesh
from surface.from_mesh.meshes import grid, triangles


def wrapped(radius, height, along, around=24, whole=2 * np.pi):
    """Meridians from 0 to `whole` with radii and heights (m,) along each: points (along, around + 1, 3), quads."""
    turn = np.linspace(0, whole, around + 1)
    points = np.stack((radius[:, None] * np.cos(turn), radius[:, None] * np.sin(turn), height[:, None] + 0 * turn), -1)
    i, j = np.meshgrid(np.arange(along - 1), np.arange(around), indexing="ij")
    a = i * (around + 1) + j
    return points, np.stack((a, a + 1, a + around + 2, a + around + 1), -1).reshape(-1, 4)


def tube():
    z = np.linspace(-1, 1, 11)
    return wrapped(np.cosh(z), z, 11)


def cap():
    """From the pole down; its first row is one point 25 times."""
    slope = np.linspace(1.2, 0, 9)[::-1]
    points, quads = wrapped(3 * np.sin(slope), 3 * np.cos(slope), 9)
    return points, quads[:, ::-1]


def cleaned(points, quads):
    return clean(RawMesh(points.reshape(-1, 3), triangles(quads)))


@pytest.mark.parametrize("gap", [1e-15, 1e-10, 1e-6, 1e-5, 1e-4])
@pytest.mark.parametrize("form", [tube, cap])
def test_seams_open_by_less_than_the_tolerance_are_welded(form, gap):
    points, quads = form()
    rng = np.random.default_rng(1)
    points[:, -1] += gap * rng.uniform(-1, 1, points[:, -1].shape)
    mesh = cleaned(points, quads)
    seam = len(points) if form is tube else len(points) - 1
    pole = 0 if form is tube else 24
    assert len(mesh.points) == points.shape[0] * points.shape[1] - seam - pole
    assert len(mesh.borders) == (2 if form is tube else 1)
    (note,) = (note for note in mesh.notes if "welded" in note)
    assert note.endswith("mm away" if gap > 1e-9 else "a rounding away")


@pytest.mark.parametrize("apart", [0, 1e-16, 1e-12, 1e-8, 1e-5])
@pytest.mark.parametrize("open_seam", [False, True])
def test_poles_drawn_once_for_every_meridian_are_one_vertex(apart, open_seam):
    points, quads = cap()
    points[0] += apart * np.random.default_rng(2).uniform(-1, 1, points[0].shape)
    points[1:, -1, 1] -= 1e-5 * open_seam
    mesh = cleaned(points, quads)
    assert len(mesh.points) == 8 * 24 + 1
    assert len(mesh.borders) == 1
    assert len(mesh.borders[0]) == 24
    told = [note for note in mesh.notes if "welded" in note or "merged" in note]
    assert sum(int(note.split()[0]) for note in told) == 9 * 25 - len(mesh.points)


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("rows", [11, 1001])
def test_the_tolerance_follows_size_and_edges(factor, rows):
    """A millimetre at 10 m, but never more than a fiftieth of the edges."""
    z = np.linspace(-1, 1, rows)
    points, quads = wrapped(np.cosh(z), z, rows)
    size, edge = np.linalg.norm(np.ptp(points.reshape(-1, 3), axis=0)), 1.1 * (z[1] - z[0])
    limit = min(OF_SIZE * size, MERGE_OF_EDGE * edge)
    for gap, welded in ((0.8 * limit, True), (3 * limit, False)):
        opened = points.copy()
        opened[:, -1, 1] -= gap
        if welded:
            assert len(cleaned(factor * opened, quads).borders) == 2
        elif gap < MERGE_OF_EDGE * edge:
            with pytest.raises(InputError, match="the border comes within"):
                cleaned(factor * opened, quads)


def test_halves_apart_are_joined_or_the_gap_is_named():
    z = np.linspace(-0.8, 0.9, 11)
    points, quads = wrapped(np.cosh(z), z, 11, 12, np.pi)
    for gap in (1e-5, 3e-3):
        other = points * [-1, -1, 1] - [0, gap, 0]
        both = np.concatenate((points.reshape(-1, 3), other.reshape(-1, 3)))
        faces = np.concatenate((quads, quads + points.shape[0] * points.shape[1]))
        if gap < 1e-4:
            assert len(clean(RawMesh(both, triangles(faces))).borders) == 2
            continue
        with pytest.raises(InputError, match=r"2 pieces .* The two largest come within 3 mm of one another at \(") as e:
            clean(RawMesh(both, triangles(faces)))
        assert "weld" in e.value.remedy


def test_what_remains_open_is_named_with_gap_and_place():
    points, quads = tube()
    points[:, -1, 1] -= 2e-3
    with pytest.raises(InputError, match=r"the border comes within 2 mm of itself at \(.*\) m.*\n.*weld the two sides"):
        cleaned(points, quads)
    points, quads = cap()
    turn = np.linspace(0, 2 * np.pi, 25)
    points[0, :, :2] += 2e-3 * np.stack((np.cos(turn), np.sin(turn)), -1)
    with pytest.raises(InputError, match=r"a hole only 5.66 mm wide at \(0.002, 0, 3\) m, between edges of 4\d\d mm"):
        cleaned(points, quads)


def test_a_fine_rim_beside_coarse_faces_is_not_welded():
    """Border edges of a hundredth of the others: nothing is nearer than they mean."""
    points, quads = grid(9, 9)
    faces = triangles(quads)
    fine = np.linspace(0, 1, 801)[1:-1] / 8
    fan = np.column_stack((fine, 0 * fine, 0 * fine))
    low, high = np.flatnonzero((points[:, 1] == 0) & (points[:, 0] < 0.13))
    face = next(k for k, f in enumerate(faces.tolist()) if {int(low), int(high)} <= set(f))
    (top,) = set(faces[face].tolist()) - {int(low), int(high)}
    chain = [int(low), *range(len(points), len(points) + len(fan)), int(high)]
    fan_faces = [[a, b, top] for a, b in pairwise(chain)]
    mesh = clean(RawMesh(np.vstack((points, fan)), np.vstack((np.delete(faces, face, axis=0), fan_faces))))
    assert len(mesh.points) == len(points) + len(fan)
    assert not any("welded" in note for note in mesh.notes)
