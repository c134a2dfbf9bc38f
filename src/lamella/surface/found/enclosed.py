"""The volume a film encloses, with lids over its loops, also where parts of these slide.

With origin o the body has the volume 1/3 of the integral of (x - o) . N over its skin: the film, the lid of each loop
as it was drawn (the cone from its centroid), and where a part has slid from L to R the strip between the two, in the
plane or wall it slides on. A strip needs line integrals along both curves alone,

    plane through p with normal n   1/3 (p - o) . n  n . 1/2 (int_L x dx - int_R x dx)     (vector products)
    wall along e                    1/3 (int_R - int_L) (x . e) (x - o) . (dx x e)

whatever their parametrisations. The rim slides within plane or wall, and so the first variation of this volume is the
integral of phi d . N over the film alone: the film of a given volume meets plane and wall at 90 degrees.
"""

from __future__ import annotations

import numpy as np

from lamella.surface.element.geometry import tangents
from lamella.surface.element.placing import rim_parameters
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.found.film import Film, Loop, Slide
from lamella.surface.found.slid_rim import SlidRim, within
from lamella.surface.points import Floats

# pieces of a drawn loop between two corners at least, and points of each
PIECES, POINTS = 64, 8


def enclosed_volume(film: Film) -> float:
    """Volume between a film and lids over its loops as they were drawn, m^3.

    Positive where the normal points out of it; on films without sliding parts `ElementSurface.volume`.
    """
    origin = film.nodes.mean(0)
    basis = film.connectivity.basis
    points, weights = triangle_rule(3 * basis.order - 2 + basis.order % 2)
    corners = film.nodes[film.connectivity.elements]
    slopes = (basis.basis(points, 1, 0), basis.basis(points, 0, 1))
    skin = ((np.matmul(basis.basis(points), corners - origin) * np.cross(*tangents(*slopes, corners))).sum(2)) @ weights
    total = float(skin.sum()) / 3
    rim_nodes = film.connectivity.rim_nodes
    of_loop = film.mesh.loop[rim_nodes[:, 0]]
    t = rim_parameters(film.connectivity, film.mesh.parameter)
    span = (t[:, -1] - t[:, 0] + 0.5) % 1 - 0.5
    middle = (t[:, 0] + span / 2) % 1
    for index, loop in enumerate(film.loops):
        mine = of_loop == index
        curve, step = _along(film.nodes[rim_nodes[mine]] - origin)
        if not loop.slides:
            total += _lid(curve, step)
            continue
        start, pieces = _pieces(loop.loop if isinstance(loop, SlidRim) else loop)
        drawn, drawn_step = _along(pieces - origin)
        drawn_step *= np.sign(span[mine][0])
        held = np.ones(len(curve), bool)
        rim = []
        for slide in loop.slides:
            now, before = within(middle[mine], slide), within(start, slide)
            total += _strip(slide, curve[now], step[now]) - _strip(slide, drawn[before], drawn_step[before])
            held &= ~now
            rim.append((drawn[before], drawn_step[before]))
        rim.append((curve[held], step[held]))
        total += _lid(*(np.concatenate([part[k].reshape(-1, 3) for part in rim]) for k in (0, 1)))
    return total


def _along(edges: Floats) -> tuple[Floats, Floats]:
    """Points and weighted steps (e, q, 3) along polynomial edges (e, p + 1, 3)."""
    p = edges.shape[1] - 1
    places, weights = np.polynomial.legendre.leggauss(2 * p)
    places, weights = (places + 1) / 2, weights / 2
    to_powers = np.linalg.inv(np.vander(np.linspace(0, 1, p + 1), increasing=True))
    value = np.vander(places, p + 1, increasing=True) @ to_powers
    slope = (np.arange(1, p + 1) * np.vander(places, p, increasing=True)) @ to_powers[1:]
    return np.matmul(value, edges), np.matmul(slope, edges) * weights[:, None]


def _pieces(loop: Loop) -> tuple[Floats, Floats]:
    """Middles t of short pieces of a drawn loop that end at its corners, and points (m, POINTS, 3) along them."""
    corners = np.asarray(loop.corners, float)
    marks = np.unique(np.concatenate([np.arange(PIECES) / PIECES, corners, [1.0]]))
    # next to a mark the other side of a corner must not be met by rounding
    share = np.linspace(1e-12, 1 - 1e-12, POINTS)
    t = marks[:-1, None] + np.diff(marks)[:, None] * share
    return (marks[:-1] + marks[1:]) / 2, loop.at(t.ravel()).reshape(*t.shape, 3)


def _lid(curve: Floats, step: Floats) -> float:
    """Volume of the cones from the origin over a lid, whose rim runs against the surface's."""
    length = np.linalg.norm(step, axis=-1)[..., None]
    centroid = (curve * length).sum(axis=tuple(range(curve.ndim - 1))) / length.sum()
    return -float((np.cross(curve, step) @ centroid).sum()) / 6


def _strip(slide: Slide, curve: Floats, step: Floats) -> float:
    """One curve's part in the volume of the cones from the origin over a strip."""
    if slide.direction is not None:
        e = np.asarray(slide.direction)
        return float(((curve @ e) * (curve * np.cross(step, e)).sum(2)).sum()) / 3
    n = np.asarray(slide.normal)
    height = float((curve @ n).mean())
    return -height * float((np.cross(curve, step) @ n).sum()) / 6
