"""The joint of two lamellas on two levels: plates, spacers, carriage bolt and nut.

The A pair stands below the B pair; no strip is slotted. The bolt on the node's axis runs between the layers of both
pairs, through a plate below the A pair, one between the pairs and one above the B pair. A spacer between the layers of
either pair is fixed to the plate in the middle: the two of them hold the angle, and keep the layers apart. The strips
are clamped between the plates; they have no hole for the bolt. The paper shows the timber prototype (Figure 12) and no
joint of it: measures are ours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.hardware.classes import classes, rounded_down
from lamella.hardware.fasteners import carriage_bolts, flange_nuts, neck_hole
from lamella.hardware.grid_joint import ANGLE_STEP, check_room
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import LayerFaces, ahead
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import MM, SEAT_PLAY, JointRules
from lamella.hardware.shape import Prism, circle, crossed, rectangle
from lamella.hardware.shear_blocks import WIDTH_ROUNDING, WIDTH_STEP
from lamella.strip.lamellas import Lamellas

ACROSS = np.linspace(-0.5, 0.5, 5)
"""Places along a plate and a spacer where the strips are looked at, as shares of its length."""

SPACER_SHORT = 0.001
"""m; a spacer is lower than the strips: the bolt clamps these."""


@dataclass(frozen=True, eq=False)
class StackedJoints:
    """Joints of all crossings.

    Attributes
    ----------
    items : tuple of Item
    upper : (q,)
        Height over the surface of the faces on which plates lie above the B lamellas, m.
    angle_play : float
        How far a spacer may turn between its layers at most, deg.
    """

    items: tuple[Item, ...]
    upper: Floats
    angle_play: float


@dataclass(frozen=True, eq=False)
class _Level:
    """The strips of one family at the nodes, in the nodes' axes.

    Attributes
    ----------
    low, high : (q,)
        The lowest and the highest place of their edges near the node, m.
    width : (q,)
        What the innermost layers leave for a spacer, m.
    middle : (q,)
        Of that, to the left of the node's axis, m.
    along, left : (q, 3)
        Unit vectors of the lamella and to its left, across the node's axis.
    """

    low: Floats
    high: Floats
    width: Floats
    middle: Floats
    along: Floats
    left: Floats


def joint_length(rules: JointRules, lamellas: Lamellas) -> float:
    """Of plates and spacers of stacked lamellas, m."""
    return rules.star_width(lamellas.section) if rules.washer_length is None else rules.washer_length


def stacked_upper(frames: NodeFrames, lamellas: Lamellas, rules: JointRules) -> Floats:
    """Height over the surface of the plates' lower faces above the B lamellas, m, (q,)."""
    return _level(frames, lamellas, frames.stop_b, joint_length(rules, lamellas)).high + SEAT_PLAY


def stacked_joints(
    frames: NodeFrames, lamellas: Lamellas, rules: JointRules, *, clamp: Floats | None = None
) -> StackedJoints:
    """Plates, spacers, bolts and nuts of all nodes.

    Parameters
    ----------
    frames : NodeFrames
    lamellas : Lamellas
        On two levels.
    rules : JointRules
    clamp : (q,), optional
        Height of what lies on the upper plate under the bolt's head, m.

    Raises
    ------
    InputError
        Joints of neighbouring nodes would meet, levels are too near to each other, or there is no room for a spacer.
    """
    section, size, thickness = lamellas.section, rules.size, rules.washer_thickness
    length = joint_length(rules, lamellas)
    check_room(frames, lamellas, length)
    below, above = (_level(frames, lamellas, stops, length) for stops in (frames.stop_a, frames.stop_b))
    clear = above.low - below.high
    if len(frames) and clear.min() < thickness + 2 * SEAT_PLAY:
        gap = 2 * section.level - section.height
        needed = gap + thickness + 2 * SEAT_PLAY - float(clear.min())
        raise InputError(
            f"at node {frames.nodes[np.argmin(clear)]} the levels leave {MM * clear.min():.4g} mm for a plate "
            f"{MM * thickness:g} mm thick: the strips bend and twist",
            f"write level_gap = {rounded(needed, up=True):g} or more",
            "level_gap",
        )
    between = (below.high + above.low - thickness) / 2
    upper, lower = above.high + SEAT_PLAY, below.low - SEAT_PLAY
    normal = frames.axes[:, 2]
    on_top = Places(frames.origins + upper[:, None] * normal, _axes(above, normal), frames.labels)
    # turned over: along A, downwards
    under = Places(frames.origins + lower[:, None] * normal, _axes(below, -normal), frames.labels)
    items = _plates(frames, rules, length, between, on_top, under)
    spacers, angle_play = _spacers(frames, lamellas, rules, length, below, above, between)
    items += spacers
    raised = thickness + (np.zeros(len(frames)) if clamp is None else clamp)
    if len(frames):
        items += carriage_bolts("bolt", rules, size, on_top.moved(raised), upper - lower + thickness + raised)
        items.append(flange_nuts("nut", rules, size, under.moved(np.full(len(frames), thickness))))
    return StackedJoints(tuple(items), upper, angle_play)


