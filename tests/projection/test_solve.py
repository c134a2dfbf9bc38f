"""The solver: verdicts, line search, records, what is refused, and that nothing is worked out twice.

1. Exact line search: the length it gives is the least of the sum of squares, found by trying. 2. Normal equations equal
dense ones. 3. Verdicts of problems that can be solved, ask too much, or stall. 4. Records. 5. Both back ends agree, the
pattern is analysed once. 6. Bad input.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from lamella import Catenoid
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.edge_length import EdgeLength
from lamella.projection.constraints.fairness import SECOND, Fairness
from lamella.projection.constraints.fixed import Fixed
from lamella.projection.constraints.planar_face import PlanarFace
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.determination import uncertainty
from lamella.projection.line_search import best_length
from lamella.projection.normal_equations import NormalEquations
from lamella.projection.problems.asymptotic import asymptotic
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block, Layout, Slot
from projection.nets import lamella_patch, noisy
from refusals import refused

EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])


def square(seed: int = 0) -> Block:
    """A unit square, a little off."""
    exact = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    return Block("vertices", exact + 0.1 * np.random.default_rng(seed).normal(size=(4, 3)), 1.0)


def lengths(values: float = 1.0, **options) -> EdgeLength:
    return EdgeLength(name="lengths", edges=EDGES, lengths=np.full(4, values), edge=1.0, **options)


@dataclass(frozen=True, kw_only=True)
class Equal(Constraint):
    """All points equal one number."""

    linear: ClassVar[bool] = True
    count: int

    def slots(self):
        return Slot("vertices", np.arange(self.count)), Slot("mean", np.zeros(self.count, int))

    def residual(self, *arguments):
        return arguments[0] - arguments[1]

    def jacobian(self, *arguments):
        one = np.ones((self.count, 1, 1))
        return one, -one


class TestLineSearch:
    @pytest.mark.parametrize("seed", range(10))
    def test_least_sum_of_squares_along_the_line(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        f, change, q = rng.normal(size=(3, 2, 5))
        change *= -np.sign((f * change).sum())  # downhill
        weights = [0.7, 0.0]
        t = best_length([f, 9 * f], [change, change], [f + change + q, q], weights)
        tried = np.linspace(0, 2, 4001)[1:]
        values = [((f + s * change + s * s * q) ** 2).sum() for s in tried]
        least = ((f + t * change + t * t * q) ** 2).sum()
        decrease = (f**2).sum() - min(values)
        assert least <= min(values) + 0.01 * decrease + 1e-6

    def test_full_step_on_linear_residuals(self) -> None:
        f = np.array([[1.0, -2.0]])
        assert best_length([f], [-f], [0 * f], [1.0]) == 1.0


def weighted(residuals, weights) -> np.ndarray:
    return np.concatenate([w * f.ravel() for w, f in zip(weights, residuals, strict=True)])


def test_normal_equations_are_dense_ones() -> None:
    rng = np.random.default_rng(1)
    blocks = [square(), Block("normals", rng.normal(size=(1, 3)))]
    faces = PlanarFace(name="face", faces=np.arange(4)[None], edge=0.5, normals="normals")
    fair = Fairness(name="fair", stencils=np.array([[0, 1, 2], [1, 2, 3]]), coefficients=SECOND, edge=0.5)
    held = [faces, UnitLength(name="unit", block="normals", index=np.array([0])), fair]
    layout, vector = Layout.of(blocks)
    equations = NormalEquations.of(layout, held)
    weights = [1.0, 2.0, 0.3]
    for _ in range(2):  # linear constraints come from memory the second time
        linearised = equations.linearise(held, vector)
        entries, right = equations.assemble(held, linearised, weights)
        step, rows = 1e-3, []
        for i in range(layout.size):
            d = np.zeros(layout.size)
            d[i] = step
            ends = [equations.residuals(held, vector + s * d) for s in (1, -1)]
            rows.append((weighted(ends[0], weights) - weighted(ends[1], weights)) / (2 * step))
        residuals = weighted(equations.residuals(held, vector), weights)
        jacobian = np.stack(rows, 1)
        assert equations.pattern.matrix(entries).toarray() == pytest.approx(jacobian.T @ jacobian, abs=1e-10)
        assert right == pytest.approx(jacobian.T @ residuals, abs=1e-10)
        change = weighted(equations.change(linearised, vector), weights)
        assert change == pytest.approx(jacobian @ vector, abs=1e-9)
        vector = vector + 0.1 * rng.normal(size=len(vector))


class TestVerdict:
    def test_solved(self) -> None:
        solution = solve([square()], [lengths()])
        v = solution.values["vertices"]
        assert solution.solved
        assert solution.unmet == ()
        assert np.linalg.norm(v[EDGES[:, 0]] - v[EDGES[:, 1]], axis=1) == pytest.approx(1, abs=1e-9)

    def test_least_change(self) -> None:
        """What constraints leave open is settled by the least change: no motion of the square as a whole."""
        solution = solve([square()], [lengths()])
        before, after = square().values, solution.values["vertices"]
        assert after.mean(0) == pytest.approx(before.mean(0), abs=1e-6)  # rounding over the least damping

    def test_too_much_is_asked(self) -> None:
        """Corners held and edges of another length: the remainder is the least one and is told by constraint."""
        exact = Block("vertices", np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]))
        held = Fixed(name="held", index=np.arange(4), points=exact.values, edge=1.0)
        solution = solve([exact], [lengths(1.2), held])
        assert solution.verdict == "settled"
        assert set(solution.unmet) == {"held", "lengths"}
        # least sum of squares of a square of side a: 4 ((a^2 - l^2) / 2 l)^2 + 8 ((a - 1) / 2)^2
        a = np.linspace(1, 1.2, 200001)
        least = (4 * ((a * a - 1.44) / 2.4) ** 2 + 8 * ((a - 1) / 2) ** 2).min()
        assert solution.last.objective == pytest.approx(least, rel=1e-6)
        assert "not met" in str(solution)

    def test_lasting_wish_is_granted_as_far_as_possible(self) -> None:
        """A soft constraint that stays has its least among all ways to meet the hard one, to its weight squared."""
        far = np.array([[0.9, 1.2, 0]])
        wish = Fixed(name="wish", index=np.array([1]), points=far, edge=1.0, weight=1e-2, hard=False)
        held = Fixed(name="held", index=np.array([0]), points=np.zeros((1, 3)), edge=1.0)
        rod = EdgeLength(name="rod", edges=EDGES[:1], lengths=np.ones(1), edge=1.0)
        start = Block("vertices", square().values[:2], 1.0)
        solution = solve([start], [rod, held, wish], tolerance=1e-4, iterations=100)
        assert solution.solved
        assert solution.values["vertices"][1] == pytest.approx([0.6, 0.8, 0], abs=1e-4)

    def test_hard_holds_to_rounding_beside_a_wish_that_fades_and_to_its_weight_squared_beside_one_that_stays(
        self,
    ) -> None:
        """Least of (|v|^2 - 1)^2 / 4 + w^2 |v - p|^2: |v| - 1 is w^2 (|p| - 1) to first order."""
        far = np.array([[1.8, 2.4, 0.0]])
        start = Block("vertices", square().values[:2], 1.0)
        held = Fixed(name="held", index=np.array([0]), points=np.zeros((1, 3)), edge=1.0)
        rod = EdgeLength(name="rod", edges=EDGES[:1], lengths=np.ones(1), edge=1.0)
        left = []
        for weight in (0.04, 0.02, 0.01):
            stays = Fixed(name="wish", index=np.array([1]), points=far, edge=1.0, weight=weight, hard=False)
            solution = solve([start], [rod, held, stays], iterations=200)
            assert not solution.solved
            assert "rod" in solution.unmet
            left.append(solution.last.residual["rod"])
            fades = replace(stays, fade=0.5)
            solution = solve([start], [rod, held, fades])
            assert solution.solved
            assert max(solution.last.largest[name] for name in ("rod", "held")) <= 1e-9
        assert np.log2(np.array(left[:-1]) / left[1:]) == pytest.approx(2, abs=0.1)
        assert left[-1] == pytest.approx(0.01**2 * (3 - 1), rel=0.05)

    def test_iterations_used_up(self) -> None:
        solution = solve([square()], [lengths()], iterations=1)
        assert solution.verdict == "iterations used up"
        assert solution.last.number == 1
        assert solution.unmet == ("lengths",)

    def test_start_that_is_a_solution(self) -> None:
        exact = Block("vertices", np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]))
        solution = solve([exact], [lengths()])
        assert (solution.verdict, solution.last.number) == ("solved", 0)


def test_records() -> None:
    seen = []
    fade = Fixed(name="start", index=np.arange(4), points=square().values, edge=1.0, weight=0.1, fade=0.1, hard=False)
    solution = solve([square()], [lengths(), fade], on_iteration=seen.append)
    assert tuple(seen) == solution.iterations
    moved = solution.values["vertices"] - square().values
    assert solution.last.drift["vertices"] == pytest.approx(np.sqrt((moved**2).mean()), rel=1e-12)
    assert solution.last.residual["start"] == pytest.approx(solution.last.drift["vertices"], rel=1e-12)
    assert [i.number for i in seen] == list(range(len(seen)))
    assert (np.diff([i.seconds for i in seen]) >= 0).all()
    first = seen[0]
    assert first.objective == pytest.approx(4 * first.residual["lengths"] ** 2)
    assert seen[-1].step == 0


def test_arguments_are_left_alone() -> None:
    block = square()
    before = block.values.copy()
    solve([block], [lengths()])
    assert np.array_equal(block.values, before)


def test_back_ends_agree_and_analyse_once(monkeypatch: pytest.MonkeyPatch) -> None:
    built = []
    make = NormalEquations.of

    def counted(*arguments, **options):
        built.append(1)
        return make(*arguments, **options)

    monkeypatch.setattr(NormalEquations, "of", counted)
    mesh = noisy(lamella_patch(Catenoid(1.0, (-1, 1)), 12, 1.0), 0.02, 0)
    splu = asymptotic(mesh, backend="splu")
    assert len(built) == 1
    other = asymptotic(mesh)
    assert splu.mesh.vertices == pytest.approx(other.mesh.vertices, abs=1e-8)
    assert splu.solution.last.number == other.solution.last.number


class TestUncertainty:
    def test_mean_of_measured_numbers(self) -> None:
        """An unknown that all n points have to equal is known to doubt / sqrt(n)."""
        n = 25
        blocks = [Block("vertices", np.zeros((n, 1)), 2.0), Block("mean", np.zeros((1, 1)), 1.0)]
        found = uncertainty(blocks, [Equal(name="equal", count=n)], "mean", "vertices", 0.1)
        assert found == pytest.approx(0.1 * 2.0 / np.sqrt(n), rel=1e-4)

    def test_nothing_determines_it(self) -> None:
        blocks = [square(), Block("radius", np.ones((1, 1)))]
        assert uncertainty(blocks, [lengths()], "radius", "vertices", 0.1) > 1e3 * 0.1


class TestRefused:
    def test_names_given_twice(self) -> None:
        with refused(names=("lengths",)):
            solve([square()], [lengths(), lengths()])
        with refused(names=("vertices",)):
            solve([square(), square()], [lengths()])

    def test_nothing_hard(self) -> None:
        with refused(names=("hard=True",)):
            solve([square()], [lengths(hard=False)])

    def test_hard_that_fades(self) -> None:
        with refused(names=("lengths", "hard=False")):
            solve([square()], [lengths(fade=0.5)])

    @pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
    def test_weight(self, bad: float) -> None:
        with refused(names=("lengths",), numbers=(bad,) if np.isfinite(bad) else ()):
            solve([square()], [lengths(weight=bad)])

    def test_unknown_block_and_index(self) -> None:
        with refused(names=("vertices",)):
            solve([Block("points", square().values)], [lengths()])
        with refused(numbers=(3, 2), names=("vertices",)):
            solve([Block("vertices", square().values[:3])], [lengths()])

    def test_values_that_are_no_numbers(self) -> None:
        with refused(numbers=(12,), names=("vertices",)):
            solve([Block("vertices", np.full((4, 3), np.nan))], [lengths()])
        with refused(numbers=(0.0,), names=("vertices",)):
            solve([Block("vertices", square().values, 0.0)], [lengths()])

    def test_limits(self) -> None:
        with refused(names=("tolerance",), numbers=(0.0,)):
            solve([square()], [lengths()], tolerance=0.0)
