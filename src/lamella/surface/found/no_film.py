"""What is raised where a film is looked for in vain."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamella.surface.found.film import Film


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
