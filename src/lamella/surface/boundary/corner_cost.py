"""What corners of a boundary cost, before a film is looked for: its elements are graded to each of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.message import Message
from lamella.surface.boundary.checks import CORNER_TOLERANCE, LEAST_TURN
from lamella.surface.boundary.curve import Loop

MANY_CORNERS = 30
"""A film between fewer takes seconds."""

NODES = 1000, 2700
"""Around a corner, with elements of order 4: 1,000 at a tolerance of 0.1, at `CORNER_TOLERANCE` up to 2,700 (see
`lamella.surface.boundary.checks`)."""

LOOSE = 0.2
"""Tolerance that is kept without refining again and again: a polygon of 36 corners took 9 s, and 27 s at 0.1."""

SECONDS_PER_NODE = 1e-3
"""CPU time of all refinements together: 37 s for a polygon of 30 corners, whose film took 35,000 nodes."""


def corner_cost(loops: Sequence[Loop], most_nodes: int, tolerance: float) -> Message | None:
    """How many nodes and how long a boundary of many corners takes, and what takes less; None for few corners.

    Parameters
    ----------
    loops : sequence of Loop
    most_nodes : int
    tolerance : float
        Of the film's curvature, over the curvature scale; nothing is said at `LOOSE` and above.
    """
    counts = [int((loop.turns > LEAST_TURN).sum()) for loop in loops]
    total = sum(counts)
    if total < MANY_CORNERS or tolerance >= LOOSE:
        return None
    k = int(np.argmax(counts))
    least, most = (total * nodes for nodes in NODES)
    minutes = max(round(SECONDS_PER_NODE * most / 60), 1)
    finer = f", more at tolerance = {tolerance:g}" if tolerance < CORNER_TOLERANCE else ""
    limit = f", most_nodes = {most_nodes:,} may be too few" if most > most_nodes else ""
    return Message(
        "corners_many",
        f"the boundary has {total:,} corners, {counts[k]:,} of them in the loop {loops[k].name!r}: down to "
        f"tolerance = {CORNER_TOLERANCE:g} the film takes about {least:,} to {most:,} nodes around them and about "
        f'{minutes} min{finer}{limit}; where the loop\'s points mean a curve, interpolation = "spline" takes seconds, '
        f"otherwise fewer corners, or tolerance = {LOOSE:g}, take less",
    )
