"""Curve files: which reader, and the curve that is meant."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.plausible_size import SMALLEST, refuse_doubtful
from lamella.base.units import METRES, PROJECT_UNITS, unit_name
from lamella.files.read.choose_curve import choose_loop
from lamella.files.read.curves_3dm import read_3dm
from lamella.files.read.curves_dxf import read_dxf
from lamella.files.read.curves_json import read_json
from lamella.surface.boundary.pieces import Pieces
from lamella.surface.boundary.smooth_polyline import smooth_curve, vertices

CURVE_BYTES_MAX = 64_000_000
"""Of a file of curves: some twenty seconds of the DXF library."""

_READERS = {".3dm": read_3dm, ".dxf": read_dxf, ".json": read_json}
_HEADERS = {".3dm": "the model's unit system", ".dxf": "$INSUNITS in its header", ".json": 'its key "unit"'}


def read_curve(
    path: Path,
    *,
    layer: str | None = None,
    name: str | None = None,
    unit: str | None = None,
    interpolation: Literal["spline", "polyline"] | None = None,
    origin: Origin = NOWHERE,
    may_be_small: bool = False,
    where: str = "path",
) -> tuple[Pieces, tuple[Message, ...]]:
    """The closed curve of a .3dm, .dxf or .json, measured from a point of the drawing, and remarks on it.

    Parameters
    ----------
    path : Path
    layer, name : str, optional
        Of the curve; a name is an object's name or id (.3dm), a handle (.dxf) or a name (.json).
    unit : str, optional
        Of the file, one of `PROJECT_UNITS`; that in its header when not given.
    interpolation : "spline" or "polyline", optional
        What a polyline means; see `smooth_curve` when not given.
    origin : (x, y, z)
        m.
    may_be_small : bool
        Whether a curve smaller than any building says nothing of the unit.
    where : str
        What the caller calls the file, for messages.

    Raises
    ------
    InputError
        The file cannot be read, or no such curve is in it.
    """
    drawn, metres, remarks = chosen_curve(path, layer, name, unit, where)
    pieces = drawn.transformed(metres, -np.array(origin))
    try:
        size = pieces.extent
        if unit is None:
            given = max(size, SMALLEST) if may_be_small else size
            refuse_doubtful("the curve", given, metres, unit_name(metres, PROJECT_UNITS), where)
        # curves of a .json say themselves how their points are joined
        corners = None if path.suffix.lower() == ".json" else vertices(pieces, interpolation, where)
        if corners is not None:
            pieces, remark = smooth_curve(corners, interpolation, where)
            remarks += (remark,) if remark else ()
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    return pieces, remarks


def chosen_curve(
    path: Path, layer: str | None, name: str | None, unit: str | None, where: str = "path"
) -> tuple[Pieces, float, tuple[Message, ...]]:
    """The curve of a file in its own unit, that unit in metres, and remarks on the curve; see `read_curve`."""
    _require_readable(path, where)
    suffix = path.suffix.lower()
    content = _READERS[suffix](path, where)
    try:
        metres = _metres(unit, content.metres_per_unit, _HEADERS[suffix], where)
        chosen = choose_loop(content, layer, name, where, metres)
    except InputError as error:
        raise InputError(f"{path}: {error.message}", error.remedy, where) from None
    return chosen.pieces, metres, chosen.remarks


def unit_of_file(path: Path, where: str = "path") -> str | None:
    """Name of the unit in a curve file's header, one of `PROJECT_UNITS`; None: it has none of these."""
    metres = _READERS[path.suffix.lower()](path, where).metres_per_unit
    return next((name for name in PROJECT_UNITS if METRES[name] == metres), None)


def _require_readable(path: Path, where: str) -> None:
    if not path.is_file():
        raise InputError(f"{path}: no such file", "paths are relative to the project file's folder", where)
    try:
        count = path.stat().st_size
        if count > CURVE_BYTES_MAX:
            raise InputError(
                f"{path} has {count / 1e6:,.0f} MB; at most {CURVE_BYTES_MAX / 1e6:g} MB of curves are read",
                "save the boundary curves alone in a file of their own",
                where,
            )
        with path.open("rb") as file:
            file.read(1)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}", "check its permissions", where) from None


def _metres(given: str | None, in_header: float | None, header: str, where: str) -> float:
    """Metres per unit of a file: of the unit that is given, else as its header says."""
    if given is not None:
        return METRES[given]
    if in_header is None:
        raise InputError(
            f"the file does not say its unit ({header})", 'add unit = "mm", or the one it was drawn in, here', where
        )
    return in_header
