"""Which bracing a net needs before it is lifted: at two, three and four points, with each bracing that there is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.progress import Progress, Report, silent
from lamella.erection.bracings import Bracings
from lamella.erection.lifted import Lifted, lifted
from lamella.erection.lifting_points import lifting_points
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas, crossings
from lamella.structure.actions.node_supports import no_supports


@dataclass(frozen=True, eq=False)
class LiftCase:
    """A net lifted at some nodes.

    Attributes
    ----------
    points : int
    bracing : str
        "none", "cables", "edge_beams" or "both".
    lifted : Lifted
    holds : bool
        Whether it bends by no more than the limit.
    """

    points: int
    bracing: str
    lifted: Lifted
    holds: bool


@dataclass(frozen=True, eq=False)
class LiftRules:
    """How nets are lifted.

    Attributes
    ----------
    counts : sequence of int
        Numbers of points.
    nodes : (p,) int or None
        Instead of those: the nodes that the net is lifted at.
    hook, diameter
        See `lifted`.
    limit : float
        Of the deflection, over the net's extent.
    """

    counts: Sequence[int] = (2, 3, 4)
    nodes: Integers | None = None
    hook: float | None = None
    diameter: float = 0.01
    limit: float = 0.02


def lift_cases(
    lamellas: Lamellas,
    rules: LiftRules,
    bracings: Bracings,
    *,
    elements: int = 2,
    node_masses: Floats | None = None,
    progress: Progress = silent,
) -> tuple[LiftCase, ...]:
    """A net in the crane, by number of points and by bracing.

    Parameters
    ----------
    lamellas : Lamellas
        Of a net or of a segment of it.
    rules : LiftRules
    bracings : Bracings
    elements : int
        Beam elements in a cell edge.
    node_masses : (n,), optional
        See `lifted`.
    progress : callable

    Returns
    -------
    tuple of LiftCase
        Numbers of points for which there are no nodes are left out.
    """
    network = lamellas.network
    places = [rules.nodes] if rules.nodes is not None else [_nodes(network, count) for count in rules.counts]
    found = []
    for name, model in bracings.models(lamellas, no_supports(len(network.node_points)), elements):
        progress(Report.detail(f"lifted, bracing: {name.replace('_', ' ')}"))
        limit = rules.limit * model.structure.size
        for nodes in places:
            if not len(nodes):
                continue
            one = lifted(model, nodes, hook=rules.hook, diameter=rules.diameter, node_masses=node_masses)
            holds = one.deflection is not None and one.deflection <= limit
            found.append(LiftCase(len(nodes), name, one, holds))
    return tuple(found)


def least_bracing(cases: Sequence[LiftCase], points: int) -> str | None:
    """The first bracing that holds a net lifted at so many points; None where none does."""
    return next((case.bracing for case in cases if case.points == points and case.holds), None)


def _nodes(network: Network, count: int) -> Integers:
    """Joints around the centre of the lamellas' lengths, and any nodes where these do not surround it."""
    reached = np.unique(network.stop_nodes)
    points = network.node_points
    centre = _centre(network)
    joints = np.flatnonzero(crossings(network))
    found = lifting_points(joints, points[joints], centre, count)
    return found if len(found) else lifting_points(reached, points[reached], centre, count)


def _centre(network: Network) -> Floats:
    """Of gravity of lamellas that weigh the same by length, m."""
    points, owner = network.sample_points, np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))
    inside = owner[1:] == owner[:-1]
    length = np.diff(network.sample_arclengths)[inside]
    middle = (0.5 * (points[1:] + points[:-1]))[inside]
    return np.asarray(length @ middle / length.sum())
