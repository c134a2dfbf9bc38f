"""Cross sections of lamellas of several layers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.material import Material
from lamella.strip.lamellas import Section
from lamella.structure.beam.cross_section import CrossSection, flat_strip

SUMMED = ("axial", "shear_u", "shear_n", "torsion", "bending_u", "bending_n", "helix", "mass")
"""What layers beside each other have together as a sum."""


def layers_section(material: Material, section: Section) -> CrossSection:
    """All layers of a lamella as one section: they are bent and twisted alike, each about its own axis.

    Layers that slip on one another between the nodes have no more; what shear blocks add is left out.
    """
    strip = flat_strip(material, section.height, section.thickness)
    count = section.layers
    beside = float(np.mean(np.square(section.layer_offsets)))
    summed = {name: count * getattr(strip, name) for name in SUMMED}
    return replace(
        strip,
        **summed,
        inertia_t=count * (strip.inertia_t + strip.mass * beside),
        inertia_u=count * strip.inertia_u,
        inertia_n=count * (strip.inertia_n + strip.mass * beside),
    )
