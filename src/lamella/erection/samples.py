"""A state of a net at the samples of its designed network: the same indices, so that both can be laid side by side."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.helices import points_between
from lamella.structure.beam.poses import Poses
from lamella.structure.model.model import Model


def sampled(model: Model, poses: Poses) -> tuple[Floats, Floats]:
    """Points and normals of the lamellas at the network's samples, both (k, 3).

    Each at the same share of its element's length as it has of the arc length in the network.
    """
    lines, network = model.lines, model.lamellas.network
    # lamellas one after the other on one line
    stride = 2 * float(network.sample_arclengths.max()) + 1
    starts = lines.lamella * stride + lines.arclengths[:, 0]
    owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))
    place = owner * stride + network.sample_arclengths
    element = np.clip(np.searchsorted(starts, place, side="right") - 1, 0, len(starts) - 1)
    first, last = lines.arclengths[element].T
    # hubs begin beyond the first sample of their rays
    share = (network.sample_arclengths - first) / (last - first)
    points, frames = model.structure.beams.attachment.ends(poses)
    along, turned = points_between(points[element], frames[element], share[:, None])
    return along[:, 0], turned[:, 0, :, 2]
