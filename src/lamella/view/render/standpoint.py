"""Where a picture is taken from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError

VIEWS: dict[str, tuple[float, float, float]] = {
    "iso": (0.75, -1.15, 0.62),
    "top": (0.0, -0.001, 1.0),
    "front": (0.0, -1.0, 0.001),
    "back": (0.0, 1.0, 0.001),
    "side": (1.0, 0.0, 0.001),
    "left": (-1.0, 0.0, 0.001),
    "eye": (0.75, -1.15, 0.0),
}
"""Directions to the eye; "eye": from where a person sees it who stands on the ground."""

FIELD = 32.0
"""Height of the picture as an angle, degrees."""

EYE_LEVEL = 1.6
"""Of a person, m above the ground."""

PICTURE_MARGIN = 1.06
CENTRINGS = 24
"""Times that the picture's middle is corrected: far points move less than near ones."""
NEAR = 1e-3
"""Distance before which nothing is seen, over that of the eye from what it looks at."""


@dataclass(frozen=True, eq=False)
class Standpoint:
    """A perspective camera.

    Attributes
    ----------
    eye : (3,)
        m.
    right, up, ahead : (3,)
        Orthonormal; the picture's axes, and where it looks to.
    distance : float
        From the eye to what it looks at, m.
    """

    eye: Floats
    right: Floats
    up: Floats
    ahead: Floats
    distance: float

    def local(self, points: Floats) -> Floats:
        """To the right, up, and ahead of the eye, m."""
        away = points - self.eye
        return np.stack([dot(away, axis) for axis in (self.right, self.up, self.ahead)], axis=-1)

    def pixels(self, points: Floats, width: int, height: int) -> tuple[Floats, Floats]:
        """Places (..., 2) in a picture, pixels, y down, and distances ahead (...), m."""
        local = self.local(points)
        ahead = local[..., 2]
        scale = focal(height) / np.where(np.abs(ahead) > 0, ahead, np.inf)
        return np.stack([width / 2 + local[..., 0] * scale, height / 2 - local[..., 1] * scale], axis=-1), ahead


def focal(height: int) -> float:
    """Pixels of a picture that has the size of its distance."""
    return float(height / (2 * np.tan(np.radians(FIELD) / 2)))


def dot(vectors: Floats, axis: Floats) -> Floats:
    """Products of vectors (..., 3) with an axis, summed in one order whatever the processor."""
    return np.asarray(vectors[..., 0] * axis[0] + vectors[..., 1] * axis[1] + vectors[..., 2] * axis[2])


def direction_of(view: str) -> Floats:
    """Direction to the eye, unit.

    Parameters
    ----------
    view : str
        One of `VIEWS`, or "azimuth,elevation" in degrees.

    Raises
    ------
    InputError
        Neither.
    """
    if view in VIEWS:
        found = np.array(VIEWS[view])
        return np.asarray(found / np.sqrt((found**2).sum()))
    remedy = f"choose one of {', '.join(VIEWS)}, or azimuth and elevation in degrees: --view=-60,20"
    try:
        azimuth, elevation = (float(part) for part in view.split(","))
    except ValueError:
        raise InputError(f"there is no view {view!r}", remedy, "--view") from None
    if not (np.isfinite(azimuth) and -90 <= elevation <= 90):
        raise InputError(f"view {view!r}: an elevation is from -90 to 90 degrees", remedy, "--view")
    a, e = np.radians((azimuth, min(max(elevation, -89.9), 89.9)))
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def standpoint(view: str, points: Floats, ground: float, width: int, height: int) -> Standpoint:
    """The camera that sees all points (n, 3), as large as the picture allows.

    Raises
    ------
    InputError
        No such view.
    """
    back = direction_of(view)
    low, high = points.min(0), points.max(0)
    camera = _framed((low + high) / 2, points, back, width / height)
    if view == "eye":
        # from the height of a person, looking up or down to the middle
        rise = ground + EYE_LEVEL - (low + high)[2] / 2
        level = np.sqrt(max(camera.distance**2 - rise**2, (0.5 * camera.distance) ** 2))
        back = np.array([back[0] * level, back[1] * level, rise])
        camera = _framed((low + high) / 2, points, back / np.sqrt((back**2).sum()), width / height)
    return camera


def _framed(target: Floats, points: Floats, back: Floats, aspect: float) -> Standpoint:
    """The nearest camera in a direction that sees all points, with as much room on either side."""
    right = np.array([-back[1], back[0], 0.0]) / np.hypot(back[0], back[1])
    up = np.cross(back, right)
    for _ in range(CENTRINGS):
        distance = _fitting(points - target, right, up, back, aspect)
        camera = Standpoint(target + distance * back, right, up, -back, distance)
        local = camera.local(points)
        seen = local[:, :2] / local[:, 2:]
        middle = distance * (seen.min(0) + seen.max(0)) / 2
        target = target + middle[0] * right + middle[1] * up
    return camera


def _fitting(points: Floats, right: Floats, up: Floats, back: Floats, aspect: float) -> float:
    """Distance from the origin at which all points are inside the picture."""
    tall = np.tan(np.radians(FIELD) / 2)
    needed = np.maximum(np.abs(dot(points, right)) / (tall * aspect), np.abs(dot(points, up)) / tall)
    return max(float((dot(points, back) + PICTURE_MARGIN * needed).max()), np.finfo(float).tiny)
