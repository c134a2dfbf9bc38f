"""Where the layers of a lamella run beside its centre line, and how their flat strips are made.

A layer at the distance d beside a lamella has normal curvature kn + d (tg' + 2 kg (kn - H)) + O(d^2)
(`lamella.surface.darboux.sideways_slope`), not kn. There are three ways to build it:

- "offset": at an equal distance, cut straight or with the lamellas' one radius. Held at the depth of its slots the
strip
  is bent about its strong axis: a stress that is counted.
- "cut": at an equal distance, each layer cut to an outline of its own that has this curvature.
- "lamella": on lamella curves of its own, u + v shifted by a constant: kn = H, the strip is cut as ever and free of
that
  stress, but its distance goes with the cell edge (`lamella.strip.layer_curves`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.blocks import blocks
from lamella.network.network import Network

LayerCurves = Literal["offset", "cut", "lamella"]

# names of the layers from the right one to the left one, by how many there are
SIDES = {1: ("",), 2: ("R", "L"), 3: ("R", "M", "L"), 4: ("RR", "R", "L", "LL")}


@dataclass(frozen=True)
class Layers:
    """The layers of all lamellas; layer 1 is the one farthest to the right, the last one farthest to the left.

    Left is u = n x t: looking along the lamella with the surface normal up.

    Attributes
    ----------
    distances : (layers, k)
        From the centre line at its samples, m, > 0 to the left.
    stations : (layers, k)
        Place of the samples on the flat layers, m from the lamella's start.
    stop_stations : (layers, q)
        The same of the nodes.
    bow : (layers, k)
        Curvature of the flat layers over that of the lamellas' development, 1/m, > 0 towards +n; not 0 where "cut".
    slot_shifts : (layers, q, layers) or None
        Where a layer is crossed by those of the other lamella, from the right one of that to its left one, m from its
        `stop_stations`; None: at the layers' equal distances.
    points, normals : (layers, k, 3)
        The layers' curves on the surface, m, and its unit normals there.
    followed : (k,) bool
        Whether they are known beside the sample. Next to a singular node layers on lamella curves turn away from their
        ray; strips end before.
    """

    distances: Floats
    stations: Floats
    stop_stations: Floats
    bow: Floats
    slot_shifts: Floats | None
    points: Floats
    normals: Floats
    followed: Booleans


def running(network: Network, strain: Floats) -> Floats:
    """Integral of a strain given at the samples from each lamella's start to its samples, m, (k,).

    Trapezia, whose samples are near-equal arcs a small part of a cell long.
    """
    growth = np.append(0.0, (strain[1:] + strain[:-1]) / 2 * np.diff(network.sample_arclengths))
    growth[network.sample_offsets[:-1]] = 0.0
    total = np.cumsum(growth)
    return np.asarray(total - np.repeat(total[network.sample_offsets[:-1]], np.diff(network.sample_offsets)))


def at_stops(network: Network, values: Floats) -> Floats:
    """Values (..., k) of samples at the stops, (..., q)."""
    return np.asarray(values[..., network.sample_offsets[network.stop_owner] + network.stop_samples])


def parallel_layers(network: Network, offsets: Floats, lengthening: Floats, *, own_lengths: bool, cut: bool) -> Layers:
    """Layers at equal distances.

    Parameters
    ----------
    network : Network
    offsets : (layers,)
        Distances from the centre line, m.
    lengthening : (k,)
        Strain by which marks are lengthened.
    own_lengths : bool
        Whether layers are marked at the arc lengths of their own curves, where an element is
        sqrt((1 - d kg)^2 + (d tg)^2) ds long, and not like the centre line.
    cut : bool
        Whether they are cut to their own curvature.
    """
    kn, kg, tg = network.sample_darboux
    d = offsets[:, None]
    base = network.sample_arclengths + running(network, lengthening)
    stations = np.tile(base, (len(offsets), 1))
    if own_lengths:
        stretch = np.sqrt((1 - d * kg) ** 2 + (d * tg) ** 2) - 1
        stations = stations + np.stack([running(network, strain) for strain in stretch])
    points, normals = _beside(network, offsets)
    return Layers(
        np.repeat(d, len(kn), 1),
        stations,
        at_stops(network, stations),
        d * network.sample_slopes if cut else np.zeros_like(stations),
        None,
        points,
        normals,
        np.ones(len(kn), bool),
    )


def _beside(network: Network, offsets: Floats) -> tuple[Floats, Floats]:
    """Points and unit normals of the surface at distances beside the lamellas, each (layers, k, 3)."""
    d = offsets[:, None, None]
    points, turned = np.empty((2, len(offsets), *network.sample_points.shape))
    for block in blocks(len(network.sample_points)):
        normals, tangents = network.sample_normals[block], network.sample_tangents[block]
        sideways = np.cross(normals, tangents)
        # kn of the curve that leads sideways, up to its own geodesic curvature
        across = (2 * network.sample_mean_curvature[block] - network.sample_darboux.kn[block])[:, None]
        turn = d * (network.sample_darboux.tg[block, None] * tangents + across * sideways)
        tilted = normals - turn
        points[:, block] = network.sample_points[block] + d * sideways + d**2 / 2 * across * normals
        turned[:, block] = tilted / np.linalg.norm(tilted, axis=2)[..., None]
    return points, turned
