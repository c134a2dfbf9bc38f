"""Every constraint: its derivatives, its degree and the order of convergence.

1. Jacobians against central differences, which are exact on quadratic residuals. 2. The second-order Taylor expansion
f(x + d) = f + J d + d'H d / 2 holds exactly, however large d is, with H d the change of J. 3. A problem that can be
solved is solved with order two. 4. No constraint is left out here.
"""

from __future__ import annotations

import importlib
import itertools
import pkgutil

import numpy as np
import pytest

from conftest import KINDS, draw_places, draw_surface
from lamella import Catenoid, Unduloid
from lamella.projection import constraints as package
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.closeness import Closeness
from lamella.projection.constraints.conformal import Conformal
from lamella.projection.constraints.curved_star import CurvedStar
from lamella.projection.constraints.developable_strip import DevelopableStrip
from lamella.projection.constraints.edge_alignment import EdgeAlignment
from lamella.projection.constraints.edge_length import EdgeLength
from lamella.projection.constraints.equal_diagonals import EqualDiagonals
from lamella.projection.constraints.fairness import THIRD, Fairness
from lamella.projection.constraints.fixed import Fixed
from lamella.projection.constraints.gliding import Gliding
from lamella.projection.constraints.in_plane import InPlane
from lamella.projection.constraints.inverted_edge import InvertedEdge
from lamella.projection.constraints.leg_directions import LegDirections
from lamella.projection.constraints.node_angle import NodeAngle
from lamella.projection.constraints.planar_face import PlanarFace
from lamella.projection.constraints.right_angle import RightAngle
from lamella.projection.constraints.shared_length import SharedLength
from lamella.projection.constraints.spherical_star import SphericalStar
from lamella.projection.constraints.symmetry import mirrored, turned
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.constraints.upright import Upright
from lamella.projection.curve_feet import LineFeet, LoopFeet, SplineFeet
from lamella.projection.foot_points import MeshFeet, foot_surface
from lamella.projection.solve import LEAST_DAMPING, solve
from lamella.projection.unknowns import Block
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.arcs import circle
from surface.element.exact_elements import catenoid_map, whole_catenoid

