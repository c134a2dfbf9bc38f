"""What the view shows of an erection: the net, or its segments, on the way from flat to designed, on a slider."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.erection.erection import Erection
from lamella.erection.samples import sampled
from lamella.network.network import FAMILIES
from lamella.solid.finish import finish
from lamella.stages.erection.output import ErectedSegment, ErectionOutput
from lamella.stages.lamellas.scene import LOOKS
from lamella.stages.network.scene import stop_places
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import PointsLayer, StripsLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, signed
from lamella.view.scene.scene import Mark, Shown
from lamella.view.scene.thinning import kept_samples, kept_stops

NAME, TURN = "erection", "joint_turn"
# samples of all frames together, 12 bytes each, and frames
MOST_MOVED_SAMPLES, MOST_FRAMES = 1_500_000, 60
# of the largest: a driver of less is rounding
LEAST_DRIVER = 1e-9
# not drawn meanwhile
REPLACED = (
    "surface",
    "lines A",
    "lines B",
    "strips A",
    "strips B",
    "solids A",
    "solids B",
    "nodes regular",
    "nodes boundary",
    "nodes singular",
    "nodes seam",
    "supports",
    "group:Hardware",
    "group:Cables",
    "group:Edge beams",
    "group:Panels",
)


@dataclass(frozen=True, eq=False)
class _Shown:
    """Layers of a net and where they are in every frame."""

    layers: list[StripsLayer | PointsLayer]
    motions: list[Motion]


def erection_scene(out: ErectionOutput) -> Iterator[Shown]:
    """A slider over the states; segments are driven at the same time, each where it is designed."""
    there = [one for one in out.segments if one.made is not None]
    if not there:
        return
    longest = max(out.made, key=lambda made: len(made.states))
    frames = np.unique(np.linspace(0, len(longest.states) - 1, MOST_FRAMES).round().astype(np.int64))
    samples = sum(len(made.model.lamellas.network.sample_points) for made in out.made)
    # as large a part of each
    part = min(1.0, MOST_MOVED_SAMPLES / (len(frames) * samples))
    shown = [_net(one, one.made, frames, part) for one in there if one.made is not None]
    yield Frames(
        NAME,
        "Erection",
        np.array([longest.states[k].share for k in frames.tolist()]),
        captions=tuple(_caption(longest, k) for k in frames.tolist()),
        motions=tuple(motion for one in shown for motion in one.motions),
        layers=tuple(layer for one in shown for layer in one.layers),
        hides=REPLACED,
        colour=TURN,
        first=len(frames) - 1 if longest.laid else 0,
    )
    yield from _marks(out)


def _caption(made: Erection, state: int) -> str:
    one = made.states[state]
    unit = "N m" if made.way is None else made.way.unit
    largest = max(abs(state.driver) for state in made.states)
    driver = one.driver if abs(one.driver) > LEAST_DRIVER * largest else 0.0
    return f"driver {driver:.3g} {unit}, {one.energy:.3g} J, strips up to {one.von_mises / 1e6:.0f} MPa"


def _net(segment: ErectedSegment, made: Erection, frames: Integers, part: float) -> _Shown:
    model = made.model
    network, section = model.lamellas.network, model.lamellas.section
    label = f" {segment.id}" if segment.id else ""
    # a way that ended before stays where it ended
    states = [made.states[min(k, len(made.states) - 1)] for k in frames.tolist()]
    moved = [sampled(model, state.poses) for state in states]
    limit = max(int(part * len(network.sample_points)), 2 * len(network.ids))
    stops = stop_places(network)[kept_stops(network.stop_offsets, limit)]
    kept = kept_samples(network.sample_offsets, stops, limit)
    offsets = np.searchsorted(kept, network.sample_offsets)
    layers: list[StripsLayer | PointsLayer] = []
    motions: list[Motion] = []
    for family in FAMILIES:
        own = np.flatnonzero(network.families == family)
        if not len(own):
            continue
        counts = np.diff(offsets)[own]
        begin = np.concatenate(([0], np.cumsum(counts)))
        some = kept[np.arange(begin[-1]) + np.repeat(offsets[:-1][own] - begin[:-1], counts)]
        sides = section.layer_offsets
        if section.layer_curves == "lamella":
            sides = model.lamellas.layers.distances[:, some]
        layer = StripsLayer(
            name=f"{NAME} {family}{label}",
            label=f"Lamellas {family}{label}",
            groups=(family,),
            material=LOOKS[finish(model.lamellas.material.density)],
            colour=FAMILY_COLOURS[family],
            ids=tuple(network.ids[k] for k in own.tolist()),
            positions=network.sample_points[some],
            normals=network.sample_normals[some],
            offsets=begin,
            sides=sides,
            height=section.height,
            thickness=section.thickness,
        )
        layers.append(layer)
        places, normals = (np.stack([one[k][some] for one in moved]) for k in (0, 1))
        motions.append(Motion(layer.name, positions=places, normals=normals))
    turns = np.stack([state.angles - 90 for state in states])
    joints = _joints(made, turns, label)
    places = np.stack([state.poses.points[model.joint_nodes] for state in states])
    return _Shown([*layers, joints], [*motions, Motion(joints.name, positions=places, values={TURN: turns})])


def _joints(made: Erection, turns: Floats, label: str) -> PointsLayer:
    model = made.model
    nodes = model.joint_nodes
    return PointsLayer(
        name=f"{NAME} joints{label}",
        label=f"Joints{label}",
        groups=("Nodes",),
        quantities=(signed(TURN, "Joint off square", "deg", _farthest(turns)),),
        quantity=TURN,
        ids=tuple(f"node {node}" for node in nodes.tolist()),
        owner=np.arange(len(nodes)),
        positions=model.lamellas.network.node_points[nodes],
        size=8.0,
        least=2.0,
    )


def _farthest(turns: Floats) -> Floats:
    """Of all frames, by size, with its sign."""
    return np.asarray(np.take_along_axis(turns, np.abs(turns).argmax(0)[None], 0)[0])


def _marks(out: ErectionOutput) -> Iterator[Mark]:
    """Places of warnings on the designed net."""
    for made in out.made:
        way = made.way
        if way is None:
            continue
        points = made.model.structure.poses.points
        for key, snaps in (("driver_stops", [way.stop]), ("driver_snaps", way.snaps)):
            nodes = [snap.node for snap in snaps if snap is not None and snap.node < made.model.nodes]
            if nodes:
                yield Mark(key, points[nodes])
