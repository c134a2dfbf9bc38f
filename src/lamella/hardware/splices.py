"""Splices: what joins the pieces of a lamella that was too long for its sheet.

Each layer has a plate of its own over the cut, on the side towards the lamella's middle, bent and twisted with the
strip. Two rows of screws go through strip and plate, two screws a row on either side of the cut, heads towards the
middle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part, Parts
from lamella.hardware.bolts import BoltSize
from lamella.hardware.fasteners import flange_nuts, hexagon_screws
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import ahead, ring
from lamella.hardware.rules import MM, SEAT_PLAY, JointRules
from lamella.hardware.shape import Bent, Prism, circle, rectangle
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas
from lamella.strip.layer_map import LayerMap
from lamella.strip.layers import SIDES

ROWS = 0.25
"""Of a strip's height that the two rows of screws are above and below its centre line."""

HEIGHT = 0.8
"""Of a strip's height that a splice plate is high."""

EDGE_STEP = 0.002
"""m; longest piece of a plate's edges where it is drawn in place."""

CONTACT = 5e-5
"""m; between a strip and the plate on it as they are drawn: faces of triangles leave twisted ones by about as much."""


@dataclass(frozen=True, eq=False)
class Splices:
    """Plates, screws and nuts, and the parts with the holes for them.

    Attributes
    ----------
    items : tuple of Item
    parts : Parts
    """

    items: tuple[Item, ...]
    parts: Parts


@dataclass(frozen=True, eq=False)
class Cut:
    """Where a layer of a lamella is cut.

    Attributes
    ----------
    lamella, row : int
        The layer, from the right one (0) on.
    station : float
        On its flat strip, m.
    label : str
        "A3.1 to A3.2 L".
    """

    lamella: int
    row: int
    station: float
    label: str

    def arclength(self, lamellas: Lamellas) -> float:
        """Beside it on the centre line, m."""
        network = lamellas.network
        span = slice(int(network.sample_offsets[self.lamella]), int(network.sample_offsets[self.lamella + 1]))
        return float(np.interp(self.station, lamellas.layers.stations[self.row, span], network.sample_arclengths[span]))


def cuts(parts: Parts, lamellas: Lamellas) -> list[Cut]:
    """Cuts between the pieces of all layers: where one ends and the next one of its strip begins."""
    found = []
    sides = SIDES[lamellas.section.layers]
    for one, other in _neighbours(parts, lamellas.network):
        rows = range(one.layer - 1, one.layer) if one.layer else range(lamellas.section.layers)
        for row in rows:
            found.append(Cut(one.lamella, row, one.end, f"{one.id} to {other.id} {sides[row]}".strip()))
    return found


def _neighbours(parts: Parts, network: Network) -> list[tuple[Part, Part]]:
    """Pieces that follow each other on one strip; a closed lamella's last piece is followed by its first one."""
    found: list[tuple[Part, Part]] = []
    strip: dict[tuple[int, int], list[Part]] = {}
    for part in parts.parts:
        strip.setdefault((part.lamella, part.layer), []).append(part)
    for (lamella, _), pieces in strip.items():
        found += pairwise(pieces)
        if network.closed[lamella]:
            found.append((pieces[-1], pieces[0]))
    return found


def splice_length(rules: JointRules) -> float:
    """Of a splice plate, m."""
    first, second = _columns(rules.block_size)
    return 2 * (second + first)


def _columns(size: BoltSize) -> tuple[float, float]:
    """Distances of the screws from the cut, m."""
    return 2 * size.hole, 6 * size.hole


