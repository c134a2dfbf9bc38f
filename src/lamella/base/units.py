"""Units of length: metres of each, by the names that users, Rhino files and DXF files have for them."""

from __future__ import annotations

from collections.abc import Iterable

from lamella.base.errors import InputError

METRES: dict[str, float] = {
    "mm": 1e-3,
    "cm": 1e-2,
    "dm": 0.1,
    "m": 1.0,
    "km": 1000.0,
    "in": 0.0254,
    "ft": 0.3048,
    "yd": 0.9144,
}
"""Metres per unit, by the names people write."""

MESH_UNITS = tuple(METRES)
"""What a mesh file may be in: all of them."""

PROJECT_UNITS = ("m", "mm", "cm", "dm", "ft", "in")
"""What a project file may name; `lamella.project.values.Unit` has them as a type."""

RHINO_METRES: dict[str, float] = {
    "Angstroms": 1e-10,
    "Nanometers": 1e-9,
    "Microns": 1e-6,
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Decimeters": 0.1,
    "Meters": 1.0,
    "Dekameters": 10.0,
    "Hectometers": 100.0,
    "Kilometers": 1000.0,
    "Mils": 2.54e-5,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Yards": 0.9144,
    "Miles": 1609.344,
}
"""Metres of openNURBS' units; those it leaves to the user (None, CustomUnits) are not here."""

DXF_METRES: dict[int, float] = {
    1: 0.0254,  # inch
    2: 0.3048,  # foot
    3: 1609.344,  # mile
    4: 1e-3,
    5: 1e-2,
    6: 1.0,
    7: 1000.0,
    9: 2.54e-5,  # mil
    10: 0.9144,  # yard
    13: 1e-6,  # micron
    14: 0.1,
    15: 10.0,
    16: 100.0,
    21: 1200 / 3937,  # US survey foot
}
"""Metres of the codes of $INSUNITS."""


def unit_name(metres: float, names: Iterable[str] = MESH_UNITS) -> str:
    """Name of a unit given in metres, of some of the names; the number itself where it has none."""
    return next((name for name in names if abs(METRES[name] / metres - 1) < 1e-9), f"{metres:g} m")


def metres_of(unit: str) -> float:
    """Metres of a unit that is given by name.

    Raises
    ------
    InputError
        None of `MESH_UNITS`.
    """
    try:
        return METRES[unit.strip().lower()]
    except KeyError:
        raise InputError(f"unit {unit!r} is not known", f"take one of {', '.join(MESH_UNITS)}", "unit") from None
