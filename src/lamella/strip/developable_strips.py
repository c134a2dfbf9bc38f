"""Developable strips that stand upright along the lamellas of a net, half their height on either side of the surface.

Along a curve with geodesic curvature kg, geodesic torsion tg and normal curvature kn the rulings are r = kg n + tg t:
with L = tg / kg a point is c(s) + z (n + L t), and the strip's own normal is u all along a ruling (paper, section 2).
It is regular while 1 + z b > 0 with b = L' - kn (1 + L^2), so that one of the height h exists where 2 / |b| > h; none
does where kg = 0 and tg is not. It is not strained but bent, across its rulings: by (kg^2 + tg^2) / (|kg| (1 + z b)),
most at one edge. Flat it is the same strip as the twisted one: the developed centre line has the curvature kn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.network.network import Network
from lamella.network.turning import derivative
from lamella.strip.developable import NEGLIGIBLE
from lamella.strip.lamellas import Lamellas
from lamella.strip.planarity import planarity_score


@dataclass(frozen=True, eq=False)
class DevelopableStrips:
    """Developable strips along all lamellas of a net; arrays run over its samples.

    Attributes
    ----------
    slopes : (k,)
        L: how far a ruling goes along the lamella for each metre along the normal; 0 where `heights` is.
    heights : (k,)
        Height up to which the strip is regular, m; infinite where nothing limits it.
    exists : (k,) bool
        Whether that is more than the section's height.
    curvatures : (k,)
        Largest bending curvature within the height, 1/m; infinite where the strip does not exist.
    bending : (k,)
        Bending stress E t / 2 times that, Pa.
    planarity : (k,)
        Planarity score of the quad between the rulings of a sample and the next; NaN where the strip does not exist
        at both, and at the end of a lamella.
    """

    slopes: Floats
    heights: Floats
    exists: Booleans
    curvatures: Floats
    bending: Floats
    planarity: Floats

    @property
    def share(self) -> float:
        """Of the samples at which the strip exists."""
        return float(self.exists.mean())

    @property
    def score(self) -> dict[str, float] | None:
        """Median and largest planarity score of all quads; None where there are none."""
        scores = self.planarity[np.isfinite(self.planarity)]
        return {"median": float(np.median(scores)), "max": float(scores.max())} if len(scores) else None

    def gaps(self, network: Network) -> list[tuple[int, int, int]]:
        """Where the strip does not exist: lamella, first and last sample of each such piece."""
        owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))
        lacks = ~self.exists
        begins = lacks & ~(np.append(False, lacks[:-1]) & np.append(False, owner[1:] == owner[:-1]))
        ends = lacks & ~(np.append(lacks[1:], False) & np.append(owner[1:] == owner[:-1], False))
        first, last = np.flatnonzero(begins), np.flatnonzero(ends)
        return list(zip(owner[first].tolist(), first.tolist(), last.tolist(), strict=True))


def developable_strips(lamellas: Lamellas) -> DevelopableStrips:
    """Developable strips of a section along the lamellas of a net.

    Parameters
    ----------
    lamellas : Lamellas
        Their network, section and material are taken.
    """
    network, section = lamellas.network, lamellas.section
    kn, kg, tg = network.sample_darboux
    least = NEGLIGIBLE * np.sqrt(kn**2 + kg**2 + tg**2).max(initial=0.0)
    kg, tg = (np.where(np.abs(values) > least, values, 0.0) for values in (kg, tg))
    rates = _derivative(network, np.column_stack([kg, tg]))
    # b times kg^2, so that nothing is divided by a small kg
    bracket = rates[:, 1] * kg - tg * rates[:, 0] - kn * (kg**2 + tg**2)
    straight = (kg == 0) & (tg == 0)
    square = np.where(straight, 1.0, kg**2)
    bracket = np.where(straight, -kn, bracket)
    heights = np.where(bracket != 0, 2 * square / np.where(bracket != 0, np.abs(bracket), 1.0), np.inf)
    heights[(kg == 0) & (tg != 0)] = 0.0
    heights[_turns(network, kg) & (tg != 0)] = 0.0
    exists = heights > section.height
    safe = np.where(exists & (kg != 0), kg, 1.0)
    slopes = np.where(exists & (kg != 0), tg / safe, 0.0)
    middle = np.where(kg != 0, (kg**2 + tg**2) / np.abs(safe), 0.0)
    nearer = 1 - np.where(exists, section.height / np.where(exists, heights, 1.0), 0.0)
    curvatures = np.where(exists, middle / nearer, np.inf)
    bending = lamellas.material.youngs_modulus * section.thickness / 2 * curvatures
    planarity = _planarity(network, slopes, exists, section.height)
    return DevelopableStrips(slopes, heights, exists, curvatures, bending, planarity)


def meeting_offsets(network: Network, strips: DevelopableStrips, height: float) -> Floats:
    r"""How far from the normal two developable strips meet at their edges, m, (nodes,); NaN where one does not exist.

    A strip leaves the plane of its t and n by kg (x - L z)^2 / 2 towards u, x along t and z along n: on the normal by
    d = tg^2 z^2 / (2 kg). Two strips meet where both are left by their own d:

    .. math:: |p| = \sqrt{d_A^2 + d_B^2 - 2 d_A d_B \cos\gamma} / \sin\gamma,

    gamma the angle between u_A and u_B; up to terms of third order in z.
    """
    off = network.sample_darboux.kg * strips.slopes**2 * height**2 / 8
    samples = network.sample_offsets[network.stop_owner] + network.stop_samples
    found = np.full((2, len(network.node_points)), -1)
    for row, family in enumerate("AB"):
        stops = np.flatnonzero(network.families[network.stop_owner] == family)
        found[row, network.stop_nodes[stops]] = samples[stops]
    both = (found >= 0).all(axis=0) & (np.sum(network.node_degrees(), axis=0) == 2)
    a, b = found[:, both]
    cosine = np.einsum("ij,ij->i", network.sample_tangents[a], network.sample_tangents[b])
    square = off[a] ** 2 + off[b] ** 2 - 2 * off[a] * off[b] * cosine
    offsets = np.full(len(network.node_points), np.nan)
    there = strips.exists[a] & strips.exists[b]
    offsets[both] = np.where(there, np.sqrt(np.maximum(square, 0.0) / (1 - cosine**2)), np.nan)
    return offsets


def flat_ends(lamellas: Lamellas, slopes: Floats) -> Floats:
    """Ends of the rulings on the flat strip, lower and upper one, (2, k, 2), m.

    Each developed centre line begins at the origin along x and bends towards y.
    """
    network, height = lamellas.network, lamellas.section.height
    s = network.sample_arclengths
    k = np.repeat(lamellas.cut_curvatures, np.diff(network.sample_offsets))
    half = k * s / 2
    chord = s * np.sinc(half / np.pi)
    foot = np.column_stack([chord * np.cos(half), chord * np.sin(half)])
    ahead = np.column_stack([np.cos(2 * half), np.sin(2 * half)])
    ruling = np.column_stack([-ahead[:, 1], ahead[:, 0]]) + slopes[:, None] * ahead
    return np.stack([foot - height / 2 * ruling, foot + height / 2 * ruling])


def rulings(network: Network, slopes: Floats) -> Floats:
    """Directions n + L t at the samples, (k, 3)."""
    return np.asarray(network.sample_normals + slopes[:, None] * network.sample_tangents)


def _derivative(network: Network, values: Floats) -> Floats:
    return derivative(values, network.sample_arclengths, network.sample_offsets, network.closed)


def _turns(network: Network, kg: Floats) -> Booleans:
    """Samples beside a change of the sign of kg along their lamella."""
    changes = kg[1:] * kg[:-1] < 0
    changes[network.sample_offsets[1:-1] - 1] = False
    return np.asarray(np.append(changes, False) | np.append(False, changes))


def _planarity(network: Network, slopes: Floats, exists: Booleans, height: float) -> Floats:
    reach = height / 2 * rulings(network, slopes)
    low, high = network.sample_points - reach, network.sample_points + reach
    scores = np.full(len(slopes), np.nan)
    scores[:-1] = planarity_score(low[:-1], low[1:], high[1:], high[:-1])
    scores[:-1][~(exists[1:] & exists[:-1])] = np.nan
    scores[network.sample_offsets[1:] - 1] = np.nan
    return scores
