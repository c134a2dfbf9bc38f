"""Stresses of a thin strip that is bent about its weak axis and twisted (docs/theory.md).

Strip coordinates: z across the height h (along the surface normal, 0 on the centre line), thickness t.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.blocks import blocks
from lamella.base.material import Material
from lamella.strip.plate import Plate, poisson_ratio

# above the centre line, over h / 2: where stresses are compared; the worst is at the edge or on the centre line
HEIGHTS = (0.0, 0.5, 1.0)


def bending(material: Material, thickness: float | Floats, kg: Floats) -> Floats:
    """Weak-axis bending stress at the faces, E t |kg| / 2, Pa."""
    return np.asarray(material.youngs_modulus * thickness * np.abs(kg) / 2)


def strong_axis(material: Material, height: float | Floats, curvature_error: Floats) -> Floats:
    """Strong-axis bending stress at the edges, E h |kn - 1/r| / 2, Pa; zero by design."""
    return np.asarray(material.youngs_modulus * height * np.abs(curvature_error) / 2)


def torsion(material: Material, thickness: float | Floats, tg: Floats) -> Floats:
    """St-Venant shear stress at the faces, G t |tg|, Pa."""
    return np.asarray(material.shear_modulus * thickness * np.abs(tg))


def shortening(height: float, tg: Floats) -> Floats:
    """Strain h^2 tg^2 / 24 by which a free strip's centre line shortens when it is twisted: what relaxed marks add."""
    return np.asarray(np.square(height * tg) / 24)


@dataclass(frozen=True)
class Stresses:
    """Stresses along the lamellas, Pa, each (k,); see `lamella.strip.lamellas.Lamellas`."""

    bending: Floats
    torsion: Floats
    layer: Floats
    helix_edge: Floats
    helix_centre: Floats
    restraint: Floats
    von_mises: Floats
    utilisation: Floats
    net_utilisation: Floats


def stresses(
    material: Material,
    height: float | Floats,
    thickness: float | Floats,
    *,
    curvature_error: Floats,
    layer_curvature: Floats,
    kg: Floats,
    tg: Floats,
    held: bool,
    axial: Floats | float = 0.0,
) -> Stresses:
    """All stresses of twisted strips.

    Parameters
    ----------
    material : Material
    height, thickness : float or (k,)
        m.
    curvature_error : (k,)
        kn - 1/r of the centre line, 1/m.
    layer_curvature : (k,)
        Largest difference of a layer's normal curvature from the one its flat strip has, beside that error, 1/m.
    kg, tg : (k,)
        1/m.
    held : bool
        Whether node marks hold the unshortened length.
    axial : (k,) or float
        Mean over the height of the normal stress that loads make, Pa.

    Returns
    -------
    Stresses
        Von Mises stress of plane stress, the worst of both faces at `HEIGHTS`: membrane stress of the helix with its
        plate action (`lamella.strip.plate`), bending of the plate along and across, strong-axis bending, and the
        St-Venant shear of the long faces everywhere. Utilisation is von Mises over strength, or, where the
        material has a shear strength of its own, the worse of normal and shear stress over their strengths; with
        k_mod or gamma_M both together over design strengths.
        The net section's is that at a slot, see `net_section`.
    """
    result = Stresses(*np.empty((len(fields(Stresses)), len(kg))))
    everywhere = np.broadcast_to(axial, kg.shape)
    for block in blocks(len(kg)):
        own = _Along(curvature_error[block], layer_curvature[block], kg[block], tg[block], everywhere[block])
        h, t = (one[block] if isinstance(one, np.ndarray) else one for one in (height, thickness))
        part = _stresses(material, h, t, own, held)
        for one in fields(Stresses):
            getattr(result, one.name)[block] = getattr(part, one.name)
    return result


class _Along(NamedTuple):
    """What strips have at some samples, see `stresses`."""

    curvature_error: Floats
    layer_curvature: Floats
    kg: Floats
    tg: Floats
    axial: Floats


def _stresses(
    material: Material, height: float | Floats, thickness: float | Floats, along: _Along, held: bool
) -> Stresses:
    kg, tg = along.kg, along.tg
    weak, shear = bending(material, thickness, kg), torsion(material, thickness, tg)
    layer = strong_axis(material, height, along.layer_curvature)
    strong = strong_axis(material, height, along.curvature_error) + layer
    plate = Plate(material, height, thickness, kg, tg)
    edge, centre = (plate.across(share, False).stress for share in (1.0, 0.0))
    nu = poisson_ratio(material)
    face = material.youngs_modulus * thickness / (2 * (1 - nu**2))
    normal, square = np.zeros((2, len(weak)))
    for share in HEIGHTS:
        membrane, curvature = plate.across(share, held)
        lengthwise, cross = face * (np.abs(kg) + nu * curvature), face * (curvature + nu * np.abs(kg))
        for side in (-1.0, 1.0):
            for bent in (-strong, strong):
                sigma = membrane + along.axial + share * bent + side * lengthwise
                normal = np.maximum(normal, np.abs(sigma))
                square = np.maximum(square, sigma**2 - sigma * side * cross + cross**2)
    mises = np.sqrt(square + 3 * shear**2)
    tension = plate.mean_tension() if held else np.zeros_like(weak)
    net = net_section(weak, tension + along.axial, strong)
    return Stresses(
        weak,
        shear,
        layer,
        edge,
        centre,
        -centre if held else np.zeros_like(weak),
        mises,
        _utilisation(material, mises, normal, shear, height / thickness),
        _utilisation(material, np.sqrt(net**2 + 3 * shear**2), net, shear, height / thickness),
    )


def net_section(bending: Floats, tension: Floats, strong: Floats) -> Floats:
    """Largest normal stress at a slot, where half of the height is left, Pa.

    The half carries the axial force and the strong-axis moment of the whole strip: on half of the area and a quarter of
    the section modulus they make twice the mean tension and four times the strong-axis stress (net section of a beam,
    elastic: EN 1993-1-1, 6.2.3 and 6.2.5). The helix stress has no resultant and is not carried over. The moment that
    an axial force has about the half's own middle is taken by the node, which clamps both edges; stress concentration
    at the slot's corners is not counted.

    Parameters
    ----------
    bending : (k,)
        About the weak axis: the same on half of the height.
    tension : (k,)
        Mean of the membrane stress over the height.
    strong : (k,)
        Strong-axis bending stress at the edges of the whole strip.
    """
    return np.asarray(bending + 2 * np.abs(tension) + 4 * strong)


def torsion_shape(slenderness: float | Floats) -> Floats:
    """Factor k_shape of a rectangle's torsion strength, of height over thickness (EN 1995-1-1:2004/A2:2014, 6.1.8)."""
    return np.minimum(1 + 0.05 * np.asarray(slenderness), 1.3)


def _utilisation(
    material: Material, mises: Floats, normal: Floats, shear: Floats, slenderness: float | Floats
) -> Floats:
    """Of metals von Mises; of other materials the worse of normal and shear, of timber by design values both together.

    With k_mod and gamma_M strengths are k_mod f / gamma_M, torsion's k_shape times as large (EN 1995-1-1, 2.4.1 and
    6.1.8); bending and torsion together are judged by the sum of their squares, which EN 1995-1-1 leaves open.
    """
    if material.shear_strength is None:
        return np.asarray(mises / (material.strength * material.design_factor))
    bent, sheared = normal / material.strength, shear / material.shear_strength
    if not material.has_design_values:
        return np.maximum(bent, sheared)
    return np.asarray(np.hypot(bent, sheared / torsion_shape(slenderness)) / material.design_factor)
