"""Hubs of singular nodes: what the pairs of 6, 8, 10 lamella rays are bolted to.

A hub is made of flat plates. A fin for each ray stands between the two innermost layers of its lamella, in the plane of
the node's normal and of the ray's direction where it is bolted; tenons of the fins go through radial slots of two star
plates above and below, and are welded there. Packers fill the gaps between a fin and the layers, and between further
layers. Angles between fins are the rays' own ones.

All layers of a lamella are bolted through at two places. They are as near to the node as heads and nuts of neighbouring
rays leave room: at the distance r an outer layer w beside its ray is r tan(alpha / 2) - w from the bisector of the
angle alpha to the next ray.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.hardware.bores import Bores
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import LayerFaces, ahead, area
from lamella.hardware.rules import FIT, MM, SEAT_PLAY, WEB, JointRules
from lamella.hardware.screws import screws
from lamella.hardware.shape import Prism, circle, polygon
from lamella.hardware.shear_blocks import filling
from lamella.network.network import SINGULAR
from lamella.strip.lamellas import Lamellas
from lamella.strip.levels import level_heights

HOLE_ROUNDING = 1e-4
"""m; places of holes in fins are rounded to it, far less than the play of a hole, so that equal fins are one part."""

EDGE = 2.0
"""Hole diameters from a hole's axis to the end of a fin, a packer or a layer."""

PITCH = 4.0
"""Hole diameters between the axes of a ray's two screws."""

CLEAR_ROUNDS = 4
"""Rounds in which the place of the first screw is moved outwards, where layers do not run at an equal distance."""

BEYOND_NUT = 0.005
"""m; how much farther than it needs a screw of the next length goes at most."""


@dataclass(frozen=True, eq=False)
class Hubs:
    """Hubs and the holes they need.

    Attributes
    ----------
    items : tuple of Item
    bores : Bores
    reach : dict of int to float
        By node, from it to the far end of its fins, m.
    angles : dict of int to (rays,)
        By node, the angles between neighbouring rays, deg.
    """

    items: tuple[Item, ...]
    bores: Bores
    reach: dict[int, float]
    angles: dict[int, Floats]


@dataclass(frozen=True, eq=False)
class Rays:
    """The lamellas that begin or end at a singular node, counter-clockwise about its normal.

    Attributes
    ----------
    node : int
    lamellas : (r,) int
    starts : (r,)
        Arc length at which the node lies on each, m.
    senses : (r,)
        1 where arc length grows away from the node, else -1.
    directions : (r, 3)
        Unit tangents away from the node.
    height : float
        Of the rays' level over the node, m.
    """

    node: int
    lamellas: Integers
    starts: Floats
    senses: Floats
    directions: Floats
    height: float = 0.0

    def at(self, distance: float) -> Floats:
        """Arc lengths of the places at a distance from the node, m, (r,)."""
        return self.starts + self.senses * distance


@dataclass(frozen=True)
class _Measures:
    """Distances from a hub's node along its rays, m."""

    strips: float
    screws: tuple[float, float]
    fin_begin: float
    fin_end: float
    tenon: tuple[float, float]
    plate: float

    @property
    def middle(self) -> float:
        """Of the screws."""
        return (self.screws[0] + self.screws[1]) / 2


def singular_rays(lamellas: Lamellas) -> list[Rays]:
    """The rays of every singular node that has at least three; of stacked lamellas those of either level."""
    network = lamellas.network
    owner = network.stop_owner
    found = []
    level = level_heights(network, lamellas.section.level)
    singular = np.flatnonzero(network.node_kinds == SINGULAR).tolist()
    for node, height in ((node, height) for node in singular for height in np.unique(level).tolist()):
        stops = np.flatnonzero((network.stop_nodes == node) & (level[owner] == height))
        if len(stops) < 3:
            continue
        sense = np.where(stops == network.stop_offsets[owner[stops]], 1.0, -1.0)
        tangent = network.sample_tangents[network.sample_offsets[owner[stops]] + network.stop_samples[stops]]
        away = sense[:, None] * tangent
        normal = network.node_normals[node]
        angle = _angles(away, away[0], normal)
        order = np.argsort(angle, kind="stable")
        stops = stops[order]
        found.append(Rays(node, owner[stops], network.stop_arclengths[stops], sense[order], away[order], height))
    return found


