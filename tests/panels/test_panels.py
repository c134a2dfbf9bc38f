"""Panels: planar but for fourth order, warped alike on cells, covering the net once, cut as they stand in space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import lamella
from lamella import InputError
from lamella.network.network import SINGULAR, Network
from lamella.panels.every_second_node import every_second_node
from lamella.panels.flat_outlines import on_cylinders, with_true_sides
from lamella.panels.make_panels import make_panels
from lamella.panels.panels import COLD_BENT, FLAT, INSIDE, SINGLE_CURVED, UMBILIC, Panels
from lamella.panels.polygons import Polygons
from lamella.panels.rules import PanelRules

SURFACES = {
    "scherk": lamella.Scherk(1.2, 3.0),
    "enneper": lamella.Enneper(2, 0.8, 5.0),
    "helicoid": lamella.Helicoid(6.0, 0.6, 4.5, 1.0),
    "unduloid": lamella.Unduloid(1.6, 2.8, (-2.0, 3.0)),
    "monkey": lamella.Enneper(3, 0.8, 5.0),
}


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(19)


def vector_areas(points: np.ndarray, polygons: Polygons) -> np.ndarray:
    """Of each polygon, (p, 3)."""
    after = polygons.nodes[polygons.following()]
    cross = np.cross(points[polygons.nodes], points[after]) / 2
    return np.stack([np.bincount(polygons.owner, cross[:, k], len(polygons)) for k in range(3)], axis=1)


def sides(panels: Panels, corners: np.ndarray) -> np.ndarray:
    return np.linalg.norm(corners[panels.plates.following()] - corners, axis=1)


@pytest.mark.parametrize("name", ["scherk", "enneper", "helicoid"])
def test_principal_quads_are_planar_to_fourth_order(name: str) -> None:
    """The volume of the tetrahedron of four corners of a conjugate net, over the areas (Bobenko, Suris 2008)."""
    median = []
    for cells in (12, 24):
        panels = make_panels(lamella.net(SURFACES[name], cells=cells), PanelRules(offset=0.05))
        median.append(np.median(panels.planes.out_of_plane[panels.laid == INSIDE]))
    assert np.log2(median[0] / median[1]) > 3.7


def test_quads_of_revolution_are_planar() -> None:
    """Isosceles trapezia between two parallels and two meridians."""
    panels = make_panels(lamella.net(SURFACES["unduloid"], cells=12), PanelRules(offset=0.1))
    assert panels.planes.out_of_plane[panels.laid == INSIDE].max() < 1e-13


@pytest.mark.parametrize("name", ["scherk", "enneper", "helicoid", "unduloid"])
def test_cells_are_warped_alike(name: str) -> None:
    """l^2 tg = l0^2 / 2 in every cell of a CMC net, up to second order in the cells; all within 4 %."""
    off = []
    for cells in (12, 24):
        net = lamella.net(SURFACES[name], cells=cells)
        panels = make_panels(net, PanelRules(on="cells", above_limit="cold-bent"))
        warps = panels.planes.warps[panels.laid == INSIDE]
        assert warps.max() < 1.04 * warps.min()
        off.append(abs(warps.mean() / (net.step**2 / 2) - 1))
    assert np.log2(off[0] / off[1]) > 1.8


@pytest.mark.parametrize("on", ["diagonals", "cells"])
@pytest.mark.parametrize("name", sorted(SURFACES))
def test_panels_cover_every_face_once(name: str, on: str) -> None:
    """Vector areas of polygons add up to those of the faces; each side has one panel on either side, or a rim."""
    net = lamella.net(SURFACES[name], cells=14)
    panels = make_panels(net, PanelRules(on=on, gap=0.0))
    faces = Polygons(net.face_offsets, net.face_nodes, np.zeros(0, int), np.zeros(0, bool))
    faces = replace(faces, centres=np.full(len(net.face_offsets) - 1, -1))
    whole = vector_areas(net.node_points, faces)
    planned = vector_areas(panels.points, panels.planned)
    assert planned.sum(axis=0) == pytest.approx(whole.sum(axis=0), abs=1e-10)
    assert np.linalg.norm(planned, axis=1).sum() == pytest.approx(np.linalg.norm(whole, axis=1).sum(), rel=0.02)
    nodes = panels.planned.nodes
    pairs = np.column_stack([nodes, nodes[panels.planned.following()]])
    assert len(np.unique(pairs, axis=0)) == len(pairs)
    # none is turned over
    normals = np.stack([np.bincount(panels.planned.owner, net.node_normals[nodes, k]) for k in range(3)], axis=1)
    assert (np.einsum("ij,ij->i", normals, planned) > 0).all()


def test_area_is_that_of_the_offset_surface() -> None:
    """A catenoid's area pi c^2 (u + sinh u cosh u), its offset's A + d^2 int K, int K = -2 pi (tanh u1 - tanh u0)."""
    c, offset = 2.5, 0.3
    # whole cells between the rims
    u = np.pi / 24 * np.array([-6, 9])
    area = np.pi * c**2 * np.diff(u + np.sinh(u) * np.cosh(u))[0] - 2 * np.pi * offset**2 * np.diff(np.tanh(u))[0]
    off = []
    for cells in (24, 48):
        net = lamella.net(lamella.Catenoid(c, tuple(c * u)), cells=cells)
        panels = make_panels(net, PanelRules(offset=offset, gap=0.0))
        off.append(area - panels.areas.sum())
    assert off[0] < 0.01 * area
    assert np.log2(off[0] / off[1]) == pytest.approx(2, abs=0.1)


def test_gaps_take_their_share() -> None:
    """A polygon moved inwards by d loses d times its perimeter, less d^2 cot(a / 2) for each corner (Steiner)."""
    net, d = lamella.net(SURFACES["unduloid"], cells=16), 0.004
    whole, less = (make_panels(net, PanelRules(gap=gap)) for gap in (0.0, 2 * d))
    owner = whole.plates.owner
    lost = d * sides(whole, whole.outlines) - d**2 / np.tan(np.radians(whole.angles) / 2)
    kept = np.isin(whole.ids, less.ids) & (whole.plates.sizes == 4) & (whole.laid[whole.owners] == INSIDE)
    expected = whole.areas - np.bincount(owner, lost)
    areas = dict(zip(less.ids, less.areas, strict=True))
    assert [areas[i] for i in np.array(whole.ids)[kept]] == pytest.approx(expected[kept], rel=1e-12)
    assert (less.areas > 0).all()


def test_plates_do_not_overlap() -> None:
    """In space plates keep the gap: every corner lies half a gap or more from the planes through its panel's sides."""
    net, gap = lamella.net(SURFACES["monkey"], cells=14), 0.02
    panels = make_panels(net, PanelRules(gap=gap, offset=0.1))
    plates = panels.plates
    after = plates.nodes[plates.following()]
    along = panels.points[after] - panels.points[plates.nodes]
    along /= np.linalg.norm(along, axis=1)[:, None]
    whole = np.flatnonzero((plates.sizes == 4) & (panels.laid[panels.owners] == INSIDE))
    for k in whole.tolist():
        at = slice(plates.offsets[k], plates.offsets[k + 1])
        corner, start = panels.corners[at], panels.points[plates.nodes[at]]
        normal = np.cross(start[2] - start[0], start[3] - start[1])
        inwards = np.cross(normal / np.linalg.norm(normal), along[at])
        distance = np.einsum("sj,csj->cs", inwards, corner[:, None] - start[None])
        assert distance.min() > gap / 2 - 1e-5
    assert len(whole) > 100


