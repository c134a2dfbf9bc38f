"""Where a net's samples are in a pose of its model, and what is known at the ends of elements, at its samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential, logarithm
from lamella.structure.model.model import Model


@dataclass(frozen=True)
class SampleMotion:
    """Samples of centre lines, each in an element of its lamella.

    A sample has the mean rigid motion of its element, and a cubic of what the element's ends, and their directions,
    differ from that: errors of the fourth order. Where every layer is a line of its own the first layer's elements
    count.

    Attributes
    ----------
    model : Model
    points, normals : (s, 3)
        Of the samples in the designed shape, m.
    elements : (s,) int
    share : (s,)
        From the element's first end (0) to its second one (1).
    length : (s,)
        Of the element along the centre line, m.
    """

    model: Model
    points: Floats
    normals: Floats
    elements: Integers
    share: Floats
    length: Floats

    @classmethod
    def of(cls, model: Model, samples: Integers) -> SampleMotion:
        """Of some samples of the model's network."""
        network, lines = model.lamellas.network, model.lines
        own = np.flatnonzero(lines.layer <= 0)
        # lamellas one after the other on one line
        stride = 2 * float(network.sample_arclengths.max()) + 1
        starts = lines.lamella[own] * stride + lines.arclengths[own, 0]
        order = own[np.argsort(starts, kind="stable")]
        owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))[samples]
        arclength = network.sample_arclengths[samples]
        found = np.searchsorted(np.sort(starts), owner * stride + arclength, side="right") - 1
        element = order[np.clip(found, 0, len(order) - 1)]
        # before the first element, on a hub, it is that element
        after = order[np.clip(found + 1, 0, len(order) - 1)]
        element = np.where(lines.lamella[element] == owner, element, after)
        first, last = lines.arclengths[element].T
        share = np.clip((arclength - first) / (last - first), 0.0, 1.0)
        return cls(model, network.sample_points[samples], network.sample_normals[samples], element, share, last - first)

    def at(self, poses: Poses) -> tuple[Floats, Floats]:
        """Places of the samples, m, and their normals, both (s, 3)."""
        attachment, designed = self.model.structure.beams.attachment, self.model.structure.poses
        (points, frames), (there, turned) = attachment.ends(designed), attachment.ends(poses)
        points, frames, there, turned = (values[self.elements] for values in (points, frames, there, turned))
        ends = turned @ np.swapaxes(frames, 2, 3)
        half = exponential(logarithm(np.swapaxes(ends[:, 0], 1, 2) @ ends[:, 1]) / 2)
        mean = ends[:, 0] @ half
        # what is left of a rigid motion at the ends, as Hermite's cubic
        low, high = (self.length[:, None] * _turned(ends[:, end] - mean, frames[:, end, :, 0]) for end in (0, 1))
        rise = there[:, 1] - there[:, 0] - _turned(mean, points[:, 1] - points[:, 0])
        s = self.share[:, None]
        beside = s * (low + s * (3 * rise - 2 * low - high + s * (low + high - 2 * rise)))
        place = there[:, 0] + _turned(mean, self.points - points[:, 0]) + beside
        normal = (1 - s) * _turned(ends[:, 0], self.normals) + s * _turned(ends[:, 1], self.normals)
        return np.asarray(place), np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])

    def values(self, at_ends: Floats) -> Floats:
        """Between values (m, 2) at the ends of the elements, linearly, (s,)."""
        first, last = at_ends[self.elements].T
        return np.asarray((1 - self.share) * first + self.share * last)


def _turned(rotations: Floats, vectors: Floats) -> Floats:
    return np.asarray(np.einsum("sij,sj->si", rotations, vectors))
