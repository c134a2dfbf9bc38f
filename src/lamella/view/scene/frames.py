"""What moves: states of erection, load cases, modes, as the frames of a slider."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from lamella.base.arrays import Floats
from lamella.view.scene.layer import Layer


@dataclass(frozen=True, eq=False)
class Motion:
    """Where a layer is in every frame, and the values its colours show there.

    Attributes
    ----------
    layer : str
        Name of a layer of the scene, or of the frames' own: mesh, lines, points, strips, or instances.
    positions : (k, n, 3) or None
        Of the layer's positions (of instances, of their origins) in every frame, m.
    displacements : (k, n, 3) or None
        In place of `positions`: from where the layer is, m; the viewer can exaggerate them.
    normals : (k, n, 3) or None
        Of strips: their normals; those of the layer where they are not given.
    values : mapping
        By the key of one of the layer's quantities: (k, n), in its unit; its colours are those of all frames.
    """

    layer: str
    positions: Floats | None = None
    displacements: Floats | None = None
    normals: Floats | None = None
    values: Mapping[str, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise a `ValueError` where a layer has two kinds of places."""
        if self.positions is not None and self.displacements is not None:
            raise ValueError(f"{self.layer}: positions or displacements, not both")


@dataclass(frozen=True, eq=False)
class Frames:
    """A slider.

    Attributes
    ----------
    name : str
        Unique in a scene, "erection".
    label : str
        What people read in the list of what can be shown: "Erection".
    values : (k,)
        Of what the slider shows, one a frame.
    unit : str
        Of the values.
    captions : tuple of str
        What is said of each frame: driver force, load factor, name of the load case.
    motions : tuple of Motion
    layers : tuple of Layer
        That are there only while these frames are shown.
    hides : tuple of str
        Names of layers that are not drawn meanwhile; "group:Hardware" stands for all layers of a switch.
    colour : str
        Key of the quantity that layers are coloured by while the frames are shown; empty: as chosen.
    continuous : bool
        Whether there is something between two frames: places are then mixed of both. Cases are not.
    exaggeration : float
        By which displacements are drawn larger at first.
    first : int
        Frame that is shown at first.
    """

    name: str
    label: str
    values: Floats
    unit: str = ""
    captions: tuple[str, ...] = ()
    motions: tuple[Motion, ...] = ()
    layers: tuple[Layer, ...] = ()
    hides: tuple[str, ...] = ()
    colour: str = ""
    continuous: bool = True
    exaggeration: float = 1.0
    first: int = 0

    def __post_init__(self) -> None:
        """Raise a `ValueError` where lists differ in length."""
        count = len(self.values)
        if self.captions and len(self.captions) != count:
            raise ValueError(f"{self.name}: {len(self.captions)} captions of {count} frames")
        for motion in self.motions:
            given = (motion.positions, motion.displacements, motion.normals, *motion.values.values())
            if any(len(array) != count for array in given if array is not None):
                raise ValueError(f"{self.name}: the motion of {motion.layer} has not {count} frames")
