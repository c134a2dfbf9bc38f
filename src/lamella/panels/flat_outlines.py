"""Flat outlines of panels: corners in the plane of the plate that each is cut from.

- A flat panel is projected onto its plane.
- A single-curved panel is a piece of the cylinder through its four corners whose axis is parallel to its shorter
  diagonal. Seen along that diagonal, its two ends are one point; the circle through this point and the two others is
  the section of the cylinder. Laid flat, corners are at the arc along the section and at the place along the axis; the
  sides between them are straight when flat, on the cylinder helices.
- A panel that is bent cold has no flat state of the same lengths everywhere; its outline has the lengths of its sides,
  and diagonals that have one ratio to those in space.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.panels.flatness import shorter_diagonal

BISECTIONS = 60


def projected(corner: Floats, origins: Floats, axes: Floats) -> Floats:
    """Corners (q, n, 3) in the planes with these origins (q, 3) and axes (q, 3, 3), (q, n, 2) m."""
    return np.asarray(np.einsum("qni,qki->qnk", corner - origins[:, None], axes[:, :2]))


def on_cylinders(corner: Floats) -> tuple[Floats, Floats]:
    """Quads (q, 4, 3) on cylinders laid flat.

    Returns
    -------
    outlines : (q, 4, 2)
        m.
    radii : (q,)
        Of the cylinders, m; infinite where the quad is flat.
    """
    shift = shorter_diagonal(corner)[:, None]
    order = (np.arange(4) + shift) % 4
    turned = np.take_along_axis(corner, order[:, :, None], axis=1)
    start, axis = turned[:, 0], turned[:, 2] - turned[:, 0]
    axis = axis / np.linalg.norm(axis, axis=1)[:, None]
    along = np.einsum("qni,qi->qn", turned - start[:, None], axis)
    flat = np.stack([np.zeros_like(along), along], axis=2)
    across = (turned - start[:, None]) - along[:, :, None] * axis[:, None]
    right, left = across[:, 1], across[:, 3]
    a, b, chord = (np.linalg.norm(v, axis=1) for v in (right, left, right - left))
    double = np.linalg.norm(np.cross(right, left), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        radii = np.where(double > 1e-12 * a * b, a * b * chord / (2 * double), np.inf)
    # arcs over the chords from the diagonal to either side
    flat[:, 1, 0], flat[:, 3, 0] = _arc(a, radii), -_arc(b, radii)
    outlines = np.empty_like(flat)
    np.put_along_axis(outlines, np.broadcast_to(order[:, :, None], flat.shape), flat, axis=1)
    return outlines, radii


def _arc(chord: Floats, radius: Floats) -> Floats:
    """Arc over a chord, m."""
    with np.errstate(invalid="ignore"):
        arc = 2 * radius * np.arcsin(np.minimum(chord / (2 * radius), 1.0))
    return np.asarray(np.where(np.isfinite(radius), arc, chord))


def with_true_sides(corner: Floats) -> Floats:
    """Quads (q, 4, 3) laid flat with the lengths of their sides, (q, 4, 2) m."""
    sides = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
    first, second = (np.linalg.norm(corner[:, k] - corner[:, k + 2], axis=1) for k in (0, 1))
    # both diagonals are longer when flat: by a share between none and what makes one of two triangles straight
    reach = np.minimum(sides[:, 0] + sides[:, 1], sides[:, 2] + sides[:, 3])
    low, high = first.copy(), reach
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        flat = _two_triangles(sides, middle)
        other = np.linalg.norm(flat[:, 1] - flat[:, 3], axis=1)
        longer = middle * second > other * first
        low, high = np.where(longer, low, middle), np.where(longer, middle, high)
    return _two_triangles(sides, (low + high) / 2)


def _two_triangles(sides: Floats, diagonal: Floats) -> Floats:
    """Quads with these sides (q, 4), and diagonal from corner 0 to corner 2, which runs along x."""
    flat = np.zeros((len(sides), 4, 2))
    flat[:, 2, 0] = diagonal
    for corner, near, far, sign in ((1, 0, 1, -1.0), (3, 3, 2, 1.0)):
        x = (diagonal**2 + sides[:, near] ** 2 - sides[:, far] ** 2) / (2 * diagonal)
        flat[:, corner, 0] = x
        flat[:, corner, 1] = sign * np.sqrt(np.maximum(sides[:, near] ** 2 - x**2, 0))
    return flat
