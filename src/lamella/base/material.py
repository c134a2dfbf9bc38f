"""Materials of lamellas, with the sources of their figures: data that strips and the project's schema share."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.errors import InputError


@dataclass(frozen=True)
class Material:
    """Elastic constants and strength, SI.

    Attributes
    ----------
    density : float
        kg/m^3.
    youngs_modulus, shear_modulus : float
        E and G, Pa (along the grain for timber).
    strength : float
        Limit of normal stress, Pa: 0.2 % yield strength of metals, characteristic bending strength of timber. No
        partial factors are applied.
    shear_strength : float or None
        Limit of shear stress, Pa, where it is not that of von Mises (timber).
    source : str
    expansion : float
        Strain by one kelvin, 1/K (along the grain for timber).
    k_mod, gamma_m : float or None
        Modification factor for duration of load and moisture, and partial factor of the material (EN 1995-1-1);
        with either of them strengths are k_mod f / gamma_M.

    Examples
    --------
    >>> import lamella
    >>> steel = lamella.Material(7850, 210e9, 81e9, 550e6, source="mill certificate")
    >>> lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips(material=steel)
    Lamellas(24 lamellas of 2 x 100 x 1.5 mm, 203.4 m, utilisation up to 0.18)
    """

    density: float
    youngs_modulus: float
    shear_modulus: float
    strength: float
    shear_strength: float | None = None
    source: str = "project file"
    expansion: float = 12e-6
    k_mod: float | None = None
    gamma_m: float | None = None

    @property
    def has_design_values(self) -> bool:
        """Whether strengths are design values."""
        return self.k_mod is not None or self.gamma_m is not None

    @property
    def design_factor(self) -> float:
        """Design strength over strength; 1 without factors."""
        return (1.0 if self.k_mod is None else self.k_mod) / (1.0 if self.gamma_m is None else self.gamma_m)


_STAINLESS = "EN 1993-1-4 table 2.1 (cold-rolled strip), density and expansion EN 10088-1"
_STEEL = "EN 1993-1-1 3.2.6 and table 3.1 (t <= 40 mm)"
_TIMBER = "EN 338:2016 table 1 (characteristic strengths, mean stiffness and density), EN 1991-1-5 table C.1"

MATERIALS: dict[str, Material] = {
    "1.4301": Material(7900, 200e9, 77e9, 230e6, source=_STAINLESS, expansion=16e-6),
    "1.4404": Material(8000, 200e9, 77e9, 240e6, source=_STAINLESS, expansion=16e-6),
    "1.4462": Material(7800, 200e9, 77e9, 500e6, source=_STAINLESS, expansion=13e-6),
    "S235": Material(7850, 210e9, 81e9, 235e6, source=_STEEL),
    "S355": Material(7850, 210e9, 81e9, 355e6, source=_STEEL),
    "S700MC": Material(7850, 210e9, 81e9, 700e6, source="EN 10149-2 table 2; constants EN 1993-1-1 3.2.6"),
    "EN AW-6082 T6": Material(
        2700, 70e9, 27e9, 260e6, source="EN 1999-1-1 table 3.2a (sheet, t <= 6 mm), 3.2.5", expansion=23e-6
    ),
    "C24": Material(420, 11.0e9, 0.69e9, 24e6, 4.0e6, source=_TIMBER, expansion=5e-6),
    "D40": Material(660, 13.0e9, 0.81e9, 40e6, 4.2e6, source=_TIMBER, expansion=5e-6),
    "GL24h": Material(420, 11.5e9, 0.65e9, 24e6, 3.5e6, source="EN 14080:2013 table 5", expansion=5e-6),
}


def find_material(name: str, own: dict[str, Material] | None = None) -> Material:
    """A material by name: the project's own first, then the table.

    Raises
    ------
    InputError
        Unknown name; the message lists what there is.

    Examples
    --------
    >>> import lamella
    >>> lamella.find_material("S355").strength
    355000000.0
    """
    known = MATERIALS | (own or {})
    if name in known:
        return known[name]
    from difflib import get_close_matches

    near = get_close_matches(name, known, 1, 0.5)
    raise InputError(
        f"unknown material {name!r}" + (f", did you mean {near[0]!r}?" if near else ""),
        f"use one of {', '.join(known)}, or add a table [materials.{name!r}] with density, youngs_modulus, "
        "shear_modulus and strength",
        "material",
    )
