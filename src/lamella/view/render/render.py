"""Pictures of scenes by our own renderer: no screen, no browser, the same bytes in every run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.view.render.light import EARTH, GROUND, SKY, SKY_SOFT, SUN, SUN_SOFT, ShadowMap, sky_of, sun_of
from lamella.view.render.raster import NO_TRIANGLE, Seen, rasterise
from lamella.view.render.soup import Soup, shown_layers, soup_of
from lamella.view.render.standpoint import NEAR, Standpoint, dot, focal, standpoint
from lamella.view.scene.scene import Scene

SUBPIXELS = 2
"""Pixels are drawn so much smaller each way, and put together."""

PIECE_PIXELS = 5.0
"""Samples of strips that are nearer to each other in the picture are left out."""

BAND = 128
"""Rows of a picture that are shaded together."""

SIZE_LEAST, SIZE_MOST = 16, 8192
"""Of a picture, pixels each way."""

FADE = 1.3, 3.2
"""Distances from the middle over which the ground goes over into the sky, over the size of what stands on it."""


def render(
    scene: Scene, *, view: str = "iso", size: tuple[int, int] = (1600, 1000), colour: str = "", surface: bool = False
) -> NDArray[np.uint8]:
    """A picture of a scene.

    Parameters
    ----------
    scene : Scene
    view : str
        See `lamella.view.render.standpoint.direction_of`.
    size : (int, int)
        Width and height, pixels.
    colour : str
        Key of a quantity that strips are coloured by, "layer": by their family; empty: as their material looks.
    surface : bool
        Whether the surface is shown with its strips.

    Returns
    -------
    (height, width, 3) of 0 to 255

    Raises
    ------
    InputError
        There is no such view, no such quantity or nothing to see; a picture too small or too large.
    """
    refuse_size(size)
    _refuse_colour(scene, colour)
    width, height = (SUBPIXELS * side for side in size)
    points = np.concatenate([layer.points for layer in shown_layers(scene, surface=surface)] or [np.zeros((0, 3))])
    if not len(points):
        raise InputError("there is nothing to see", "compute a stage that shows something", "--until")
    ground = next((float(one.points[0, 2]) for one in scene.layers if one.name == "ground" and one.visible), None)
    camera = standpoint(view, points, float(scene.box[0][2]) if ground is None else ground, *size)
    piece = PIECE_PIXELS * SUBPIXELS * camera.distance / focal(height)
    soup = soup_of(scene, colour=colour, surface=surface, eye=camera.eye, piece=piece)
    picture = _Picture.of(soup, camera, width, height, ground)
    bands = [picture.band(row, min(row + BAND, height)) for row in range(0, height, BAND)]
    fine = np.concatenate(bands).reshape(size[1], SUBPIXELS, size[0], SUBPIXELS, 3).mean((1, 3))
    encoded = np.where(fine <= 0.0031308, 12.92 * fine, 1.055 * np.clip(fine, 0.0031308, None) ** (1 / 2.4) - 0.055)
    return np.asarray(np.rint(np.clip(encoded, 0, 1) * 255), np.uint8)


def refuse_size(size: tuple[int, int]) -> None:
    """Refuse a picture that is none, or that no memory holds.

    Raises
    ------
    InputError
    """
    if not all(SIZE_LEAST <= side <= SIZE_MOST for side in size):
        limit = f"each side from {SIZE_LEAST} to {SIZE_MOST} pixels"
        raise InputError(f"a picture of {size[0]} x {size[1]} pixels", limit, "--size")


def _refuse_colour(scene: Scene, colour: str) -> None:
    known = {one.key for layer in scene.layers for one in layer.quantities}
    if colour not in known | {"", "layer"}:
        raise InputError(
            f"there is no quantity {colour!r}", f"choose one of {', '.join(['family', *sorted(known)])}", "--colour"
        )


@dataclass(frozen=True, eq=False)
class _Picture:
    """What is needed to shade pixels."""

    soup: Soup
    camera: Standpoint
    flat: Floats
    ahead: Floats
    seen: Seen
    sun: ShadowMap
    sky: ShadowMap
    ground: float | None
    middle: Floats
    radius: float

    @classmethod
    def of(cls, soup: Soup, camera: Standpoint, width: int, height: int, ground: float | None) -> _Picture:
        flat, ahead = camera.pixels(soup.corners, width, height)
        a, b, c = flat[:, 0], flat[:, 1], flat[:, 2]
        turn = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
        # y runs downwards: what is seen from outside runs clockwise
        drawn = np.flatnonzero(((turn < 0) | soup.two_sided) & (ahead > NEAR * camera.distance).all(1))
        seen = rasterise(flat[drawn], -1 / ahead[drawn], width, height)
        triangle = np.where(
            seen.triangle == NO_TRIANGLE, NO_TRIANGLE, drawn[seen.triangle] if len(drawn) else NO_TRIANGLE
        )
        low, high = soup.corners.min((0, 1)), soup.corners.max((0, 1))
        return cls(
            soup,
            camera,
            flat,
            ahead,
            Seen(triangle, seen.depth),
            ShadowMap.of(soup.corners, sun_of(camera), max(width, height)),
            ShadowMap.of(soup.corners, np.array([0.0, 0.0, 1.0]), max(width, height)),
            ground,
            (low + high) / 2,
            float(np.sqrt(((high - low)[:2] ** 2).sum()) / 2),
        )

    def band(self, first: int, last: int) -> Floats:
        """Light of some rows of pixels, (rows, width, 3)."""
        triangle = self.seen.triangle[first:last].ravel()
        height, width = self.seen.triangle.shape
        row, column = np.divmod(np.arange(first * width, last * width), width)
        x, y = column + 0.5, row + 0.5
        rays = self._rays(x, y, width, height)
        light = sky_of(rays[:, 2] / np.sqrt((rays**2).sum(1)))
        self._put_ground(light, rays, -1 / self.seen.depth[first:last].ravel())
        own = np.flatnonzero(triangle != NO_TRIANGLE)
        behind = self._is_below_ground(rays[own], -1 / self.seen.depth[first:last].ravel()[own])
        own = own[~behind]
        light[own] = self._shaded(triangle[own], x[own], y[own], rays[own])
        return np.asarray(light.reshape(last - first, width, 3))

    def _rays(self, x: Floats, y: Floats, width: int, height: int) -> Floats:
        """Directions of pixels, whose part ahead is 1."""
        camera, scale = self.camera, focal(height)
        aside, up = (x - width / 2) / scale, (height / 2 - y) / scale
        return np.asarray(camera.ahead + aside[:, None] * camera.right + up[:, None] * camera.up)

    def _ground_ahead(self, rays: Floats) -> Floats:
        """How far ahead the ground is; infinite where there is none."""
        if self.ground is None or self.camera.eye[2] <= self.ground:
            return np.full(len(rays), np.inf)
        fall = -rays[:, 2]
        away = np.divide(self.camera.eye[2] - self.ground, fall, out=np.full(len(rays), np.inf), where=fall > 0)
        return np.asarray(away)

    def _is_below_ground(self, rays: Floats, ahead: Floats) -> NDArray[np.bool_]:
        # what stands on the ground is before it, whatever the rounding
        return np.asarray(ahead > 1.0001 * self._ground_ahead(rays))

    def _put_ground(self, light: Floats, rays: Floats, ahead: Floats) -> None:
        """Light of the ground, which fades into the sky far away, where nothing is before it."""
        away = self._ground_ahead(rays)
        own = np.flatnonzero(np.isfinite(away) & ((ahead <= 0) | (ahead >= 0.9999 * away) | ~np.isfinite(ahead)))
        points = self.camera.eye + away[own, None] * rays[own]
        out = np.sqrt(((points - self.middle)[:, :2] ** 2).sum(1)) / max(self.radius, np.finfo(float).tiny)
        near = out < FADE[1]
        own, points, out = own[near], points[near], out[near]
        share = np.clip((FADE[1] - out) / (FADE[1] - FADE[0]), 0, 1)
        share = share * share * (3 - 2 * share)
        sun = 0.42 * SUN * self.sun.lit(points, SUN_SOFT)
        sky = 0.35 + 0.65 * self.sky.lit(points, SKY_SOFT)
        ground = GROUND * (sun[:, None] + SKY * sky[:, None] * 0.72)
        light[own] += share[:, None] * (ground - light[own])

    def _shaded(self, triangle: Integers, x: Floats, y: Floats, rays: Floats) -> Floats:
        """Light (n, 3) that triangles send to pixels."""
        soup = self.soup
        weights = _weights(self.flat[triangle], self.ahead[triangle], x, y)
        points, normals, colours = (
            (weights[:, :, None] * values[triangle]).sum(1) for values in (soup.corners, soup.normals, soup.colours)
        )
        normals /= np.maximum(np.sqrt((normals**2).sum(1)), np.finfo(float).tiny)[:, None]
        rays = rays / np.sqrt((rays**2).sum(1))[:, None]
        facing = (normals * rays).sum(1)
        normals = np.where((facing > 0)[:, None], -normals, normals)
        facing = -np.abs(facing)
        outside = points + 1.5 * self.sun.pixel * normals
        shade = self.sun.lit(outside, SUN_SOFT)
        sun = SUN * shade * np.clip(dot(normals, self.sun.towards), 0, None)
        open_sky = 0.45 + 0.55 * self.sky.lit(outside, SKY_SOFT)
        up = (0.5 + 0.5 * normals[:, 2])[:, None]
        sky = SKY * up * open_sky[:, None] + EARTH * (1 - up)
        mirror = soup.mirror[triangle][:, None]
        mirrored = rays - 2 * facing[:, None] * normals
        gloss = np.clip(dot(mirrored, self.sun.towards), 0, 1) ** soup.sharp[triangle] * shade
        around = np.where(mirrored[:, 2:] > 0, sky_of(mirrored[:, 2]) * 0.9, GROUND * 0.55)
        matt = colours * (0.46 * sun[:, None] + sky)
        return np.asarray(matt * (1 - 0.6 * mirror) + mirror * (0.55 * around * colours + 0.45 * gloss[:, None]))


def _weights(flat: Floats, ahead: Floats, x: Floats, y: Floats) -> Floats:
    """Shares (n, 3) of a triangle's corners at a pixel, in space."""
    a, b, c = flat[:, 0], flat[:, 1], flat[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    second = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (y - a[:, 1])) / area
    third = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])) / area
    shares = np.stack([1 - second - third, second, third], 1) / ahead
    return np.asarray(shares / shares.sum(1)[:, None])
