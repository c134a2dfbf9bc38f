"""Units of length of files and project keys."""

from __future__ import annotations

from lamella.base.errors import InputError
from lamella.project.values import METRES


def metres_per_unit(asked: str | None, in_header: float | None, header: str, where: str) -> float:
    """Metres per unit of a file.

    Parameters
    ----------
    asked : str or None
        The project's `unit`, which wins.
    in_header : float or None
        What the file says; None where it does not.
    header : str
        Where in the file the unit would stand.
    where : str
        Key for messages.

    Raises
    ------
    InputError
        Neither says.
    """
    if asked is not None:
        return METRES[asked]
    if in_header is None:
        raise InputError(
            f"the file does not say its unit ({header})", 'add unit = "mm", or the one it was drawn in, here', where
        )
    return in_header


def name_of(metres: float) -> str:
    """Name of a unit given in metres."""
    return next((name for name, value in METRES.items() if abs(value / metres - 1) < 1e-9), f"{metres:g} m")
