"""The joint of two crossing lamellas: star washers, keys, carriage bolt and nut.

Two pairs of strips enclose a cell on the node's axis. A key, a plate that fills the cell up to its play, fixes the
angle; the star washer that it is fixed to lies across the strips' edges; a carriage bolt holds the washers above and
below together (Schling et al. 2018, Figure 13). The measures are ours: none of the built joint are published.

Around the node the surface is z = (kn x^2 + 2 tg x y + k y^2) / 2. A strip beside the axis at y = d leans by
-(tg x + k d) to the side for each metre above the surface, so that the cell narrows towards the strips' edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.hardware.classes import classes, rounded_down
from lamella.hardware.fasteners import carriage_bolts, flange_nuts, neck_hole
from lamella.hardware.item import Item, Places
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import MM, SEAT_PLAY, JointRules
from lamella.hardware.shape import Prism, crossed, rhombus
from lamella.strip.lamellas import Lamellas

KEY_STEP = 1e-3
"""m; keys whose cells differ by less are made alike, as large as the narrowest of them."""

KEY_ROUNDING = 1e-4
"""m; keys are a whole number of these wide."""

ANGLE_STEP = 0.5
"""deg; joints whose angles differ by less have the same washers."""

ALONG = np.linspace(-1.0, 1.0, 5)
"""Places along an arm where it may lie on the strips, as shares of its length."""


@dataclass(frozen=True, eq=False)
class GridJoints:
    """Joints of all crossings.

    Attributes
    ----------
    items : tuple of Item
    angle_play : float
        How far a key may turn between its strips at most, deg.
    """

    items: tuple[Item, ...]
    angle_play: float


def grid_joints(
    frames: NodeFrames, lamellas: Lamellas, rules: JointRules, *, clamp: Floats | None = None
) -> GridJoints:
    """Washers, keys, bolts and nuts.

    Parameters
    ----------
    frames : NodeFrames
    lamellas : Lamellas
    rules : JointRules
    clamp : (q,), optional
        Height of what lies on the upper washer under the bolt's head, m.

    Raises
    ------
    InputError
        The washers of neighbouring nodes would meet, or there is no room for a key.
    """
    section, size = lamellas.section, rules.size
    length, width = rules.star_length(section, frames.least_angle), rules.star_width(section)
    check_room(frames, lamellas, length)
    if length <= width / np.tan(frames.least_angle / 2):
        raise InputError(
            f"washer_length = {MM * length:.4g} mm leaves nothing of the arms beside strips that take "
            f"{MM * width:.4g} mm",
            f"write washer_length = {rounded(rules.least_star_length(section, frames.least_angle), up=True):g} or more",
            "washer_length",
        )
    angles = np.degrees(frames.angles)
    angle_class, angle_values = classes(angles, ANGLE_STEP)
    upper, lower = seats(frames, lamellas, length / 2)
    thickness = rules.washer_thickness
    on_top = frames.above.moved(section.height / 2 + upper)
    under = frames.below.moved(section.height / 2 + lower)
    items: list[Item] = []
    for kind, angle in enumerate(angle_values.tolist()):
        some = angle_class == kind
        # one hole for the neck: both washers of a node are the same part
        star = Prism(crossed(length / 2, width / 2, np.radians(angle)), 0.0, thickness, (neck_hole(size),))
        items.append(
            _item(
                f"washer-{kind + 1}",
                "washer",
                f"star washer {MM * length:.4g} x {MM * thickness:g} mm, {angle:g} deg",
                rules,
                star,
                _both(on_top.chosen(some), under.chosen(some)),
            )
        )
    keys, angle_play = _keys(frames, lamellas, rules, angle_class, angle_values, on_top, under)
    items += keys
    above = thickness + (np.zeros(len(frames)) if clamp is None else clamp)
    grip = section.height + upper + lower + thickness + above
    if len(frames):
        items += carriage_bolts("bolt", rules, size, on_top.moved(above), grip)
        items.append(flange_nuts("nut", rules, size, under.moved(np.full(len(frames), thickness))))
    return GridJoints(tuple(items), angle_play)


def check_room(frames: NodeFrames, lamellas: Lamellas, length: float) -> None:
    """Require that washers of neighbouring nodes do not meet."""
    network = lamellas.network
    joined = np.zeros(len(network.node_points), bool)
    joined[frames.nodes] = True
    owner, nodes = network.stop_owner, network.stop_nodes
    next_to = (owner[1:] == owner[:-1]) & joined[nodes[1:]] & joined[nodes[:-1]]
    edges = np.where(next_to, np.diff(network.stop_arclengths), np.inf)
    if not len(edges) or length <= edges.min():
        return
    at, shortest = int(np.argmin(edges)), float(edges.min())
    raise InputError(
        f"washers {MM * length:.4g} mm long do not fit between the nodes {nodes[at]} and {nodes[at + 1]}, "
        f"{MM * shortest:.4g} mm apart",
        f"write washer_length = {rounded(0.9 * shortest, up=False):g} or less, fewer cells, or washer = false",
        "washer_length",
    )


def seats(frames: NodeFrames, lamellas: Lamellas, reach: float) -> tuple[Floats, Floats]:
    """How far washers lie above the upper edge, and below the lower edge, of a strip at the node, m, (q,) each.

    They lie on the highest places of the strips that cross below them; strips that lean are lower there.
    """
    section = lamellas.section
    outer = (section.layers - 1) * section.offset / 2 + section.thickness / 2
    high = low = np.zeros(len(frames))
    for cosine, sine in ((np.ones(len(frames)), np.zeros(len(frames))), (np.cos(frames.angles), np.sin(frames.angles))):
        for side in (-outer, outer):
            x = reach * ALONG * cosine[:, None] - side * sine[:, None]
            y = reach * ALONG * sine[:, None] + side * cosine[:, None]
            z = frames.height(x, y)
            high, low = np.maximum(high, z.max(axis=1)), np.minimum(low, z.min(axis=1))
    # one corner of the edge of a strip that leans is higher than its middle
    bend = np.maximum(np.abs(frames.kn), np.abs(frames.across))
    corner = section.thickness / 2 * (np.abs(frames.tg) * reach + bend * outer) + SEAT_PLAY
    return high + corner, corner - low


def _keys(
    frames: NodeFrames,
    lamellas: Lamellas,
    rules: JointRules,
    angle_class: Integers,
    angle_values: Floats,
    on_top: Places,
    under: Places,
) -> tuple[list[Item], float]:
    """Keys, above and below alike, and how far they may turn, deg."""
    half = _key_half_widths(frames, lamellas, rules)
    least = rules.size.neck / 2 + rules.washer_thickness / 4
    if len(half) and half.min() < least:
        node = int(frames.nodes[np.argmin(half)])
        raise InputError(
            f"at node {node} the strips leave {2 * MM * half.min():.3g} mm for a key around a bolt {rules.size.name}, "
            f"which takes {2 * MM * least:.3g} mm",
            "choose a larger offset, a smaller bolt or a lower strip, or write washer = false",
            "bolt",
        )
    items: list[Item] = []
    turn = 0.0
    for kind, angle in enumerate(angle_values.tolist()):
        of_angle = np.flatnonzero(angle_class == kind)
        key_class, sizes = _key_sizes(half[of_angle])
        for number, size in enumerate(sizes.tolist()):
            some = of_angle[key_class == number]
            turn = max(turn, float((half[some] + rules.play - size).max()) / size)
            shape = Prism(rhombus(size, np.radians(angle)), -rules.washer_thickness, 0.0, (neck_hole(rules.size),))
            items.append(
                _item(
                    f"key-{len(items) + 1}",
                    "key",
                    f"key {2 * MM * size:.4g} x {MM * rules.washer_thickness:g} mm, {angle:g} deg, fixed to the washer",
                    rules,
                    shape,
                    _both(on_top.chosen(some), under.chosen(some)),
                )
            )
    return items, float(np.degrees(turn))


def _key_half_widths(frames: NodeFrames, lamellas: Lamellas, rules: JointRules) -> Floats:
    """Half of what the strips around each node's axis leave for a key, less its play, m, (q,)."""
    section = lamellas.section
    middle = section.layers // 2
    free = np.full(len(frames), np.inf)
    distances = frames.layer_distances(lamellas)
    for of_family in distances:
        inner = np.minimum(-of_family[middle - 1], of_family[middle])
        free = np.minimum(free, inner - section.thickness / 2)
    sine, cosine = np.sin(frames.angles), np.abs(np.cos(frames.angles))
    along = free * (1 + cosine) / sine
    # of both families: across the B lamella the surface is bent as it is along the A one
    bend = np.maximum(np.abs(frames.kn), np.abs(frames.across))
    lean = section.height / 2 * (np.abs(frames.tg) * along + bend * (free + section.thickness))
    return np.asarray(free - lean - frames.kg * along**2 / 2 - rules.play)


def _key_sizes(half: Floats) -> tuple[Integers, Floats]:
    """Which of the sizes each node has, and these, m."""
    kind, smallest = classes(half, KEY_STEP, lowest=True)
    return kind, rounded_down(smallest, KEY_ROUNDING)


def _both(one: Places, other: Places) -> Places:
    """Places above and below, of the same labels."""
    return Places(
        np.concatenate([one.origins, other.origins]),
        np.concatenate([one.axes, other.axes]),
        (*(f"{label} above" for label in one.labels), *(f"{label} below" for label in other.labels)),
    )


def _item(identity: str, kind: str, description: str, rules: JointRules, shape: Prism, places: Places) -> Item:
    plate = kind in ("washer", "key")
    return Item(identity, kind, description, rules.material, rules.density, (shape,), places, plate=plate)