def turned(net: Network, rng: np.random.Generator) -> Network:
    """The same net turned, its coordinates with other last bits."""
    turn = Rotation.random(random_state=rng).as_matrix()
    keys = ("node_points", "node_normals", "sample_points", "sample_normals", "sample_tangents")
    return replace(net, **{key: getattr(net, key) @ turn.T for key in keys})


def test_kinds_do_not_hang_on_last_bits(rng: np.random.Generator) -> None:
    """Panels of a ring of an unduloid are one kind, its mirror image about the neck another place of it."""
    net = lamella.net(lamella.Unduloid(1.6, 2.8, (-2.5, 2.5)), cells=24)
    panels = make_panels(net, PanelRules(offset=0.1))
    inside = panels.laid[panels.owners] == INSIDE
    kinds = panels.kinds[inside]
    rings = np.unique(np.round(np.abs(panels.corners[panels.plates.offsets[:-1], 2])[inside], 6))
    assert (np.bincount(kinds)[np.unique(kinds)] % 24 == 0).all()
    assert len(np.unique(kinds)) <= len(rings)
    again = make_panels(turned(net, rng), PanelRules(offset=0.1))
    assert (again.kinds == panels.kinds).all()


def test_mirror_images_are_two_kinds() -> None:
    """A net without mirror symmetry of its panels: those left and right of Enneper's planes of symmetry."""
    panels = make_panels(lamella.net(SURFACES["enneper"], cells=12), PanelRules())
    inside = panels.laid[panels.owners] == INSIDE
    assert panels.quantities[panels.kinds[inside]].max() <= 8