def hubs(lamellas: Lamellas, rules: JointRules, strips_end: float, room: dict[int, float]) -> Hubs:
    """Hubs of all singular nodes.

    Parameters
    ----------
    lamellas : Lamellas
    rules : JointRules
    strips_end : float
        From a singular node to the strips' ends, m.
    room : dict of int to float
        By node, from it to where the next joint begins on its rays, m.

    Raises
    ------
    InputError
        A hub would reach the next joint, or the strips come so near to its node that there is no room for plates.
    """
    items: list[Item] = []
    owners, arcs, gaps = [], [], []
    labels: tuple[str, ...] = ()
    reach: dict[int, float] = {}
    angles: dict[int, Floats] = {}
    for number, rays in enumerate(singular_rays(lamellas)):
        measures = _measures(lamellas, rules, rays, strips_end)
        if measures.fin_end > room[rays.node]:
            raise InputError(
                f"the hub of node {rays.node} with {len(rays.lamellas)} rays reaches {MM * measures.fin_end:.4g} mm "
                f"along its lamellas, the next joint begins at {MM * room[rays.node]:.4g} mm",
                "choose fewer cells, a smaller block_bolt or offset, or hub = false",
                "hub",
            )
        hub = _Hub.of(lamellas, rules, rays, measures, f"hub-{number + 1}")
        items += [hub.plates(), *hub.fins(), *hub.post()]
        gaps.append(hub.packers())
        for distance, which in zip(measures.screws, ("inner", "outer"), strict=True):
            owners.append(rays.lamellas)
            arcs.append(rays.at(distance))
            labels += tuple(f"{label} {which}" for label in hub.labels)
        reach[rays.node] = max(measures.fin_end, reach.get(rays.node, 0.0))
        angles[rays.node] = np.degrees(np.diff(np.append(hub.angles, hub.angles[0] + 2 * np.pi)))
    if not reach:
        return Hubs((), Bores.of([]), reach, angles)
    owner, arc = np.concatenate(owners), np.concatenate(arcs)
    hole = np.full(len(owner), rules.block_size.hole)
    items += _packers(lamellas, rules, gaps)
    items += screws(lamellas, owner, arc, rules, labels, "hub")
    return Hubs(tuple(items), Bores(owner, arc, np.zeros(len(owner)), hole), reach, angles)


def _packers(lamellas: Lamellas, rules: JointRules, gaps: list[tuple[Floats, Places]]) -> list[Item]:
    """What fills the gaps beside the fins and between further layers, of all hubs."""
    size = rules.block_size
    spread = PITCH * size.hole / 2
    places = Places(
        np.concatenate([at.origins for _, at in gaps]),
        np.concatenate([at.axes for _, at in gaps]),
        tuple(label for _, at in gaps for label in at.labels),
    )
    widths = np.concatenate([widths for widths, _ in gaps])
    length, height = _packer_length(rules), rules.block_height(lamellas.section)
    return filling("packer", "packer", rules, length, height, widths, places, (-spread, spread))


def _packer_length(rules: JointRules) -> float:
    """From end to end, m."""
    return (PITCH + 2 * EDGE) * rules.block_size.hole


def _angles(vectors: Floats, first: Floats, normal: Floats) -> Floats:
    """Angles about a normal from the first vector, rad, from 0 on; rounding does not make a turn of a zero."""
    x = first - (first @ normal) * normal
    grain = 1e-9
    return np.asarray(np.mod(np.arctan2(vectors @ np.cross(normal, x), vectors @ x) + grain, 2 * np.pi) - grain)


def _measures(lamellas: Lamellas, rules: JointRules, rays: Rays, strips_end: float) -> _Measures:
    section, size = lamellas.section, rules.block_size
    turn = _angles(rays.directions, rays.directions[0], lamellas.network.node_normals[rays.node])
    least = float(np.diff(np.append(turn, 2 * np.pi)).min())
    needed = rules.least_hub_radius(least)
    if strips_end < needed - 1e-9:
        raise InputError(
            f"strips end {MM * strips_end:.4g} mm from node {rays.node}: the plates of its hub with "
            f"{len(rays.lamellas)} rays take {MM * needed:.4g} mm",
            f"write hub_radius = {np.ceil(MM * needed) / MM:g} or more, a smaller hub_thickness, or hub = false",
            "hub",
        )
    beside = section.thickness / 2 + max(size.hex_height, size.nut + 2 * size.pitch + BEYOND_NUT)
    first = strips_end + EDGE * size.hole
    for _ in range(CLEAR_ROUNDS):
        outer = _outermost(lamellas, rays, first) + beside
        first = max(first, float(outer / np.tan(min(least, np.pi / 2) / 2)) + size.nut_flange / 2)
    second = first + PITCH * size.hole
    begin = rules.fin_begin(least)
    plate = strips_end - rules.hub_thickness / 2
    return _Measures(
        strips_end, (first, second), begin, second + EDGE * size.hole, (begin + WEB, plate - WEB - FIT), plate
    )


