"""What is told of a way that a device drives a net along."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers


@dataclass(frozen=True)
class Snap:
    """A net that went over to another equilibrium.

    Attributes
    ----------
    share : float
        Of the way at which it has arrived.
    state : int
        Number of that state, the first is 0.
    node : int
        That moved farthest.
    distance : float
        By which it did from one state to the next, m.
    """

    share: float
    state: int
    node: int
    distance: float


@dataclass(frozen=True, eq=False)
class Way:
    """A way driven by a device.

    Attributes
    ----------
    kind : str
        "cable", "lift", "radius", "supports" or "angles".
    start : str
        "flat" or "designed": what it begins in.
    unit : str
        Of the driver, "N" or "N m".
    gravity : bool
        Whether the net weighs, and lies on a floor.
    travel : float
        m, of joints rad.
    nodes : (p,) int
        Those that are moved, or the first end of each cable; then those that props raise.
    forces : (s, p)
        On them in every state, N: tensions of cables; of others along their way.
    snaps : tuple of Snap
    stop : Snap or None
        Where no further state was found: the node that moves farthest in the last one, and how far.
    off_design : float
        Largest distance of a node of the last state from where it was designed, after the best rigid motion, m.
    """

    kind: str
    start: str
    unit: str
    gravity: bool
    travel: float
    nodes: Integers
    forces: Floats
    snaps: tuple[Snap, ...]
    stop: Snap | None
    off_design: float


@dataclass(frozen=True)
class RangeOfMotion:
    """How far a net moves as a mechanism.

    Attributes
    ----------
    node : int
        Of the joint that the angles are told of.
    least, most : float
        Its angle in the first and the last state that was found, deg.
    """

    node: int
    least: float
    most: float
