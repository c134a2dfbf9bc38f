"""What is raised where a film is looked for in vain."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamella.surface.form_finding.film import Film


class NoFilmError(ArithmeticError):
    """A search ended without a film.

    Attributes
    ----------
    last : Film or None
        The last film on its way, with sound elements.
    """

    def __init__(self, message: str, last: Film | None = None) -> None:
        super().__init__(message)
        self.last = last


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