def _level(frames: NodeFrames, lamellas: Lamellas, stops: Integers, length: float) -> _Level:
    network, section = lamellas.network, lamellas.section
    owner, arcs = network.stop_owner[stops], network.stop_arclengths[stops]
    half, normal = section.height / 2, frames.axes[:, 2]
    edges = []
    x = length * ACROSS
    for z in (-half, half):
        faces = LayerFaces.of(lamellas, owner, arcs, x, np.full(len(x), z))
        both = np.concatenate([*faces.right, *faces.left], axis=1)
        edges.append(ahead(both, frames.origins, normal))
    inner = np.linspace(-half, half, len(ACROSS))
    grid_x, grid_z = np.repeat(x, len(inner)), np.tile(inner, len(x))
    faces = LayerFaces.of(lamellas, owner, arcs, grid_x, grid_z)
    row = section.layers // 2
    tangent = network.sample_tangents[network.sample_offsets[owner] + network.stop_samples[stops]]
    along = tangent - np.einsum("ij,ij->i", tangent, normal)[:, None] * normal
    along /= np.linalg.norm(along, axis=1)[:, None]
    left = np.cross(normal, along)
    to_right = ahead(faces.left[row - 1], frames.origins, left).max(axis=1)
    to_left = ahead(faces.right[row], frames.origins, left).min(axis=1)
    return _Level(
        edges[0].min(axis=1),
        edges[1].max(axis=1),
        to_left - to_right,
        (to_left + to_right) / 2,
        along,
        left,
    )


def _axes(level: _Level, up: Floats) -> Floats:
    """Axes (q, 3, 3) of a plate: x along the lamella, z up or down."""
    return np.stack([level.along, np.cross(up, level.along), up], axis=1)


def _plates(
    frames: NodeFrames, rules: JointRules, length: float, between: Floats, on_top: Places, under: Places
) -> list[Item]:
    """Plates above and below, one kind; plates in the middle, one kind for each angle of the lamellas."""
    thickness, size = rules.washer_thickness, rules.size
    plate = Prism(rectangle(length, length), 0.0, thickness, (neck_hole(size),))
    places = Places(
        np.concatenate([on_top.origins, under.origins]),
        np.concatenate([on_top.axes, under.axes]),
        (*(f"{label} above" for label in on_top.labels), *(f"{label} below" for label in under.labels)),
    )
    text = f"plate {MM * length:.4g} x {MM * length:.4g} x {MM * thickness:g} mm"
    items = [Item("washer-1", "washer", text, rules.material, rules.density, (plate,), places, plate=True)]
    kind, angles = classes(np.degrees(frames.angles), ANGLE_STEP)
    middle = frames.above.moved(between)
    for number, angle in enumerate(angles.tolist()):
        # a bar along either pair: the spacers are fixed to it
        width = rules.size.hole + 2 * thickness
        shape = Prism(crossed(length / 2, width / 2, np.radians(angle)), 0.0, thickness, (circle(size.hole),))
        text = f"cross plate {MM * length:.4g} x {MM * thickness:g} mm, {angle:g} deg, hole {MM * size.hole:g} mm"
        at = middle.chosen(kind == number)
        name = f"cross-{number + 1}"
        items.append(Item(name, "cross plate", text, rules.material, rules.density, (shape,), at, plate=True))
    return items


def _spacers(
    frames: NodeFrames,
    lamellas: Lamellas,
    rules: JointRules,
    length: float,
    below: _Level,
    above: _Level,
    between: Floats,
) -> tuple[list[Item], float]:
    """Spacers between the layers of both pairs, below and above the plate in the middle; how far they may turn, deg."""
    size, height = rules.size, lamellas.section.height - SPACER_SHORT
    normal = frames.axes[:, 2]
    # around the node's axis, where the bolt is
    free = np.concatenate([one.width / 2 - np.abs(one.middle) for one in (below, above)]) - rules.play
    least = size.hole / 2 + SPACER_SHORT
    if len(free) and free.min() < least:
        node = int(frames.nodes[int(np.argmin(free)) % len(frames)])
        raise InputError(
            f"at node {node} the layers leave {2 * MM * free.min():.3g} mm for a spacer around a bolt {size.name}, "
            f"which takes {2 * MM * least:.3g} mm",
            "choose a larger offset, a smaller bolt, a shorter washer_length or a lower strip",
            "bolt",
        )
    kind, smallest = classes(2 * free, WIDTH_STEP, lowest=True)
    widths = rounded_down(smallest, WIDTH_ROUNDING)
    # between the plates of either level, at the end of the one in the middle
    thickness = rules.washer_thickness
    low = np.concatenate([between - height - SEAT_PLAY, between + thickness + SEAT_PLAY])
    axes = np.concatenate([_axes(one, normal) for one in (below, above)])
    origins = np.tile(frames.origins, (2, 1)) + low[:, None] * np.tile(normal, (2, 1))
    labels = (*(f"{label} A" for label in frames.labels), *(f"{label} B" for label in frames.labels))
    places = Places(origins, axes, labels)
    items = []
    for number, width in enumerate(widths.tolist()):
        shape = Prism(rectangle(length, width), 0.0, height, (circle(size.hole),))
        text = (
            f"spacer {MM * length:.4g} x {MM * width:.4g} x {MM * height:.4g} mm, hole {MM * size.hole:g} mm, fixed "
            "to the cross plate"
        )
        material, density = rules.block
        at = places.chosen(kind == number)
        items.append(Item(f"spacer-{number + 1}", "spacer", text, material, density, (shape,), at))
    turn = float(((2 * (free + rules.play) - widths[kind]) / length).max(initial=0.0)) if len(free) else 0.0
    return items, float(np.degrees(turn))
