"""Cables along the diagonals of a net, in pairs, and the cross clamps that hold them at the nodes.

Cables run above the upper washers, flat under a clamp and straight from clamp to clamp. A clamp's arms reach beyond the
washer, so that a cable that leaves it at an angle does not rest on the washer's edges. Where both kinds of diagonals
meet, the first kind lies below the second one. A clamp is a cross-shaped plate under the head of the node's bolt; the
pair of a line passes the bolt on either side.

A cable is cut to the length between its ends at the clamps, less the turnbuckle that stretches it and less what the
prestress lengthens it by, P L / (E A), plus a length for each end's fitting.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.hardware.diagonals import Diagonal, diagonals
from lamella.hardware.fasteners import neck_hole
from lamella.hardware.item import Item, Places
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import FILLING, MM, CableRules, JointRules
from lamella.hardware.shape import Prism, Sweep, circle, crossed
from lamella.network.network import Network
from lamella.strip.lamellas import Section

FITTING = 0.05
"""m; cable in the fitting at either end."""

STRAND_DENSITY = 7900.0
"""kg/m3; of its wires."""

ARM_BEYOND = 0.002
"""m; how far beyond the washer, and beyond the clamp, a cable bends."""

TURNBUCKLE_OUTSIDE, TURNBUCKLE_INSIDE = 2.0, 1.2
"""Cable diameters of the tube that a turnbuckle is drawn as, which has about its mass."""

BESIDE_BOLT = 0.001
"""m; between a bolt and the cables beside it."""


@dataclass(frozen=True, eq=False)
class Cables:
    """Cables and clamps, and what these need of the joints.

    Attributes
    ----------
    items : tuple of Item
    above : (q,)
        Height of cables and clamp between the upper washer and the bolt's head, m.
    """

    items: tuple[Item, ...]
    above: Floats


def cables(
    network: Network, frames: NodeFrames, section: Section, seats: Floats, rules: JointRules, measures: CableRules
) -> Cables:
    """Cables along every n-th diagonal.

    Parameters
    ----------
    network : Network
    frames : NodeFrames
    section : Section
    seats : (q,)
        Height of the upper washers' upper faces over the nodes, m.
    rules : JointRules
    measures : CableRules

    Raises
    ------
    InputError
        A prestress the cable cannot bear.
    """
    if measures.stretch > 0.01:
        largest = 0.01 * measures.prestress / measures.stretch
        raise InputError(
            f"a prestress of {measures.prestress:g} N lengthens a cable of {MM * measures.diameter:g} mm by "
            f"{100 * measures.stretch:.3g} %, more than 1 %",
            f"write {largest:.3g} N or less, or a thicker cable",
            "prestress",
        )
    lines = diagonals(network, frames, measures.every)
    number = np.full(len(network.node_points), -1)
    number[frames.nodes] = np.arange(len(frames))
    # beyond the washers' inner corners, whose sides lead away from the line, and the cables of the other kind
    outer = _beside(rules, measures) + measures.diameter / 2
    half = frames.least_angle / 2
    corner = rules.star_width(section) / 2 / np.sin(half) + outer / np.tan(half)
    arm = float(max(corner, outer + measures.diameter)) + ARM_BEYOND
    has = np.zeros((2, len(frames)), bool)
    for line in lines:
        has[0 if line.first else 1, number[line.nodes]] = True
    level = np.where(has.all(axis=0), 1, 0)
    stretched: list[tuple[Floats, str]] = []
    items = [
        item
        for k, line in enumerate(lines)
        for item in _pair(f"cable-{k + 1}", line, frames, number, seats, level, rules, measures, arm, stretched)
    ]
    items += _turnbuckles(stretched, rules, measures)
    above = measures.diameter * has.sum(axis=0) + np.where(has.any(axis=0), rules.washer_thickness, 0.0)
    items += _clamps(frames, seats, has, rules, measures, arm)
    return Cables(tuple(items), above)


def _pair(
    name: str,
    line: Diagonal,
    frames: NodeFrames,
    number: Integers,
    seats: Floats,
    level: Integers,
    rules: JointRules,
    measures: CableRules,
    arm: float,
    stretched: list[tuple[Floats, str]],
) -> list[Item]:
    """The two cables of a line; `arm` is half the length of a clamp, m. Those with turnbuckles go to `stretched`."""
    at = number[line.nodes]
    normal = frames.axes[at, 2]
    height = seats[at] + measures.diameter * (0.5 + (0 if line.first else level[at]))
    middle = frames.origins[at] + height[:, None] * normal
    chord = np.gradient(middle, axis=0)
    if line.closed:
        chord[[0, -1]] = middle[1] - middle[-2]
    aside = np.cross(normal, chord)
    aside /= np.linalg.norm(aside, axis=1)[:, None]
    along = arm * np.cross(aside, normal)
    up = np.repeat(normal, 2, axis=0)
    found = []
    for side, sign in (("right", -1.0), ("left", 1.0)):
        beside = middle + sign * _beside(rules, measures) * aside
        points = np.stack([beside - along, beside + along], axis=1).reshape(-1, 3)
        if line.closed:
            # from the middle of the first clamp around to it
            points = np.concatenate([beside[:1], points[1:-1], beside[:1]])
            up = np.concatenate([normal[:1], np.repeat(normal, 2, axis=0)[1:-1], normal[:1]])
        free = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        length = (free - measures.turnbuckle) / (1 + measures.stretch) + 2 * FITTING
        if length <= 2 * FITTING:
            continue
        metal = FILLING * np.pi / 4 * measures.diameter**2
        shape = Sweep(circle(measures.diameter), points, up)
        here = f"nodes {line.nodes[0]} to {line.nodes[-1]} {side}"
        places = Places(np.zeros((1, 3)), np.eye(3)[None], (here,))
        text = f"cable {MM * measures.diameter:g} mm, cut to {MM * length:.1f} mm"
        density = metal * length * STRAND_DENSITY / shape.volume
        if measures.turnbuckle:
            stretched.append((points, f"{name}-{side}"))
        found.append(Item(f"{name}-{side}", "cable", text, rules.material, density, (shape,), places, length=length))
    return found


def _turnbuckles(stretched: list[tuple[Floats, str]], rules: JointRules, measures: CableRules) -> list[Item]:
    """A turnbuckle for every cable with points (k, 3), drawn as a tube around the middle of its longest straight piece.

    Raises
    ------
    InputError
        No piece of a cable is as long.
    """
    if not stretched:
        return []
    origins, axes = [], []
    for points, _ in stretched:
        pieces = np.diff(points, axis=0)
        lengths = np.linalg.norm(pieces, axis=1)
        k = int(np.argmax(np.round(lengths, 6)))
        if lengths[k] <= measures.turnbuckle:
            raise InputError(
                f"a turnbuckle {MM * measures.turnbuckle:g} mm long does not fit between clamps that leave "
                f"{MM * lengths[k]:.4g} mm",
                f"write turnbuckle = {rounded(0.9 * float(lengths[k]), up=False):g} or less",
                "turnbuckle",
            )
        z = pieces[k] / lengths[k]
        x = np.cross(z, np.eye(3)[np.argmin(np.abs(np.round(z, 6)))])
        x /= np.linalg.norm(x)
        origins.append((points[k] + points[k + 1]) / 2)
        axes.append(np.stack([x, np.cross(z, x), z]))
    half = measures.turnbuckle / 2
    inner = circle(TURNBUCKLE_INSIDE * measures.diameter)
    shape = Prism(circle(TURNBUCKLE_OUTSIDE * measures.diameter), -half, half, (inner,))
    places = Places(np.array(origins), np.array(axes), tuple(name for _, name in stretched))
    text = f"turnbuckle {MM * measures.turnbuckle:g} mm for a cable of {MM * measures.diameter:g} mm"
    return [Item("turnbuckle-1", "turnbuckle", text, rules.material, rules.density, (shape,), places)]


def _beside(rules: JointRules, measures: CableRules) -> float:
    """From a bolt's axis to a cable's, m."""
    return rules.size.diameter / 2 + measures.diameter / 2 + BESIDE_BOLT


def _clamps(
    frames: NodeFrames, seats: Floats, has: Booleans, rules: JointRules, measures: CableRules, arm: float
) -> list[Item]:
    """Clamps on top of the cables, one kind for nodes of one height."""
    reach = _beside(rules, measures) + measures.diameter
    plate = Prism(crossed(arm - ARM_BEYOND, reach, np.pi / 2), 0.0, rules.washer_thickness, (neck_hole(rules.size),))
    some = np.flatnonzero(has.any(axis=0))
    if not len(some):
        return []
    # its arms lie along the cables: halfway between the lamellas
    turn = frames.angles[some] / 2
    x = np.cos(turn)[:, None] * frames.axes[some, 0] + np.sin(turn)[:, None] * frames.axes[some, 1]
    normal = frames.axes[some, 2]
    axes = np.stack([x, np.cross(normal, x), normal], axis=1)
    height = seats[some] + measures.diameter * has[:, some].sum(axis=0)
    labels = tuple(frames.labels[k] for k in some.tolist())
    places = Places(frames.origins[some] + height[:, None] * normal, axes, labels)
    text = f"cross clamp {2 * MM * (arm - ARM_BEYOND):.4g} x {MM * rules.washer_thickness:g} mm"
    return [Item("clamp-1", "clamp", text, rules.material, rules.density, (plate,), places, plate=True)]
