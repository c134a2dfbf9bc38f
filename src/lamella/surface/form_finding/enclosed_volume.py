"""The volume a film encloses, with lids over its loops, also where parts of these slide.

With origin o the body has the volume 1/3 of the integral of (x - o) . N over its skin: the film, lids over its loops as
they were drawn, and where a part has slid from L to R the strip between the two, in the plane or wall it slides on. A
lid is the cone over a closed curve from its centroid. A loop that is held or slides as a whole has one; a loop of which
parts slide has one over each of its stretches, held or sliding, closed by the chord between its ends, and one over the
polygon of these chords. So a vault between arches, whose sides slide on the ground, encloses what is between it, the
ground and the arches' own planes. A strip needs line integrals along both curves alone,

    plane through p with normal n   1/3 (p - o) . n  n . 1/2 (int_L x dx - int_R x dx)     (vector products)
    wall along e                    1/3 (int_R - int_L) (x . e) (x - o) . (dx x e)

whatever their parametrisations. The rim slides within plane or wall, and so the first variation of this volume is the
integral of phi d . N over the film alone: the film of a given volume meets plane and wall at 90 degrees.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.surface.element.geometry import tangents
from lamella.surface.element.placing import rim_parameters
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.form_finding.film import Film, Loop, Slide
from lamella.surface.form_finding.free_boundary import FreeRim, within

# pieces of a drawn loop between two corners at least, and points of each
LID_PIECES, LID_POINTS = 64, 8


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
            total += _lid((curve, step))
            continue
        held = loop.loop if isinstance(loop, FreeRim) else loop
        start, pieces = _pieces(held)
        drawn, drawn_step = _along(pieces - origin)
        sense = np.sign(span[mine][0])
        drawn_step *= sense
        chords = []
        for first, last, slide in stretches_of(loop):
            now, before = within(middle[mine], first, last), within(start, first, last)
            if slide is None:
                part = (curve[now], step[now])
            else:
                part = (drawn[before], drawn_step[before])
                total += _strip(slide, curve[now], step[now]) - _strip(slide, *part)
            if last - first < 1:
                ends = held.at(np.array([first, last]))[:: int(sense)] - origin
                chords.append(_along(ends[None]))
                total += _lid(part, _along(ends[None, ::-1]))
            else:
                total += _lid(part)
        if chords:
            total += _lid(*chords)
    return total


def stretches_of(loop: Loop) -> list[tuple[float, float, Slide | None]]:
    """Stretches of a loop from end to end: where each begins and ends, and on what it slides (None: held)."""
    slides = sorted(loop.slides, key=lambda slide: slide.start)
    result: list[tuple[float, float, Slide | None]] = []
    for slide, after in zip(slides, slides[1:] + slides[:1], strict=True):
        result.append((slide.start, slide.end, slide))
        gap = (after.start - slide.end) % 1
        if slide.end - slide.start < 1 and 1e-9 < gap < 1 - 1e-9:
            result.append((slide.end % 1, slide.end % 1 + gap, None))
    return result


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
    """Middles t of short pieces of a drawn loop that end at its corners, and points (m, LID_POINTS, 3) along them."""
    corners = np.asarray(loop.corners, float)
    marks = np.unique(np.concatenate([np.arange(LID_PIECES) / LID_PIECES, corners, [1.0]]))
    # next to a mark the other side of a corner must not be met by rounding
    share = np.linspace(1e-12, 1 - 1e-12, LID_POINTS)
    t = marks[:-1, None] + np.diff(marks)[:, None] * share
    return (marks[:-1] + marks[1:]) / 2, loop.at(t.ravel()).reshape(*t.shape, 3)


def _lid(*parts: tuple[Floats, Floats]) -> float:
    """Volume of the cones from the origin over a lid, whose rim runs against the surface's; (points, steps) of it."""
    curve, step = (np.concatenate([part[k].reshape(-1, 3) for part in parts]) for k in (0, 1))
    length = np.linalg.norm(step, axis=1)[:, None]
    centroid = (curve * length).sum(0) / length.sum()
    return -float((np.cross(curve, step) @ centroid).sum()) / 6


def _strip(slide: Slide, curve: Floats, step: Floats) -> float:
    """One curve's part in the volume of the cones from the origin over a strip."""
    if slide.direction is not None:
        e = np.asarray(slide.direction)
        return float(((curve @ e) * (curve * np.cross(step, e)).sum(2)).sum()) / 3
    n = np.asarray(slide.normal)
    height = float((curve @ n).mean())
    return -height * float((np.cross(curve, step) @ n).sum()) / 6