EDGE = 0.7
ROUNDING = 1e-13
COUNT = 24


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def draw(name: str, rng: np.random.Generator) -> tuple[list[Block], list[Constraint]]:
    """Random blocks and a constraint on them that can be met, with those it leans on."""
    v = rng.normal(size=(COUNT, 3))
    index = rng.permutation(COUNT)
    stars = index[:20].reshape(4, 5)
    middles, legs = stars[:, 0], stars[:, 1:]
    points = Block("vertices", v, EDGE)
    normals = Block("normals", unit(rng.normal(size=(4, 3))))
    units = UnitLength(name="unit", block="normals", index=np.arange(4))
    pairs = index.reshape(-1, 2)
    surface = foot_surface(Unduloid(0.6, 1.4, (-3.0, 3.0)))
    if name == "PlanarFace":
        faces = PlanarFace(name=name, faces=legs, edge=EDGE, normals="normals")
        return [points, normals], [faces, units]
    if name == "UnitLength":
        return [Block("normals", rng.normal(size=(4, 3)))], [units]
    if name == "SharedLength":
        share = Block("share", rng.uniform(0.5, 2, 1))
        vectors = Block("normals", rng.normal(size=(4, 3)))
        return [vectors, share], [SharedLength(name=name, block="normals", length="share", index=np.arange(4))]
    if name in ("CurvedStar", "planar CurvedStar"):
        curvature = 0.0 if name.startswith("planar") else 0.8
        star = CurvedStar(name=name, centres=middles, neighbours=legs, curvature=curvature, edge=EDGE)
        return [points, normals], [star, units]
    if name in ("SphericalStar", "shared SphericalStar"):
        shared = name.startswith("shared")
        blocks = [
            points,
            Block("centres", rng.normal(size=(4, 3)), 2.0),
            Block("radii", np.full(1 if shared else 4, 2.0)),
        ]
        of = np.zeros(4, int) if shared else np.arange(4)
        kinds = {"middles": middles, "neighbours": legs, "radius_of": of}
        return blocks, [SphericalStar(name=name, size=2.0, edge=EDGE, **kinds)]
    if name == "InvertedEdge":
        d = v[pairs[:, 1]] - v[pairs[:, 0]]
        q = EDGE * d / (d * d).sum(1, keepdims=True) + 0.1 * rng.normal(size=d.shape)
        return [points, Block("inverse edges", q)], [InvertedEdge(name=name, edges=pairs, edge=EDGE)]
    if name == "RightAngle":
        return [points], [RightAngle(name=name, stars=legs, edge=EDGE)]
    if name == "NodeAngle":
        blocks = [points, Block("chords", rng.uniform(1, 2, (4, 2)), EDGE)]
        return blocks, [NodeAngle(name=name, stars=legs, angle=rng.uniform(40, 140), edge=EDGE)]
    if name == "EqualDiagonals":
        return [points], [EqualDiagonals(name=name, faces=legs, edge=EDGE)]
    if name == "LegDirections":
        blocks = [
            points,
            normals,
            Block("directions", unit(rng.normal(size=(16, 3)))),
            Block("reaches", rng.uniform(1, 2, (16, 2))),
        ]
        return blocks, [LegDirections(name=name, middles=middles, neighbours=legs, edge=EDGE), units]
    if name == "EdgeLength":
        return [points], [EdgeLength(name=name, edges=pairs, lengths=rng.uniform(0.5, 2, len(pairs)), edge=EDGE)]
    if name == "Conformal":
        circles = Block("circles", rng.uniform(0.3, 1, COUNT), EDGE)
        return [points, circles], [Conformal(name=name, edges=pairs, edge=EDGE)]
    if name == "Fairness":
        return [points], [Fairness(name=name, stencils=legs, coefficients=THIRD, edge=EDGE, hard=True)]
    if name == "DevelopableStrip":
        lower, upper = index[:12].reshape(4, 3), index[12:].reshape(4, 3)
        strip = DevelopableStrip(name=name, lower=lower, upper=upper, edge=EDGE, normals="normals")
        return [points, normals], [strip, units]
    near = surface.foot(v)
    close = Block("vertices", near.position + 0.1 * rng.normal(size=v.shape), EDGE)
    if name in ("Closeness", "Closeness at an offset"):
        offset = 0.0 if name == "Closeness" else 0.15
        return [close], [Closeness(name=name, index=index, surface=surface, edge=EDGE, offset=offset)]
    if name == "EdgeAlignment":
        return [close], [EdgeAlignment(name=name, edges=pairs, surface=surface, edge=EDGE)]
    if name == "Upright":
        return [close, Block("normals", unit(rng.normal(size=(4, 3))))], [
            Upright(name=name, edges=pairs[:4], surface=surface, normals="normals"),
            units,
        ]
    if name == "Fixed":
        return [points], [Fixed(name=name, index=index, points=rng.normal(size=v.shape), edge=EDGE)]
    if name == "Gliding":
        ring = make_loop("ring", circle(np.array([0.0, 0.0, 0.3]), 2.0, np.array([0.0, 0.6, 0.8])))
        start = Block("vertices", ring.at(rng.uniform(size=COUNT)) + 0.2 * rng.normal(size=v.shape), EDGE)
        return [start], [Gliding(name=name, index=index, curve=LoopFeet(ring), edge=EDGE)]
    if name == "InPlane":
        return [points], [InPlane(name=name, index=index, normal=unit(rng.normal(size=3)), distance=0.4, edge=EDGE)]
    if name == "mirrored":
        return [points], [mirrored(name, pairs, unit(rng.normal(size=3)), 0.4, EDGE)]
    assert name == "turned"
    return [points], [turned(name, pairs, rng.normal(size=3), rng.normal(size=3), 5, EDGE)]


NAMES = [
    *(
        "PlanarFace",
        "UnitLength",
        "SharedLength",
        "CurvedStar",
        "planar CurvedStar",
        "SphericalStar",
        "shared SphericalStar",
    ),
    *(
        "InvertedEdge",
        "RightAngle",
        "NodeAngle",
        "EqualDiagonals",
        "LegDirections",
        "EdgeLength",
        "Conformal",
        "Fairness",
    ),
    *(
        "Fairness",
        "DevelopableStrip",
        "Closeness",
        "Closeness at an offset",
        "EdgeAlignment",
        "Upright",
        "Fixed",
        "Gliding",
    ),
    *("InPlane", "mirrored", "turned"),
]


