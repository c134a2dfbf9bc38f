"""Layers on lamella curves of their own: u + v (or u - v) shifted by a constant, where kn is H as well.

A sample of the centre line is moved along the other family's lamella through it by a constant length of the isothermic
plane, whose metric is mu^2 times the surface's: all images of a lamella then lie on one curve u + v = const, at the
distance (shift / mu) to first order, which goes with the cell edge. An arc of the layer is mu / mu' times that of the
centre line, mu' its own. The shift of each lamella is such that the distance is as asked for where a cell edge is as
long as the lamella's mean one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.network.charts.charts import Charts, ChartSample
from lamella.network.charts.charts_of import charts_of
from lamella.network.network import SINGULAR, Network
from lamella.network.pattern import Pattern
from lamella.strip.layers import Layers, at_stops, running
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.places import Places
from lamella.surface.surface import Surface

# Runge-Kutta steps from one layer to the next
LAYER_STEPS = 2
# of the distance to the singular node at a ray's end: a layer that would be farther from its ray is not followed there
NEAR_ZERO = 0.5
# 1/sqrt(m): mu of an umbilic itself
LEAST_MU = 1e-9


def check_layer_curves(surface: Surface[Any], pattern: Pattern) -> None:
    """Refuse layers on lamella curves of their own where lamellas have no isothermic coordinates.

    Raises
    ------
    InputError
    """
    if pattern.normal_curvature not in (None, surface.mean_curvature) or not surface.has_lattice():
        raise InputError(
            'layer_curves = "lamella" shifts u + v by a constant, and lines of a given normal curvature have no such '
            "coordinates",
            'write layer_curves = "cut", or "offset"',
            "section.layer_curves",
        )


def lamella_layers(surface: Surface[Any], network: Network, offsets: Floats, lengthening: Floats) -> Layers:
    """Layers on lamella curves, whose distance is that of equal layers on the average over a lamella's cells.

    Parameters
    ----------
    surface : Surface
        The network's.
    network : Network
    offsets : (layers,)
        Mean distances from the centre line, m, over equal isothermic lengths.
    lengthening : (k,)
        Strain by which marks are lengthened.
    """
    check_layer_curves(surface, network.pattern)
    charts, start = charts_of(surface), _places(surface, network)
    sample = charts.evaluate(start)
    mu = np.sqrt(np.abs(sample.deviator))
    length = running(network, mu)
    # isothermic length for each length of mean distance, of each lamella
    unit = (length[network.sample_offsets[1:] - 1] / network.lengths)[
        np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))
    ]
    sideways = np.cross(network.sample_normals, network.sample_tangents)
    near = _near_zero(network)
    count = len(mu)
    distances, stations = np.empty((2, len(offsets), count))
    points, normals = np.empty((2, len(offsets), count, 3))
    rates = np.empty((len(offsets), count))
    for row, offset in enumerate(offsets.tolist()):
        some = np.flatnonzero(np.abs(offset) * unit / np.maximum(mu, LEAST_MU) < NEAR_ZERO * near)
        there = _moved(charts, start[some], sideways[some], offset * unit[some])
        points[row], normals[row], own = network.sample_points, network.sample_normals, mu.copy()
        points[row, some], normals[row, some] = there.position, there.normal
        own[some] = np.sqrt(np.abs(there.deviator))
        distances[row] = np.sign(offset) * np.linalg.norm(points[row] - network.sample_points, axis=1)
        rates[row] = (1 + lengthening) * np.where(own > LEAST_MU, mu / np.maximum(own, LEAST_MU), 1.0)
        stations[row] = network.sample_arclengths + running(network, rates[row] - 1)
    shifts = _slot_shifts(network, mu, length, unit, rates, stations, offsets)
    return Layers(
        distances,
        stations,
        at_stops(network, stations),
        np.zeros_like(stations),
        shifts,
        points,
        normals,
        np.abs(offsets).max() * unit / np.maximum(mu, LEAST_MU) < NEAR_ZERO * near,
    )


def _places(surface: Surface[Any], network: Network) -> Places:
    """The samples' places as grounds know them."""
    if isinstance(surface, ClosedForm):
        zeta = np.asarray(network.sample_where, np.complex128)
        return Places(np.zeros(len(zeta), np.int64), np.column_stack([zeta.real, zeta.imag]))
    # the net's own elements are others next to umbilics
    places: Places = surface.closest(network.sample_points)[0]  # type: ignore[attr-defined]
    return places


