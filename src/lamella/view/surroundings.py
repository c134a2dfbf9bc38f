"""What tells the size of a structure: the ground it stands on and a person, 1.75 m tall, beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.view.scene.layer import Layer, MeshLayer
from lamella.view.scene.scene import Scene

TALL = 1.75
"""Height of the person, m."""

LEAST_BESIDE, LARGEST_BESIDE = 1.0, 60.0
"""m: beside smaller things a person hides them, beside larger ones nobody sees one; both can still be switched on."""

GROUND = 2.5
"""Radius of the ground over half the diagonal of what stands on it."""

GROUP = "Ground and person"

# a body as rings about its axis: height, half width, half depth, shares of TALL
_TRUNK = (
    (0.435, 0.000, 0.000),
    (0.44, 0.040, 0.040),
    (0.47, 0.088, 0.062),
    (0.52, 0.098, 0.068),
    (0.62, 0.080, 0.057),
    (0.72, 0.100, 0.066),
    (0.79, 0.122, 0.062),
    (0.818, 0.112, 0.052),
    (0.84, 0.060, 0.042),
    (0.85, 0.034, 0.034),
    (0.87, 0.030, 0.032),
    (0.885, 0.038, 0.046),
    (0.93, 0.047, 0.058),
    (0.97, 0.042, 0.052),
    (0.993, 0.022, 0.028),
    (1.0, 0.000, 0.000),
)
_LEG = (
    (0.0, 0.000, 0.000),
    (0.0, 0.030, 0.060),
    (0.03, 0.029, 0.045),
    (0.06, 0.023, 0.027),
    (0.20, 0.034, 0.037),
    (0.28, 0.032, 0.035),
    (0.42, 0.046, 0.052),
    (0.49, 0.044, 0.056),
    (0.51, 0.000, 0.000),
)
_ARM = (
    (0.40, 0.000, 0.000),
    (0.405, 0.013, 0.018),
    (0.44, 0.019, 0.026),
    (0.48, 0.017, 0.020),
    (0.60, 0.023, 0.026),
    (0.66, 0.024, 0.027),
    (0.77, 0.031, 0.034),
    (0.80, 0.028, 0.031),
    (0.82, 0.018, 0.020),
    (0.826, 0.000, 0.000),
)
# of the legs from the middle, of an arm's hand and shoulder
_HIP, _HAND, _SHOULDER = 0.049, 0.150, 0.120
_AROUND = 16


def surroundings(low: Floats, high: Floats) -> Iterator[MeshLayer]:
    """Ground and person for what lies between two corners of a box, m; nothing where the box has no size."""
    diagonal = float(np.linalg.norm(high - low))
    if not diagonal > 0:
        return
    middle, ground = (low + high) / 2, float(low[2])
    shown = LEAST_BESIDE <= diagonal <= LARGEST_BESIDE
    disc = _disc(np.array([middle[0], middle[1], ground]), GROUND * diagonal / 2)
    yield MeshLayer(
        name="ground",
        label="Ground",
        groups=(GROUP,),
        visible=shown,
        material="ground",
        positions=disc[0],
        normals=np.tile([0.0, 0.0, 1.0], (len(disc[0]), 1)),
        faces=disc[1],
    )
    vertices, faces = person()
    # beside the structure, where a view from the front and one from the front-right show it before nothing else
    place = np.array([high[0] + 0.7 * TALL, low[1] + 0.25 * (high[1] - low[1]), ground])
    yield MeshLayer(
        name="person",
        label="Person, 1.75 m",
        groups=(GROUP,),
        visible=shown,
        material="person",
        positions=vertices + place,
        faces=faces,
        normals=_normals(vertices, faces),
    )


def standing(scene: Scene, shown: Iterable[Layer]) -> Scene:
    """The scene with ground and person where what a picture of it shows is, after layers have moved.

    Parameters
    ----------
    scene : Scene
    shown : iterable of Layer
        Those of its layers that the picture shows.
    """
    about = ("ground", "person")
    built = [one for one in scene.layers if one.material not in about]
    clouds = [one.reach for one in shown if one.material not in about and len(one.points)]
    if not clouds:
        return scene
    low = np.min([cloud.min(0) for cloud in clouds], axis=0)
    high = np.max([cloud.max(0) for cloud in clouds], axis=0)
    return replace(scene, layers=(*built, *surroundings(low, high)))


def person() -> tuple[Floats, Integers]:
    """A person standing on the origin, who looks against y: vertices (v, 3), m, and triangles (f, 3)."""
    pieces = [_rings(_TRUNK, 0.0, 0.0)]
    for side in (-1, 1):
        pieces.append(_rings(_LEG, side * _HIP, side * _HIP))
        pieces.append(_rings(_ARM, side * _HAND, side * _SHOULDER))
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    return (
        TALL * np.concatenate([vertices for vertices, _ in pieces]),
        np.concatenate([faces + start for (_, faces), start in zip(pieces, starts[:-1], strict=True)]),
    )


def _rings(rings: tuple[tuple[float, float, float], ...], foot: float, top: float) -> tuple[Floats, Integers]:
    """Ellipses about an axis that leans from `foot` to `top` in x, joined by triangles."""
    z, wide, deep = (np.array(column) for column in zip(*rings, strict=True))
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    lean = foot + (top - foot) * (z - z[0]) / (z[-1] - z[0])
    points = np.stack(
        [
            lean[:, None] + wide[:, None] * np.cos(angle),
            deep[:, None] * np.sin(angle),
            np.broadcast_to(z[:, None], (len(z), _AROUND)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(len(z) - 1), np.arange(_AROUND), indexing="ij")
    a, b = row * _AROUND + column, row * _AROUND + (column + 1) % _AROUND
    quads = np.stack([a, b, b + _AROUND, a + _AROUND], -1).reshape(-1, 4)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _normals(vertices: Floats, faces: Integers) -> Floats:
    """Unit normals of vertices, means of their faces' by area; vertices in one place have one."""
    _, same = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    same = same.reshape(-1)
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros((int(same.max()) + 1, 3))
    for k in range(3):
        np.add.at(total, same[faces[:, k]], across)
    length = np.linalg.norm(total, axis=1)
    return np.asarray((total / np.maximum(length, np.finfo(float).tiny)[:, None])[same])


def _disc(centre: Floats, radius: float, parts: int = 64) -> tuple[Floats, Integers]:
    """Vertices and triangles of a level disc."""
    angle = 2 * np.pi * np.arange(parts) / parts
    rim = centre + radius * np.stack([np.cos(angle), np.sin(angle), np.zeros(parts)], 1)
    around = np.arange(parts)
    faces = np.stack([np.zeros(parts, np.int64), around + 1, (around + 1) % parts + 1], 1)
    return np.vstack([centre, rim]), faces
