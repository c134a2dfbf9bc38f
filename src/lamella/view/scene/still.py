"""A scene as it is in one frame of a slider."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import InstancesLayer, Layer, MeshLayer, StripsLayer
from lamella.view.scene.scene import Scene

WHERE = "--frames"


def at_frame(scene: Scene, name: str, frame: int) -> Scene:
    """The scene with layers where they are in a frame: those of the slider in place of those that it hides.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the slider.
    frame : int
        From 0; negative ones count from the end.

    Raises
    ------
    InputError
        No such slider, or it has fewer frames.
    """
    frames = next((one for one in scene.frames if one.name == name), None)
    if frames is None:
        known = ", ".join(one.name for one in scene.frames) or "none: no stage that was run moves anything"
        raise InputError(f"there are no frames {name!r}", f"choose one of {known}", WHERE)
    count = len(frames.values)
    if not -count <= frame < count:
        raise InputError(f"frame {frame} of {name!r}", f"there are {count}: write 0 to {count - 1}", WHERE)
    motions = {motion.layer: motion for motion in frames.motions}
    hidden = set(frames.hides)
    kept = [
        layer
        for layer in (*scene.layers, *frames.layers)
        if layer.name not in hidden and not any(f"group:{group}" in hidden for group in layer.groups)
    ]
    moved = (_moved(layer, motions.get(layer.name), frame, frames) for layer in kept)
    return replace(scene, layers=tuple(moved), frames=())


def _moved(layer: Layer, motion: Motion | None, frame: int, frames: Frames) -> Layer:
    if motion is None:
        return layer
    changes: dict[str, Any] = {}
    own = "origins" if isinstance(layer, InstancesLayer) else "positions"
    rest: Floats = getattr(layer, own)
    if motion.positions is not None:
        changes[own] = motion.positions[frame]
    if motion.displacements is not None:
        changes[own] = rest + frames.exaggeration * motion.displacements[frame]
    if motion.normals is not None and isinstance(layer, StripsLayer):
        changes["normals"] = motion.normals[frame]
    if own in changes and isinstance(layer, MeshLayer):
        # of where it was
        changes["normals"] = None
    if motion.values:
        changes["quantities"] = tuple(
            replace(one, values=np.asarray(motion.values[one.key][frame])) if one.key in motion.values else one
            for one in layer.quantities
        )
    return replace(layer, **changes)
