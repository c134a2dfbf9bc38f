"""What drives a net, from the table [erection]: its points are those of nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.arrays import Integers
from lamella.base.drawing_origin import coordinates, drawing_origin
from lamella.base.errors import InputError
from lamella.erection.ground import Ground
from lamella.erection.moved_nodes import Lift, Ring, Together
from lamella.erection.rigged import Device
from lamella.erection.ropes import Ropes
from lamella.erection.turned_joints import TurnedJoints
from lamella.hardware.diagonals import diagonals
from lamella.hardware.node_frames import NodeFrames
from lamella.network.network import Network
from lamella.project.driver_table import RadiusTable
from lamella.project.erection_table import ErectionTable
from lamella.stages.actions_of_tables import rims_of
from lamella.stages.keys import keys
from lamella.stages.stage import Upstream

# decimals of a distance, m: nodes that are as far away but for rounding are alike, and the first of them counts
DISTANCE_DIGITS = 9


def device_of(up: Upstream, network: Network) -> Device | None:
    """What drives the whole net; None: moments in its joints alone."""
    table = up.project.erection
    assert table is not None
    driver = table.driver
    with keys("erection.driver"):
        if driver.cable is not None:
            ends = [nodes_near(up, network, one.between, f"cable[{k}].between") for k, one in enumerate(driver.cable)]
            by, diameter = (np.array([getattr(one, key) for one in driver.cable]) for key in ("by", "diameter"))
            return Ropes(np.array(ends), by, diameter)
        if driver.lift is not None:
            return Lift(np.unique(nodes_near(up, network, driver.lift.at, "lift.at")), driver.lift.by)
        if driver.supports is not None:
            return Together(np.unique(nodes_near(up, network, driver.supports.at, "supports.at")), driver.supports.by)
        if driver.radius is not None:
            return Ring(_ring(up, network, driver.radius), driver.radius.factor)
    return TurnedJoints() if table.on_ground else None


def ground_of(up: Upstream, network: Network, table: ErectionTable) -> Ground:
    """What the net stands on."""
    with keys("erection"):
        props = np.unique(nodes_near(up, network, table.props or (), "props"))
    return Ground(table.weighs, props)


def nodes_near(up: Upstream, network: Network, points: Sequence[tuple[float, ...]], where: str) -> Integers:
    """The nodes of lamellas that are nearest to points of the drawing, (p,)."""
    reached = np.unique(network.stop_nodes)
    places = network.node_points[reached] + np.array(drawing_origin(up.surface), float)
    given = np.array(points, float).reshape(-1, 3)
    away = np.linalg.norm(places - given[:, None], axis=2)
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    far = np.flatnonzero(away.min(1, initial=np.inf) > size)
    if len(far):
        point = given[far[0]] - np.array(drawing_origin(up.surface), float)
        raise InputError(
            f"the point {coordinates(point)} is {float(away[far[0]].min()):.4g} m away from the nearest node of a net "
            f"of {size:.4g} m",
            "give a point of the net, in m",
            where,
        )
    return np.asarray(reached[np.round(away, DISTANCE_DIGITS).argmin(1)] if len(given) else np.zeros(0, np.int64))


def _ring(up: Upstream, network: Network, table: RadiusTable) -> Integers:
    """Nodes of a boundary, or of the closed line of diagonals through a node."""
    if table.boundary is not None:
        with keys("radius"):
            on_it = rims_of(up.project, network, up.surface).on(table.boundary)
        found: Integers = np.flatnonzero(on_it & np.isin(np.arange(len(on_it)), network.stop_nodes))
        where = "radius.boundary"
    else:
        assert table.through is not None
        (node,) = nodes_near(up, network, [table.through], "radius.through").tolist()
        lines = [line.nodes for line in diagonals(network, NodeFrames.of(network), 1) if line.closed]
        found = np.unique(next((line for line in lines if node in line), np.zeros(0, np.int64)))
        where = "radius.through"
    if len(found) < 3:
        raise InputError(
            "no closed line of diagonals goes through the node there" if table.through else "fewer than three nodes",
            "name a boundary, or a point on a ring of nodes that closes",
            where,
        )
    return found
