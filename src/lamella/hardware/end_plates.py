"""End plates: what joins the ends of lamellas with an edge beam.

An end plate is a flat plate that is folded once, along the surface normal, by the angle between the lamella and the
beam. One leg lies on the beam and is welded to it; the other one stands between the two innermost layers, which are
bolted to it with packers on either side. It may be turned over, so that ends that lean to the left and to the right
have the same one; folds that differ by less than half a degree are made alike.

The flat length of the fold is that of its middle surface.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.flat import outline_points
from lamella.hardware.axis_ends import BeamAxis, BeamEnds, EdgeBeamAxes, end_lengths
from lamella.hardware.bores import Bores
from lamella.hardware.edge_rules import END_EDGE, END_PITCH, FOLD_BEND
from lamella.hardware.folded_plate import FoldedPlate, folded_plates
from lamella.hardware.item import Item, Places
from lamella.hardware.layer_faces import LayerFaces, ahead, area
from lamella.hardware.rules import MM, SEAT_PLAY, JointRules
from lamella.hardware.screws import screws
from lamella.hardware.shear_blocks import filling
from lamella.strip.lamellas import Lamellas
from lamella.strip.levels import level_heights

CONTACT = 5e-5
"""m; between a beam and a plate on it as they are drawn: straight pieces of a bent beam leave it by about as much."""

SCREW_ROUNDS = 3
"""Steps for the place of the screws: each leaves the square of the error over the lamella's radius."""


@dataclass(frozen=True, eq=False)
class EndPlates:
    """Plates, packers and screws, and the holes they need.

    Attributes
    ----------
    items : tuple of Item
    bores : Bores
    reach : (e,)
        From the rim's nodes back to where their plates end, m.
    """

    items: tuple[Item, ...]
    bores: Bores
    reach: Floats


def end_plates(lamellas: Lamellas, found: EdgeBeamAxes, joints: JointRules) -> EndPlates:
    """End plates of all lamella ends that have one.

    Parameters
    ----------
    lamellas : Lamellas
    found : EdgeBeamAxes
    joints : JointRules
    """
    made: list[Item] = []
    bores, gaps = [], []
    reach = np.zeros(len(found.ends))
    labels: tuple[str, ...] = ()
    for number, axis in enumerate(found.axes):
        mine = np.flatnonzero(found.ends.axes == number)
        if not len(mine):
            continue
        ends = found.ends.chosen(mine)
        of_axis = _OnAxis.of(lamellas, axis, ends, joints)
        kinds = np.unique(np.round(np.column_stack([ends.bends, ends.legs]), 9), axis=0, return_inverse=True)[1].ravel()
        for kind in range(int(kinds.max()) + 1):
            made.append(of_axis.item(np.flatnonzero(kinds == kind), joints))
        gaps.append(of_axis.packers(joints))
        bores.append(of_axis.bores(joints))
        labels += tuple(f"{label} {which}" for which in ("outer", "inner") for label in of_axis.labels)
        reach[mine] = _reach(lamellas, ends, of_axis.inner_ends)
    if not made:
        return EndPlates((), Bores.of([]), reach)
    drilled = Bores.of(bores)
    made = _alike(made)
    made += _packers(lamellas, joints, gaps)
    made += screws(lamellas, drilled.lamellas, drilled.arclengths, joints, labels, "end")
    return EndPlates(tuple(made), drilled, reach)


def _alike(items: list[Item]) -> list[Item]:
    """Equal plates of several beams as one item."""
    groups: dict[tuple[str, str], list[Item]] = {}
    for item in items:
        groups.setdefault((item.description, item.material), []).append(item)
    found = []
    for number, group in enumerate(groups.values()):
        places = Places(
            np.concatenate([item.places.origins for item in group]),
            np.concatenate([item.places.axes for item in group]),
            tuple(label for item in group for label in item.places.labels),
        )
        bent = tuple(one for item in group for one in item.bent)
        found.append(replace(group[0], id=f"end-{number + 1}", places=places, bent=bent))
    return found


