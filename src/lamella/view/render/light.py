"""Sun, sky and shadows of a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.view.render.raster import rasterise
from lamella.view.render.soup import linear_of
from lamella.view.render.standpoint import Standpoint, dot

SUN_AZIMUTH, SUN_ELEVATION = -52.0, 48.0
"""Degrees: to the left of the eye, above the horizon."""

MAP_SIZE = 2400
"""Pixels of a shadow's picture each way, at most."""

SUN, SKY, EARTH = 2.05, np.array([0.92, 0.96, 1.0]) * 0.62, np.array([1.0, 0.95, 0.88]) * 0.30
"""Light of the sun, of the sky above and of the ground below; a white surface in the sun is about 1."""

SKY_TOP, SKY_LOW = linear_of("#eef3f8"), linear_of("#fbfcfd")
GROUND = linear_of("#cfcdc6")

SUN_SOFT = 1.5
"""Pixels of its picture about which the sun's shadow is blurred."""
SKY_SOFT = 14.0
"""The same of what hides the sky."""


@dataclass(frozen=True, eq=False)
class ShadowMap:
    """How far things reach towards a light far away.

    Attributes
    ----------
    towards, right, up : (3,)
        Orthonormal; to the light.
    corner : (2,)
        Of the picture, along right and up, m.
    pixel : float
        Size of a pixel, m.
    height : (n, n)
        Largest distance towards the light, m; -infinite where there is nothing.
    """

    towards: Floats
    right: Floats
    up: Floats
    corner: Floats
    pixel: float
    height: Floats

    @classmethod
    def of(cls, corners: Floats, towards: Floats, size: int) -> ShadowMap:
        """Of triangles (t, 3, 3), seen from where the light comes, for a picture of some pixels."""
        size = min(size, MAP_SIZE)
        side = np.array([1.0, 0.0, 0.0]) if abs(towards[2]) > 0.9 else np.array([0.0, 0.0, 1.0])
        right = np.cross(side, towards)
        right /= np.sqrt((right**2).sum())
        up = np.cross(towards, right)
        flat = np.stack([dot(corners, right), dot(corners, up)], axis=-1)
        low, high = flat.min((0, 1)), flat.max((0, 1))
        pixel = max(float((high - low).max()), np.finfo(float).tiny) / (size - 4)
        corner = low - 2 * pixel
        seen = rasterise((flat - corner) / pixel, -dot(corners, towards), size, size)
        return cls(towards, right, up, corner, pixel, -seen.depth)

    def lit(self, points: Floats, soft: float) -> Floats:
        """Share of a light of some width that points (n, 3) see: the mean of nine rays `soft` pixels apart."""
        x = (dot(points, self.right) - self.corner[0]) / self.pixel
        y = (dot(points, self.up) - self.corner[1]) / self.pixel
        height = dot(points, self.towards) + 2.5 * self.pixel
        last = len(self.height) - 1
        lit = np.zeros(len(points))
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                column = np.clip(x + soft * dx, 0, last).astype(np.int64)
                row = np.clip(y + soft * dy, 0, last).astype(np.int64)
                lit += self.height[row, column] <= height
        return lit / 9


def sun_of(camera: Standpoint) -> Floats:
    """Direction to the sun, which stands to the left of the eye, unit."""
    azimuth = np.arctan2(-camera.ahead[1], -camera.ahead[0]) + np.radians(SUN_AZIMUTH)
    elevation = np.radians(SUN_ELEVATION)
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def sky_of(up: Floats) -> Floats:
    """Light of the sky (n, 3) seen in directions whose z are `up`."""
    share = np.sqrt(np.clip(up, 0, 1))[:, None]
    return np.asarray(SKY_LOW + share * (SKY_TOP - SKY_LOW))
