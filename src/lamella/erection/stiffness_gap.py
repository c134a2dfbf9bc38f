"""Whether a net opens in one way only."""

from __future__ import annotations

from lamella.structure.equilibrium import Equilibrium
from lamella.structure.vibration import vibration


def stiffness_gap(equilibrium: Equilibrium) -> float | None:
    """How much stiffer the second easiest motion is than the easiest one: 1 - k1 / k2, from 0 to 1.

    Motions are orthogonal in the mass matrix, k their generalised stiffness per generalised mass: squares of the two
    lowest natural frequencies with free joints. Near 1 the net follows one motion, a mechanism of one degree of
    freedom; near 0 a second motion is as easy, and on site it opens in any mixture of both.

    Returns
    -------
    float or None
        None where the equilibrium is not stable without the driver.
    """
    if equilibrium.negative:
        return None
    frequencies = vibration(equilibrium, 2).frequencies
    if len(frequencies) < 2:
        return None
    return float(1 - (frequencies[0] / frequencies[1]) ** 2)