def _reach(lamellas: Lamellas, ends: BeamEnds, inner_ends: Floats) -> Floats:
    """From the rim's nodes back to where plates end, m; 0 where these end beyond the node."""
    network = lamellas.network
    stops = network.stop_offsets
    node = network.stop_arclengths[np.where(ends.last, stops[ends.lamellas + 1] - 1, stops[ends.lamellas])]
    return np.maximum((node - inner_ends) * ends.senses, 0.0)


@dataclass(frozen=True, eq=False)
class _OnAxis:
    """The plates on one beam: axes (e, 3, 3), x outwards along the lamella, y about the normal, folded towards z."""

    lamellas: Lamellas
    axis: BeamAxis
    ends: BeamEnds
    first: Floats
    rest: float
    height: float
    outer: Floats
    axes: Floats
    corners: Floats

    @classmethod
    def of(cls, lamellas: Lamellas, axis: BeamAxis, ends: BeamEnds, joints: JointRules) -> _OnAxis:
        section, senses, folds, towards = lamellas.section, ends.senses, ends.bends, ends.towards
        first, rest = end_lengths(folds, axis.rules, section, joints)
        pitch, height = END_PITCH * joints.block_size.hole, axis.rules.plate_height(section, joints)
        levels = level_heights(lamellas.network, section.level)[ends.lamellas]
        screw = ends.arclengths - senses * first
        for _ in range(SCREW_ROUNDS):
            near, far, normal = _screw_places(lamellas, ends.lamellas, screw, screw - senses * pitch)
            x = _unit(near - far)
            y = _unit(normal - np.einsum("ij,ij->i", normal, x)[:, None] * x)
            z = np.cross(x, y)
            beam = towards[:, None] * axis.piece.frames(ends.along).ahead
            over = np.einsum("ij,ij->i", beam, z) < 0
            y[over], z[over] = -y[over], -z[over]
            away = np.sin(folds)[:, None] * x - np.cos(folds)[:, None] * z
            face = _touching(axis, ends, away, height, levels)
            ahead_of = (face - axis.rules.end_plate / 2 - np.einsum("ij,ij->i", near, away)) / np.sin(folds)
            screw = screw + senses * (ahead_of - first)
        corners = near + first[:, None] * x
        return cls(lamellas, axis, ends, first, rest, height, screw, np.stack([x, y, z], axis=1), corners)

    @property
    def labels(self) -> tuple[str, ...]:
        """The lamella and which of its ends."""
        ids = self.lamellas.network.ids
        return tuple(
            f"{ids[k]} {'end' if last else 'start'}"
            for k, last in zip(self.ends.lamellas.tolist(), self.ends.last.tolist(), strict=True)
        )

    @property
    def inner_ends(self) -> Floats:
        """Arc lengths at which the plates end, m."""
        return np.asarray(self.outer - self.ends.senses * self.rest)

    def item(self, some: Integers, joints: JointRules) -> Item:
        """The plates of one fold."""
        rules = self.axis.rules
        plates = FoldedPlate(
            float(self.ends.bends[some[0]]),
            rules.end_plate,
            self.height,
            float(self.ends.legs[some[0]]),
            float(self.first[some[0]]),
            self.rest,
            joints.block_size.hole,
        )
        flat = plates.flat()
        size = np.ptp(outline_points(flat.outline), axis=0)
        text = (
            f"end plate {MM * size[0]:.1f} x {MM * size[1]:.4g} x {MM * rules.end_plate:g} mm, folded by "
            f"{np.degrees(plates.fold):g} deg, inner radius {MM * FOLD_BEND * rules.end_plate:g} mm"
        )
        labels = self.labels
        places = Places(self.corners[some], self.axes[some], tuple(labels[k] for k in some.tolist()))
        return Item(
            "end",
            "end plate",
            text,
            rules.material,
            rules.density,
            (flat,),
            places,
            plate=True,
            bent=folded_plates(plates, flat, places),
            folds=plates.folds(),
        )

    def bores(self, joints: JointRules) -> Bores:
        """Holes of the layers: the outer screws, then the inner ones."""
        size = joints.block_size
        pitch = self.ends.senses * END_PITCH * size.hole
        arcs = np.concatenate([self.outer, self.outer - pitch])
        return Bores(np.tile(self.ends.lamellas, 2), arcs, np.zeros(len(arcs)), np.full(len(arcs), size.hole))

    def packers(self, joints: JointRules) -> tuple[Floats, Places]:
        """Largest widths and places of what fills the gaps beside the plates and between further layers."""
        lamellas, hole = self.lamellas, joints.block_size.hole
        middle = self.outer - self.ends.senses * END_PITCH * hole / 2
        faces = LayerFaces.of(lamellas, self.ends.lamellas, middle, *area(packer_length(joints), self.height))
        x, z = self.axes[:, 0], self.axes[:, 2]
        centre = self.corners - (self.first + END_PITCH * hole / 2)[:, None] * x
        # to the right of the lamella's own direction
        sideways = np.cross(faces.normals, self.ends.senses[:, None] * x)
        sign = np.where(np.einsum("ij,ij->i", sideways, z) > 0, -1.0, 1.0)
        right = sign[:, None] * z
        axes = np.stack([x, np.cross(right, x), right], axis=1)
        half, layers = lamellas.section.layers // 2, lamellas.section.layers
        plate = np.full(len(centre), self.axis.rules.end_plate / 2 + SEAT_PLAY)
        widths, middles = [], []
        for gap in range(layers - 1):
            to_right = ahead(faces.left[gap], centre, right).min(axis=1) - joints.play
            to_left = ahead(faces.right[gap + 1], centre, -right).min(axis=1) - joints.play
            both = [(plate, to_right), (-to_left, -plate)] if gap == half - 1 else [(-to_left, to_right)]
            for low, high in both:
                widths.append(high - low)
                middles.append(centre + ((low + high) / 2)[:, None] * right)
        labels = tuple(f"{label} filling {row + 1}" for row in range(len(widths)) for label in self.labels)
        return np.concatenate(widths), Places(np.concatenate(middles), np.tile(axes, (len(widths), 1, 1)), labels)


