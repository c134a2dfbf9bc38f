"""Outlines moved by half a kerf: lines stay lines and arcs arcs, corners are where the moved ones meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats

# sine of the angle between segments that go over into each other smoothly
SMOOTH_SINE = 1e-6
# m: an arc with less radius is a corner
NO_RADIUS = 1e-9


@dataclass(frozen=True)
class _Segments:
    """Segments of a closed outline: lines, and arcs about centres; each (n,)."""

    begin: Complexes
    end: Complexes
    angles: Floats
    centres: Complexes
    radii: Floats
    leaving: Complexes
    arriving: Complexes

    @classmethod
    def of(cls, vertices: Floats) -> _Segments:
        begin, bulge = vertices[:, 0] + 1j * vertices[:, 1], vertices[:, 2]
        end = np.roll(begin, -1)
        chord = end - begin
        arc = bulge != 0
        safe = np.where(arc, bulge, 1.0)
        centres = np.where(arc, 0.5 * (begin + end) + 1j * chord * (1 - safe**2) / (4 * safe), np.nan)
        angles = 4 * np.arctan(bulge)
        along = chord / np.abs(chord)
        half = np.exp(0.5j * angles)
        return cls(begin, end, angles, centres, np.abs(begin - centres), along / half, along * half)

    def kept(self, some: Booleans) -> _Segments:
        return _Segments(*(values[some] for values in vars(self).values()))


def offset_outline(vertices: Floats, distance: float) -> Floats:
    """A closed counter-clockwise outline, every segment moved to its outside.

    Parameters
    ----------
    vertices : (v, 3)
        x, y in m and bulge, see `lamella.fabrication.axis.outline`.
    distance : float
        m; < 0 moves to the inside.

    Returns
    -------
    (w, 3) array
        Arcs whose radius would be gone are left out: their neighbours meet.

    Raises
    ------
    ValueError
        Segments would be turned round: the outline has parts narrower than twice the distance.
    """
    if not distance:
        return vertices
    segments = _Segments.of(vertices)
    is_arc = segments.angles != 0
    radii = np.where(is_arc, segments.radii + distance * np.sign(segments.angles), np.inf)
    kept = radii > NO_RADIUS
    followed = kept & np.roll(kept, 1)
    segments, radii, touching = segments.kept(kept), radii[kept], followed[kept]
    corners = _corners(segments, radii, distance, touching)
    following = np.roll(corners, -1)
    arc = segments.angles != 0
    spokes = np.where(arc, corners - segments.centres, 1.0), np.where(arc, following - segments.centres, 1.0)
    turn = np.angle(spokes[1] * np.conj(spokes[0]))
    turn = np.where(segments.angles > 0, np.mod(turn, 2 * np.pi), -np.mod(-turn, 2 * np.pi))
    ahead = np.real((following - corners) * np.conj(segments.leaving))
    if np.any(~arc & (ahead <= 0)) or np.any(arc & (np.abs(turn - segments.angles) > np.pi)):
        raise ValueError("an outline is narrower than the kerf")
    return np.column_stack([corners.real, corners.imag, np.where(arc, np.tan(0.25 * turn), 0.0)])


def _corners(segments: _Segments, radii: Floats, distance: float, touching: Booleans) -> Complexes:
    """Where each moved segment begins: where it meets the one before."""
    before = _Segments(*(np.roll(values, 1) for values in vars(segments).values()))
    radii_before = np.roll(radii, 1)
    near = np.where(touching, segments.begin, 0.5 * (before.end + segments.begin))
    # both pass through the moved ends of their segments; the outside is on the right
    one, other = before.end - 1j * distance * before.arriving, segments.begin - 1j * distance * segments.leaving
    sine = np.imag(np.conj(before.arriving) * segments.leaving)
    smooth = touching & (np.abs(sine) < SMOOTH_SINE)
    line_before, line = before.angles == 0, segments.angles == 0
    found = np.where(smooth, other, np.nan + 0j)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # one + share * arriving lies on the line through the other
        share = np.imag(np.conj(segments.leaving) * (other - one)) / -sine
        straight = one + share * before.arriving
        first = _on_circle(one, before.arriving, segments.centres, radii, near)
        second = _on_circle(other, segments.leaving, before.centres, radii_before, near)
        circles = _of_circles(before.centres, radii_before, segments.centres, radii, near)
    for mask, points in (
        (line_before & line, straight),
        (line_before & ~line, first),
        (~line_before & line, second),
        (~line_before & ~line, circles),
    ):
        found = np.where(mask & ~smooth, points, found)
    return np.asarray(found)


def _on_circle(point: Complexes, along: Complexes, centre: Complexes, radius: Floats, near: Complexes) -> Complexes:
    """Where lines meet circles, of both places the one nearer to `near`."""
    ahead = np.real((centre - point) * np.conj(along))
    foot = point + ahead * along
    reach = np.sqrt(np.maximum(radius**2 - np.abs(centre - foot) ** 2, 0.0)) * along
    return _nearer(foot + reach, foot - reach, near)


def _of_circles(one: Complexes, r: Floats, other: Complexes, s: Floats, near: Complexes) -> Complexes:
    """Where circles meet, of both places the one nearer to `near`."""
    apart = np.abs(other - one)
    along = (other - one) / apart
    ahead = (apart**2 + r**2 - s**2) / (2 * apart)
    reach = 1j * along * np.sqrt(np.maximum(r**2 - ahead**2, 0.0))
    foot = one + ahead * along
    return _nearer(foot + reach, foot - reach, near)


def _nearer(one: Complexes, other: Complexes, near: Complexes) -> Complexes:
    return np.where(np.abs(one - near) <= np.abs(other - near), one, other)
