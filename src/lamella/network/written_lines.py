"""Centre lines as they are written: tangents and normal curvature from the points of their samples alone.

On elements a centre line has a small kink wherever it goes over from one element to the next, by as much as the
elements' tangent planes differ there, and next to an umbilic or a corner of the rim its points are as good as the
surface is. The surface's derivatives, inside the elements, know nothing of this; who builds or measures the line meets
it. So the figures of a net are taken from both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.blocks import blocks
from lamella.base.vectors import dots, lengths
from lamella.network.network import Network
from lamella.surface.darboux import Darboux

# samples to either side of one through which a polynomial is laid, and its degree
STENCIL_SAMPLES, STENCIL_DEGREE = 3, 4
# part of a polynomial's term that is new over the terms before it: less is rounding
NOTHING = 1e-13
# lines of more samples are not judged by their first and last ones, where the polynomial is one-sided
SHORT = 12


@dataclass(frozen=True)
class WrittenLines:
    """What the written points of a network tell of its lines.

    Attributes
    ----------
    tangents : (k, 3)
        Unit tangents at the samples.
    bend : (k,)
        Normal curvature, 1/m.
    inner : (i,) int
        Samples whose normal curvature tells something: all but the first and last ones of open lines, unless these are
        short.
    """

    tangents: Floats
    bend: Floats
    inner: Integers

    @classmethod
    def of(cls, network: Network) -> WrittenLines:
        """Those of a network.

        By the polynomial of degree four in the arc length that fits seven neighbouring samples best (Savitzky and
        Golay, Anal. Chem. 36 (1964), 1627-1639, doi:10.1021/ac60214a047), the nearest seven at the ends. Off by the
        fourth power of the samples' distance; a kink reads as curvature over the samples beside it.
        """
        first, second = _derivatives(network, network.sample_points, _steps(network))
        return cls(_unit(first), dots(second, network.sample_normals), _inner(network))

    def bend_off(self, network: Network, wanted: float) -> Floats:
        """Difference of the normal curvature at the samples from a wanted one, 1/m: the larger of both, (k,)."""
        off = np.abs(network.sample_darboux.kn - wanted)
        off[self.inner] = np.maximum(off[self.inner], np.abs(self.bend[self.inner] - wanted))
        return off

    def node_angles(self, network: Network) -> Floats:
        """Angles between the A and the B lamella at every regular node, deg, by surface and by points, (2, n)."""
        return np.stack([network.node_angles, network.angles_between(self.tangents)])


def angle_figures(angles: Floats, wanted: float = 90.0) -> dict[str, float]:
    """What summary.json tells of node angles (2, n), deg: the worse of both ways to measure them, and off a wanted one.

    Angles between lines are those up to 90 degrees.
    """
    off = np.abs(min(wanted, 180 - wanted) - angles).max(0)
    return {
        "node_angle_min_deg": float(angles.min()),
        "node_angle_max_deg": float(angles.max()),
        "node_angle_deviation_max_deg": float(off.max()),
        "node_angle_deviation_mean_deg": float(off.mean()),
    }


def written_darboux(network: Network) -> tuple[Floats, Darboux]:
    """Unit tangents (k, 3) and Darboux curvatures of a network's lines, from their points and normals alone.

    By the same polynomials as `WrittenLines`: kn = t' . n, kg = t' . u, tg = -n' . u.
    """
    steps, normals = _steps(network), network.sample_normals
    first, second = _derivatives(network, network.sample_points, steps)
    tangents = _unit(first - dots(first, normals)[:, None] * normals)
    sideways = np.cross(normals, tangents)
    turned, _ = _derivatives(network, normals, steps)
    return tangents, Darboux(dots(second, normals), dots(second, sideways), -dots(turned, sideways))


def _steps(network: Network) -> Floats:
    """Arc lengths from each sample's predecessor, (k,) m; 0 at the start of a line."""
    chords = np.r_[0.0, lengths(np.diff(network.sample_points, axis=0))]
    chords[network.sample_offsets[:-1]] = 0.0
    bends = lengths(_derivatives(network, network.sample_points, chords)[1])
    # the arc over a chord, by the circle through its ends
    bends[1:] = (bends[1:] + bends[:-1]) / 2
    return np.asarray(chords * (1 + (bends * chords) ** 2 / 24))


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.maximum(lengths(vectors), np.finfo(float).tiny)[:, None])


