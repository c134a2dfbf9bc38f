"""Stiffness and mass of a beam's cross section.

Axes of the section are those of the package: t along the beam, u sideways (through a strip's thickness), n upright
(along a strip's height).
"""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.errors import InputError, require_positive
from lamella.base.material import Material
from lamella.strip.plate import poisson_ratio

# of a rectangle's shear area over its area (G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335, nu = 0)
RECTANGLE_SHEAR_SHARE = 5 / 6


@dataclass(frozen=True)
class CrossSection:
    """Elastic stiffness and mass of a cross section, in the principal axes through its centroid.

    Attributes
    ----------
    axial : float
        E A, N.
    shear_u, shear_n : float
        G A_s of shear along u and n, N; may be infinite.
    torsion : float
        G J, N m^2.
    bending_u, bending_n : float
        E I about u (a strip's strong axis) and about n (its weak axis), N m^2.
    gyration : float
        Square of the polar radius of gyration, m^2, with which twist stretches the fibres away from the centroid; 0
        leaves the helix (Wagner) effect out.
    helix : float
        E t b^5 / 64 of a strip of height b and thickness t, N m^4: the energy per length is half of it times
        (p Psi^(1/2))^2, see `lamella.structure.beam.plate_action`; 0 for other sections.
    poisson : float
        nu of a strip's plate action; 0: no lateral contraction.
    plate_rate : float
        3 (1 - nu^2) b^4 / (16 t^2), m^2, of a strip; 0: it stays flat across.
    mass : float
        Per length, kg/m.
    inertia_t, inertia_u, inertia_n : float
        Mass moments of inertia per length about the three axes, kg m.
    """

    axial: float
    shear_u: float
    shear_n: float
    torsion: float
    bending_u: float
    bending_n: float
    gyration: float = 0.0
    helix: float = 0.0
    poisson: float = 0.0
    plate_rate: float = 0.0
    mass: float = 0.0
    inertia_t: float = 0.0
    inertia_u: float = 0.0
    inertia_n: float = 0.0

    def __post_init__(self) -> None:
        for name in ("axial", "torsion", "bending_u", "bending_n"):
            require_positive(**{name: getattr(self, name)})
        for name in ("shear_u", "shear_n"):
            if not getattr(self, name) > 0:
                value = getattr(self, name)
                raise InputError(f"{name} = {value!r} is out of range", f"{name} has to be above 0, or infinite", name)


def flat_strip(material: Material, height: float, thickness: float, *, flat_across: bool = False) -> CrossSection:
    """Cross section of a strip with its helix (Wagner) effect and plate action.

    Parameters
    ----------
    material : Material
    height, thickness : float
        m; the height is the larger one.
    flat_across : bool
        The strip is kept from bending across its height: the helix effect of a beam whose section keeps its shape, and
        no lateral contraction.

    Returns
    -------
    CrossSection
        J = b t^3 / 3 (1 - 0.63 t / b (1 - t^4 / (12 b^4))) (W. C. Young, R. G. Budynas, Roark's Formulas for Stress and
        Strain, table 10.1).

    Raises
    ------
    InputError
        A measure that is not above 0; a thickness that is not less than the height.
    """
    require_positive(height=height, thickness=thickness)
    if thickness >= height:
        raise InputError(
            f"thickness = {thickness!r} is not less than the height {height!r}",
            "the height of a strip is the larger of the two",
            "thickness",
        )
    b, t, young, shear = height, thickness, material.youngs_modulus, material.shear_modulus
    nu = 0.0 if flat_across else poisson_ratio(material)
    area = b * t
    about_u, about_n = t * b**3 / 12, b * t**3 / 12
    slim = 1 - 0.63 * t / b * (1 - t**4 / (12 * b**4))
    return CrossSection(
        axial=young * area,
        shear_u=RECTANGLE_SHEAR_SHARE * shear * area,
        shear_n=RECTANGLE_SHEAR_SHARE * shear * area,
        torsion=shear * b * t**3 / 3 * slim,
        bending_u=young * about_u,
        bending_n=young * about_n,
        gyration=(b**2 + t**2) / 12,
        helix=young * t * b**5 / 64,
        poisson=nu,
        plate_rate=0.0 if flat_across else 3 * (1 - nu**2) * b**4 / (16 * t**2),
        mass=material.density * area,
        inertia_t=material.density * (about_u + about_n),
        inertia_u=material.density * about_u,
        inertia_n=material.density * about_n,
    )
