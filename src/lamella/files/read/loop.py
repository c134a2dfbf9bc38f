"""The boundary loop of a file of curves."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from lamella.files.read.curve import read_curve
from lamella.surface.boundary.curve import Loop, make_loop


def read_loop(
    path: str | Path,
    *,
    layer: str | None = None,
    name: str | None = None,
    unit: str | None = None,
    interpolation: Literal["spline", "polyline"] | None = None,
) -> Loop:
    """The closed curve of a .3dm, .dxf or .json, or the closed chain of its open curves.

    Parameters
    ----------
    path : str or Path
    layer, name : str, optional
        Which curve, where there are several; a name is an object's name or id (.3dm), a handle (.dxf) or a name
        (.json).
    unit : str, optional
        Of the file; that in its header when not given.
    interpolation : "spline" or "polyline", optional
        What the corners of a polyline mean.

    Raises
    ------
    InputError
        The file cannot be read, or no such curve is in it; what there is is listed.

    Examples
    --------
    >>> import lamella, json, pathlib, tempfile
    >>> corners = [[0, 0, 0], [6000, 0, 0], [6000, 6000, 0], [0, 6000, 0]]
    >>> square = {"unit": "mm", "curves": {"rim": {"points": corners, "interpolation": "polyline"}}}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "rim.json"
    ...     _ = file.write_text(json.dumps(square))
    ...     print(lamella.read_loop(file, name="rim"))
    Loop(rim: 24 m, 4 corners)
    """
    pieces, remarks = read_curve(
        Path(path), layer=layer, name=name, unit=unit, interpolation=interpolation, may_be_small=True
    )
    return make_loop(name or layer or "", pieces, remarks=remarks)
