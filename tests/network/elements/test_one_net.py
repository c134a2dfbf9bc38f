"""One surface, one net: turned, mirrored, moved, scaled or on other elements it has the same nodes and the same ids.

H and the shape operator go with a motion of space, and so do isothermic coordinates, up to sign and a constant (DESIGN
section 2); a reflection exchanges the families, since it changes the sign of geodesic torsion. What a net adds to them,
its origin, its numbers and what it does on the rim, has to go with them too.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import Catenoid, Cylinder, Enneper, Helicoid, Scherk
from lamella.network.density_request import DensityRequest
from lamella.network.elements.element_network import element_network, plan_net
from lamella.network.elements.lattice import choose_lattice
from lamella.network.network import BOUNDARY, REGULAR, SEAM, SINGULAR, Network
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film

TAU = 2 * np.pi
# of the size: twice the error of surfaces on coarse elements; of ends of lamellas on a seam
ACCURACY, SEAM_ACCURACY = 5e-4, 5e-3
COARSE = 2e-2
TURN = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))
FAR = np.array([1e4, -2e3, 50.0])


class Case(NamedTuple):
    """Points of the loops, whether these are beams between them, H in 1/m, and cells."""

    loops: tuple[np.ndarray, ...]
    beams: bool
    mean_curvature: float
    cells: int


class Motion(NamedTuple):
    """Of points, back again, by what lengths grow, and whether it is a reflection."""

    there: Callable[[np.ndarray], np.ndarray]
    back: Callable[[np.ndarray], np.ndarray]
    scale: float = 1.0
    mirrored: bool = False


MOTIONS = {
    "turned": Motion(lambda x: x @ TURN.T, lambda x: x @ TURN),
    "mirrored": Motion(lambda x: x * [-1, 1, 1], lambda x: x * [-1, 1, 1], mirrored=True),
    "10 km away": Motion(lambda x: x + FAR, lambda x: x - FAR),
    "in millimetres": Motion(lambda x: 1e3 * x, lambda x: x / 1e3, 1e3),
    "a thousandth": Motion(lambda x: x / 1e3, lambda x: 1e3 * x, 1e-3),
}


def film(case: Case, tolerance: float = COARSE, motion: Motion | None = None) -> ElementSurface:
    move = motion or Motion(lambda x: x, lambda x: x)
    curves = [lines(move.there(p), closed=True) if case.beams else closed_spline(move.there(p)) for p in case.loops]
    loops = tuple(make_loop(f"loop {k}", curve) for k, curve in enumerate(curves))
    h = case.mean_curvature / move.scale * (-1 if move.mirrored else 1)
    return find_film(loops, h, tolerance=tolerance).surface("form-found")


def size_of(network: Network) -> float:
    return float(np.linalg.norm(np.ptp(network.node_points, axis=0)))


def off(one: np.ndarray, other: np.ndarray) -> float:
    """Largest distance of a point (n, 3) from the nearest of others."""
    return float(cKDTree(other).query(one)[0].max(initial=0.0))


def same(one: Network, other: Network, motion: Motion | None = None) -> float:
    """Distance of the nodes lamella by lamella over the size, where nets are alike in numbers and ids."""
    move = motion or Motion(lambda x: x, lambda x: x)
    exchanged = {"A": "B", "B": "A"} if move.mirrored else {"A": "A", "B": "B"}
    assert np.bincount(one.node_kinds, minlength=4).tolist() == np.bincount(other.node_kinds, minlength=4).tolist()
    assert len(one.face_offsets) == len(other.face_offsets)
    names = [exchanged[name[0]] + name[1:] for name in other.ids]
    assert sorted(one.ids) == sorted(names)
    points, worst = move.back(other.node_points), 0.0
    for k, name in enumerate(one.ids):
        j = names.index(name)
        mine = one.stop_nodes[one.stop_offsets[k] : one.stop_offsets[k + 1]]
        theirs = other.stop_nodes[other.stop_offsets[j] : other.stop_offsets[j + 1]]
        assert len(mine) == len(theirs), name
        apart = np.linalg.norm(one.node_points[mine] - points[theirs], axis=1) / size_of(one)
        # a lamella that meets a seam at a small angle ends far along it for a small shift
        apart[one.node_kinds[mine] == SEAM] *= ACCURACY / SEAM_ACCURACY
        worst = max(worst, float(apart.max()))
    return worst


def on_a_margin(one: Network, other: Network) -> bool:
    """Whether nets differ by one end of a lamella, about as near the next one as ends are one node.

    `lamella.network.elements.rim_ends` takes crossings within 0.005 cells of the rim for one node; coarse elements are
    off by a fifth of that. A crossing there with an end on the rim is one node or two, with two ends one or three.
    """
    near = min(float(net.cell_edges.min() / np.median(net.cell_edges)) for net in (one, other))
    return (
        abs(len(one.node_points) - len(other.node_points)) in (1, 2) and len(one.ids) == len(other.ids) and near < 0.02
    )


def waving(seed: int, count: int = 20) -> np.ndarray:
    """A closed waving curve of about 6 m radius."""
    rng = np.random.default_rng(seed)
    k, t = np.arange(2, 5), TAU * np.arange(count) / count
    wave, lift = (rng.normal(size=(2, 3)) * share / k for share in (0.1, 0.3))
    harmonics = np.stack([np.cos(np.outer(t, k)), np.sin(np.outer(t, k))])
    reach, height = 1 + np.einsum("ctk,ck->t", harmonics, wave), np.einsum("ctk,ck->t", harmonics, lift)
    # a saddle
    height = height + 0.25 * np.cos(2 * t + rng.uniform(0, TAU))
    return 6 * np.column_stack([reach * np.cos(t), 0.85 * reach * np.sin(t), height])


def rings() -> tuple[np.ndarray, ...]:
    """Two round curves over each other, mirror images of themselves in y = 0: no umbilics, one period that is whole."""
    t = TAU * np.arange(16) / 16
    return (
        np.column_stack([2.4 * np.cos(t), 2.4 * np.sin(t), 0 * t]),
        np.column_stack([1.9 * np.cos(t) + 0.2, 1.9 * np.sin(t), 1.4 + 0.2 * np.cos(t)]),
    )


def lobes() -> np.ndarray:
    """A rim that rises and falls three times, unevenly: its film has one umbilic of order 1, off the middle."""
    t = TAU * np.arange(20) / 20
    reach, height = 1 + 0.05 * np.cos(2 * t + 1), 1.5 * np.cos(3 * t + 0.4) + 0.4 * np.cos(2 * t)
    return np.column_stack([5 * reach * np.cos(t), 4.4 * np.sin(t), height])


def skew_ring() -> tuple[np.ndarray, ...]:
    """A round hole off the middle of a rim that rises and falls: its umbilics are not whole cells apart."""
    t = TAU * np.arange(20) / 20
    outer = np.column_stack([6 * np.cos(t), 4.6 * np.sin(t), 1.4 * np.cos(2 * t + 0.3) + 0.3 * np.cos(3 * t)])
    return outer, np.column_stack([0.5 + 1.3 * np.cos(t), 1.2 * np.sin(t) - 0.2, 0.2 + 0.1 * np.cos(2 * t)])


def box_path(width: float, depth: float, height: float) -> np.ndarray:
    """Six edges of a box, each at right angles to the next, around two opposite corners of it."""
    steps = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]])
    return np.cumsum(steps, 0) * [width, depth, height] - np.array([width, 0, 0])


CASES = {
    "four beams": Case((np.array([[0, 0, 0], [4, -0.3, 1.9], [3.6, 3.1, 0.2], [0.3, 3.4, 2.2]]),), True, 0.0, 13),
    "waving": Case((waving(3),), False, 0.0, 12),
    "two rings": Case(rings(), False, 0.0, 14),
    "six beams": Case((box_path(3.0, 3.0, 3.0),), True, 0.0, 12),
    "three lobes": Case((lobes(),), False, 0.02, 13),
    "skew ring": Case(skew_ring(), False, 0.0, 11),
}


@cache
def woven(name: str) -> tuple[ElementSurface, Network]:
    case = CASES[name]
    surface = film(case)
    return surface, element_network(surface, cells=case.cells).network


MOVED = [("four beams", name) for name in MOTIONS] + [
    ("waving", "turned"),
    ("waving", "mirrored"),
    ("two rings", "mirrored"),
    ("six beams", "turned"),
    ("three lobes", "turned"),
    ("three lobes", "mirrored"),
    ("skew ring", "turned"),
    ("skew ring", "mirrored"),
]


def test_the_skew_ring_has_seams() -> None:
    _, network = woven("skew ring")
    assert (network.node_kinds == SEAM).sum() >= 8


@pytest.mark.parametrize(("case", "motion"), MOVED)
@pytest.mark.few(6)
def test_a_moved_surface_has_the_moved_net(case: str, motion: str) -> None:
    """A film found in a turned, mirrored, moved or scaled boundary has the net moved alike, lamella by lamella."""
    _, network = woven(case)
    move = MOTIONS[motion]
    there = element_network(film(CASES[case], motion=move), cells=CASES[case].cells).network
    assert same(network, there, move) < ACCURACY


@pytest.mark.parametrize(
    "case",
    [
        "four beams",
        "waving",
        "two rings",
        "three lobes",
        "skew ring",
        pytest.param("six beams", marks=pytest.mark.slow),
    ],
)
@pytest.mark.few(2)
def test_finer_elements_have_the_same_net(case: str) -> None:
    """The same nodes and ids on elements found to a tenth of the tolerance."""
    _, network = woven(case)
    finer = film(CASES[case], 5e-4 if case == "six beams" else 2e-3)
    assert finer.connectivity.node_count > woven(case)[0].connectivity.node_count
    assert same(network, element_network(finer, cells=CASES[case].cells).network) < ACCURACY


@pytest.mark.parametrize("case", CASES)
def test_doubled_cells_contain_the_single_ones(case: str) -> None:
    surface, network = woven(case)
    double = element_network(surface, cells=2 * CASES[case].cells).network
    crossings = network.node_points[np.isin(network.node_kinds, (REGULAR, SINGULAR))]
    assert len(double.node_points) > 2 * len(network.node_points)
    assert off(crossings, double.node_points) < 1e-9 * size_of(network)


@pytest.mark.parametrize("cells", [8, 9, 11, 14])
@pytest.mark.parametrize(
    "form",
    [
        Catenoid(1.0, (-0.8, 1.1)),
        Cylinder(2.0, (0.0, 3.1)),
        Helicoid(5.0, 0.3, 2.0, 0.8),
        Helicoid(4.0, 0.5, 1.4, 1.7),
        Enneper(2, 0.9, 1.0),
        Enneper(3, 0.9, 1.0),
        Scherk(1.0, 1.2),
    ],
    ids=lambda form: form.kind,
)
@pytest.mark.parametrize("kind", ["lamellas", "principal"])
def test_doubled_cells_of_closed_forms_contain_the_single_ones(form, cells: int, kind) -> None:
    network, double = (lamella.net(form, cells=n, kind=kind, minimum_length=0.0) for n in (cells, 2 * cells))
    crossings = network.node_points[np.isin(network.node_kinds, (REGULAR, SINGULAR))]
    assert off(crossings, double.node_points) < 1e-9 * size_of(network)


@pytest.mark.parametrize("cells", [8, 12, 16])
def test_lines_of_the_lattice_on_straight_beams_are_the_beams(cells: int) -> None:
    """Straight lines of a surface are asymptotic: these six are whole cells from the flat point in the middle.

    The surface comes onto itself by a third of a turn about the diagonal of the box (Schwarz reflection).
    """
    surface, _ = woven("six beams")
    network = element_network(surface, cells=cells).network
    beams = CASES["six beams"].loops[0]
    ends = np.stack([beams, np.roll(beams, -1, 0)], 1)
    on_beam = []
    edges = np.diff(network.stop_arclengths)
    median = np.median(edges[edges > 0])
    for begin, end in ends:
        along = (end - begin) / np.linalg.norm(end - begin)
        out = network.node_points - begin
        apart = np.linalg.norm(out - (out @ along)[:, None] * along, axis=1)
        on_beam.append(int(((apart < 1e-3 * median) & (network.node_kinds == BOUNDARY)).sum()))
        # no crossing next to a beam
        assert apart[network.node_kinds == REGULAR].min() > 0.3 * median
    assert len(set(on_beam)) == 1, on_beam
    # one end for each cell along the beam, but for its corners
    assert on_beam[0] == cells - 1
    assert network.left_out == 0
    assert edges[edges > 0].min() > 0.3 * median
    middle = beams.mean(0)
    axis = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)
    cross = np.cross(np.eye(3), axis)
    third = np.eye(3) * np.cos(TAU / 3) + cross * np.sin(TAU / 3) + np.outer(axis, axis) * (1 - np.cos(TAU / 3))
    flipped = [(network.node_points - middle) @ m + middle for m in (third, -np.eye(3))]
    assert min(off(points, network.node_points) for points in flipped) < 1e-4 * size_of(network)


def test_a_symmetric_surface_has_a_symmetric_net() -> None:
    """A saddle over an ellipse, its own image in x = 0 and y = 0; crossings lie on the rim at both ends of its axis."""
    t = TAU * np.arange(24) / 24
    case = Case((np.column_stack([5 * np.cos(t), 4 * np.sin(t), 0.9 * np.cos(2 * t)]),), False, 0.0, 14)
    network = element_network(film(case), cells=case.cells).network
    for mirror in ([-1, 1, 1], [1, -1, 1]):
        assert off(network.node_points * mirror, network.node_points) < 1e-4 * size_of(network)
    assert np.hypot(*network.node_points[:, :2].T).min() < 1e-4 * size_of(network)
    # one node where two lamellas meet on the rim
    tip = int(network.node_points[:, 0].argmax())
    a, b = network.node_degrees()
    assert network.node_kinds[tip] == BOUNDARY
    assert (a[tip], b[tip]) == (1, 1)
    assert cKDTree(network.node_points).query(network.node_points, k=2)[0][:, 1].min() > 5e-3 * size_of(network)


def test_lamellas_of_the_family_that_closes_go_on_over_the_seam() -> None:
    """Around the hole of skew rings one family is whole cells apart and the other one is not: it alone ends there."""
    t = TAU * np.arange(16) / 16
    outer = np.column_stack([2.4 * np.cos(t) * (1 + 0.05 * np.cos(t)), 2.4 * np.sin(t), 0.25 * np.cos(2 * t + 0.5)])
    inner = np.column_stack([1.9 * np.cos(t) + 0.2, 1.9 * np.sin(t), 1.4 + 0.3 * np.cos(t)])
    net = element_network(film(Case((outer, inner), False, 0.0, 14)), cells=14)
    network = net.network
    assert [joint.closed for joint in net.joints] == [False]
    crossed = np.array(network.periods[0][1:])
    assert np.abs(crossed - np.round(crossed)).max() > 0.01
    ends = np.isin(network.stop_nodes, np.flatnonzero(network.node_kinds == SEAM))
    assert len(set(network.families[network.stop_owner[ends]].tolist())) <= 1
    assert cKDTree(network.node_points).query(network.node_points, k=2)[0][:, 1].min() > 1e-4 * size_of(network)


def test_of_umbilics_alike_the_first_one_goes_with_the_surface() -> None:
    """Two flat points at the same distance from the rim (DESIGN section 4's annulus): nets hang in the first one."""
    t = TAU * np.arange(24) / 24
    outer = np.column_stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)])
    case = Case((outer, np.column_stack([1.3 * np.cos(t), 1.3 * np.sin(t), 2 + 0 * t])), False, 0.0, 12)
    umbilics = film(case).umbilics
    assert umbilics.orders.tolist() == [1, 1]
    turned = MOTIONS["turned"]
    there = turned.back(film(case, motion=turned).umbilics.position)
    assert np.linalg.norm(there - umbilics.position, axis=1).max() < 0.1


