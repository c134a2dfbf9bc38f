"""What is raised where no way leads to a film."""

from __future__ import annotations


class SearchError(ArithmeticError):
    """No film was found.

    Attributes
    ----------
    reasons : tuple of str
        How far each way went.
    fold : float or None
        H at which the stable films from the minimal one turn back, 1/m.
    steps : int
        Newton steps.
    """

    def __init__(self, reasons: tuple[str, ...], fold: float | None, steps: int) -> None:
        super().__init__("; ".join(reasons))
        self.reasons, self.fold, self.steps = reasons, fold, steps