def prepared(name: str, seed: int) -> tuple[Constraint, list[np.ndarray]]:
    """A constraint with its foot points, and its arguments."""
    blocks, found = draw(name, np.random.default_rng(seed))
    values = {block.name: block.values.reshape(len(block.values), -1) for block in blocks}
    constraint = found[0].refreshed(values)
    arguments = []
    for slot in constraint.slots():
        whole = values[slot.block][slot.index]
        rows = np.arange(len(whole))
        arguments.append(whole if slot.component is None else whole[rows, slot.component][:, None])
    return constraint, arguments


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", NAMES)
def test_jacobian_is_that_of_central_differences(name: str, seed: int) -> None:
    constraint, arguments = prepared(name, seed)
    step = 1e-2
    for number, jacobian in enumerate(constraint.jacobian(*arguments)):
        for component in range(arguments[number].shape[1]):
            ends = []
            for sign in (1, -1):
                moved = [a.copy() for a in arguments]
                moved[number][:, component] += sign * step
                ends.append(constraint.residual(*moved))
            slope = (ends[0] - ends[1]) / (2 * step)
            assert jacobian[..., component] == pytest.approx(slope, abs=1e-11), (number, component)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("name", NAMES)
def test_taylor_expansion_of_second_order_is_exact(name: str, size: float) -> None:
    constraint, arguments = prepared(name, 7)
    rng = np.random.default_rng(1)
    steps = [size * rng.normal(size=a.shape) for a in arguments]
    moved = [a + d for a, d in zip(arguments, steps, strict=True)]
    here, there = constraint.jacobian(*arguments), constraint.jacobian(*moved)
    change = np.zeros(constraint.residual(*arguments).shape)
    for a, b, d in zip(here, there, steps, strict=True):
        change = change + np.einsum("mpk,mk->mp", a + (b - a) / 2, d)
        if constraint.linear:
            assert np.array_equal(a, b)
    expected = constraint.residual(*arguments) + change
    assert constraint.residual(*moved) == pytest.approx(expected, rel=1e-12, abs=1e-12 * max(1, size**2))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", NAMES)
def test_a_problem_that_can_be_solved_is_solved_with_order_two(name: str, seed: int) -> None:
    blocks, found = draw(name, np.random.default_rng(seed))
    solution = solve(blocks, found, damping=LEAST_DAMPING, tolerance=ROUNDING, iterations=80)
    assert solution.solved, solution
    errors = [max(i.residual.values()) for i in solution.iterations]
    if found[0].linear:
        assert len(errors) <= 3
        return
    steps = zip(itertools.pairwise(errors), solution.iterations, strict=False)
    near = [(a, b, iteration.damping) for (a, b), iteration in steps if a < 0.1]
    assert near
    # b <= C a^2, but for what damping leaves (lambda a) and rounding
    for a, b, damping in near:
        assert b <= 10 * a**2 + 10 * damping * a + ROUNDING, errors


def test_every_constraint_is_tested_here() -> None:
    for module in pkgutil.iter_modules(package.__path__):
        importlib.import_module(f"{package.__name__}.{module.name}")

    def below(kind: type) -> set[type]:
        return {kind}.union(*(below(sub) for sub in kind.__subclasses__()))

    mine = {kind for kind in below(Constraint) if kind.__module__.startswith(package.__name__)}
    tested = {type(constraint) for name in NAMES for constraint in draw(name, np.random.default_rng(0))[1]}
    assert mine == tested


