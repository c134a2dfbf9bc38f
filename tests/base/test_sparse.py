"""Sparse symmetric systems, both back ends, against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.base.sparse import SingularError, SymmetricPattern, default_backend, packed


def has_rslab() -> bool:
    try:
        import rslab  # noqa: F401
    except ImportError:
        return False
    return True


BACKENDS = [
    pytest.param("rslab", marks=pytest.mark.skipif(not has_rslab(), reason="rslab is not installed")),
    "splu",
]


def elements(count: int = 60, rng=None):
    """Random overlapping elements of four unknowns; some are held."""
    rng = rng or np.random.default_rng(0)
    unknowns = np.array([rng.choice(count, 4, replace=False) for _ in range(3 * count)])
    unknowns[rng.random(unknowns.shape) < 0.1] = -1
    blocks = rng.normal(size=(len(unknowns), 4, 4))
    return unknowns, blocks + blocks.transpose(0, 2, 1)


def dense(unknowns, blocks, count: int) -> np.ndarray:
    """Assembled entry by entry."""
    matrix = np.zeros((count, count))
    for nodes, block in zip(unknowns, blocks, strict=True):
        for a, i in enumerate(nodes):
            for b, j in enumerate(nodes):
                if i >= 0 and j >= 0:
                    matrix[i, j] += block[a, b]
    return matrix


@pytest.mark.parametrize("backend", BACKENDS)
class TestBackend:
    def test_assembles_what_entry_by_entry_sums_give(self, backend) -> None:
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        expected = dense(unknowns, blocks, 60)
        assert pattern.matrix(pattern.assemble(packed(blocks))).toarray() == pytest.approx(expected, abs=1e-13)

    def test_solves_definite_systems_for_one_and_several_sides(self, backend) -> None:
        unknowns, blocks = elements()
        blocks = np.matmul(blocks, blocks)
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        matrix = dense(unknowns, blocks, 60)
        factor = pattern.factor(pattern.assemble(packed(blocks)))
        right = np.random.default_rng(1).normal(size=(60, 3))
        assert factor.negative == 0
        assert factor.solve(right) == pytest.approx(np.linalg.solve(matrix, right), rel=1e-8)
        assert factor.solve(right[:, 0]) == pytest.approx(np.linalg.solve(matrix, right[:, 0]), rel=1e-8)

    @pytest.mark.parametrize("shift", [-20.0, -5.0, -1.0, 0.0, 0.5, 3.0, 20.0])
    def test_counts_negative_eigenvalues(self, backend, shift) -> None:
        """Sylvester's law of inertia, against dense eigenvalues."""
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        values = pattern.assemble(packed(blocks))
        matrix = dense(unknowns, blocks, 60) + shift * np.eye(60)
        diagonal = pattern.columns[:-1]  # each column of the lower triangle begins there
        values[diagonal] += shift
        factor = pattern.factor(values)
        assert factor.negative == (np.linalg.eigvalsh(matrix) < 0).sum()
        right = np.random.default_rng(2).normal(size=60)
        assert matrix @ factor.solve(right) == pytest.approx(right, abs=1e-7)

    def test_factors_other_values_on_the_same_pattern(self, backend) -> None:
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        right = np.ones(60)
        for power in (1.0, 2.0, 0.01):
            scaled = power * np.matmul(blocks, blocks)
            solution = pattern.factor(pattern.assemble(packed(scaled))).solve(right)
            assert dense(unknowns, scaled, 60) @ solution == pytest.approx(right, abs=1e-8)

    @pytest.mark.parametrize("border", [1, 2])
    def test_border_is_coupled_with_all(self, backend, border) -> None:
        unknowns, blocks = elements()
        blocks = np.matmul(blocks, blocks)
        rng = np.random.default_rng(3)
        rows = rng.normal(size=(border, 60 + border))
        rows[:, 60:] = rows[:, 60:] + rows[:, 60:].T
        pattern = SymmetricPattern.from_elements(unknowns, 60, border=border, backend=backend)
        expected = np.zeros((60 + border, 60 + border))
        expected[:60, :60] = dense(unknowns, blocks, 60)
        expected[60:], expected[:, 60:] = rows, rows.T
        values = pattern.assemble(packed(blocks), rows)
        assert pattern.matrix(values).toarray() == pytest.approx(expected, abs=1e-13)
        right = rng.normal(size=60 + border)
        assert expected @ pattern.factor(values).solve(right) == pytest.approx(right, abs=1e-7)

    def test_multiplier_of_a_constraint(self, backend) -> None:
        """A border with nought on its diagonal: one negative eigenvalue more, and the constraint is met."""
        unknowns, blocks = elements()
        blocks = np.matmul(blocks, blocks)
        row = np.append(np.random.default_rng(4).normal(size=60), 0.0)
        pattern = SymmetricPattern.from_elements(unknowns, 60, border=1, backend=backend)
        factor = pattern.factor(pattern.assemble(packed(blocks), row[None]))
        assert factor.negative == 1
        assert row @ factor.solve(np.append(np.zeros(60), 1.0)) == pytest.approx(1)

    def test_unknown_without_an_element_makes_it_singular(self, backend) -> None:
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 61, backend=backend)
        with pytest.raises(SingularError):
            pattern.factor(pattern.assemble(packed(np.matmul(blocks, blocks))))

    def test_matrix_of_noughts_is_singular(self, backend) -> None:
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        with pytest.raises(SingularError):
            pattern.factor(pattern.assemble(packed(0 * blocks)))

    def test_dependent_rows_are_singular_or_say_so_in_the_solution(self, backend) -> None:
        """Rounding may hide a dependence from the pivots: then the solution is huge, never plausible."""
        rng = np.random.default_rng(6)
        chain = np.column_stack([np.arange(29), np.arange(1, 30)])
        pattern = SymmetricPattern.from_elements(chain, 30, backend=backend)
        blocks = rng.uniform(1, 2, (29, 1, 1)) * [[1.0, -1.0], [-1.0, 1.0]]  # constants are in its kernel
        try:
            solution = pattern.factor(pattern.assemble(packed(blocks))).solve(np.ones(30))
        except SingularError:
            return
        assert not np.abs(solution).max() < 1e8

    @pytest.mark.parametrize("bad", [np.nan, np.inf])
    def test_entries_that_are_no_numbers_are_refused(self, backend, bad) -> None:
        unknowns, blocks = elements()
        pattern = SymmetricPattern.from_elements(unknowns, 60, backend=backend)
        values = pattern.assemble(packed(blocks))
        values[5] = bad
        with pytest.raises(SingularError):
            pattern.factor(values)