def _outermost(lamellas: Lamellas, rays: Rays, distance: float) -> float:
    """From a ray to its outermost layer at a distance from the node, m, the largest of all rays."""
    network = lamellas.network
    found = []
    for lamella, arc in zip(rays.lamellas.tolist(), rays.at(distance).tolist(), strict=True):
        span = slice(int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1]))
        for row in (0, -1):
            found.append(np.interp(arc, network.sample_arclengths[span], lamellas.layers.distances[row, span]))
    return float(np.abs(found).max())


@dataclass(frozen=True, eq=False)
class _Hub:
    """One hub while its parts are made; `axes` (r, 3, 3) of its fins: x away from the node, y along its normal."""

    lamellas: Lamellas
    rules: JointRules
    rays: Rays
    measures: _Measures
    name: str
    origin: Floats
    normal: Floats
    axes: Floats
    angles: Floats

    @classmethod
    def of(cls, lamellas: Lamellas, rules: JointRules, rays: Rays, measures: _Measures, name: str) -> _Hub:
        network = lamellas.network
        normal = network.node_normals[rays.node]
        origin = network.node_points[rays.node] + rays.height * normal
        zero = np.zeros(1)
        faces = LayerFaces.of(lamellas, rays.lamellas, rays.at(measures.middle), zero, zero)
        half = lamellas.section.layers // 2
        away = (faces.middles[half - 1] + faces.middles[half]) / 2 - origin
        x = away - (away @ normal)[:, None] * normal
        x /= np.linalg.norm(x, axis=1)[:, None]
        y = np.tile(normal, (len(x), 1))
        axes = np.stack([x, y, np.cross(x, y)], axis=1)
        return cls(lamellas, rules, rays, measures, name, origin, normal, axes, _angles(x, x[0], normal))

    @property
    def labels(self) -> tuple[str, ...]:
        """The node and the lamella of each ray."""
        ids = self.lamellas.network.ids
        return tuple(f"node {self.rays.node}, {ids[k]}" for k in self.rays.lamellas.tolist())

    @property
    def _height(self) -> float:
        """Of the fins between the plates, m."""
        return self.rules.block_height(self.lamellas.section)

    def _item(self, part: str, kind: str, text: str, shape: Prism, places: Places) -> Item:
        rules = self.rules
        return Item(f"{self.name}-{part}", kind, text, rules.material, rules.density, (shape,), places, plate=True)

    def plates(self) -> Item:
        """The two star plates."""
        thickness, (begin, end) = self.rules.hub_thickness, self.measures.tenon
        slot = np.array([[begin - FIT, -1], [end + FIT, -1], [end + FIT, 1], [begin - FIT, 1]])
        slot[:, 1] *= thickness / 2 + FIT
        slots = []
        for angle in self.angles.tolist():
            turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            slots.append(polygon(slot @ turn))
        shape = Prism(circle(2 * self.measures.plate), 0.0, thickness, tuple(slots))
        x = self.axes[0, 0]
        axes = np.tile(np.stack([x, np.cross(self.normal, x), self.normal]), (2, 1, 1))
        low = np.array([self._height / 2, -self._height / 2 - thickness])
        origins = self.origin + low[:, None] * self.normal
        text = f"star plate {2 * MM * self.measures.plate:.4g} x {MM * thickness:g} mm, {len(self.angles)} slots"
        labels = (f"node {self.rays.node} above", f"node {self.rays.node} below")
        return self._item("plate", "hub plate", text, shape, Places(origins, axes, labels))

    def post(self) -> list[Item]:
        """What joins the star plates of the lower hub with those of the upper one, on two levels."""
        level, rules = self.lamellas.section.level, self.rules
        gap = 2 * (level - self._height / 2 - rules.hub_thickness)
        if self.rays.height >= 0 or gap <= 0:
            return []
        # on top of the star plates, whose slots it covers
        shape = Prism(circle(2 * self.measures.plate), SEAT_PLAY, gap - SEAT_PLAY)
        at = self.origin + (self._height / 2 + rules.hub_thickness) * self.normal
        x = self.axes[:1, 0]
        axes = np.stack([x, np.cross(self.normal[None], x), self.normal[None]], axis=1)
        text = f"post {2 * MM * self.measures.plate:.4g} x {MM * gap:.4g} mm, welded between the hubs of both levels"
        places = Places(at[None], axes, (f"node {self.rays.node}",))
        name = f"{self.name}-post"
        return [Item(name, "hub post", text, rules.material, rules.density, (shape,), places)]

    def _screw_places(self) -> Floats:
        """Where the screws go through the fins, in their axes, (r, screws, 3), m."""
        zero = np.zeros(1)
        half = self.lamellas.section.layers // 2
        found = []
        for distance in self.measures.screws:
            faces = LayerFaces.of(self.lamellas, self.rays.lamellas, self.rays.at(distance), zero, zero)
            found.append((faces.middles[half - 1] + faces.middles[half]) / 2 - self.origin)
        return np.stack([np.einsum("rij,rj->ri", self.axes, point) for point in found], axis=1)

    def fins(self) -> list[Item]:
        """A fin for each ray."""
        measures, rules, half = self.measures, self.rules, self._height / 2
        holes = np.round(self._screw_places()[:, :, :2] / HOLE_ROUNDING) * HOLE_ROUNDING
        patterns, kind = np.unique(holes.reshape(len(holes), -1), axis=0, return_inverse=True)
        (begin, end), thickness = measures.tenon, rules.hub_thickness
        low = [
            [measures.fin_begin, -half],
            [begin, -half],
            [begin, -half - thickness],
            [end, -half - thickness],
            [end, -half],
            [measures.fin_end, -half],
        ]
        outline = polygon([*low, *([x, -y] for x, y in reversed(low))])
        places = Places(np.tile(self.origin, (len(holes), 1)), self.axes, self.labels)
        items = []
        for number, pattern in enumerate(patterns.reshape(len(patterns), -1, 2).tolist()):
            bored = tuple(circle(rules.block_size.hole, (x, y)) for x, y in pattern)
            shape = Prism(outline, -thickness / 2, thickness / 2, bored)
            length = MM * (measures.fin_end - measures.fin_begin)
            text = f"fin {length:.4g} x {MM * (self._height + 2 * thickness):.4g} x {MM * thickness:g} mm"
            some = np.flatnonzero(kind.ravel() == number)
            items.append(self._item(f"fin-{number + 1}", "hub fin", text, shape, places.chosen(some)))
        return items

    def packers(self) -> tuple[Floats, Places]:
        """Largest widths and places of what fills the gaps beside the fins and between further layers."""
        rules, rays = self.rules, self.rays
        faces = LayerFaces.of(
            self.lamellas, rays.lamellas, rays.at(self.measures.middle), *area(_packer_length(rules), self._height)
        )
        # to the right of each lamella's own direction
        right = rays.senses[:, None] * self.axes[:, 2]
        centre = self.origin + np.einsum("rj,rji->ri", self._screw_places().mean(axis=1), self.axes)
        half, layers = self.lamellas.section.layers // 2, self.lamellas.section.layers
        fin = np.full(len(centre), rules.hub_thickness / 2 + SEAT_PLAY)
        widths, middles = [], []
        for gap in range(layers - 1):
            to_right = ahead(faces.left[gap], centre, right).min(axis=1) - rules.play
            to_left = ahead(faces.right[gap + 1], centre, -right).min(axis=1) - rules.play
            beside_fin = gap == half - 1
            for low, high in [(fin, to_right), (-to_left, -fin)] if beside_fin else [(-to_left, to_right)]:
                widths.append(high - low)
                middles.append(centre + ((low + high) / 2)[:, None] * right)
        labels = tuple(f"{label} filling {row + 1}" for row in range(len(widths)) for label in self.labels)
        places = Places(np.concatenate(middles), np.tile(self.axes, (len(widths), 1, 1)), labels)
        return np.concatenate(widths), places
