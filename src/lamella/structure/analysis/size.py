"""How much memory the analysis of a structure takes, told before it begins."""

from __future__ import annotations

BYTES_PER_ELEMENT = 30_000
"""Of one analysis at its largest: stiffness of elements, matrix, factors, vectors of buckling."""

BYTES_PER_CASE = 2_000
"""Of an element and a case that is kept: its pose, stresses and modes."""


def structure_memory(elements: int, cases: int) -> float:
    """GB, on the safe side.

    Parameters
    ----------
    elements : int
        Beam elements of the model.
    cases : int
        Load cases, the residual state too.
    """
    return elements * (BYTES_PER_ELEMENT + cases * BYTES_PER_CASE) / 1e9
