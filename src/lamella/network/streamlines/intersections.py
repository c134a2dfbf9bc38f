"""Where the lines of two families cross, by Newton's method along both of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.network.streamlines.streamlines import Streamlines

# of a chord: how far beyond its ends a crossing may seem to be at first
SLACK = 0.6
CROSSING_NEWTON_STEPS = 8
# of the spacing: where Newton's method ends, what lines that cross miss each other by at most, and how near to each
# other crossings are one
CROSSING_TOLERANCE, CROSSING_MISS, SAME_CROSSING = 1e-10, 1e-6, 1e-5
# cosine between normals of two sheets of a surface that lie side by side
CROSSING_SAME_SIDE = 0.5


class Crossings(NamedTuple):
    """Lines a and b of the families A and B, and the arc lengths from their starts where they cross, each (c,)."""

    a: Integers
    b: Integers
    s_a: Floats
    s_b: Floats


class _Chords(NamedTuple):
    """Chords of lines from one kept state to the next, pointing forward along the line."""

    line: Integers
    middle: Floats
    vector: Floats
    s: Floats  # at the middle
    length: Floats


def find_crossings(lines: Streamlines, spacing: float) -> Crossings:
    """All crossings of A lines with B lines.

    Parameters
    ----------
    lines : Streamlines
    spacing : float
        Typical distance of nodes, m.
    """
    chords = _chords(lines)
    is_a = lines.is_a[chords.line]
    a, b = np.flatnonzero(is_a), np.flatnonzero(~is_a)
    nothing = np.zeros(0, np.int64)
    if not len(a) or not len(b):
        return Crossings(nothing, nothing, np.zeros(0), np.zeros(0))
    reach = float(chords.length.max()) * (0.5 + SLACK)
    near = cKDTree(chords.middle[a]).sparse_distance_matrix(
        cKDTree(chords.middle[b]), 2 * reach, output_type="coo_matrix"
    )
    a, b = a[near.row], b[near.col]
    # a chord has to be as near as both are long
    close = near.data <= (0.5 + SLACK) * (chords.length[a] + chords.length[b])
    a, b = a[close], b[close]
    x, y = _meet(
        chords.vector[a] / chords.length[a, None],
        chords.vector[b] / chords.length[b, None],
        chords.middle[b] - chords.middle[a],
    )
    inside = (np.abs(x) <= (0.5 + SLACK) * chords.length[a]) & (np.abs(y) <= (0.5 + SLACK) * chords.length[b])
    a, b, x, y = a[inside], b[inside], x[inside], y[inside]
    lines_a, lines_b = chords.line[a], chords.line[b]
    return _refined(lines, lines_a, lines_b, chords.s[a] + x, chords.s[b] + y, spacing)


def _refined(lines: Streamlines, a: Integers, b: Integers, s_a: Floats, s_b: Floats, spacing: float) -> Crossings:
    """Crossings from guesses of them, each once."""
    lengths = lines.lengths
    off = np.full(len(a), np.inf)
    for _ in range(CROSSING_NEWTON_STEPS):
        s_a, s_b = np.clip(s_a, 0, lengths[a]), np.clip(s_b, 0, lengths[b])
        _, sample_a, t_a = lines.at(a, s_a)
        _, sample_b, t_b = lines.at(b, s_b)
        apart = sample_b.position - sample_a.position
        off = np.linalg.norm(apart, axis=1)
        off[(sample_a.normal * sample_b.normal).sum(1) < CROSSING_SAME_SIDE] = np.inf
        if not (off > CROSSING_TOLERANCE * spacing).any():
            break
        x, y = _meet(t_a, t_b, apart)
        s_a, s_b = s_a + x, s_b + y
        # guesses that run away belong to no crossing
        kept = np.isfinite(off) & (np.abs(x) + np.abs(y) < 2 * spacing)
        a, b, s_a, s_b, off = a[kept], b[kept], s_a[kept], s_b[kept], off[kept]
    met = off <= CROSSING_MISS * spacing
    a, b, s_a, s_b = a[met], b[met], s_a[met], s_b[met]
    order = np.lexsort((s_a, b, a))
    a, b, s_a, s_b = a[order], b[order], s_a[order], s_b[order]
    again = np.zeros(len(a), bool)
    again[1:] = (a[1:] == a[:-1]) & (b[1:] == b[:-1]) & (np.diff(s_a) < SAME_CROSSING * spacing)
    return Crossings(a[~again], b[~again], s_a[~again], s_b[~again])


def _meet(u: Floats, v: Floats, apart: Floats) -> tuple[Floats, Floats]:
    """x, y for which x u = apart + y v, as nearly as can be, for unit vectors u and v, each (n,)."""
    across = (u * v).sum(1)
    determinant = np.maximum(1 - across**2, 1e-12)
    along_u, along_v = (apart * u).sum(1), (apart * v).sum(1)
    return (along_u - across * along_v) / determinant, (across * along_u - along_v) / determinant


def _chords(lines: Streamlines) -> _Chords:
    """All chords; the last one of a half goes to its end."""
    halves = np.arange(len(lines.length))
    line = halves // 2
    forward = halves % 2 == 1
    lengths = lines.lengths
    _, ends, _ = lines.at(line, np.where(forward, lengths[line], 0.0))
    last = np.searchsorted(lines.half, halves, side="right") - 1
    end, way = np.empty_like(lines.position), np.empty_like(lines.way)
    end[:-1], way[:-1] = lines.position[1:], lines.way[1:]
    end[last], way[last] = ends.position, lines.length
    sense = np.where(lines.half % 2 == 1, 1.0, -1.0)
    vector = sense[:, None] * (end - lines.position)
    owner = lines.half // 2
    s = lines.length[2 * owner] + sense * (lines.way + way) / 2
    length = np.linalg.norm(vector, axis=1)
    some = length > 0
    return _Chords(owner[some], ((lines.position + end) / 2)[some], vector[some], s[some], length[some])
