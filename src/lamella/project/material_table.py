"""The tables [materials.NAME]: materials of the project's own."""

from __future__ import annotations

from lamella.project.values import Table, number


class MaterialTable(Table):
    """A material of the project's own, SI units."""

    density: float = number("Density.", "kg/m3", gt=0, le=30000)
    youngs_modulus: float = number("Young's modulus along the strip.", "Pa", ge=1e6, le=1e13)
    shear_modulus: float = number("Shear modulus.", "Pa", ge=1e5, le=1e13)
    strength: float = number("Limit of the normal (von Mises) stress.", "Pa", ge=1e3, le=1e11)
    shear_strength: float | None = number(
        "Limit of the shear stress where it is not that of von Mises (timber).", "Pa", ge=1e3, le=1e11, default=None
    )
    k_mod: float | None = number(
        "Modification factor for duration of load and moisture (timber, EN 1995-1-1 table 3.1).",
        "",
        gt=0,
        le=1.5,
        default=None,
    )
    gamma_m: float | None = number(
        "Partial factor of the material; with it or k_mod utilisations are of design strengths.",
        "",
        ge=1,
        le=10,
        default=None,
    )
    expansion: float = number("Strain by one kelvin.", "1/K", ge=0, le=1e-3, default=12e-6)
