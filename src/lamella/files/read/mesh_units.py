"""Units of length of mesh files."""

from __future__ import annotations

from lamella.base.errors import InputError

METRES = {"mm": 0.001, "cm": 0.01, "dm": 0.1, "m": 1.0, "km": 1000.0, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
"""Metres of each unit a project file can name."""


def metres_of(unit: str) -> float:
    """Metres of a named unit; InputError names the known ones."""
    try:
        return METRES[unit.strip().lower()]
    except KeyError:
        known = ", ".join(METRES)
        raise InputError(f"unit {unit!r} is not known", f"take one of {known}", where="surface.unit") from None


def name_of(metres: float) -> str:
    """Name of a unit given in metres."""
    return next((name for name, value in METRES.items() if abs(value / metres - 1) < 1e-9), f"{metres:g} m")