def drawn(seed: int) -> Case:
    """Quadrilaterals and hexagons of beams, rings, waving discs with pressure or without, and with a hole."""
    rng = np.random.default_rng(seed)
    kind, cells = seed % 5, int(rng.integers(8, 25))
    if kind == 0:
        corners = np.array([[0, 0, 0], [3, 0, 1.3], [3, 3, 0], [0, 3, 1.3]]) + rng.uniform(-0.5, 0.5, (4, 3))
        return Case((corners,), True, 0.0, cells)
    if kind == 1:
        return Case((box_path(*rng.uniform(2.0, 5.0, 3)),), True, 0.0, cells)
    if kind == 2:
        outer, inner = rings()
        low, high = (1 + 0.15 * rng.uniform(size=(2, 1))) * [1.0, 0.9, 1.0]
        return Case((outer * low, inner * high), False, float(rng.uniform(-0.05, 0.05)), cells)
    if kind == 3:
        return Case((waving(seed),), False, float(rng.choice([0.0, 0.02, -0.03])), cells)
    t = TAU * np.arange(12) / 12
    hole = np.column_stack([1.2 * np.cos(t), 1.1 * np.sin(t), 0.1 * np.cos(2 * t)]) + rng.uniform(-0.6, 0.6, 3)
    return Case((waving(seed), hole), False, 0.0, cells)


