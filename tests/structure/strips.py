"""Straight strips in elements of equal length, for tests."""

import numpy as np

from lamella.base.material import Material
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import CrossSection, flat_strip
from lamella.structure.beam.poses import straight_poses
from lamella.structure.structure import Structure, make_structure

STEEL = Material(7850, 200e9, 77e9, 235e6)
HEIGHT, THICKNESS = 0.1, 0.0015
STRIP = flat_strip(STEEL, HEIGHT, THICKNESS)
STIFF_ACROSS = flat_strip(STEEL, HEIGHT, THICKNESS, flat_across=True)


def rod(axial=1e8, torsion=8.0, about_u=2.5e4, about_n=5.6, **others) -> CrossSection:
    """A section that does not shear."""
    return CrossSection(axial, np.inf, np.inf, torsion, about_u, about_n, **others)


def strip(elements: int, length: float, section: CrossSection, held: dict[int, str], **options) -> Structure:
    """Along x, upright along z; the node -1 is the last one."""
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes, length / elements, section, **options)
    supports = {node % (elements + 1): what for node, what in held.items()}
    return make_structure(straight_poses(length, elements), beams, supports)


def orders(errors) -> np.ndarray:
    """Order with which errors fall, each with elements half as long as the one before."""
    return np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
