"""What drawings hold besides their curves: pieces of no length, and curves drawn twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from lamella.surface.boundary.pieces import Pieces

_MARKS = 5
"""Places of a curve that are compared."""


def without_short(pieces: Pieces, limit: float) -> tuple[Pieces, int]:
    """A polyline or run of arcs without pieces shorter than a limit, and how many these were.

    Splines stay as they are: their pieces may be short where the curve is not.
    """
    if pieces.degree > 2 or pieces.count < 2:
        return pieces, 0
    controls = pieces.controls[..., :3] / pieces.controls[..., 3:]
    lengths = np.linalg.norm(np.diff(controls, axis=1), axis=2).sum(1)
    if lengths.min() > limit:
        return pieces, 0
    kept, at = [], None
    for k, length in enumerate(lengths):
        # a short piece only moves where the next one begins; several in a row may come to more than the limit
        start = controls[k, 0] if at is None else at
        if length > limit or np.linalg.norm(controls[k, -1] - start) > limit:
            one = Pieces(pieces.controls[k : k + 1])
            kept.append(one if at is None else one.from_to(start, one.ends[0]))
            at = None
        elif at is None:
            at = start
    if len(kept) == pieces.count:
        return pieces, 0
    if at is not None and kept:
        kept[-1] = kept[-1].from_to(kept[-1].starts[0], controls[-1, -1])
    degree = max(one.degree for one in kept)
    return Pieces(np.concatenate([one.raised(degree).controls for one in kept])), pieces.count - len(kept)


def without_doubles(curves: Sequence[Pieces], limit: float) -> list[int]:
    """Indices of curves of which none lies on an earlier one, from end to end.

    Two curves are one where they have both ends and the places at a quarter, half and three quarters of their pieces
    within the limit, in either direction.
    """
    if not curves:
        return []
    marks = np.array([_marks(curve) for curve in curves]).reshape(len(curves), -1)
    backwards = marks.reshape(len(curves), -1, 3)[:, ::-1].reshape(len(curves), -1)
    tree = cKDTree(marks)
    kept: list[int] = []
    dropped = set[int]()
    for k in range(len(curves)):
        if k in dropped:
            continue
        kept.append(k)
        for turned in (marks[k], backwards[k]):
            dropped.update(j for j in tree.query_ball_point(turned, limit * np.sqrt(_MARKS)) if j > k)
    return kept


def _marks(curve: Pieces) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    along = np.linspace(0, 1, _MARKS) * curve.count
    piece = np.minimum(along.astype(np.int64), curve.count - 1)
    position, _, _ = curve.evaluate(piece, along - piece)
    return np.asarray(position)