def _derivatives(network: Network, values: Floats, steps: Floats) -> tuple[Floats, Floats]:
    """First and second derivatives of values (k, 3) at all samples, by the length of the steps to them, (k,) m."""
    along, count = np.cumsum(steps), np.diff(network.sample_offsets)
    half = np.minimum(STENCIL_SAMPLES, (count - 1) // 2)
    first, second = np.zeros((2, *values.shape))
    for reach in np.unique(half[half > 0]).tolist():
        samples = np.flatnonzero(np.repeat(half == reach, count))
        for block in blocks(len(samples)):
            at = samples[block]
            window, away = _windows(network, at, reach, along)
            weights = _weights(np.ascontiguousarray(away.T))
            # numbers that differ little are fitted: from the sample itself
            own = values[at]
            for number, one in enumerate(window.T):
                apart = values[one] - own
                first[at] += weights[0, number, :, None] * apart
                second[at] += weights[1, number, :, None] * apart
    return first, second


def _inner(network: Network) -> Integers:
    count = np.diff(network.sample_offsets)
    place = np.arange(count.sum()) - np.repeat(network.sample_offsets[:-1], count)
    last = np.repeat(count - 1, count)
    whole = np.repeat(network.closed | (count <= SHORT), count)
    return np.flatnonzero(whole | ((place >= STENCIL_SAMPLES) & (place <= last - STENCIL_SAMPLES)))


def _windows(network: Network, samples: Integers, reach: int, along: Floats) -> tuple[Integers, Floats]:
    """The 2 reach + 1 samples around each (s,), and how far along the line they are from it, m, (s, 2 reach + 1)."""
    owner = np.searchsorted(network.sample_offsets, samples, side="right") - 1
    begin = network.sample_offsets[owner]
    last = network.sample_offsets[owner + 1] - 1 - begin
    place = (samples - begin)[:, None] + np.arange(-reach, reach + 1)
    closed = (network.closed[owner] & (last > 2 * reach))[:, None]
    turn = np.where(closed, np.floor_divide(place, last[:, None]), 0)
    shift = np.where(closed[:, 0], 0, np.minimum(place[:, 0], 0) + np.maximum(place[:, -1] - last, 0))
    window = begin[:, None] + place - turn * last[:, None] - shift[:, None]
    length = along[begin + last] - along[begin]
    return window, along[window] - along[samples][:, None] + turn * length[:, None]


def _weights(away: Floats) -> Floats:
    """Weights of values at arguments (w, s) in the derivatives at 0 of the polynomial that fits them best, (2, w, s).

    By polynomials that are orthogonal on the arguments, from their three-term recurrence (Forsythe, J. SIAM 5 (1957),
    74-88, doi:10.1137/0105007): all samples at once, where a factorisation for each takes ten times as long.
    """
    scale = np.maximum(np.abs(away).max(0), np.finfo(float).tiny)
    x = away / scale
    # the polynomials of this degree and of the one before: at the arguments; value and two derivatives at 0
    own, before = np.ones_like(x), np.zeros_like(x)
    at_zero, earlier = np.zeros((2, 3, x.shape[1]))
    at_zero[0] = 1.0
    size_before = np.ones(x.shape[1])
    weights = np.zeros((2, *x.shape))
    for degree in range(min(STENCIL_DEGREE, len(x) - 1) + 1):
        square = own * own
        size = square.sum(0)
        # of samples in one place fewer derivatives follow
        tells = size > NOTHING**2
        size = np.where(tells, size, 1.0)
        share = np.where(tells, own / size, 0.0)
        weights[0] += at_zero[1] * share
        weights[1] += at_zero[2] * share
        middle = (x * square).sum(0) / size
        ratio = size / size_before if degree else np.zeros_like(size)
        after = (x - middle) * own - ratio * before
        there = -middle * at_zero - ratio * earlier
        there[1] += at_zero[0]
        there[2] += 2 * at_zero[1]
        own, before, at_zero, earlier, size_before = after, own, there, at_zero, size
    return np.asarray(weights / np.stack((scale, scale**2))[:, None])
