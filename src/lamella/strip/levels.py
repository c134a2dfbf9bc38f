"""Lamellas on two levels: the curves of a net moved along the surface's normals.

A strip that stands along the normals on the curve c_z = c + z n is a part of the same ruled surface as the one on c:
the normals of the parallel surface at the distance z are those of the surface. With a = 1 - z kn, b = -z tg and
w = sqrt(a^2 + b^2), c_z' = a t + b u, an element is w ds long, and from S_z = S (1 - z S)^-1

    kn_z = (kn - z (kn^2 + tg^2)) / w^2,    tg_z = tg / w^2,    kg_z = (kg + (arctan(b / a))') / w,

H_z = (H - z K) / (1 - 2 z H + z^2 K). A straight strip (kn = 0) is bent about its strong axis by -z tg^2 / w^2, which
is what the twist of a strip does to the lines beside its own middle; strips of one radius 1 / H are cut to
1 / H - z, and are bent by the rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.network import Network
from lamella.surface.darboux import Darboux

LEAST_LEVEL_SCALE = 0.1
"""Length of a curve on its level over that on the surface, at least: farther out it folds."""


def level_heights(network: Network, level: float) -> Floats:
    """Heights of the lamellas' levels over the surface, m, (m,): A below it, B above it."""
    return np.where(network.families == "A", -level, level)


def cut_curvatures(network: Network, level: float) -> Floats:
    """Curvatures that the strips are cut to, 1/m, (m,): 1 / (r - z) for lamellas of a radius r on the surface."""
    curvature = network.normal_curvature
    return np.asarray(curvature / (1 - level_heights(network, level) * curvature))


def on_levels(network: Network, level: float) -> Network:
    """A network whose A lamellas run `level` (m) below the surface and whose B lamellas run as much above it.

    Nodes, normals and faces stay; of samples and stops what belongs to the moved curves is theirs. `sample_slopes` is
    that of the surface, which differs by the order of the level.

    Raises
    ------
    InputError
        A level as far away as the surface's radius of curvature.
    """
    if not level:
        return network
    z = np.repeat(level_heights(network, level), np.diff(network.sample_offsets))
    kn, kg, tg = network.sample_darboux
    mean = network.sample_mean_curvature
    gauss = kn * (2 * mean - kn) - tg**2
    most = float((np.abs(mean) + np.sqrt(np.maximum(mean**2 - gauss, 0.0))).max())
    if level * most > 1 - LEAST_LEVEL_SCALE:
        raise InputError(
            f"levels {level:g} m from the surface, whose smallest radius of curvature is {1 / most:.4g} m: the strips "
            "there would fold",
            f"write height = {rounded((1 - LEAST_LEVEL_SCALE) / most, up=False):g} or less",
            "section.height",
        )
    a, b = 1 - z * kn, -z * tg
    w = np.hypot(a, b)
    sideways = np.cross(network.sample_normals, network.sample_tangents)
    turn = _rate(network, np.arctan2(b, a))
    arclengths = _running(network, w)
    at = network.sample_offsets[network.stop_owner] + network.stop_samples
    return replace(
        network,
        sample_points=network.sample_points + z[:, None] * network.sample_normals,
        sample_tangents=(a[:, None] * network.sample_tangents + b[:, None] * sideways) / w[:, None],
        sample_darboux=Darboux((kn - z * (kn**2 + tg**2)) / w**2, (kg + turn) / w, tg / w**2),
        sample_mean_curvature=(mean - z * gauss) / (1 - 2 * z * mean + z**2 * gauss),
        sample_arclengths=arclengths,
        stop_arclengths=arclengths[at],
    )


def _running(network: Network, rate: Floats) -> Floats:
    """Integral of a rate by arc length from each lamella's start, m, (k,): cubic between samples, by their slopes."""
    step = np.diff(network.sample_arclengths)
    slope = _rate(network, rate)
    growth = (rate[1:] + rate[:-1]) / 2 * step + (slope[:-1] - slope[1:]) / 12 * step**2
    growth = np.append(0.0, growth)
    growth[network.sample_offsets[:-1]] = 0.0
    total = np.cumsum(growth)
    return np.asarray(total - np.repeat(total[network.sample_offsets[:-1]], np.diff(network.sample_offsets)))


def _rate(network: Network, values: Floats) -> Floats:
    """Derivative of values at the samples by arc length, (k,), of second order."""
    found = np.zeros(len(values))
    for begin, end in zip(network.sample_offsets[:-1].tolist(), network.sample_offsets[1:].tolist(), strict=True):
        if end - begin > 1:
            span = slice(begin, end)
            some, s = values[span], network.sample_arclengths[span]
            found[span] = np.gradient(some, s, edge_order=2) if len(s) > 2 else np.gradient(some, s)
    return found
