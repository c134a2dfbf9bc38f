"""A scene as triangles with their looks, for a picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.view.render.sweep import swept
from lamella.view.scene.layer import InstancesLayer, Layer, LinesLayer, MeshLayer, StripsLayer
from lamella.view.scene.quantity import Quantity
from lamella.view.scene.scene import Scene

LOOKS: dict[str, tuple[str, float, float]] = {
    "steel": ("#b6bdc4", 0.45, 40.0),
    "timber": ("#c89d69", 0.05, 8.0),
    "fibre": ("#4d5359", 0.25, 40.0),
    "surface": ("#b9c6d3", 0.05, 8.0),
    "person": ("#46525f", 0.0, 1.0),
    "plain": ("#7b8796", 0.05, 8.0),
}
"""Colour of a material, share of what it mirrors, how sharply."""

VARIED = 0.07
"""By how much boards of timber differ in lightness."""

MISSING_COLOUR = "#8a8f96"


@dataclass(frozen=True, eq=False)
class Soup:
    """Triangles without order.

    Attributes
    ----------
    corners : (t, 3, 3)
        m.
    normals : (t, 3, 3)
        At the corners, outwards.
    colours : (t, 3, 3)
        At the corners, linear red, green and blue, 0 to 1.
    mirror, sharp : (t,)
        See `LOOKS`.
    two_sided : (t,) bool
        Whether it is seen from behind too.
    """

    corners: Floats
    normals: Floats
    colours: Floats
    mirror: Floats
    sharp: Floats
    two_sided: np.ndarray[tuple[int], np.dtype[np.bool_]]


def soup_of(scene: Scene, *, colour: str, surface: bool, eye: Floats, piece: float) -> Soup:
    """All triangles of what a picture shows.

    Parameters
    ----------
    scene : Scene
    colour : str
        Key of a quantity, "layer" or "" (materials).
    surface : bool
        Whether the surface is shown.
    eye : (3,)
        Lines are bands that face it.
    piece : float
        Samples of strips nearer to each other are left out, and lines are half as wide, m.
    """
    parts = [_part(layer, scene, colour, eye, piece) for layer in shown_layers(scene, surface=surface)]
    found = [part for part in parts if part is not None]
    if not found:
        nothing = np.zeros((0, 3, 3))
        return Soup(nothing, nothing, nothing, np.zeros(0), np.zeros(0), np.zeros(0, bool))
    names = ("corners", "normals", "colours", "mirror", "sharp", "two_sided")
    return Soup(*(np.concatenate([getattr(part, name) for part in found]) for name in names))


def shown_layers(scene: Scene, *, surface: bool) -> Iterator[Layer]:
    """Layers of a picture: nothing that another one replaces, no points, the ground is drawn otherwise."""
    off = {
        group
        for layer in scene.layers
        for group in layer.groups
        if not any(one.visible for one in scene.layers if group in one.groups)
    }
    on = [layer for layer in scene.layers if not off & set(layer.groups)]
    replaced = {name for layer in on for name in layer.replaces}
    # where nothing else stands there the surface is what there is to see
    alone = not any(isinstance(layer, StripsLayer | LinesLayer) and layer.name != "rim" for layer in on)
    for layer in on:
        if layer.name in replaced or layer.material == "ground":
            continue
        if layer.material == "surface" and not (surface or alone):
            continue
        yield layer


def _part(layer: Layer, scene: Scene, colour: str, eye: Floats, piece: float) -> Soup | None:
    match layer:
        case MeshLayer():
            colours = _vertex_colours(layer, scene, colour)
            return _soup(layer, layer.positions, layer.faces, colours, layer.normals)
        case StripsLayer():
            kept = _spaced(layer.positions, layer.offsets, piece)
            vertices, faces, sample = swept(layer, kept)
            return _soup(layer, vertices, faces, _element_colours(layer, colour)[sample])
        case InstancesLayer():
            count = len(layer.positions)
            places = np.einsum("vi,qij->qvj", layer.positions, layer.axes) + layer.origins[:, None]
            faces = (layer.faces[None] + count * np.arange(layer.count)[:, None, None]).reshape(-1, 3)
            colours = np.repeat(_element_colours(layer, colour), count, axis=0)
            return _soup(layer, places.reshape(-1, 3), faces, colours)
        case LinesLayer():
            kept = _spaced(layer.positions, layer.offsets, piece)
            return _bands(layer, kept, _element_colours(layer, colour), eye, piece / 4)
    return None


def _soup(layer: Layer, vertices: Floats, faces: Integers, colours: Floats, normals: Floats | None = None) -> Soup:
    corners = vertices[faces]
    if normals is None:
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(flat, axis=1)[:, None]
        at_corners = np.repeat((flat / np.where(length > 0, length, 1.0))[:, None], 3, axis=1)
    else:
        at_corners = normals[faces]
    _, mirror, sharp = LOOKS.get(layer.material, LOOKS["plain"])
    every = np.ones(len(faces))
    both = np.full(len(faces), layer.material == "surface" or isinstance(layer, LinesLayer))
    return Soup(corners, at_corners, colours[faces], mirror * every, sharp * every, both)


def _bands(layer: LinesLayer, kept: Integers, colours: Floats, eye: Floats, width: float) -> Soup:
    """Lines as bands that face the eye."""
    points = layer.positions[kept]
    offsets = np.searchsorted(kept, layer.offsets)
    starts = np.setdiff1d(np.arange(len(kept)), offsets[1:] - 1)
    a, b = points[starts], points[starts + 1]
    across = np.cross(b - a, eye - a)
    length = np.linalg.norm(across, axis=1)[:, None]
    across *= width / np.where(length > 0, length, 1.0)
    vertices = np.stack([a - across, b - across, b + across, a + across], 1).reshape(-1, 3)
    quads = 4 * np.arange(len(starts))[:, None] + np.arange(4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return _soup(layer, vertices, faces, np.repeat(colours[kept[starts]], 4, axis=0))


def _spaced(points: Floats, offsets: Integers, piece: float) -> Integers:
    """Every so many samples of curves, about `piece` apart, with their ends."""
    if len(points) < 2:
        return np.arange(len(points))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    stride = max(int(piece / max(float(np.median(steps)), np.finfo(float).tiny)), 1)
    within = np.arange(len(points)) - np.repeat(offsets[:-1], np.diff(offsets))
    keep = within % stride == 0
    keep[offsets[1:] - 1] = True
    return np.flatnonzero(keep)


def _vertex_colours(layer: MeshLayer, scene: Scene, colour: str) -> Floats:
    """Of a mesh: its own, or those of the strips it is like."""
    if layer.like and layer.samples is not None:
        source = scene.layer(layer.like)
        assert isinstance(source, StripsLayer)
        return _element_colours(source, colour)[layer.samples]
    return _element_colours(layer, colour)


def _element_colours(layer: Layer, colour: str) -> Floats:
    quantity = next((one for one in layer.quantities if one.key == colour), None)
    if quantity is not None:
        return quantity_colours(quantity)
    own = layer.colour and (colour == "layer" or not layer.palette)
    plain = linear_of(layer.colour if own else LOOKS.get(layer.material, LOOKS["plain"])[0])
    if layer.material == "timber" and isinstance(layer, StripsLayer):
        board = np.repeat(np.arange(len(layer.offsets) - 1), np.diff(layer.offsets))
        # the golden ratio spreads the shades of neighbours
        shade = 1 + VARIED * (2 * np.mod(board * 0.6180339887498949, 1.0) - 1)
        return np.asarray(shade[:, None] * plain)
    return np.broadcast_to(plain, (layer.count, 3))


def quantity_colours(quantity: Quantity) -> Floats:
    """Linear colours of a quantity's values, (n, 3)."""
    stops = np.array([srgb_of(stop) for stop in quantity.stops])
    span = quantity.high - quantity.low
    share = np.clip((quantity.values - quantity.low) / span, 0, 1) if span > 0 else np.zeros(len(quantity.values))
    place = np.where(np.isfinite(share), share, 0) * (len(stops) - 1)
    left = np.minimum(place.astype(np.int64), max(len(stops) - 2, 0))
    right = np.minimum(left + 1, len(stops) - 1)
    mixed = stops[left] + (place - left)[:, None] * (stops[right] - stops[left])
    return np.where(np.isfinite(share)[:, None], linear(mixed), linear_of(MISSING_COLOUR))


def srgb_of(colour: str) -> Floats:
    """Shares of red, green and blue of #rrggbb."""
    return np.array([int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)])


def linear(srgb: Floats) -> Floats:
    """Light of sRGB values (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def linear_of(colour: str) -> Floats:
    """Light of #rrggbb."""
    return linear(srgb_of(colour))