class TestFormulas:
    """Values that the formulas promise, in natural units."""

    def test_a_star_on_a_sphere_has_no_residual_and_in_the_plane_neither(self) -> None:
        rng = np.random.default_rng(3)
        for curvature in (0.0, 1e-12, 0.5, -2.0):
            n = unit(rng.normal(size=(1, 3)))
            basis = np.linalg.svd(n)[2][1:]
            legs = rng.normal(size=(6, 2)) * 0.1 @ basis
            # heights of a sphere of that curvature over its tangent plane
            square = (legs**2).sum(1)
            height = curvature * square / (1 + np.sqrt(1 - curvature**2 * square))
            v = np.vstack([np.zeros(3), legs + height[:, None] * n])
            star = CurvedStar(
                name="star", centres=np.array([0]), neighbours=np.arange(1, 7)[None], curvature=curvature, edge=0.1
            )
            found = star.residual(np.repeat(n, 6, 0), np.repeat(v[:1], 6, 0), v[1:])
            assert np.abs(found).max() < 1e-14

    def test_residual_of_a_star_is_the_distance_from_the_sphere_in_edges(self) -> None:
        """To first order: a neighbour moved by s along the radius is off by s / e, in both forms."""
        r, e, s = 2.0, 0.1, 1e-6
        n, v0 = np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 3))
        angle = e / r
        on = np.array([[r * np.sin(angle), 0.0, r - r * np.cos(angle)]])
        out = unit(on - [[0, 0, r]])
        star = CurvedStar(name="star", centres=np.array([0]), neighbours=np.array([[1]]), curvature=1 / r, edge=e)
        assert star.residual(n, v0, on + s * out) == pytest.approx(-s / e, rel=1e-4)
        kinds = {"middles": np.array([0]), "neighbours": np.array([[1]]), "radius_of": np.array([0])}
        sphere = SphericalStar(name="star", size=r, edge=e, **kinds)
        assert sphere.residual(on + s * out, np.array([[0, 0, r]]), np.array([[r]])) == pytest.approx(s / e, rel=1e-4)

    @pytest.mark.parametrize("opening", [90.0, 70.0, 120.0])
    def test_sums_of_opposite_angles(self, opening: float) -> None:
        """Paper, Figure 5: legs at angles with w1 + w3 = 2 w are met by `NodeAngle` w on the legs' directions."""
        rng = np.random.default_rng(4)
        for _ in range(5):
            a1, a3 = rng.uniform(-0.3, 0.3), np.pi + rng.uniform(-0.3, 0.3)
            a2 = np.radians(opening) + rng.uniform(-0.2, 0.2)
            a4 = 2 * np.radians(opening) + a1 + a3 - a2
            w1, w3 = a2 - a1, a4 - a3
            assert w1 + w3 == pytest.approx(2 * np.radians(opening))
            p = [np.array([[np.cos(a), np.sin(a), 0.0]]) for a in (a1, a2, a3, a4)]
            chords = np.array([[np.linalg.norm(p[0] - p[2]), np.linalg.norm(p[1] - p[3])]])
            angle = NodeAngle(name="angle", stars=np.arange(4)[None], angle=opening, edge=0.5, block="directions")
            assert np.abs(angle.residual(*p, chords)).max() < 1e-14
            right = RightAngle(name="angle", stars=np.arange(4)[None], edge=0.5, block="directions")
            assert right.residual(*p)[0, 0] == pytest.approx(np.cos(np.radians(opening)) * chords.prod(), abs=1e-14)

    def test_equal_diagonals_are_perpendicular_middle_lines(self) -> None:
        v = np.random.default_rng(5).normal(size=(4, 1, 3))
        first, second = (v[1] + v[2] - v[0] - v[3]) / 2, (v[2] + v[3] - v[0] - v[1]) / 2
        found = EqualDiagonals(name="faces", faces=np.arange(4)[None], edge=1.0).residual(*v)
        assert found[0, 0] == pytest.approx((first * second).sum(), abs=1e-14)

    def test_closeness_holds_the_height_of_a_strip(self) -> None:
        """The upper border of a strip of constant width lies on the parallel surface, normals of both are the same."""
        surface = Unduloid(0.6, 1.4, (-3.0, 3.0))
        where = np.random.default_rng(6).uniform(-1, 1, 20) + 1j * np.linspace(0, 3, 20)
        at = surface.at(where)
        upper = at.position + 0.12 * at.normal
        close = Closeness(name="upper", index=np.arange(20), surface=foot_surface(surface), edge=1.0, offset=0.12)
        assert np.abs(close.refreshed({"vertices": upper}).residual(upper)).max() < 1e-12


