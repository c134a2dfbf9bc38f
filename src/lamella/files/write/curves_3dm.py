"""adjusted.3dm: boundary curves in the unit of the drawing they came from, for Rhino and for a next project."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import rhino3dm

from lamella.base.units import METRES
from lamella.files.whole import write_whole
from lamella.files.write.rhino_file import Frame, RhinoFile
from lamella.files.write.text import require_finite
from lamella.surface.boundary.curve import Loop

COLOUR = (60, 60, 60)


def write_curves_3dm(path: Path, loops: Sequence[Loop], frame: Frame, *, name: str, version: str) -> None:
    """Write closed NURBS curves, exactly; each is named after its loop.

    Parameters
    ----------
    path : Path
    loops : sequence of Loop
    frame : Frame
        Unit of the file, and where in the drawing the loops are measured from.
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        It cannot be written whole.
    """
    rhino = RhinoFile("curves", name, version, frame)
    rhino.add_layers({"boundary": COLOUR})
    for loop in loops:
        rhino.file.Objects.AddCurve(_curve(loop, frame), rhino.attributes("boundary", loop.name))
    write_whole(path, rhino.encoded())


def _curve(loop: Loop, frame: Frame) -> rhino3dm.NurbsCurve:
    """A loop as one NURBS curve in the file's unit, its pieces joined by full knots, its parameter the arc length."""
    metres = METRES[frame.unit]
    pieces = loop.course.pieces.transformed(1 / metres, (loop.course.origin + np.array(frame.origin)) / metres)
    degree = pieces.degree
    # homogeneous (w x, w y, w z, w); a joint is one point, its weight that of the piece it ends: pieces are rescaled
    controls = pieces.controls.copy()
    for k in range(1, len(controls)):
        controls[k] *= controls[k - 1, -1, 3] / controls[k, 0, 3]
    flat = np.concatenate([controls[:, :-1].reshape(-1, 4), controls[-1:, -1]])
    flat[-1, :3] = flat[0, :3] / flat[0, 3] * flat[-1, 3]
    require_finite(flat)
    curve = rhino3dm.NurbsCurve(3, bool((flat[:, 3] != 1).any()), degree + 1, len(flat))
    for k, (x, y, z, w) in enumerate(flat.tolist()):
        curve.Points[k] = rhino3dm.Point4d(x, y, z, w)
    breaks = np.append(loop.course.joints, loop.course.length) / metres
    for k, knot in enumerate(np.repeat(breaks, degree).tolist()):
        curve.Knots[k] = knot
    return curve