def packer_length(joints: JointRules) -> float:
    """From end to end, m."""
    return (END_PITCH + 2 * END_EDGE) * joints.block_size.hole


def _packers(lamellas: Lamellas, joints: JointRules, gaps: list[tuple[Floats, Places]]) -> list[Item]:
    """What fills the gaps beside the end plates, of all beams."""
    places = Places(
        np.concatenate([at.origins for _, at in gaps]),
        np.concatenate([at.axes for _, at in gaps]),
        tuple(label for _, at in gaps for label in at.labels),
    )
    widths = np.concatenate([widths for widths, _ in gaps])
    spread = END_PITCH * joints.block_size.hole / 2
    length, height = packer_length(joints), joints.block_height(lamellas.section)
    return filling("end-packer", "packer", joints, length, height, widths, places, (-spread, spread))


def _screw_places(lamellas: Lamellas, owner: Integers, outer: Floats, inner: Floats) -> tuple[Floats, Floats, Floats]:
    """Points halfway between the two innermost layers, m, at both screws, and normals at the outer one, (e, 3) each."""
    zero = np.zeros(1)
    faces = LayerFaces.of(lamellas, np.tile(owner, 2), np.concatenate([outer, inner]), zero, zero)
    half = lamellas.section.layers // 2
    middles = (faces.middles[half - 1] + faces.middles[half]) / 2
    return middles[: len(owner)], middles[len(owner) :], faces.normals[: len(owner)]


def _touching(axis: BeamAxis, ends: BeamEnds, away: Floats, height: float, levels: Floats) -> Floats:
    """How far along `away` (e, 3) a plane touches the beam under a leg that is at heights `levels` (e,), m, (e,)."""
    least = np.full(len(ends), np.inf)
    for share in np.linspace(-0.5, 1.0, 7).tolist():
        frames = axis.piece.frames(ends.along + share * ends.towards * ends.legs)
        middle = frames.beside(axis.distance)
        if axis.beam.round:
            least = np.minimum(least, np.einsum("ij,ij->i", middle, away) - axis.beam.reach)
            continue
        for z in (-height / 2, height / 2):
            face = middle - axis.beam.reach * frames.out + (levels + z)[:, None] * frames.up
            least = np.minimum(least, np.einsum("ij,ij->i", face, away))
    return least - CONTACT


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])
