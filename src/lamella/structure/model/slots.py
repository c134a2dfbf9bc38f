r"""What slots take from the stiffness of strips.

A slot is a notch of half the height. Where the strip is bent about its strong axis the notch is a crack-like hinge: one
of depth a = h/2 in the edge of a strip of height h turns under the moment M by

.. math:: \theta = \frac{4 \sigma}{E} V_2(a / h), \qquad \sigma = \frac{6 M}{t h^2}, \qquad V_2(\tfrac12) = 1.71

(H. Tada, P. C. Paris, G. R. Irwin, The Stress Analysis of Cracks Handbook, 3rd ed., ASME 2000, section 2.14), which is
as much as 3.42 h of strip. Along the slot's width half of the section is left for axial force, weak-axis bending and
torsion: as much as one slot width of strip more. The halves of that go to the two elements beside the node. The
lamella that fills the slot and the washers that clamp it are not counted: what holds the notch together makes the joint
stiffer than this.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.beams import Beams

NOTCH_OPENING = 5.93 - 19.69 / 2 + 37.14 / 4 - 35.84 / 8 + 13.12 / 16
"""V2 of a notch of half the height, where ((a / h) / (1 - a / h))^2 is 1."""

STRIP_LIKE_A_NOTCH = 4 * 6 / 12 * NOTCH_OPENING
"""Length of strip, over its height, that turns as much as a slot under a strong-axis moment."""


def slotted(beams: Beams, slots: Floats, height: float, slot_width: float) -> Beams:
    """Beams with slots at ends of some elements.

    Parameters
    ----------
    beams : Beams
    slots : (m,)
        Slots at either end of each element: 0, 1 or 2.
    height, slot_width : float
        m.
    """
    law, section = beams.law, beams.section
    stiffness = law.stiffness.copy()
    more, wide = slots * STRIP_LIKE_A_NOTCH * height / 2, slots * slot_width / 2
    for row in (0, 3, 5):
        stiffness[row] /= 1 + wide / law.length
    stiffness[4] /= 1 + more / law.length
    # S-bends: series of shear and of what is left of bending
    bend = law.length**2 / 12
    for row, shear, bending in ((1, "shear_u", 5), (2, "shear_n", 4)):
        flexible = np.array([1 / getattr(kind, shear) for kind in beams.sections], float)[section]
        stiffness[row] = law.length / (flexible + bend * law.length / stiffness[bending])
    return replace(beams, law=replace(law, stiffness=stiffness))