def splices(parts: Parts, lamellas: Lamellas, rules: JointRules) -> Splices:
    """Splices of all cuts.

    Parameters
    ----------
    parts : Parts
    lamellas : Lamellas
    rules : JointRules

    Raises
    ------
    InputError
        A slot would be cut through a splice, or screws do not fit between the layers.
    """
    places = cuts(parts, lamellas)
    if not places:
        return Splices((), parts)
    _check(parts, lamellas, rules)
    section, size = lamellas.section, rules.block_size
    columns = np.array(_columns(size))
    x = np.concatenate([-columns[::-1], columns])
    s, z = np.tile(x, 2), np.repeat([-ROWS, ROWS], len(x)) * section.height
    plate = Prism(
        rectangle(splice_length(rules), HEIGHT * section.height),
        0.0,
        rules.plate_thickness(section),
        tuple(circle(size.hole, place) for place in zip(s.tolist(), z.tolist(), strict=True)),
    )
    bent, frames, heads, nuts = [], [], [], []
    for cut in places:
        layer = LayerMap.of(lamellas, cut.lamella, cut.row)
        side = 1.0 if cut.row < section.layers / 2 else -1.0
        bent.append(_bent(plate, layer, cut.station, side, section.thickness / 2 + CONTACT))
        point, along, normal, _ = layer.frames(np.array([cut.station]))
        frames.append((point[0], _axes(along, normal, side)[0]))
        outer = section.thickness / 2 + CONTACT + plate.high
        heads.append(_seats(layer, cut.station + s, z, side, outer, size))
        nuts.append(_seats(layer, cut.station + s, z, -side, section.thickness / 2, size))
    labels = tuple(cut.label for cut in places)
    at = Places(np.array([point for point, _ in frames]), np.array([axes for _, axes in frames]), labels)
    text = f"splice plate {MM * splice_length(rules):.4g} x {MM * HEIGHT * section.height:.4g} x {MM * plate.high:g} mm"
    items = [
        Item("splice-1", "splice", text, rules.material, rules.density, (plate,), at, plate=True, bent=tuple(bent))
    ]
    items += _screws(rules, plate.high + section.thickness, heads, nuts, labels)
    return Splices(tuple(items), _with_holes(parts, lamellas, places, s, z, size.hole))


def _check(parts: Parts, lamellas: Lamellas, rules: JointRules) -> None:
    """Require that no slot is near a splice, and that heads have room between the layers."""
    reach = splice_length(rules) / 2
    section, size = lamellas.section, rules.block_size
    for one, other in _neighbours(parts, lamellas.network):
        near = min(
            float((one.end - one.slots).min(initial=np.inf)), float((other.slots - other.start).min(initial=np.inf))
        )
        if near < reach + one.slot_width:
            raise InputError(
                f"a splice between {one.id} and {other.id} reaches {MM * reach:.4g} mm to either side, the next slot "
                f"is {MM * near:.4g} mm from the cut",
                "choose fewer cells, a larger sheet, a smaller block_bolt, or splice = false",
                "splice",
            )
    needed = rules.plate_thickness(section) + size.hex_height
    clear = (section.offset - section.thickness) / 2 if section.layers > 1 else np.inf
    if needed > clear:
        raise InputError(
            f"splice plates and heads of {size.name} take {MM * needed:.4g} mm on either side of a gap of "
            f"{2 * MM * clear:.4g} mm",
            "choose a larger offset, a smaller block_bolt, thinner splice plates, or splice = false",
            "splice_thickness",
        )


def _axes(along: Floats, normal: Floats, side: float) -> Floats:
    """Axes (b, 3, 3) of what lies on a layer's face: x along the strip or back, y up, z away from the face."""
    z = side * np.cross(normal, along)
    z /= np.linalg.norm(z, axis=1)[:, None]
    y = normal - np.einsum("ij,ij->i", normal, z)[:, None] * z
    y /= np.linalg.norm(y, axis=1)[:, None]
    return np.stack([np.cross(y, z), y, z], axis=1)