def test_singular_nodes_are_corners() -> None:
    net = lamella.net(SURFACES["monkey"], cells=14)
    corners, conflicts = every_second_node(net)
    assert corners[net.node_kinds == SINGULAR].all()
    assert not len(conflicts)
    panels = make_panels(net, PanelRules())
    beside = panels.laid == UMBILIC
    assert beside.sum() == 6
    assert (panels.planned.sizes[beside] == 4).all()


def test_cylinders_through_four_corners(rng: np.random.Generator) -> None:
    """Corners on a cylinder, two of them on one generator: arcs and heights are their coordinates when laid flat."""
    q = 50
    radius = rng.uniform(0.5, 5.0, q)
    angle = np.stack([np.zeros(q), rng.uniform(0.1, 0.5, q), np.zeros(q), -rng.uniform(0.1, 0.5, q)], axis=1)
    # the generator is the shorter diagonal
    height = radius[:, None] * np.stack(
        [np.zeros(q), rng.uniform(0.02, 0.06, q), np.full(q, 0.1), rng.uniform(0.02, 0.06, q)], axis=1
    )
    corner = np.stack([radius[:, None] * np.sin(angle), height, radius[:, None] * (np.cos(angle) - 1)], axis=2)
    corner = corner @ Rotation.random(random_state=rng).as_matrix().T
    outlines, radii = on_cylinders(corner)
    assert radii == pytest.approx(radius, rel=1e-9)
    assert outlines[..., 0] == pytest.approx(radius[:, None] * angle, rel=1e-9)
    assert outlines[..., 1] == pytest.approx(height, abs=1e-12)


def test_sides_of_cold_bent_plates_keep_their_lengths(rng: np.random.Generator) -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    corner = square + rng.uniform(-0.15, 0.15, (40, 4, 3))
    flat = with_true_sides(corner)
    length = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
    assert np.linalg.norm(np.roll(flat, -1, axis=1) - flat, axis=2) == pytest.approx(length, rel=1e-12)
    shares = [
        np.linalg.norm(flat[:, k] - flat[:, k + 2], axis=1) / np.linalg.norm(corner[:, k] - corner[:, k + 2], axis=1)
        for k in (0, 1)
    ]
    assert shares[0] == pytest.approx(shares[1], rel=1e-9)
    assert (shares[0] >= 1 - 1e-12).all()