def test_environment_chooses_the_back_end(monkeypatch) -> None:
    monkeypatch.setenv("LAMELLA_SOLVER", "splu")
    assert default_backend() == "splu"
    assert SymmetricPattern.from_elements(np.array([[0, 1]]), 2).backend == "splu"
    monkeypatch.setenv("LAMELLA_SOLVER", "no such")
    assert default_backend() == ("rslab" if has_rslab() else "splu")


@pytest.mark.skipif(not has_rslab(), reason="rslab is not installed")
def test_back_ends_agree_on_a_large_grid() -> None:
    """Laplace's operator on 60 x 60 squares, shifted into its spectrum: as many negative eigenvalues as exact ones.

    They are 4 - 2 cos(i pi / 61) - 2 cos(j pi / 61).
    """
    n = 60
    i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    number = i * n + j
    across, down = number[i < n - 1], number[j < n - 1]
    edges = np.concatenate([np.column_stack([across, across + n]), np.column_stack([down, down + 1])])
    blocks = np.tile([[0.0, -1.0], [-1.0, 0.0]], (len(edges), 1, 1))
    k = 4 - 2 * np.cos(np.arange(1, n + 1) * np.pi / (n + 1)) * 1.0
    exact = (k[:, None] + k - 4).ravel()
    right = np.random.default_rng(0).normal(size=n * n)
    solutions = []
    for backend in ("rslab", "splu"):
        pattern = SymmetricPattern.from_elements(edges, n * n, backend=backend)
        values = pattern.assemble(packed(blocks))
        values[pattern.columns[:-1]] += 4 - 0.1234567
        factor = pattern.factor(values)
        assert factor.negative == (exact < 0.1234567).sum()
        solutions.append(factor.solve(right))
    assert solutions[0] == pytest.approx(solutions[1], rel=1e-6, abs=1e-8)
