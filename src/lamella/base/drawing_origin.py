"""Drawings far from their origin, in survey coordinates: where the program measures from, and places in their words.

A double holds a coordinate of 5,000 km to a nanometre, which is too little for the curvature of a film, and products of
such coordinates hold no digits at all. A boundary or mesh that far away is therefore measured from a round point beside
it as soon as it is read; files, summary and messages add that point again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats

Origin = tuple[float, float, float]

FAR_SIZES = 1000.0
"""Sizes. Nearer drawings lose three of sixteen digits, and are measured from their own origin."""

LARGE_COORDINATE = 1e4
"""m. Larger coordinates are told to the millimetre, not to some digits."""

NOWHERE: Origin = (0.0, 0.0, 0.0)

_reported_from: ContextVar[Origin] = ContextVar("reported_from", default=NOWHERE)


def origin_of(points: Floats) -> Origin:
    """A round point beside points (n, 3) where these are far from the origin for their size, else the origin.

    Its coordinates are whole multiples of a power of ten, and of a unit of length at least, that is not below the size:
    differences from it are exact.
    """
    low, high = points.min(0), points.max(0)
    size = float(np.linalg.norm(high - low))
    middle = (low + high) / 2
    if not size > 0 or not np.abs(middle).max() > FAR_SIZES * size:
        return NOWHERE
    step = 10.0 ** max(math.ceil(math.log10(size)), 0)
    x, y, z = (np.rint(middle / step) * step + 0.0).tolist()
    return x, y, z


@contextmanager
def reported_from(origin: Origin) -> Iterator[None]:
    """Places in messages are in the drawing's coordinates, where the program measures from a point of it."""
    token = _reported_from.set(origin)
    try:
        yield
    finally:
        _reported_from.reset(token)


def coordinates(point: ArrayLike, digits: int = 4) -> str:
    """A point (3,) of the drawing in a message, m: "x, y, z"."""
    there = np.asarray(point, float) + _reported_from.get()
    if np.abs(there).max() < LARGE_COORDINATE:
        return ", ".join(f"{x:.{digits}g}" for x in there.tolist())
    return ", ".join(f"{x:.3f}" for x in there.tolist())


def drawing_origin(surface: object) -> Origin:
    """Point of the drawing that a surface's points are measured from, m; closed forms have no drawing."""
    origin: Origin = getattr(surface, "origin", NOWHERE)
    return origin


def measured_from(origin: Origin) -> str:
    """The remark on an origin that is not the drawing's."""
    return f"measured from ({', '.join(f'{x:.10g}' for x in origin)}) m of the drawing"


def origin_figure(origin: Origin | None) -> dict[str, Origin]:
    """What the summary tells of an origin that is not the drawing's."""
    return {"origin": origin} if origin is not None and any(origin) else {}


def with_drawn_points(figures: Any, origin: Origin) -> Any:
    """A table of figures with each "point" in the drawing's coordinates."""
    if not any(origin):
        return figures
    if isinstance(figures, dict):
        return {
            key: _sum(item, origin) if key == "point" else with_drawn_points(item, origin)
            for key, item in figures.items()
        }
    return [with_drawn_points(item, origin) for item in figures] if isinstance(figures, list | tuple) else figures


def _sum(point: Sequence[float], origin: Origin) -> list[float]:
    return [x + o for x, o in zip(point, origin, strict=True)]
