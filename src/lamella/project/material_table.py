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
    expansion: float = number("Strain by one kelvin.", "1/K", ge=0, le=1e-3, default=12e-6)