@pytest.mark.slow
def test_nets_of_random_surfaces_go_with_them() -> None:
    """One and the same net, also where it does not meet itself: its seam is a straight line of the plane of w."""
    alike, seams, ties = 0, 0, 0
    for seed in range(15):
        case = drawn(seed)
        surface = film(case)
        network = element_network(surface, cells=case.cells).network
        double = element_network(surface, cells=2 * case.cells).network
        crossings = network.node_points[np.isin(network.node_kinds, (REGULAR, SINGULAR))]
        seams += bool((network.node_kinds == SEAM).any())
        assert off(crossings, double.node_points) < 1e-9 * size_of(network), seed
        nets = [(element_network(film(case, 2e-3), cells=case.cells).network, None)]
        nets += [
            (element_network(film(case, motion=move), cells=case.cells).network, move) for move in MOTIONS.values()
        ]
        if any(on_a_margin(network, net) for net, _ in nets):
            ties += 1
            continue
        worst = max(same(network, net, move) for net, move in nets)
        print(seed, len(network.node_points), f"{worst:.1e}")
        assert worst < ACCURACY, seed
        alike += 1
    print(f"{alike} alike, {seams} with seams, {ties} with an end on a margin")
    assert alike + ties == 15
    assert seams >= 3
    assert ties <= 2


