"""Sections that are not overstressed: how thin, how low, how strong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from lamella.base.wording import rounded
from lamella.strip.lamellas import Section

# of the measure found, what is offered: utilisations are compared with 1
OFFERED_UTILISATION = 0.995
# of the present measure, below which it is no remedy
MEASURE_SHARE_MIN = 0.2
HALVINGS = 6
# a section of this share of the present one in height and thickness is no strip any more
LEAST_SCALE = 1e-3


def bearable(
    section: Section, measure: Literal["thickness", "height"], utilisation: Callable[[Section], float]
) -> float | None:
    """The largest thickness or height with which no lamella is overstressed, m, to three digits.

    Bending grows with the thickness, torsion too, the helix stress with the square of the height; what more is counted
    is the caller's: utilisations are computed anew.

    Parameters
    ----------
    section : Section
        Overstressed.
    measure : "thickness" or "height"
    utilisation : callable
        Largest utilisation of a section.

    Returns
    -------
    float or None
        None: a fifth of the present one would not do, or the strip would no more stand on edge.
    """
    present = float(getattr(section, measure))
    low = present * MEASURE_SHARE_MIN
    if measure == "height":
        low = max(low, 2.5 * section.thickness)
    high = present

    def fits(value: float) -> bool:
        thin = replace(section, thickness=value) if measure == "thickness" else replace(section, height=value)
        return utilisation(thin) <= 1

    if low >= high or not fits(low):
        return None
    for _ in range(HALVINGS):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if fits(middle) else (low, middle)
    return rounded(OFFERED_UTILISATION * low, up=False)


def bearable_scale(section: Section, utilisation: Callable[[Section], float]) -> tuple[float, float] | None:
    """The largest height and thickness, m, in the present proportion with which no lamella is overstressed.

    None: not even a section of `LEAST_SCALE` of the present one would do.
    """

    def scaled(share: float) -> Section:
        return replace(section, height=share * section.height, thickness=share * section.thickness)

    high, low = 1.0, 0.5
    while utilisation(scaled(low)) > 1:
        high, low = low, low / 2
        if low < LEAST_SCALE:
            return None
    for _ in range(HALVINGS):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if utilisation(scaled(middle)) <= 1 else (low, middle)
    small = scaled(OFFERED_UTILISATION * low)
    return rounded(small.height, up=False), rounded(small.thickness, up=False)
