"""Edge beams as lines of beam elements along the rim.

Their axes are those of `lamella.hardware.beam_axes`. Where a lamella ends at one, the beam hangs on its node of the
rim, beside it where the axis is beside the rim: end plates are rigid. In corners of the rim beams are mitred and
welded. They are bent to their curves before they are mounted: there is no stress in them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.material import Material, find_material
from lamella.hardware.axis_ends import BeamAxis, EdgeBeamAxes
from lamella.network.network import Network
from lamella.structure.beam.poses import Poses
from lamella.structure.model.beam_sections import EdgeSection, edge_section

SAME_PLACE = 1e-6
"""m along a rim; lamellas that end nearer to each other, or to a corner, end there."""


@dataclass(frozen=True)
class RimBeams:
    """r elements of edge beams, before they are beams.

    Attributes
    ----------
    nodes : (r, 2) int
    turns, offsets : (r, 2, 3, 3), (r, 2, 3)
        Ends in the frames of their nodes.
    section : (r,) int
        Index into `sections`.
    sections : tuple of EdgeSection
    points, frames : (i, 3), (i, 3, 3)
        Poses of nodes of their own, which come after those that are there.
    """

    nodes: Integers
    turns: Floats
    offsets: Floats
    section: Integers
    sections: tuple[EdgeSection, ...]
    points: Floats
    frames: Floats


TANGENT_STEP = 1e-4
"""m; along the rim, for the direction of the axis beside it."""

ON_NODE = 1e-9
"""m; an end that is nearer to its node is on it."""


def rim_beams(
    network: Network, found: EdgeBeamAxes | None, poses: Poses, elements: int, materials: Mapping[str, Material]
) -> RimBeams:
    """Elements along all axes.

    Parameters
    ----------
    network : Network
    found : EdgeBeamAxes or None
        None: there are no edge beams.
    poses : Poses
        Of the nodes that are there; the network's come first.
    elements : int
        From one lamella's end to the next.
    materials : mapping
        By name.
    """
    if found is None:
        return _none()
    corners, count = _corners(network, found, len(poses.points))
    own = [_corner_poses(found, corners, len(poses.points))]
    axes, pieces = [], []
    for number, axis in enumerate(found.axes):
        places, at = _stops(network, found, number, corners)
        if len(places) > 1:
            pairs, along, inner = _along(places, at, elements, count)
            axes.append(axis)
            pieces.append((pairs, *_poses(axis, along)))
            own.append(_poses(axis, inner))
            count += len(inner)
    points, frames = (np.concatenate(part) for part in zip(*own, strict=True))
    if not axes:
        return _none()
    sections = tuple(edge_section(axis.beam, find_material(axis.rules.material, dict(materials))) for axis in axes)
    numbers, end_points, end_frames = (np.concatenate(part) for part in zip(*pieces, strict=True))
    all_points, all_frames = np.concatenate((poses.points, points)), np.concatenate((poses.frames, frames))
    back = np.swapaxes(all_frames[numbers], -1, -2)
    offsets = np.einsum("ekij,ekj->eki", back, end_points - all_points[numbers])
    offsets[np.abs(offsets) < ON_NODE] = 0.0
    which = np.repeat(np.arange(len(axes)), [len(pairs) for pairs, *_ in pieces])
    return RimBeams(numbers, back @ end_frames, offsets, which, sections, points, frames)


def _none() -> RimBeams:
    none = np.zeros((0, 2), np.int64)
    ends = np.zeros((0, 2, 3, 3)), np.zeros((0, 2, 3))
    return RimBeams(none, *ends, none[:, 0], (), np.zeros((0, 3)), np.zeros((0, 3, 3)))


def _poses(axis: BeamAxis, along: Floats) -> tuple[Floats, Floats]:
    """Points and frames t, u, n in columns of the axis at places (...,): u towards the surface."""
    there = axis.piece.frames(along)
    before, after = (axis.piece.frames(along + step).beside(axis.distance) for step in (-TANGENT_STEP, TANGENT_STEP))
    # beside a rim that is twisted the axis does not run along it
    tangent = after - before
    tangent /= np.linalg.norm(tangent, axis=-1)[..., None]
    up = there.up - (there.up * tangent).sum(-1)[..., None] * tangent
    up /= np.linalg.norm(up, axis=-1)[..., None]
    return there.beside(axis.distance), np.stack((tangent, np.cross(up, tangent), up), -1)


def _corners(network: Network, found: EdgeBeamAxes, first: int) -> tuple[dict[tuple[int, int], int], int]:
    """Node where each open piece (loop, number) begins, and the number after the last of them.

    A lamella's node in the corner, or a new one.
    """
    corners: dict[tuple[int, int], int] = {}
    for number, axis in enumerate(found.axes):
        if axis.piece.closed:
            continue
        mine = found.ends.axes == number
        there = np.flatnonzero(mine & (found.ends.along < SAME_PLACE))
        key = (axis.piece.loop, axis.piece.number)
        if len(there):
            corners[key] = int(_end_nodes(network, found)[there[0]])
        else:
            corners[key] = first
            first += 1
    return corners, first


def _corner_poses(found: EdgeBeamAxes, corners: dict[tuple[int, int], int], first: int) -> tuple[Floats, Floats]:
    """Of new nodes in corners, in their order: on the axis that begins there."""
    points, frames = [np.zeros((0, 3))], [np.zeros((0, 3, 3))]
    for axis in found.axes:
        if not axis.piece.closed and corners[axis.piece.loop, axis.piece.number] >= first:
            place, frame = _poses(axis, np.zeros(1))
            points.append(place)
            frames.append(frame)
    return np.concatenate(points), np.concatenate(frames)


def _end_nodes(network: Network, found: EdgeBeamAxes) -> Integers:
    """Network node of each lamella end."""
    ends = found.ends
    stops = np.where(ends.last, network.stop_offsets[ends.lamellas + 1] - 1, network.stop_offsets[ends.lamellas])
    return np.asarray(network.stop_nodes[stops])


def _stops(
    network: Network, found: EdgeBeamAxes, number: int, corners: dict[tuple[int, int], int]
) -> tuple[Floats, Integers]:
    """Places along an axis where it hangs on a node, and these nodes: lamellas' ends, and corners at either end."""
    axis, ends = found.axes[number], found.ends
    mine = np.flatnonzero(ends.axes == number)
    nodes = _end_nodes(network, found)[mine]
    # one place a node, halfway between those of its lamellas
    _, first, node = np.unique(nodes, return_index=True, return_inverse=True)
    length, start = axis.piece.length, ends.along[mine][first]
    apart = np.mod(ends.along[mine] - start[node] + length / 2, length) - length / 2
    along, nodes = start + np.bincount(node, apart, len(first)) / np.bincount(node), nodes[first]
    order = np.lexsort((nodes, np.round(along, 9)))
    along, nodes = along[order], nodes[order]
    if axis.piece.closed:
        if not len(along):
            return along, nodes
        return np.append(along, along[0] + length), np.append(nodes, nodes[0])
    inside = (along > SAME_PLACE) & (along < length - SAME_PLACE)
    loop = axis.piece.loop
    pieces = sum(key[0] == loop for key in corners)
    begin = corners[loop, axis.piece.number]
    end = corners.get((loop, (axis.piece.number + 1) % pieces), begin)
    places = np.concatenate(([0.0], along[inside], [length]))
    return places, np.concatenate(([begin], nodes[inside], [end]))


def _along(places: Floats, at: Integers, elements: int, first: int) -> tuple[Integers, Floats, Floats]:
    """Nodes (e, 2) and places (e, 2) of elements, and places of their own nodes, from the number `first` on."""
    share = np.linspace(0, 1, elements + 1)
    along = places[:-1, None] * (1 - share) + places[1:, None] * share
    numbers = np.empty(along.shape, np.int64)
    numbers[:, 0], numbers[:, -1] = at[:-1], at[1:]
    inner = numbers[:, 1:-1]
    inner[:] = first + np.arange(inner.size).reshape(inner.shape)
    pairs = np.stack((numbers[:, :-1], numbers[:, 1:]), 2).reshape(-1, 2)
    return pairs, np.stack((along[:, :-1], along[:, 1:]), 2).reshape(-1, 2), along[:, 1:-1].ravel()