@pytest.mark.parametrize("along", [1, 2])
def test_runs_are_laid_flat_without_stretching(along: int) -> None:
    """Sides of all quads of a run, and what it is bent by: the curvature of the parallel or of the meridian."""
    net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=48)
    panels = make_panels(net, PanelRules(kind="single-curved", along=along, gap=0.0))
    runs = np.flatnonzero(panels.made == SINGLE_CURVED)
    corner = np.isin(panels.plates.owner, runs)
    assert sides(panels, panels.outlines)[corner] == pytest.approx(sides(panels, panels.corners)[corner], rel=1e-10)
    # principal curvatures +-1 / (c cosh^2 u), the largest at the neck; quads span twice the angle of their halves
    assert np.nanmin(panels.radii) == pytest.approx(2.5, rel=0.01)
    # around parallels, where the normal makes their curvature the positive one, or along as many meridians
    sizes = panels.plates.sizes[runs]
    assert (sizes == 2 * (48 + 1)).all() if along == 1 else len(runs) == 48


@pytest.mark.parametrize(("rule", "made"), [("single-curved", SINGLE_CURVED), ("cold-bent", COLD_BENT)])
def test_what_is_made_of_panels_that_are_not_flat(rule: str, made: int) -> None:
    """Quads beyond the limit are bent as asked; pentagons and, where asked, quads are divided into n - 2 triangles."""
    net = lamella.net(SURFACES["scherk"], cells=10)
    panels = make_panels(net, PanelRules(on="cells", above_limit=rule, gap=0.0))
    bent = panels.over & (panels.planned.sizes == 4)
    assert bent.any()
    assert (panels.made == np.where(bent[panels.owners], made, FLAT)).all()
    triangles = make_panels(net, PanelRules(on="cells", gap=0.0))
    assert (triangles.made == FLAT).all()
    count = np.where(triangles.over, triangles.planned.sizes - 2, 1)
    assert np.bincount(triangles.owners).tolist() == count.tolist()
    assert "panels_over_limit" in [note.key for note in triangles.warnings()]


def test_a_larger_model_has_the_same_panels() -> None:
    small, large = (
        make_panels(lamella.net(lamella.Scherk(1.2, 3.0 * by), cells=12), PanelRules(gap=0.01 * by, limit=0.003 * by))
        for by in (1, 1000)
    )
    assert small.ids == large.ids
    assert large.outlines == pytest.approx(1000 * small.outlines, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize(
    ("rules", "where"),
    [
        (PanelRules(offset=2.6), "offset"),
        (PanelRules(offset=-2.6), "offset"),
        (PanelRules(gap=3.0), "gap"),
    ],
)
def test_measures_that_leave_no_panels(rules: PanelRules, where: str) -> None:
    net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
    with pytest.raises(InputError) as refused:
        make_panels(net, rules)
    assert refused.value.where == where
    limit = float(refused.value.remedy.split("= ")[1].split()[0])
    made = make_panels(net, replace(rules, **{where: limit}))
    assert made.plates.offsets[-1] > 0


@pytest.mark.parametrize(
    ("measures", "where"),
    [({"gap": -0.1}, "gap"), ({"limit": float("nan")}, "limit"), ({"offset": float("inf")}, "offset")]
    + [({key: "other"}, key) for key in ("kind", "on", "along", "above_limit")],
)
def test_rules_that_are_none(measures: dict[str, object], where: str) -> None:
    with pytest.raises(InputError) as refused:
        PanelRules(**measures)  # type: ignore[arg-type]
    assert refused.value.where == where
    assert refused.value.remedy


def test_diagonals_of_cells_that_are_no_squares() -> None:
    project = {"surface": {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-2.0, 3.0]}}
    project |= {"network": {"cells": 24, "every": [2, 1]}, "panels": {}}
    with pytest.raises(InputError) as refused:
        lamella.compute(lamella.parse_project(project), until="panels")
    assert refused.value.where == "network"
