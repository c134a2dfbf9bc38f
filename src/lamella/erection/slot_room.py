r"""How far a joint may turn in its slots.

A strip of thickness t that goes through a slot at the angle a off square needs the width
:math:`w = t \, (1 + \sin a) / \cos a`: 1.30 t at 15, 1.73 t at 30, 2.00 t at 36.87 and 2.41 t at 45 degrees. With
:math:`\tan(\pi/4 + a/2) = (1 + \sin a) / \cos a` the largest angle is :math:`a = 2 \arctan(w / t) - \pi / 2`.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError


def slot_width_needed(off_square: Floats, thickness: float) -> Floats:
    """Width of slots in which a strip may stand off square.

    Parameters
    ----------
    off_square : (...)
        Angle from 90 degrees between the strips, rad, of either sign; below a right angle.
    thickness : float
        Of the strip, m.

    Returns
    -------
    (...)
        m.
    """
    return np.asarray(thickness * np.tan(np.pi / 4 + np.abs(off_square) / 2))


def largest_turn(slot_width: float, thickness: float) -> float:
    """Angle off square at which a strip touches both sides of its slot, rad.

    Raises
    ------
    InputError
        A slot that is narrower than the strip.
    """
    if not slot_width >= thickness > 0:
        raise InputError(
            f"slot_width = {slot_width!r} m is less than the thickness of {thickness!r} m",
            "a slot has to be as wide as the strip in it",
            "slot_width",
        )
    return float(2 * np.arctan(slot_width / thickness) - np.pi / 2)