@pytest.mark.slow
def test_density_between_several_odd_umbilics_goes_with_the_surface() -> None:
    """w has no one value there: cells are counted on the area in its plane, which no cut and no element changes."""
    t = TAU * np.arange(18) / 18
    height = 0.45 * np.cos(5 * t) + 0.25 * np.cos(2 * t + 0.5) + 0.12 * np.sin(3 * t)
    rim = np.column_stack([4 * np.cos(t) + 0.2 * np.cos(2 * t), 3 * np.sin(t), height])
    chosen = []
    for name in (None, "turned", "mirrored", "in millimetres"):
        move = MOTIONS[name] if name else None
        scale = move.scale if move else 1.0
        laid = plan_net(film(Case((rim,), False, 0.05, 12), motion=move), cells=12)
        assert laid.umbilics.orders.tolist() == [1, 1, 1]
        pick = partial(choose_lattice, laid.iso, laid.around, seams=False)
        requests = [DensityRequest.of(spacing=d * scale) for d in (0.3, 0.4, 0.5, 0.62, 0.8)]
        lattices = [pick(request) for request in (*requests, *map(DensityRequest.of, (9, 12, 16)))]
        steps = np.array([one.step for one in lattices]) / np.sqrt(scale)
        chosen.append((steps, [(one.cells, one.better_closes) for one in lattices]))
        # all that are asked for are met, within what closing may move them
        assert np.array([one.edge for one in lattices[:5]]) / scale == pytest.approx(
            [0.3, 0.4, 0.5, 0.62, 0.8], rel=0.15
        )
    for steps, rest in chosen[1:]:
        assert rest == chosen[0][1]
        assert steps == pytest.approx(chosen[0][0], rel=1e-4)