class TestFeet:
    """Foot points: the way from foot to point is perpendicular, to rounding."""

    def test_open_curves(self) -> None:
        t = np.linspace(0, 2, 9)
        helix = np.column_stack([np.cos(t), np.sin(t), 0.3 * t])
        above = helix + np.array([0, 0, 5])
        points = np.random.default_rng(0).normal(size=(14, 3)) * 0.1 + np.vstack([helix[2:9], above[:7]])
        feet = SplineFeet([helix, above], [7, 7])
        foot, tangent = feet.foot(points)
        assert np.abs(((points - foot) * tangent).sum(1)).max() < 1e-12
        assert np.linalg.norm(points - foot, axis=1).max() < 0.5

    def test_line(self) -> None:
        points = np.random.default_rng(1).normal(size=(9, 3))
        foot, tangent = LineFeet(np.array([1.0, 2, 3]), np.array([0.0, 3, 4])).foot(points)
        assert np.abs(((points - foot) * tangent).sum(1)).max() < 1e-13
        assert np.cross(foot - [1, 2, 3], [0, 0.6, 0.8]) == pytest.approx(0, abs=1e-13)

    @pytest.mark.parametrize("kind", KINDS)
    def test_closed_forms(self, kind: str) -> None:
        """Points at a known distance along the normal have known foot points."""
        rng = np.random.default_rng(2)
        surface = draw_surface(kind, rng)
        at = surface.at(draw_places(surface, rng, 30))
        bend = np.maximum(*np.abs(at.principal_curvatures))
        points = at.position + (0.2 / bend * rng.uniform(-1, 1, len(bend)))[:, None] * at.normal
        foot = foot_surface(surface).foot(points)
        size = np.ptp(at.position, axis=0).max()
        near = np.linalg.norm(foot.position - points, axis=1) <= np.linalg.norm(at.position - points, axis=1) + 1e-9
        assert near.all()
        assert np.abs(np.cross(points - foot.position, foot.normal)).max() < 1e-9 * size

    def test_curved_elements(self) -> None:
        """Elements on a catenoid find what the closed form finds, to their own error."""
        exact, elements = foot_surface(Catenoid(1.0, (-3.0, 3.0))), foot_surface(whole_catenoid(4))
        rng = np.random.default_rng(4)
        v, u = rng.uniform(-0.5, 0.5, 40), rng.uniform(0, 6, 40)
        points = catenoid_map(np.column_stack([u, v])) * (1 + 0.05 * rng.uniform(-1, 1, 40))[:, None]
        foot, found = exact.foot(points), elements.foot(points)
        assert found.position == pytest.approx(foot.position, abs=1e-4)
        # elements have their normal outwards
        assert found.normal == pytest.approx(-foot.normal, abs=1e-2)
        for one, other in zip(
            exact.principal_directions(points), elements.principal_directions(points)[::-1], strict=True
        ):
            assert np.abs((one * other).sum(1)).min() > 0.999

    def test_triangle_mesh(self) -> None:
        """Foot points and normals come from the surface, up to the mesh."""
        surface = Unduloid(0.6, 1.4, (-2.0, 2.0))
        errors = []
        for tolerance in (1e-3, 2.5e-4):
            mesh = surface.mesh(tolerance)
            triangles = np.concatenate([mesh.faces[:, [0, 1, 2]], mesh.faces[:, [0, 2, 3]]])
            at = surface.at(np.random.default_rng(3).uniform(-0.5, 0.5, 50) + 1j * np.linspace(0, 6, 50))
            foot = MeshFeet(mesh.points, triangles).foot(at.position + 0.05 * at.normal)
            errors.append(np.abs(foot.position - at.position).max())
            assert (foot.normal * at.normal).sum(1).min() > 0.999
        # a foot shifts by the distance times the facets' angle: first order in their size, which goes with sag^(1/2)
        assert errors[0] / errors[1] == pytest.approx(2, rel=0.2)
        assert errors[1] < 2e-3