def _near_zero(network: Network) -> Floats:
    """Arc length to the nearer singular node at an end of the sample's lamella, m, (k,); else infinite."""
    count = np.diff(network.sample_offsets)
    kinds = network.node_kinds[network.stop_nodes]
    first, last = kinds[network.stop_offsets[:-1]] == SINGULAR, kinds[network.stop_offsets[1:] - 1] == SINGULAR
    s = network.sample_arclengths
    left = np.repeat(network.lengths, count) - s
    return np.minimum(np.where(np.repeat(first, count), s, np.inf), np.where(np.repeat(last, count), left, np.inf))


def _moved(charts: Charts, start: Places, towards: Floats, lengths: Floats) -> ChartSample:
    """What is seen where lamellas that leave places (n,) towards directions (n, 3) have isothermic lengths (n,)."""
    where, step = start, (lengths / LAYER_STEPS)[:, None]
    for _ in range(LAYER_STEPS):

        def rate(local: Floats, element: Integers = where.element) -> Floats:
            return _rate(charts.evaluate(Places(element, local)), towards)

        x = where.local
        k1 = rate(x)
        k2 = rate(x + step / 2 * k1)
        k3 = rate(x + step / 2 * k2)
        k4 = rate(x + step * k3)
        where = charts.settle(Places(where.element, x + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)))
    return charts.evaluate(where)


def _rate(sample: ChartSample, towards: Floats) -> Floats:
    """d(x, y) over the isothermic length of lamellas next to directions (n, 3), (n, 2)."""
    # the deviator turned to a lamella's direction has no real part
    heading = np.exp(0.5j * (np.pi / 2 - np.angle(sample.deviator)))
    aim = (sample.e_u * towards).sum(1) + 1j * (sample.e_v * towards).sum(1)
    other = 1j * heading
    along, across = (np.real(np.conj(h) * aim) for h in (heading, other))
    chosen = np.where(np.abs(along) > np.abs(across), np.sign(along) * heading, np.sign(across) * other)
    chosen /= np.maximum(np.sqrt(np.abs(sample.deviator)), LEAST_MU)
    return np.asarray(np.matmul(sample.to_local, np.stack([chosen.real, chosen.imag], 1)[:, :, None])[:, :, 0])


def _slot_shifts(
    network: Network, mu: Floats, length: Floats, unit: Floats, rates: Floats, stations: Floats, offsets: Floats
) -> Floats:
    """Where layers are crossed by those of the other lamella, see `Layers.slot_shifts`."""
    owner, node = network.stop_owner, network.stop_nodes
    at = network.sample_offsets[owner] + network.stop_samples
    is_a = network.families[owner] == "A"
    # of each family at each node: its unit, and its direction
    units, sides = np.zeros((2, len(network.node_points))), np.zeros((2, len(network.node_points), 3))
    for row, mine in enumerate((is_a, ~is_a)):
        units[row, node[mine]] = unit[at[mine]]
        sides[row, node[mine]] = np.cross(network.sample_normals[at[mine]], network.sample_tangents[at[mine]])
    other = is_a.astype(np.int64)
    # whether the other lamella's left lies ahead
    ahead = np.sign((sides[other, node] * network.sample_tangents[at]).sum(1))
    goal = length[at] + (ahead * units[other, node])[None, :] * offsets[:, None]
    shifts = np.empty((len(offsets), len(at), len(offsets)))
    for row in range(len(offsets)):
        # d station / d (isothermic length) is the layer's own rate over mu
        found = _reached(network, length, stations[row], rates[row] / np.maximum(mu, LEAST_MU), owner, goal)
        shifts[row] = np.sort((found - stations[row][at]).T, axis=1)
    return shifts


def _reached(network: Network, length: Floats, station: Floats, slope: Floats, owner: Integers, goal: Floats) -> Floats:
    """Stations where isothermic lengths (layers, q) along lamellas are reached: cubics between samples, straight on.

    Parameters
    ----------
    length, station, slope : (k,)
        Isothermic length from the lamella's start, station, and its derivative by that length.
    owner : (q,) int
    goal : (layers, q)
    """
    first, last = network.sample_offsets[owner], network.sample_offsets[owner + 1] - 1
    stride = 2 * float(length.max() + np.abs(goal).max(initial=0.0) + 1)
    keys = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets)) * stride + length
    wanted = owner * stride + np.clip(goal, 0, length[last])
    after = np.clip(np.searchsorted(keys, wanted), first + 1, last)
    before = after - 1
    step = length[after] - length[before]
    share = (goal - length[before]) / step
    inside = np.clip(share, 0, 1)
    low, high = slope[before] * step, slope[after] * step
    rise = station[after] - station[before]
    cubic = station[before] + inside * (low + inside * (3 * rise - 2 * low - high + inside * (low + high - 2 * rise)))
    beyond = np.where(share > 1, (share - 1) * high, np.where(share < 0, share * low, 0.0))
    return np.asarray(cubic + beyond)
