"""Cross sections of edge beams: stiffness, and what stresses they have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.material import Material
from lamella.hardware.edge_rules import BeamSection
from lamella.structure.beam.cross_section import RECTANGLE_SHEAR_SHARE, CrossSection, flat_strip

TUBE_SHEAR_SHARE = 0.5
"""Of a thin tube's shear area over its area (G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335, nu = 0)."""


@dataclass(frozen=True)
class EdgeSection:
    """A section of an edge beam.

    Attributes
    ----------
    section : CrossSection
    material : Material
    area : float
        m^2.
    modulus_t, modulus_u, modulus_n : float
        Of torsion and of bending about u and n, m^3.
    round : bool
        Whether bending moments about both axes add up as a vector.
    """

    section: CrossSection
    material: Material
    area: float
    modulus_t: float
    modulus_u: float
    modulus_n: float
    round: bool


def edge_section(beam: BeamSection, material: Material) -> EdgeSection:
    """Of a round tube or a flat bar that stands along the surface normal."""
    if not beam.round:
        height, thickness = beam.height, 2 * beam.reach
        flat = flat_strip(material, height, thickness, flat_across=True)
        modulus_t = flat.torsion / material.shear_modulus / thickness
        area = height * thickness
        bar = CrossSection(
            flat.axial,
            RECTANGLE_SHEAR_SHARE * material.shear_modulus * area,
            RECTANGLE_SHEAR_SHARE * material.shear_modulus * area,
            flat.torsion,
            flat.bending_u,
            flat.bending_n,
            mass=flat.mass,
            inertia_t=flat.inertia_t,
            inertia_u=flat.inertia_u,
            inertia_n=flat.inertia_n,
        )
        return EdgeSection(bar, material, area, modulus_t, thickness * height**2 / 6, height * thickness**2 / 6, False)
    outer = beam.height
    inner = 2 * float(np.linalg.norm(beam.holes[0][:, :2], axis=1).max())
    area, inertia = np.pi / 4 * (outer**2 - inner**2), np.pi / 64 * (outer**4 - inner**4)
    young, shear, density = material.youngs_modulus, material.shear_modulus, material.density
    tube = CrossSection(
        young * area,
        TUBE_SHEAR_SHARE * shear * area,
        TUBE_SHEAR_SHARE * shear * area,
        2 * shear * inertia,
        young * inertia,
        young * inertia,
        mass=density * area,
        inertia_t=2 * density * inertia,
        inertia_u=density * inertia,
        inertia_n=density * inertia,
    )
    modulus = 2 * inertia / outer
    return EdgeSection(tube, material, area, 2 * modulus, modulus, modulus, True)