def _bent(plate: Prism, layer: LayerMap, station: float, side: float, begin: float) -> Bent:
    """The plate in its place on a layer's face, at `begin` from the layer's middle."""
    rings = [_fine(outline_points(plate.outline)[:-1]), *(outline_points(hole)[-2::-1] for hole in plate.holes)]
    flat = np.concatenate(rings)
    near, far = (
        layer.beside(station + flat[:, 0], flat[:, 1], side * offset) for offset in (begin, begin + plate.high)
    )
    # x along the strip and y up: the face towards the left is seen mirrored
    low, high = (near, far) if side < 0 else (far, near)
    # across the strip a face is straight: flattened, triangles reach across it and not far along it
    flattened = np.array([1.0, EDGE_STEP / float(np.ptp(flat[:, 1]))])
    return Bent(tuple(ring * flattened for ring in rings), low, high)


def _fine(corners: Floats) -> Floats:
    """A polygon with points at most `EDGE_STEP` apart along x."""
    following = np.roll(corners, -1, axis=0)
    pieces = np.maximum(np.ceil(np.abs(following - corners)[:, 0] / EDGE_STEP), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(corners)), pieces)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[owner]
    return np.asarray(corners[owner] + share[:, None] * (following - corners)[owner])


def _seats(layer: LayerMap, s: Floats, z: Floats, side: float, offset: float, size: BoltSize) -> tuple[Floats, Floats]:
    """Origins and axes of heads or nuts on a face at an offset from a layer's middle: on the highest place below."""
    point, along, normal, turning = layer.frames(s)
    axes = _axes(along + z[:, None] * turning, normal, side)
    middle = point + z[:, None] * normal
    ring_s, ring_z = ring(size.nut_flange)
    around = layer.beside((s[:, None] + ring_s).ravel(), (z[:, None] + ring_z).ravel(), side * offset)
    high = ahead(around.reshape(len(s), -1, 3), middle, axes[:, 2]).max(axis=1) + SEAT_PLAY
    return middle + high[:, None] * axes[:, 2], axes


def _screws(
    rules: JointRules,
    grip: float,
    heads: list[tuple[Floats, Floats]],
    nuts: list[tuple[Floats, Floats]],
    labels: tuple[str, ...],
) -> list[Item]:
    size = rules.block_size
    count = len(heads[0][0])
    names = tuple(f"{label} {k + 1}" for label in labels for k in range(count))
    head, nut = (
        Places(np.concatenate([one for one, _ in ends]), np.concatenate([axes for _, axes in ends]), names)
        for ends in (heads, nuts)
    )
    every = np.full(len(head), grip + CONTACT + 2 * SEAT_PLAY)
    return [
        *hexagon_screws("splice-screw", rules, size, head, every),
        flange_nuts("splice-nut", rules, size, nut),
    ]


def _with_holes(parts: Parts, lamellas: Lamellas, places: list[Cut], s: Floats, z: Floats, diameter: float) -> Parts:
    """Parts with the holes of the splices at their ends."""
    found = []
    at: dict[tuple[int, int], list[float]] = {}
    for cut in places:
        at.setdefault((cut.lamella, cut.row), []).append(cut.station)
    for part in parts.parts:
        stations = np.array(at.get((part.lamella, max(part.layer - 1, 0)), []))
        turn = 0.0
        if lamellas.network.closed[part.lamella]:
            # the last piece's end is the first one's start, a turn farther on
            stops = slice(*lamellas.network.stop_offsets[part.lamella : part.lamella + 2])
            along = lamellas.layers.stop_stations[max(part.layer - 1, 0), stops]
            turn = float(along[-1] - along[0])
            stations = np.concatenate([stations, stations - turn])
        holes = np.column_stack(
            [
                (stations[:, None] + s).ravel(),
                np.tile(z, len(stations)),
                np.full(len(stations) * len(s), diameter),
            ]
        )
        holes = holes[(holes[:, 0] > part.start) & (holes[:, 0] < part.end)]
        found.append(part.drilled(holes))
    return replace(parts, parts=tuple(found))
