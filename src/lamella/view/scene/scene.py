"""What a report, the studio, a notebook or a still picture shows, independent of any stage."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.view.scene.curves import Curves
from lamella.view.scene.frames import Frames
from lamella.view.scene.layer import Layer


@dataclass(frozen=True, eq=False)
class Labels:
    """Texts at points.

    Attributes
    ----------
    name, label : str
        Unique; what people read on the switch.
    positions : (n, 3)
        m.
    texts : tuple of str
    visible : bool
        At first.
    """

    name: str
    label: str
    positions: Floats
    texts: tuple[str, ...]
    visible: bool = False


@dataclass(frozen=True, eq=False)
class Mark:
    """The places that a warning speaks of.

    Attributes
    ----------
    key : str
        Of the warning (`Message.key`).
    positions : (n, 3)
        m.
    ids : tuple of str
        Lamellas it speaks of: one for each place, or one for all.
    """

    key: str
    positions: Floats
    ids: tuple[str, ...] = ()


@dataclass(frozen=True)
class Remark:
    """A sentence below the view: what was left out of it, for one."""

    text: str


Shown = Layer | Frames | Labels | Mark | Curves | Remark
"""What a stage may give."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that is shown.

    Attributes
    ----------
    name : str
        Of the project.
    layers : tuple of Layer
    frames : tuple of Frames
    labels : tuple of Labels
    marks : tuple of Mark
    curves : tuple of Curves
    remarks : tuple of str
    origin : (float, float, float)
        Of the coordinates, in the drawing, m.
    """

    name: str
    layers: tuple[Layer, ...] = ()
    frames: tuple[Frames, ...] = ()
    labels: tuple[Labels, ...] = ()
    marks: tuple[Mark, ...] = ()
    curves: tuple[Curves, ...] = ()
    remarks: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def layer(self, name: str) -> Layer:
        """A layer by its name.

        Raises
        ------
        KeyError
        """
        for layer in self.layers:
            if layer.name == name:
                return layer
        raise KeyError(name)

    @property
    def box(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of what is there, without its surroundings."""
        built = [layer for layer in self.layers if layer.material not in ("ground", "person")]
        clouds = [layer.reach for layer in built if len(layer.points)]
        if not clouds:
            return np.zeros(3), np.zeros(3)
        return np.min([cloud.min(0) for cloud in clouds], axis=0), np.max([cloud.max(0) for cloud in clouds], axis=0)


def make_scene(name: str, shown: Iterable[Shown], origin: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Scene:
    """A scene of what stages give; curves of one name become one.

    Raises
    ------
    ValueError
        Two layers of one name, or a motion of a layer that is not there.
    """
    given = list(shown)
    layers = tuple(one for one in given if isinstance(one, Layer))
    frames = tuple(one for one in given if isinstance(one, Frames))
    _check_names(layers, frames)
    curves: dict[str, Curves] = {}
    for one in given:
        if isinstance(one, Curves):
            curves[one.name] = _together(curves[one.name], one) if one.name in curves else one
    return Scene(
        name,
        layers,
        frames,
        tuple(one for one in given if isinstance(one, Labels)),
        tuple(one for one in given if isinstance(one, Mark)),
        tuple(curves.values()),
        tuple(one.text for one in given if isinstance(one, Remark)),
        origin,
    )


def _together(first: Curves, second: Curves) -> Curves:
    """Facts and plots of both."""
    return replace(
        first,
        facts=first.facts + second.facts,
        plots=first.plots + second.plots,
        worst=first.worst or second.worst,
        worst_by=first.worst_by or second.worst_by,
    )


def _check_names(layers: tuple[Layer, ...], frames: tuple[Frames, ...]) -> None:
    names = [layer.name for layer in (*layers, *(own for one in frames for own in one.layers))]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"two layers with the name {twice[0]!r}")
    for one in frames:
        known = {layer.name for layer in (*layers, *one.layers)}
        unknown = [motion.layer for motion in one.motions if motion.layer not in known]
        if unknown:
            raise ValueError(f"{one.name}: there is no layer {unknown[0]!r}")
