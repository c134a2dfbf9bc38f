"""Stresses of a thin strip that is bent about its weak axis and twisted (docs/theory.md).

Strip coordinates: z across the height h (along the surface normal, 0 on the centre line), thickness t.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.strip.material import Material

Floats = NDArray[np.float64]


def bending(material: Material, thickness: float, kg: Floats) -> Floats:
    """Weak-axis bending stress at the faces, E t |kg| / 2, Pa."""
    return np.asarray(material.youngs_modulus * thickness * np.abs(kg) / 2)


def strong_axis(material: Material, height: float, curvature_error: Floats) -> Floats:
    """Strong-axis bending stress at the edges, E h |kn - 1/r| / 2, Pa; zero by design."""
    return np.asarray(material.youngs_modulus * height * np.abs(curvature_error) / 2)


def torsion(material: Material, thickness: float, tg: Floats) -> Floats:
    """St-Venant shear stress at the faces, G t |tg|, Pa."""
    return np.asarray(material.shear_modulus * thickness * np.abs(tg))


def helix(material: Material, height: float, tg: Floats, z: float) -> Floats:
    """Helix normal stress E tg^2 (z^2 / 2 - h^2 / 24) of a strip free to shorten, Pa; it has no resultant."""
    return np.asarray(material.youngs_modulus * np.square(tg) * (z**2 / 2 - height**2 / 24))


def shortening(height: float, tg: Floats) -> Floats:
    """Strain h^2 tg^2 / 24 by which a free strip's centre line shortens when it is twisted."""
    return np.asarray(np.square(height * tg) / 24)


def restraint(material: Material, height: float, tg: Floats) -> Floats:
    """Tension E h^2 tg^2 / 24 of a strip whose nodes hold its unshortened length, Pa."""
    return np.asarray(material.youngs_modulus * shortening(height, tg))


@dataclass(frozen=True)
class Stresses:
    """Stresses along the lamellas, Pa, each (k,); see `lamella.strip.lamellas.Lamellas`."""

    bending: Floats
    torsion: Floats
    helix_edge: Floats
    helix_centre: Floats
    restraint: Floats
    von_mises: Floats
    utilisation: Floats


def stresses(
    material: Material, height: float, thickness: float, curvature_error: Floats, kg: Floats, tg: Floats, held: bool
) -> Stresses:
    """All stresses of twisted strips.

    Parameters
    ----------
    material : Material
    height, thickness : float
        m.
    curvature_error : (k,)
        kn - 1/r, 1/m.
    kg, tg : (k,)
        1/m.
    held : bool
        Whether node marks hold the unshortened length.

    Returns
    -------
    Stresses
        Von Mises stress sqrt(sigma^2 + 3 tau^2) at the worse of edge and centre line, on the worse face, with the
        St-Venant shear of the long faces everywhere. Utilisation is von Mises over strength, or, where the
        material has a shear strength of its own, the worse of normal and shear stress over their strengths.
    """
    weak, shear = bending(material, thickness, kg), torsion(material, thickness, tg)
    strong = strong_axis(material, height, curvature_error)
    edge, centre = helix(material, height, tg, height / 2), helix(material, height, tg, 0.0)
    tension = restraint(material, height, tg) if held else np.zeros_like(weak)
    normal = weak + np.maximum(strong + edge + tension, np.abs(centre + tension))
    mises = np.sqrt(normal**2 + 3 * shear**2)
    if material.shear_strength is None:
        utilisation = mises / material.strength
    else:
        utilisation = np.maximum(normal / material.strength, shear / material.shear_strength)
    return Stresses(weak, shear, edge, centre, tension, mises, utilisation)
